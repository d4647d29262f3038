"""The commands of one scene: ``run`` computes it, ``check`` prints it, ``scenes`` lists those shipped."""

from __future__ import annotations

import math
import shlex
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.commands.common import (
    changed_scene,
    checked_out,
    chosen_meter,
    print_json,
    read_changes,
)
from fem_impact.commands.parser import Options
from fem_impact.errors import RunError, UsageError
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.jobs.executors import cores
from fem_impact.options import RunOptions
from fem_impact.progress import clock_text
from fem_impact.scene.fields import DEFAULTS
from fem_impact.scene.library import intervals_of, shipped, source_of, stated_keys
from fem_impact.scene.shipped import load
from fem_impact.scene.types import Scene
from fem_impact.scene.write import digest, to_dict, to_toml
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped

if TYPE_CHECKING:
    from fem_impact.outcome.groups import EffectChoice
    from fem_impact.outcome.record import Outcome
    from fem_impact.plan.plan import Plan
    from fem_impact.plan.size import RunSize


LONG = 600.0
"""Expected computing time, s, above which `run` prints it before it starts."""


def run(options: Options) -> int:
    """Compute one scene, write its results and print them."""
    scene = changed_scene(options.scene, options.changes)
    if options.resume and options.fidelity in ("rigid", "modal"):
        problem, remedy = "is of finite elements: this run takes seconds.", "Leave it out."
        raise UsageError(problem, key="--resume", value=options.fidelity, remedy=remedy)
    _say_fall(scene, options)
    _say_plan(scene, options)
    out = checked_out(options.out or _default_out(scene, options))
    from fem_impact.commands.outcome import print_outcome
    from fem_impact.cost.to_target import simulate
    from fem_impact.files.run_directory import earlier

    meter, before = chosen_meter(options), earlier(out)
    try:
        run_options = RunOptions(out, meter, options.resume, options.checkpoint)
        outcome = simulate(scene, options.fidelity or None, run_options, cores(), budget_s=_budget(options))
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"Results: {out}; {_way_on(out)}") from None
    finally:
        meter.close()
        _say_kept(out, before, options)
    if options.json:
        sys.stdout.write(outcome.to_json().rstrip("\n") + "\n")
    else:
        print_outcome(outcome, out)
        _say_comparison(scene, outcome)
        _say_screening(scene, options)
    if outcome.validity.finished:
        return 0
    cause = outcome.validity.stopped_because
    sys.stderr.write(f"fem-impact: error: the run stopped early: {cause} Results: {out}\n")
    return RunError.exit_code


def _say_comparison(scene: Scene, outcome: Outcome) -> None:
    """Print the outcome beside the tests that its scene names."""
    from fem_impact.run.tests import tests_of
    from fem_impact.study.compare import compare

    tests = tests_of(scene)
    if tests is None:
        return
    head = ("", "model", "measured", "SD", "")
    rows = [
        (
            row["quantity"],
            *(f"{row[key]:.4g}" for key in ("model", "measured_mean", "measured_sd")),
            row["verdict"],
        )
        for row in compare(outcome, tests)
        if row["measured_mean"] is not None and row["model"] is not None
    ]
    told = f"beside {len(tests.motion['v_n'])} measured tests ({scene.measured}):"
    sys.stdout.write(f"{told}\n{Table.of(head, rows, left=(0, 4)).terminal(indent='  ')}\n")


def _say_screening(scene: Scene, options: Options) -> None:
    """Print the closed-form screening of the scene, and the command of the verdict on it."""
    from fem_impact.verdict.screening import screening
    from fem_impact.verdict.sentences import lines_of, screening_lines

    changes = [word for change in options.changes for word in ("--set", change)]
    lines = lines_of(screening_lines(screening(scene), shlex.join([options.scene, *changes])), indent="")
    sys.stdout.write("\n".join(lines) + "\n")


def _say_plan(scene: Scene, options: Options) -> None:
    """Print the setting chosen for the scene's target error, or without one the time of a long run."""
    if scene.accuracy.target is None:
        sentence = "" if options.fidelity in ("rigid", "modal") else _long_run(scene)
    else:
        from fem_impact.cost.to_target import settle

        sentence = settle(scene, options.fidelity or None, cores(), _budget(options)).sentence
    if sentence and not options.quiet:
        sys.stderr.write(f"{sentence}\n")


