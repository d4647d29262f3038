"""The command ``check``: all that a scene states and calls for, without computing it."""

import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.simulate import compiled, refused_by
from fem_impact.answers.verdict.screening import screening
from fem_impact.case.case import Case
from fem_impact.case.cells import ADVISED, ERROR, advice, contact_radius, expected_cells, kind
from fem_impact.case.effects.registry import BARRIERS, EFFECTS
from fem_impact.case.size import FRAMES_SPAN, RunSize, about
from fem_impact.cli.parser import Options
from fem_impact.cli.paths import shown_path
from fem_impact.cli.scene_options import asked_scene, say_kept
from fem_impact.cli.statement import statement_of
from fem_impact.cli.terminal import headed, limitation_lines, print_json, size_text
from fem_impact.errors import SceneError, UsageError
from fem_impact.figures.outline import drawn
from fem_impact.outcome.groups import EffectChoice, texts
from fem_impact.pages.drawing import draw_projectile
from fem_impact.physics.beam import disc_period
from fem_impact.progress import clock_text, range_text
from fem_impact.run.tests import count, doubtful_tests, tests_of, unused_columns
from fem_impact.scene.inputs import STATED, inputs, rounded_text
from fem_impact.scene.types import Scene, to_dict, to_toml
from fem_impact.tables.table import Table
from fem_impact.tables.text import plain, wrapped

DRAWINGS = (".png", ".svg")
BENDS = "plate-bending"
CLOSE = 2.0  # factor from its threshold within which the number of an effect that is off is told
INSIDE = "inside the measured range of speed, angle, rod, steels and surfaces"
LONG = "--long prints every value with its source, flow stresses, and each effect with its share of run time."


def check(options: Options) -> int:
    """Print what a scene states and calls for, and run nothing; return the exit code.

    That is the projectile's mass, arms and periods, the estimated contact, the effects with the numbers that
    decide on them, size and time of a run with finite elements, the fidelities that answer,
    limitations. ``--long`` prints every value with its source instead, ``--json`` all of it in SI units,
    ``--drawing`` draws the projectile into a file.

    Raises
    ------
    UsageError
        The drawing is no .png or .svg file.
    SceneError, ResultError
        The scene is refused, or the file of its tests cannot be read.
    """
    drawing = options.drawing
    if drawing is not None and drawing.suffix not in DRAWINGS:
        problem, remedy = "is no picture that can be drawn.", "Name a file such as projectile.svg or .png."
        raise UsageError(problem, key="--drawing", value=str(drawing), remedy=remedy)
    scene = asked_scene(options)
    try:
        case = compiled(scene, "solid")
    except SceneError as error:  # the models that take the scene are named
        able = [f"--fidelity {name}" for name in ("modal", "rigid") if not refused_by(scene, name)]
        if not able:
            raise
        others = f"{' and '.join(able)} take{'s' * (len(able) == 1)} the scene as it is."
        remedy, key, value = f"{error.remedy} {others}".strip(), error.key, error.value
        raise SceneError(error.problem, key=key, value=value, remedy=remedy, source=error.source) from None
    told, tests = list[str](), tests_of(scene)  # a file of tests that cannot be read is refused here
    if tests is not None:
        told = [f"measured: {count(tests)} tests, {shown_path(str(scene.measured))}", *unused_columns(scene)]
        told += [f"warning: {one}" for one in doubtful_tests(scene)]
    say_kept(scene, options)
    if drawing:
        draw_projectile(case, drawing)
    statement = statement_of(case)
    if options.json:
        print_json(statement)
    else:
        place = Path(options.scene).parent
        sys.stdout.write(_long(case, statement, place) if options.long else _short(case, statement))
        sys.stdout.writelines(f"{line}\n" for one in told for line in wrapped(one))
        sys.stdout.write(f"drawing: {drawing}\n" if drawing else "")
    return 0


