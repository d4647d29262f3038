"""Films and pages of finished runs; a missing library costs a picture, never a result."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from fem_impact.errors import FemImpactError
from fem_impact.progress import CaseProgress, Meter

FILM_FRAMES = 60


def present(runs: Iterable[Path], study: Path, progress: Meter) -> list[str]:
    """Write film and page of each run and the page of the study; return what could not be made."""
    from fem_impact.report import write_report

    folders, notes = list(runs), []
    for done, run in enumerate(folders, 1):
        if (run / "fields.vtkhdf").is_file():
            notes += _attempt(run, _film)
        notes += _attempt(run, write_report)
        progress(CaseProgress(f"pictures of {run.name}", done, len(folders), 0.0))
    notes += _attempt(study, write_report)
    return list(dict.fromkeys(notes))


def _film(run: Path) -> tuple[str, ...]:
    from fem_impact.render import render

    return render(run, frames=FILM_FRAMES).notes


def _attempt(place: Path, make: Callable[[Path], object]) -> list[str]:
    """Return the notes of making something, or why it could not be made."""
    try:
        made = make(place)
    except FemImpactError as error:
        return [f"{place.name}: {error}"]
    return list(made) if isinstance(made, tuple) else []
