"""The command ``run``: computes one scene and prints its outcome."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from fem_impact.cli.parser import Options, stated_budget
from fem_impact.cli.paths import checked_out, shown_path, told_kept
from fem_impact.cli.scene_options import asked_scene, say_kept
from fem_impact.cli.terminal import chosen_meter, headed, limitation_lines, print_table, size_text
from fem_impact.errors import RunError, UsageError
from fem_impact.files.run_directory import is_resumable
from fem_impact.jobs.executors import cores
from fem_impact.options import RunOptions
from fem_impact.outcome.ground import moves, on_the_ground
from fem_impact.outcome.groups import WRONG_NUMBERS
from fem_impact.outcome.keys import Key, Unknown, or_none, why_unknown
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.said import HEATING, MOTION, errors_said, floor_said, heat_said
from fem_impact.outcome.shares import ABOVE, ADDED, HEATS, IF_ON, EnergyShare, above_modes, shares
from fem_impact.outcome.strikes import SHOWN, spread_table, strikes_table, told
from fem_impact.progress import clock_text
from fem_impact.scene.impact import FIRST
from fem_impact.scene.types import OWN, Scene, digest
from fem_impact.tables.table import Table
from fem_impact.tables.text import plain, wrapped

if TYPE_CHECKING:
    from fem_impact.answers.friction_spread import FrictionSpread
    from fem_impact.case.case import Case
    from fem_impact.outcome.groups import Energy


ALONE = ", with the errors of its own numbers (those above are the spread of 64 sequences)"
LONG = 600.0
"""Expected computing time, s, above which `run` prints it before it starts."""


def run(options: Options) -> int:
    """Compute one scene, write its results and print them."""
    begun = perf_counter()  # a busy machine takes seconds to import what computes
    scene = asked_scene(options)
    if options.resume and options.fidelity in ("rigid", "modal"):
        problem = f"is for finite elements only: a {options.fidelity} run takes seconds."
        raise UsageError(problem, key="--resume", remedy="Leave it out.")
    from fem_impact.answers.friction_spread import friction_spread
    from fem_impact.answers.simulate import compiled, on_levels, simulate

    say_kept(scene, options)
    budget = stated_budget(options)
    if budget and not on_levels(scene, options.fidelity or scene.strikes.first):
        problem = "is for several meshes, and the scene asks for one."
        raise UsageError(problem, key="--budget", remedy="Leave it out, or accuracy.levels.")
    case = compiled(scene, options.fidelity or scene.strikes.first)
    if case.fidelity == "solid" and not options.quiet and case.size.time > LONG:
        takes = f"{clock_text(case.size.time)} ({size_text(case.size)})"
        sys.stderr.write(f"This run takes about {takes}; a larger tip_size is quicker.\n")
    name = f"{scene.id}-{digest(scene)[:8]}" if options.changes else scene.id
    name += f"-{options.fidelity}" if options.fidelity not in ("", "solid") else ""
    out = checked_out(options.out or Path("results") / name)
    if options.resume and not is_resumable(out):
        sys.stderr.write(f"fem-impact: {out} holds no checkpoint: the run starts at the beginning\n")
    try:
        with told_kept(out, options), closing(chosen_meter(options)) as meter:
            run_options = RunOptions(out, meter, options.resume, options.checkpoint)
            fidelity, read_s = options.fidelity or None, options.read_s + perf_counter() - begun
            outcome = simulate(scene, fidelity, run_options, cores(), budget, case, read_s)
    except KeyboardInterrupt:
        way = (
            "--resume goes on from the last checkpoint."
            if is_resumable(out)
            else "no checkpoint was due yet (--checkpoint SECONDS), so --resume would start at the beginning."
        )
        raise KeyboardInterrupt(f"what was computed so far is kept. Results: {out}; {way}") from None
    if options.json:
        sys.stdout.write(outcome.to_json().rstrip("\n") + "\n")
    elif outcome.validity.finished:  # what a run has at an early stop is no result of the impact
        own_tests = (scene.measured or "").endswith(OWN)
        spread = friction_spread(scene, case.fidelity, outcome)
        sys.stdout.write(f"{headed(outcome.provenance.scene_id, outcome.provenance.scene_title)}\n\n")
        if scene.impact.until != FIRST:  # what was asked for
            print_strikes(outcome, options)
            known_errors = not isinstance(outcome.strikes.certain, Unknown)
            title = wrapped(f"The first strike alone{ALONE if known_errors else ''}", "")
            sys.stdout.write("\n" + "\n".join(title) + "\n\n")
        print_outcome(outcome, out, own_tests, spread, scene.accuracy.target_of, scene.projectile.named)
        _say_comparison(scene, outcome, options)
        _say_screening(case, options)
    if outcome.validity.finished:
        return 0
    cause = outcome.validity.stopped_because
    sys.stderr.write(f"fem-impact: error: the run stopped early: {cause} Results: {out}\n")
    return RunError.exit_code


def _say_comparison(scene: Scene, outcome: Outcome, options: Options) -> None:
    """Print the outcome beside the tests that its scene names."""
    from fem_impact.answers.compare import compare, told
    from fem_impact.run.tests import count, doubtful_tests, tests_of, unused_columns

    tests = tests_of(scene)
    if tests is None:
        return
    head = ("", "model", "measured", "SD", "")
    numbers = "measured_mean", "measured_sd"
    rows = [
        (row["quantity"], told(row), *(f"{row[key]:.3g}" for key in numbers), row["verdict"])
        for row in compare(outcome, tests)
        if row["measured_mean"] is not None and row["model"] is not None
    ]
    measured = f"beside {count(tests)} measured tests ({shown_path(str(scene.measured))})"
    if rows:
        sys.stdout.write(f"{measured}:\n")
        print_table(Table.of(head, rows, left=(0, 4)), options, indent="  ")
    else:
        sys.stdout.write(f"{measured}: no number that was measured is known of this run\n")
    said = [*unused_columns(scene), *(f"warning: {one}" for one in doubtful_tests(scene))]
    sys.stdout.writelines(f"{line}\n" for one in said for line in wrapped(one))


def _say_screening(case: Case, options: Options) -> None:
    """Print the closed-form screening of a scene, the same for all fidelities, and its verdict's command."""
    from fem_impact.answers.verdict.screening import screening
    from fem_impact.answers.verdict.sentences import lines_of, screening_lines
    from fem_impact.case.case import Case

    changes = [word for change in options.changes for word in ("--set", change)]
    bodies = Case(case.scene).bodies if case.fidelity == "modal" else case.bodies
    titled = screening_lines(screening(bodies), shlex.join([options.scene, *changes]))
    sys.stdout.write("\n".join(lines_of(titled, indent="")) + "\n")