def _body_lines(case: Case, body: dict[str, float]) -> Iterable[str]:
    """Return the numbers of the projectile in words."""
    rod = case.scene.projectile
    short = rod.length < rod.diameter and disc_period(rod) == case.bodies.bending_period
    bends_as = "plate" if short else "beam"
    mm = {key: 1e3 * value for key, value in body.items() if key.endswith("_m")}
    length, period = mm["touch_length_m"], body["ovalling_period_s"]
    part = f"with {length:.3g} mm at once, the middle of it " if length else ""
    ovalling = f", ovalling of the wall {plain(1e6 * period)} us (ring)" if period else ""
    return (
        f"mass {body['mass_kg']:.4g} kg, centre {mm['centre_m']:.4g} mm from the tip, moment of inertia "
        f"about it {body['inertia_kg_m2']:.4g} kg m2",
        f"touches first {part}{mm['touch_z_m']:.3g} mm from the tip, {mm['touch_rho_m']:.3g} mm off the axis,"
        f" with radii {mm['R1_m']:.3g} mm (meridian) and {mm['R2_m']:.3g} mm (around)",
        f"arms there: d_c = {mm['d_c_m']:.4g} mm, d_d = {mm['d_d_m']:.4g} mm",
        f"periods: bending T1 = {plain(1e6 * body['bending_period_s'])} us, longitudinal "
        f"{plain(1e6 * body['stretching_period_s'])} us ({bends_as} and bar){ovalling}",
        f"gamma {body['gamma']:.4g} m^-0.3815, from the largest width, {mm['diameter_m']:.4g} mm",
    )


def _drawing(case: Case) -> list[str]:
    joints = [part.to for part in case.scene.projectile.segments[:-1]]
    return drawn(case.bodies.body, case.contact.touch_point, joints)


def _long(case: Case, statement: dict[str, Any], place: Path) -> str:
    """Return every value with its source, files as seen from the ``place`` of the scene's file."""
    lines = [to_toml(case.scene, place).rstrip(), "", "Sources"]
    given = inputs(case.scene).rows
    lines += _wrapped(f"{key} = {value}: {source}" for key, value, source in given if source != STATED)
    lines += _wrapped(
        f"{key}: interval {low:g} to {high:g}" for key, (low, high) in statement["intervals"].items()
    )
    lines += ["", "Laws in force", *_wrapped(f"{key} {law}" for key, law in statement["laws"].items())]
    if by_body := statement["flow_stress_Pa"]:
        _, *rates = next(iter(by_body.values()))
        rows = [[body, *(f"{stress / 1e6:.0f}" for stress in of.values())] for body, of in by_body.items()]
        table = Table.of(("body", "at rest", *rates), rows, left=range(1)).terminal()
        lines += ["", "Flow stress at 8 % plastic strain, MPa, at rest and at strain rates, 1/s"]
        lines += [f"  {line}" for line in table.splitlines()]
    lines += ["", "Values used where a scene does not state them"]
    lines += _wrapped(f"{d['key']} = {d['value']}: {d['source']}" for d in statement["defaults"])
    rod = case.scene.projectile
    lines += ["", "Projectile", *_drawing(case)]
    lines += _wrapped([*statement["mesh"], *_body_lines(case, statement["body"])])
    lines += ["", "Effects"]
    lines += [rod.named(line) for choice in case.choices for line in _effect_lines(choice)]
    return "\n".join([*lines, *_size_lines(case), *_end_lines(case, statement)]) + "\n"


def _end_lines(case: Case, statement: dict[str, Any]) -> list[str]:
    limited = limitation_lines(case.limitations, "  ")
    if not texts(case.limitations, "range", "model"):
        limited = [*_wrapped([INSIDE]), *limited]
    refused = {name: reason for name, reason in statement["fidelities"].items() if reason}
    limited += _wrapped(f"not by --fidelity {name}: {reason}" for name, reason in refused.items())
    answer = ", ".join(name for name in statement["fidelities"] if name not in refused)
    valid = f"The scene is valid for --fidelity {answer}; its digest:"
    return ["", "Limitations", *limited, "", valid, statement["digest"]]


