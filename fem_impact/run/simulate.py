"""One call for every fidelity: a scene in, an Outcome out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.solid.checkpoint import INTERVAL

if TYPE_CHECKING:
    from fem_impact.outcome.record import Outcome
    from fem_impact.progress import Progress
    from fem_impact.scene.types import Scene

__all__ = ["FIDELITIES", "simulate"]


Report = Callable[["Progress"], None]

FIDELITIES = ("rigid", "modal", "solid")


def simulate(
    scene: Scene,
    fidelity: str | None = None,
    out: Path | None = None,
    progress: Report | None = None,
    resume: bool = False,
    checkpoint_s: float = INTERVAL,
) -> Outcome:
    """Compute an impact.

    Parameters
    ----------
    scene : Scene
    fidelity : ``rigid``, impulses of a rigid rod, under a millisecond; ``modal``, free modes and a local
        contact law, some ten milliseconds once the modes of the rod are known; ``solid``, the explicit
        finite-element model, seconds to minutes; without one it is ``solid``, or what the measured
        costs choose for a scene that states the error it allows
    out : directory for outcome.json and scene.toml, contacts.csv where contacts have a duration, and
        history.csv and fields.vtkhdf of the solid fidelity; none of them is written without it. What an
        older run left there is moved to a directory ``earlier-...`` within
    progress : called every few hundred steps of the solid fidelity
    resume : go on from the checkpoint in ``out`` (solid); without one there, start at the beginning
    checkpoint_s : wall time between checkpoints of the solid fidelity

    Raises
    ------
    UsageError
        If the fidelity is unknown.
    SceneError
        If the tip has no fine zone where the solid fidelity needs one, or no measured cost tells how to keep
        to the error that the scene allows.
    ResultError
        If the checkpoint is damaged, or of another scene or program.
    RunError
        If the run cannot go on; what was computed stays in ``out``.
    """
    if fidelity not in (None, *FIDELITIES):
        hint = did_you_mean(str(fidelity), FIDELITIES, f"Use one of {', '.join(FIDELITIES)}.")
        raise UsageError("is not a fidelity.", key="fidelity", value=fidelity, remedy=hint)
    if scene.accuracy.target is not None:
        from fem_impact.cost.to_target import simulate_to_target

        return simulate_to_target(scene, fidelity, out, progress, resume, checkpoint_s)
    return _run(scene, fidelity or "solid", out, progress, resume, checkpoint_s)


def _run(
    scene: Scene,
    fidelity: str,
    out: Path | None,
    progress: Report | None,
    resume: bool,
    checkpoint_s: float,
) -> Outcome:
    """Compute one impact on the mesh that the scene gives, and write its files."""
    require_runnable(scene, fidelity)
    goes_on = fidelity == "solid" and resume and out is not None and (out / CHECKPOINT).exists()
    if out is not None and not goes_on:
        _begin(scene, out)
    outcome = _compute(scene, fidelity, out, progress, goes_on, checkpoint_s)
    if out is not None:
        _write(outcome, out)
    return outcome


def _begin(scene: Scene, out: Path) -> None:
    """Set an older run aside, so that nothing of it is taken for this one, and name the scene."""
    from fem_impact.files.atomic import make_directory, write_text
    from fem_impact.files.run_directory import set_aside

    make_directory(out)
    set_aside(out)
    write_text(out / "scene.toml", scene.to_toml())


def require_runnable(scene: Scene, fidelity: str) -> None:
    """Refuse what the fidelity cannot compute (SceneError)."""
    from fem_impact.plan.limits import require_approach

    require_approach(scene)
    if fidelity == "solid":
        from fem_impact.plan.limits import require_shallow
        from fem_impact.plan.plan import specify
        from fem_impact.solid.build import require_fine_zone

        require_shallow(scene)
        require_fine_zone(scene, specify(scene))


def _compute(
    scene: Scene,
    fidelity: str,
    out: Path | None,
    progress: Report | None,
    goes_on: bool,
    checkpoint_s: float,
) -> Outcome:
    """Import and run one model."""
    if fidelity == "rigid":
        from fem_impact.run.rigid import rigid_outcome

        return rigid_outcome(scene)
    if fidelity == "modal":
        from fem_impact.modal.impact import solve as solve_modal
        from fem_impact.run.modal import reduce as reduce_modal

        return reduce_modal(scene, solve_modal(scene, progress))
    from fem_impact.run.solid import reduce
    from fem_impact.solid.run import solve

    return reduce(scene, solve(scene, out, progress, goes_on, checkpoint_s))


def _write(outcome: Outcome, out: Path) -> None:
    from fem_impact.tables.csv import CONTACTS, write_table

    contacts = outcome.to_dict()["contacts"]
    if contacts is not None:
        write_table(out / "contacts.csv", CONTACTS, contacts)
    outcome.write(out / "outcome.json")
    (out / CHECKPOINT).unlink(missing_ok=True)