_BARRIER = (
    ("V_n of the barrier after", "V_bn_m_per_s", "m/s"),
    ("V_t of the barrier after", "V_bt_m_per_s", "m/s"),
)
PEAK, FLASH = (KEY_TABLE[name] for name in ("peak_force_N", "flash_temperature_K"))
RESIDUAL = KEY_TABLE["residual_over_E_0"]


def print_outcome(
    outcome: Outcome,
    out: Path,
    own_tests: bool = False,
    spread: FrictionSpread | None = None,
    target_of: str | None = None,
    named: Callable[[str], str] = str,
) -> None:
    """Print the motion after impact, where the energy went, and every limitation.

    ``own_tests``: the scene names tests of the user's own, with whose arms e is worked out if they state any.
    ``spread``: what the interval of friction changes, told beside each number. ``named`` calls the body of a
    label what it is.
    """
    lines = []
    if spread and spread.said:
        lines = [*wrapped(f"At the right, in the unit of its line: {spread.said}"), ""]
    motion = [(label, KEY_TABLE[name], unit) for label, name, unit in _motion_rows(outcome, own_tests)]
    lines += [_line(label, outcome.told(key), unit, _changed(spread, key)) for label, key, unit in motion]
    wrong = [one for one in outcome.validity.limitations if one.kind in WRONG_NUMBERS]
    lines += ["", *limitation_lines(wrong)] if wrong else []
    of = "" if isinstance(outcome.validity.mesh_limit, Unknown) else ", extrapolated from the levels"
    gravity = or_none(ADDED.of(outcome.energy))
    added = "" if gravity is None else f", to which gravity added {outcome.told(ADDED.key, 100.0)} %"
    seen = " as seen from the barrier" if moves(outcome) else ""
    lines += ["", *wrapped(f"of the initial energy{seen}, E_0 = {outcome.energy.E_0:.4g} J{added}{of}:")]
    # the keys of the listed shares of E_0 by their labels
    energy = outcome.energy
    listed = {
        named(_label(share, energy)): share.key
        for share in shares("terminal")
        if not (share.key.path[-1] in IF_ON and isinstance(share.of(energy), Unknown))
    }
    lines += [
        _line(label, _share(outcome, key), "%", _changed(spread, key, 100.0)) for label, key in listed.items()
    ]
    if above := above_modes(outcome.energy):
        lines += [_line(ABOVE, plain(100 * above), "%")]
    lines += [_line("not accounted for", _share(outcome, RESIDUAL), "%")]
    lines += ["", *wrapped(named(on_the_ground(outcome)))] if moves(outcome) else []
    lines += ["", _line(HEATING, outcome.told(HEATS, 100.0), "%", _changed(spread, HEATS, 100.0))]
    # peak force and flash temperature, where they are known or withheld as e is
    contact = {
        label: key
        for label, key in (("peak force", PEAK), ("flash temperature", FLASH))
        if not isinstance(value := key.of(outcome), Unknown) or value == outcome.restitution.edge.e
    }
    lines += [
        _line(label, outcome.told(key), key.unit, _changed(spread, key)) for label, key in contact.items()
    ]
    lines += [f"  {sentence}" for sentence in floor_said(outcome)]
    if said := errors_said(outcome, target_of):
        lines += ["", *wrapped(said[0]), *(f"  {sentence}" for sentence in said[1:])]
    told = {**{label: key for label, key, _ in motion}, **listed, HEATING: HEATS, **contact}
    if not isinstance(outcome.heat.power, Unknown):  # the heat was followed
        told["flash temperature"] = FLASH
    notes = why_unknown({label: key.of(outcome) for label, key in told.items()})
    notes += heat_said(outcome)
    lines += ["", *(line for one in notes for line in wrapped(one, "  "))] if notes else []
    others = [one for one in outcome.validity.limitations if one not in wrong]
    lines += ["", *limitation_lines(others)]
    sys.stdout.write("\n".join([*lines, f"results: {out}"]) + "\n")


