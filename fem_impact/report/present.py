"""Films and pages of finished runs, made in parallel; what a missing library prevents becomes a note."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import BrokenExecutor, Future
from pathlib import Path

from fem_impact.errors import FemImpactError
from fem_impact.jobs.executors import LocalProcesses, cores
from fem_impact.progress import CaseProgress, ProgressMeter

FILM_FRAMES = 60


def present(runs: Iterable[Path], study: Path, progress: ProgressMeter) -> list[str]:
    """Write film and page of each run and the page of the study; return what could not be made."""
    folders, notes = list(runs), []
    with LocalProcesses(max(1, min(cores(), len(folders)))) as executor:
        drawn = [executor.submit(pictures, run) for run in folders]
        _attempt(study, _draw)  # in parallel; its notes are repeated when the page is written
        for done, (run, future) in enumerate(zip(folders, drawn, strict=True), 1):
            notes += _notes(run, future)
            progress(CaseProgress(f"pictures of {run.name}", done, len(folders), 0.0))
    return list(dict.fromkeys([*notes, *_attempt(study, _write)]))


def _draw(study: Path) -> None:
    from fem_impact.report.study_page import draw_study

    draw_study(study)


def _write(study: Path) -> None:
    from fem_impact.report.write import write_report

    write_report(study, again=False)


def _notes(run: Path, drawn: Future[list[str]]) -> list[str]:
    try:
        return drawn.result()
    except BrokenExecutor as error:
        return [f"{run.name}: {error}"]


def pictures(run: Path) -> list[str]:
    """Write film and page of a run; return what could not be made."""
    from fem_impact.render.film import render
    from fem_impact.render.timeline import Span
    from fem_impact.report.write import write_report

    filmed = (run / "fields.vtkhdf").is_file()
    notes = _attempt(run, lambda place: render(place, span=Span(frames=FILM_FRAMES)).notes) if filmed else []
    return notes + _attempt(run, write_report)


def _attempt(place: Path, make: Callable[[Path], object]) -> list[str]:
    """Return the notes of making something, or why it could not be made."""
    try:
        made = make(place)
    except FemImpactError as error:
        return [f"{place.name}: {error}"]
    return list(made) if isinstance(made, tuple) else []