def _short(case: Case, statement: dict[str, Any]) -> str:
    """Return projectile, barrier and contact, effects with their numbers, size and limitations."""
    scene = case.scene
    lines = [headed(scene.id, scene.title), "", "Projectile", *_drawing(case)]
    rod = scene.projectile
    parts = [f"{part.material.name} up to {1e3 * part.to:.4g} mm" for part in rod.segments]
    size = f"{1e3 * rod.length:.4g} mm x {1e3 * rod.diameter:.4g} mm"
    parts += [f"{one.material.name} ({one.name})" for one in rod.regions]
    main = [] if rod.segments else [rod.material.name]
    lines += _wrapped([f"{size} of {', '.join(main + parts)}{rod.bored}", *statement["mesh"]])
    lines += _wrapped(_body_lines(case, statement["body"]))
    lines += ["", "Barrier and contact", *_wrapped(_contact_lines(case))]
    laws = (f"{place.removesuffix('.material')}: {law}" for place, law in statement["laws"].items())
    lines += ["", "Laws in force", *_wrapped(laws), "", "Effects"]
    lines += _wrapped(rod.named(f"on  {_named(one)}: {_decided(one)}") for one in case.choices if one.on)
    off = [one for one in case.choices if not one.on]
    called_for = [one for one in off if (one.number or 0.0) > one.threshold and one.name not in BARRIERS]
    lines += _wrapped(rod.named(f"off {_off(one)}: {_lacking(one, off)}") for one in called_for)
    others = ", ".join(_off(one) for one in off if one not in called_for)
    lines += _wrapped([f"off {others}: not called for, or left out by the scene"])
    lines += [*_size_lines(case), *_end_lines(case, statement), ""]
    return "\n".join([*lines, *wrapped(LONG)]) + "\n"


def _contact_lines(case: Case) -> Iterator[str]:
    """Return barrier, motion, friction and the estimated contact, and what they say of vibration."""
    scene, size = case.scene, case.estimate
    tables, layers = to_dict(scene), scene.barrier.layers
    stated = tables["barrier"].items()
    more = [_stated(key, value) for key, value in stated if key not in ("material", "layers")]
    on = "".join(f"{1e3 * one.thickness:.4g} mm of {one.material.name} on " for one in layers)
    yield ", ".join([f"{on}{scene.barrier.material.name}", *more])
    if scene.barrier.thickness and not scene.barrier.bends:
        yield (
            "its thickness changes nothing: a plate on a base is computed as a half-space. "
            'One that is free underneath and bends: barrier.support = "infinite"'
        )
    bending = next(one for one in case.choices if one.name == BENDS)
    if scene.barrier.bends and not (bending.on or bending.forced):
        yield (
            f"too thick to bend in this impact ({_decided(bending)}): leave out thickness and support. The "
            "contact and its cost are those of a massive barrier, and the waves that leave that count, too"
        )
    seen, body = case.scene.relative, case.bodies.body
    speed2 = seen.v_n**2 + seen.v_t**2
    energy = 0.5 * body.mass * (speed2 + body.k2 * seen.omega**2)
    motion = ", ".join(_stated(key, value) for key, value in tables["impact"].items())
    by = "" if seen == scene.impact else ", as seen from the barrier"
    parts = f" (v_n {seen.v_n:.4g}, v_t {seen.v_t:.4g})"
    yield f"{motion}: {speed2**0.5:.4g} m/s{parts}, E_0 = {energy:.4g} J{by}"
    surface = scene.surface
    low, high = surface.friction_low, surface.friction_high
    sure = f"{low:g} to {high:g}" if low < high else "no interval stated: it counts as exact"
    faces = "".join(f"; {one.name} f {one.surface.friction:g}" for one in scene.projectile.faces)
    yield f"friction f {surface.friction:g} ({sure}), {surface.state} surfaces{faces}"
    yield (
        f"the contact, estimated: {plain(1e3 * size.a_t, 2)} mm x {plain(1e3 * size.a_b, 2)} mm in radius, "
        f"{plain(1e3 * size.depth, 2)} mm deep, for {plain(1e6 * size.duration)} us"
    )
    yield f"{screening(case.bodies).sentence}. The verdict: `fem-impact assess`"


def _stated(key: str, value: object) -> str:
    """Return a value of the scene after its key, as stated; rounding of a unit is left out."""
    return f"{key} {rounded_text(str(value), 4)}"


