"""Computation of a scene by any fidelity: `simulate` returns its Outcome and writes its files."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.case.case import Case
from fem_impact.case.record import ContactRecord
from fem_impact.errors import SceneError
from fem_impact.files import run_directory
from fem_impact.files.atomic import directory_lock, write_digests, write_text
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import texts
from fem_impact.outcome.record import Outcome
from fem_impact.run.program import stamp
from fem_impact.run.tests import tests_of
from fem_impact.scene.impact import FIRST
from fem_impact.scene.types import Scene, to_toml
from fem_impact.tables.history import CONTACTS
from fem_impact.tables.table import Table

if TYPE_CHECKING:
    from fem_impact.solid.run import SolidResult

MOST = 12
"""Strikes at most by finite elements."""


def simulate(
    scene: Scene, fidelity: str = "solid", options: RunOptions = RunOptions(), case: Case | None = None
) -> Outcome:
    """Compute an impact on the mesh that its scene gives.

    Parameters
    ----------
    scene : Scene
    fidelity : ``rigid``, impulses of a rigid rod, under a millisecond; ``modal``, free modes and a local
        contact law, some ten milliseconds once the modes of the rod are known; ``solid``, the explicit
        finite-element model, seconds to minutes
    options : where the files go: scene.toml, outcome.json, contacts.csv where contacts have a duration, and
        history.csv except of the rigid and fields.vtkhdf of the solid one; none is written without ``out``.
        Their digests stand in files.sha256. What an older run left there is moved to a directory
        ``earlier-...`` within
    case : that of this scene and fidelity, where the caller has compiled it

    Raises
    ------
    UsageError
        If the fidelity is unknown.
    SceneError
        If the fidelity cannot compute the scene, or the scene states an error instead of a mesh, which is the
        business of `fem_impact.answers.simulate.simulate`.
    ResultError
        If the checkpoint is damaged, or of another scene or program.
    OutputPathError
        If another process writes to ``options.out``, or it cannot be written.
    RunError
        If the run cannot go on; what was computed stays in ``options.out``.
    """
    return simulate_recorded(scene, fidelity, options, case)[0]


def simulate_recorded(
    scene: Scene, fidelity: str = "solid", options: RunOptions = RunOptions(), case: Case | None = None
) -> tuple[Outcome, ContactRecord | None]:
    """Compute an impact as `simulate` does; return also where the bodies touched and flowed (solid).

    Beside the other files stands ``contact.npz``, which holds the record; see `Case.record` for what the mesh
    follows.
    """
    if scene.accuracy.target is not None:
        remedy = "Give a mesh, or call fem_impact.answers.simulate.simulate, which chooses one."
        raise SceneError(
            "is an error, not a mesh.", key="accuracy", value=scene.accuracy.target, remedy=remedy
        )
    case = case or Case.of(scene, fidelity)
    tests_of(scene)  # own tests that cannot be read are refused before any work
    if options.out is None:
        return _compute(case, replace(options, resume=False))
    out = options.out
    with directory_lock(out):
        run_directory.remove_drafts(out)
        resume = case.fidelity == "solid" and options.resume and (out / run_directory.CHECKPOINT).exists()
        if not resume:
            begin(case.scene, out)
        try:
            outcome, record = _compute(case, replace(options, resume=resume))
        except BaseException:
            run_directory.remove_scene_alone(out)
            raise
        _write(outcome, record, out)
    return outcome, record


def begin(scene: Scene, out: Path) -> None:
    """Move the files of an older run aside and write the scene; one that is of no run is not replaced."""
    path, text = out / "scene.toml", to_toml(scene)
    if run_directory.set_aside(out) is None:
        run_directory.refuse_other_scene(path, text)
    write_text(path, text)


def _compute(case: Case, options: RunOptions) -> tuple[Outcome, ContactRecord | None]:
    """Run the model of the case's fidelity, whose modules are imported only here."""
    if case.fidelity == "rigid":
        from fem_impact.run.rigid import rigid_outcome

        return _followed(case, rigid_outcome(case)), None
    if case.fidelity == "modal":
        from fem_impact.run.modal import closed
        from fem_impact.run.modal import reduce as reduce_modal
        from fem_impact.run.modal_history import write_history

        result = closed(case, options.progress, recorded=options.out is not None)
        if options.out is not None:
            write_history(case, result, options.out / "history.csv")
        return _followed(case, reduce_modal(case, result)), None
    from threadpoolctl import threadpool_limits

    from fem_impact.run.resolution import NOT_RESOLVED
    from fem_impact.run.solid import reduce
    from fem_impact.solid.run import solve

    # as the command does: on a busy machine further threads of the linear algebra wait for each other, and a
    # run takes four times the processor time
    with threadpool_limits(1, "blas"):
        if case.scene.impact.until != FIRST:
            from fem_impact.run.solid_strikes import with_sites

            count = case.scene.strikes.stages("solid")[0][1] or MOST
            case = with_sites(case, min(count, case.scene.impact.most_strikes or MOST))
        end = solve(case, replace(options, stamp=stamp(case.scene)))
        outcome = _followed(case, reduce(end), end, options)
    sentences = texts(outcome.validity.limitations, "resolution")
    resolved = not any(sentence.startswith(NOT_RESOLVED) for sentence in sentences)
    return outcome, replace(end.record, resolved=resolved)


def _followed(
    case: Case, outcome: Outcome, end: "SolidResult | None" = None, options: RunOptions = RunOptions()
) -> Outcome:
    """Return an outcome with all strikes that its scene asks for, whose code is imported only then."""
    if case.scene.impact.until == FIRST:
        return outcome
    from fem_impact.run.follow import with_strikes

    return with_strikes(case, outcome, end, options)


def _write(outcome: Outcome, record: ContactRecord | None, out: Path) -> None:
    contacts, strikes = (outcome.to_dict()[name] for name in ("contacts", "strikes"))
    if contacts is not None:
        write_text(out / "contacts.csv", Table.of(CONTACTS, contacts).csv())
    if strikes:
        write_text(out / "strikes.csv", Table.of(tuple(strikes[0]), strikes).csv())
    if record is not None:
        record.write(out / run_directory.RECORD)
    outcome.write(out / "outcome.json")
    (out / run_directory.CHECKPOINT).unlink(missing_ok=True)
    # last: a run that goes on from its checkpoint still changes these files
    write_digests(out, run_directory.BESIDE)