def _budget(options: Options) -> float:
    """Return the wall time, s, of ``--budget``, for a scene that states the error it allows."""
    from fem_impact.cost.to_target import BUDGET
    from fem_impact.scene.units import option_quantity

    return option_quantity(options.budget, "time", "--budget") if options.budget else BUDGET


def _long_run(scene: Scene) -> str:
    from fem_impact.plan.plan import plan

    size = plan(scene).size
    if size.time <= LONG:
        return ""
    return f"This run takes about {clock_text(size.time)} ({_elements(size)}); a larger tip_size is quicker."


def _elements(size: RunSize) -> str:
    from fem_impact.plan.size import about

    return f"{about(size.rod + size.barrier)} elements, {about(size.steps)} steps"


def _say_fall(scene: Scene, options: Options) -> None:
    """Say what became of stated velocities where ``--set`` changed the angle of impact alone."""
    changed, impact = set(read_changes(options.changes)), scene.impact
    stated = any(key.startswith(("impact.v_", "impact.speed", "impact.height")) for key in changed)
    if stated or not {"impact.angle", "impact.angle_rad"} & changed or impact.height:
        return
    speed = math.hypot(impact.v_n, impact.v_t)
    if impact.speed:
        told = f"the rod falls along its axis as fast as before, {speed:.4g} m/s"
    else:
        told = (
            "warning: v_n and v_t are those of the old angle. A fall as fast at the new one: "
            f"--set impact.speed='{speed:.4g} m/s'"
        )
    sys.stderr.write(f"fem-impact: {told}\n")


def _way_on(out: Path) -> str:
    if (out / CHECKPOINT).exists():
        return "--resume goes on from the last checkpoint."
    return "no checkpoint was due yet (--checkpoint SECONDS), so --resume would start at the beginning."


def _say_kept(out: Path, before: list[Path], options: Options) -> None:
    from fem_impact.files.run_directory import earlier

    for place in earlier(out):
        if place not in before and not options.quiet:
            sys.stderr.write(f"An older run that was in {out} is kept in {place}\n")


def _default_out(scene: Scene, options: Options) -> Path:
    """Return results/ID, with 8 digits of the digest of a changed scene and the fidelity if not solid."""
    name = f"{scene.id}-{digest(scene)[:8]}" if options.changes else scene.id
    return Path("results") / (name if options.fidelity in ("", "solid") else f"{name}-{options.fidelity}")


def scenes(options: Options) -> int:
    """List the shipped scenes."""
    listed = [_listed(load(name)) for name in shipped()]
    if options.json:
        print_json({"scenes": listed})
    else:
        rows = [[scene[key] for key in ("id", "speed", "title")] for scene in listed]
        sys.stdout.write(Table.of(("id", "speed", "title"), rows, left=range(3)).terminal() + "\n")
    return 0


def check(options: Options) -> int:
    """Print a scene's full statement: values, sources, effects and validity."""
    from fem_impact.plan.plan import plan

    planned = plan(changed_scene(options.scene, options.changes))
    _say_fall(planned.scene, options)
    statement = _statement(planned)
    if options.json:
        print_json(statement)
    else:
        sys.stdout.write(_readable(planned, statement))
    return 0


def _listed(scene: Scene) -> dict[str, Any]:
    speed = math.hypot(scene.relative.v_n, scene.relative.v_t)
    return {
        "id": scene.id,
        "title": scene.title,
        "speed": f"{speed:.2f} m/s",
        "measured": scene.measured,
        "digest": digest(scene),
    }


def _statement(planned: Plan) -> dict[str, Any]:
    scene = planned.scene
    return {
        "scene": to_dict(scene),
        "digest": digest(scene),
        "body": _body_entry(scene),
        "sources": _sources(scene),
        "intervals": _intervals(scene),
        "flow_stress_Pa": _flow_stresses(planned),
        "defaults": [{"key": d.key, "value": d.value, "source": d.source} for d in DEFAULTS],
        "effects": [_flat(choice.told(choice.share)) for choice in planned.choices],
        "validity": list(planned.validity),
        "warnings": list(planned.warnings),
        "size": None if scene.accuracy.target else _size_entry(planned.size),
    }