def _motion_rows(outcome: Outcome, own_tests: bool) -> list[tuple[str, str, str]]:
    """Return label, key and unit of what is told of the motion; of the barrier's only if it moves."""
    stated = outcome.restitution.tests_state_arms
    arms, key = ("tests'" if own_tests else "paper's", "e_paper") if stated else ("tip's", "e_edge")
    rows = [(f"restitution e ({arms} arms)", key, ""), *MOTION]
    barrier = outcome.barrier
    if any(or_none(v) != 0 for v in (barrier.v_bn, barrier.v_bt, barrier.V_bn, barrier.V_bt)):
        rows += _BARRIER
    if or_none(barrier.Omega_b) is not None:
        rows.append(("Omega of the barrier after", "barrier_Omega_rad_per_s", "rad/s"))
    return rows


def _label(share: EnergyShare, energy: Energy) -> str:
    """Return the label of a share; a body in which nothing yields has no residual stress."""
    locked, _, body = share.key.path[-1].rpartition("_")
    elastic = locked == "locked" and getattr(energy, f"plastic_{body}") == 0.0
    return f"elastic energy left in {body}" if elastic else share.label


def _share(outcome: Outcome, key: Key) -> str:
    """Return a share in per cent as text."""
    value, band = outcome.estimate(key)
    if not isinstance(value, Unknown) and band is None and 0 < abs(value) < 1e-5:
        return "under 0.001"
    if key is RESIDUAL and not isinstance(value, Unknown):
        return plain(100 * value, 2)
    return outcome.told(key, 100.0)


def _changed(spread: FrictionSpread | None, key: Key, scale: float = 1.0) -> str:
    return spread.told(key, scale) if spread else ""


def _line(label: str, told: str, unit: str, spread: str = "") -> str:
    """Return a line of a number, its unit, and what friction changes of it."""
    unit = "" if told == "not known" else unit
    return f"  {label:<31}{told:>19} {unit:<6}{spread}".rstrip()


def print_strikes(outcome: Outcome, options: Options) -> None:
    """Print what is told of a sequence, the strikes that are certain, and how later ones spread."""
    sys.stdout.writelines(f"{line}\n" for sentence in told(outcome.strikes) for line in wrapped(sentence))
    strikes = outcome.strikes
    if isinstance(strikes.each, Unknown):
        return
    print_table(strikes_table(strikes, or_none(strikes.certain) or SHOWN), options, indent="  ")
    if later := (or_none(strikes.spread) or ())[or_none(strikes.certain) or 0 :]:
        print_table(spread_table(later), options, indent="  ")