def _size_lines(case: Case) -> list[str]:
    if case.scene.accuracy.target:
        return []
    size, bodies = case.size, case.bodies
    radius = contact_radius(bodies)
    if case.scene.accuracy.levels > 1:
        found = (
            "a coarse pilot finds where, how widely and how often the bodies touch; finer meshes follow what "
            f"it found, about {case.scene.accuracy.levels} in all. Each number comes with its band",
            f"if the contact is as estimated, {1e3 * radius:.2g} mm in radius, the last of them has about "
            f"{about(size.rod + size.barrier)} elements, {about(size.memory / 1e6)} MB of memory, and "
            f"all take {range_text(*LevelMeshes.of(case).whole_s)} of processor time in nine of ten scenes",
            _fields_line(case.scene, size),
        )
        return ["", "A run with finite elements", *_wrapped(found)]
    cells, error, advised = expected_cells(bodies), ERROR[kind(bodies)], ADVISED[kind(bodies)]
    fine = (
        f"about {cells:.2g} cells over the radius of the contact, {radius * 1e3:.2g} mm: "
        f"e and mu within some {100 * error / cells:.2g} %"
    )
    fine += f". {advice(bodies)} for {100 * error / advised:.2g} %" if cells < advised else ""
    fine += f". {WHICH_FLOWS}" if len(bodies.contact.yielding) == 2 else ""
    sentences = (
        fine,
        f"about {size_text(size)} of {plain(size.step * 1e9, 2)} ns ({about(size.most_steps)} if it lasts "
        f"until max_time), {about(size.memory / 1e6)} MB of memory",
        f"about {clock_text(size.time)} of computing ({clock_text(size.most_time)} until max_time) on the "
        "machine of the stored costs, within a factor of two there",
        _fields_line(case.scene, size),
    )
    return ["", "Size of a run with finite elements", *_wrapped(sentences)]


ELEMENT_BYTES = {"shown": 18.0, "all": 53.0}
"""Of one element in one picture, compressed, as measured on t5b and quick, by ``save.fields``."""


def _fields_line(scene: Scene, size: RunSize) -> str:
    """Return how large the file is that holds the pictures of a run, and the key that makes it smaller."""
    frames = scene.save.frames
    if not frames:
        return "no pictures are kept (save.frames = 0): the run has no film"
    MB = frames * ELEMENT_BYTES[scene.save.fields] * (size.rod + size.barrier) / 1e6
    more = "" if scene.save.fields == "all" else '; save.fields = "all" keeps more'
    when = f"in {FRAMES_SPAN:g} times the estimated contact, more in a longer run"
    return f"its pictures take about {about(MB)} MB in fields.vtkhdf: {frames} (save.frames) {when}{more}"


# over the measured sets, means over places of the grid (`fem-impact cost paper`)
WHICH_FLOWS = (
    "How much of the plastic work is the rod's is known least: on the measured sets 5 cells over the radius "
    "gave 60 to 85 % of what 10 cells gave, and what was missing went into the barrier"
)


def _wrapped(sentences: Iterable[str]) -> list[str]:
    return [line for sentence in sentences for line in wrapped(sentence, "  ")]


def _named(effect: EffectChoice) -> str:
    """Return the name of an effect, and that the scene forced it where it did."""
    return f"{effect.name}{' (forced)' if effect.forced else ''}"


def _effect_lines(effect: EffectChoice) -> list[str]:
    verdict = f"{'on ' if effect.on else 'off'} {_named(effect)}"
    decision = _decided(effect)
    if effect.share is not None:
        share = "under 1" if effect.share < 0.005 else f"about {100 * effect.share:.0f}"
        decision += f"; it takes {share} % of the run time"
    return [*wrapped(f"{verdict}: {effect.sentence}", "  ", " " * 4), *wrapped(decision, " " * 8, "")]


def _off(effect: EffectChoice) -> str:
    """Return the name of an effect that is off, with the number that decides on it where that is close."""
    number, threshold = effect.number or 0.0, effect.threshold
    close = threshold / CLOSE < number < threshold * CLOSE
    told = f" ({number:.2g}, threshold {threshold:g})" if close else ""
    return f"{_named(effect)}{told}"


def _lacking(effect: EffectChoice, off: Sequence[EffectChoice]) -> str:
    """Return why an effect is off though its number calls for it."""
    needs, without = EFFECTS[effect.name].needs, {one.name for one in off}
    if needs and without.issuperset(needs):
        return (
            f"needs {' or '.join(needs)}, which are off"
            if len(needs) > 1
            else f"needs {needs[0]}, which is off"
        )
    return "left out by the scene" if effect.forced else effect.sentence


def _decided(effect: EffectChoice) -> str:
    if effect.number is None:
        return f"{effect.measure}: has no upper limit, so the effect is on"
    return f"{effect.measure}: {effect.number:.2g}, threshold {effect.threshold:g}"