def _body_entry(scene: Scene) -> dict[str, float]:
    """Return what the theories need of the projectile, SI."""
    from fem_impact.physics.beam import bending_period, stretching_period
    from fem_impact.physics.contact import arms, principal_radii, projectile, touch_point

    body, (d_c, d_d), (rho, z) = projectile(scene), arms(scene), touch_point(scene)
    R1, R2 = principal_radii(scene)
    return {
        "mass_kg": body.mass,
        "centre_m": body.z_c,
        "inertia_kg_m2": body.mass * body.k2,
        "k2_m2": body.k2,
        "length_m": body.length,
        "diameter_m": body.diameter,
        "gamma": body.gamma,
        "touch_z_m": z,
        "touch_rho_m": rho,
        "R1_m": R1,
        "R2_m": R2,
        "d_c_m": d_c,
        "d_d_m": d_d,
        "bending_period_s": bending_period(scene),
        "stretching_period_s": stretching_period(scene),
    }


def _body_lines(body: dict[str, float]) -> Iterable[str]:
    """Return the projectile's numbers in words."""
    mm = {key: 1e3 * value for key, value in body.items() if key.endswith("_m")}
    return (
        f"mass {body['mass_kg']:.4g} kg, centre {mm['centre_m']:.4g} mm from the tip, moment of inertia "
        f"about it {body['inertia_kg_m2']:.4g} kg m2",
        f"touches first {mm['touch_z_m']:.3g} mm from the tip, {mm['touch_rho_m']:.3g} mm off the axis, "
        f"with radii {mm['R1_m']:.3g} mm (meridian) and {mm['R2_m']:.3g} mm (around)",
        f"arms there: d_c = {mm['d_c_m']:.4g} mm, d_d = {mm['d_d_m']:.4g} mm",
        f"periods: bending T1 = {1e6 * body['bending_period_s']:.3g} us, longitudinal "
        f"{1e6 * body['stretching_period_s']:.3g} us (beam and bar)",
        f"gamma {body['gamma']:.4g} m^-0.3815, from the largest diameter, {mm['diameter_m']:.4g} mm",
    )


def _drawing(scene: Scene) -> list[str]:
    from fem_impact.figures.outline import drawn
    from fem_impact.physics.contact import projectile, touch_point

    joints = [part.to for part in scene.projectile.segments[:-1]]
    return drawn(projectile(scene), touch_point(scene), joints)


def _size_entry(size: RunSize) -> dict[str, float]:
    return {
        "elements_rod": size.rod,
        "elements_barrier": size.barrier,
        "elements_yielding": size.yielding,
        "step_s": size.step,
        "steps": size.steps,
        "most_steps": size.most_steps,
        "memory_MB": round(size.memory / 1e6),
        "cpu_s": size.time,
        "most_cpu_s": size.most_time,
    }


def _flat(choice: EffectChoice) -> dict[str, Any]:
    from fem_impact.outcome.keys import keys_of

    return {key.name: key.of(choice) for key in keys_of(type(choice))}


def _sources(scene: Scene) -> dict[str, str]:
    """Return where each material value and the friction come from, by dotted key."""
    sources = {
        f"{body}.material.{key}": source_of(metal.name, key)
        for body, metal in scene.materials.items()
        for key in stated_keys(metal)
    }
    return sources | {"surface.friction": scene.surface.source}


def _intervals(scene: Scene) -> dict[str, tuple[float, float]]:
    """Return the intervals that a shipped material states for its values, by dotted key."""
    return {
        f"{body}.material.{key}": interval
        for body, metal in scene.materials.items()
        for key, interval in intervals_of(metal.name).items()
    }


def _flow_stresses(planned: Plan) -> dict[str, dict[str, float]]:
    """Return the flow stress, Pa, of each body that yields, at rest and at strain rates, 1/s."""
    from fem_impact.plan.metals import RATES, flow_stresses

    told = flow_stresses(planned.scene, planned.active)
    rates = ["0", *(f"{rate:g}" for rate in RATES)]
    return {body: dict(zip(rates, stresses, strict=True)) for body, stresses in told.items()}


