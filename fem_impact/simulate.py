"""One call for every fidelity: a scene in, an Outcome out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from fem_impact.errors import SceneError

if TYPE_CHECKING:
    from fem_impact.outcome import Outcome
    from fem_impact.progress import Progress
    from fem_impact.scene import Scene

__all__ = ["simulate"]


def simulate(
    scene: Scene,
    fidelity: Literal["solid"] = "solid",
    out: Path | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Outcome:
    """Compute an impact.

    Parameters
    ----------
    scene : Scene
    fidelity : ``solid``, the explicit finite-element model
    out : directory for outcome.json, history.csv, contacts.csv, fields.vtkhdf and scene.toml; none of
        them is written without it
    progress : called every few hundred steps

    Raises
    ------
    SceneError
        If the fidelity is unknown, or the tip has no fine zone where one is needed.
    RunError
        If the run cannot go on; what was computed stays in ``out``.
    """
    if fidelity != "solid":
        raise SceneError("is not available yet.", key="fidelity", value=fidelity, remedy='Use "solid".')
    from fem_impact.effects import specify
    from fem_impact.output import make_directory, write_text
    from fem_impact.reduce import reduce, write_contacts
    from fem_impact.solid.build import require_fine_zone
    from fem_impact.solid.run import solve

    require_fine_zone(scene, specify(scene))
    if out is not None:
        make_directory(out)
        write_text(out / "scene.toml", scene.to_toml())
    outcome = reduce(scene, solve(scene, out, progress))
    if out is not None:
        write_contacts(outcome, out)
        outcome.write(out / "outcome.json")
    return outcome