def _flow_lines(statement: dict[str, Any]) -> list[str]:
    told = statement["flow_stress_Pa"]
    if not told:
        return []
    heading = "Flow stress at 8 % plastic strain, MPa, at rest and at strain rates, 1/s"
    rates = list(next(iter(told.values())))
    rows = [[body, *(f"{stress / 1e6:.0f}" for stress in told[body].values())] for body in told]
    table = Table.of(("body", "at rest", *rates[1:]), rows, left=range(1)).terminal()
    return ["", heading, *(f"  {line}" for line in table.splitlines())]


def _readable(planned: Plan, statement: dict[str, Any]) -> str:
    lines = [to_toml(planned.scene).rstrip(), "", "Sources"]
    lines += _wrapped(f"{key}: {source}" for key, source in statement["sources"].items())
    lines += _wrapped(
        f"{key}: interval {low:g} to {high:g}" for key, (low, high) in statement["intervals"].items()
    )
    lines += _flow_lines(statement)
    lines += ["", "Values used where a scene does not state them"]
    lines += _wrapped(f"{d['key']} = {d['value']}: {d['source']}" for d in statement["defaults"])
    lines += ["", "Projectile", *_drawing(planned.scene), *_wrapped(_body_lines(statement["body"]))]
    lines += ["", "Effects"]
    lines += [line for choice in planned.choices for line in _effect_lines(choice.told(choice.share))]
    lines += _wrapped(f"warning: {sentence}" for sentence in statement["warnings"])
    lines += _size_lines(planned)
    lines += ["", "Validity"]
    inside = "inside the measured range of speed, angle, rod, steels and surfaces"
    lines += _wrapped(statement["validity"] or [inside])
    return "\n".join([*lines, "", "The scene is valid; its digest:", statement["digest"]]) + "\n"


def _size_lines(planned: Plan) -> list[str]:
    if planned.scene.accuracy.target:
        return []
    from fem_impact.plan.size import about

    size = planned.size
    sentences = (
        _cells_line(planned),
        f"about {_elements(size)} of {size.step * 1e9:.2g} ns ({about(size.most_steps)} if it lasts until "
        f"max_time), {about(size.memory / 1e6)} MB of memory",
        f"about {clock_text(size.time)} of computing ({clock_text(size.most_time)} until max_time) on the "
        "machine of the stored costs, within a factor of two there",
    )
    return ["", "Size of a run with finite elements", *_wrapped(sentences)]


def _cells_line(planned: Plan) -> str:
    """Return how fine the mesh is at the contact, and the tip size that the program advises."""
    from fem_impact.plan.cells import ADVISED, ERROR, advice, contact_radius, expected_cells, kind

    bodies = planned.bodies
    cells, error, advised = expected_cells(bodies), ERROR[kind(bodies)], ADVISED[kind(bodies)]
    line = (
        f"about {cells:.2g} cells over the radius of the contact, {contact_radius(bodies) * 1e3:.2g} mm: "
        f"e and mu within some {100 * error / cells:.2g} %"
    )
    return line if cells >= advised else f"{line}. {advice(bodies)} for {100 * error / advised:.2g} %"


def _wrapped(sentences: Iterable[str]) -> list[str]:
    return [line for sentence in sentences for line in wrapped(sentence, "  ")]


def _effect_lines(effect: EffectChoice) -> list[str]:
    number = "not finite" if effect.number is None else f"{effect.number:.2g}"
    verdict = f"{'on ' if effect.on else 'off'} {effect.name}{' (forced)' if effect.forced else ''}"
    decided = f"{effect.measure}: {number}, threshold {effect.threshold:g}"
    clauses = [decided, _harm(effect), _time(effect)]
    decision = wrapped("; ".join(clause for clause in clauses if clause), " " * 8, "")
    return [*wrapped(f"{verdict}: {effect.sentence}", "  ", " " * 4), *decision]


def _harm(effect: EffectChoice) -> str:
    """Return the changes of e and E_vib without the effect, empty for a barrier that is not in use."""
    from fem_impact.effects.registry import BARRIERS

    if effect.name in BARRIERS and not effect.on:
        return ""
    return (
        f"leaving it out changes e by about {effect.change_of_e:.1g}, "
        f"E_vib by {effect.change_of_vibration:.1g} of E_0"
    )


def _time(effect: EffectChoice) -> str:
    if effect.share is None:
        return ""
    share = "under 1" if effect.share < 0.005 else f"about {100 * effect.share:.0f}"
    return f"it takes {share} % of the run time"
