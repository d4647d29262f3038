"""Films and pages of finished runs, made in parallel; what a missing library prevents becomes a note."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import nullcontext
from pathlib import Path

from fem_impact.errors import FemImpactError
from fem_impact.jobs.executors import LocalProcesses, cores
from fem_impact.progress import CaseProgress, ProgressMeter


def present(
    runs: Iterable[Path],
    study: Path,
    progress: ProgressMeter,
    frames: int,
    executor: Executor | None = None,
) -> list[str]:
    """Write film and page of each run and the page of the study; return what could not be made.

    Parameters
    ----------
    runs, study : folders
    progress : called after the page of each run
    frames : number of pictures of a film
    executor : processes on this machine, which have the libraries of the runs loaded; new ones when None
    """
    folders, notes = list(runs), list[str]()
    few = max(1, min(cores(), len(folders)))
    with LocalProcesses(few) if executor is None else nullcontext(executor) as pool:
        films = [pool.submit(film, run, frames) for run in folders]  # the longest work first
        figures = pool.submit(_attempt, study, _draw)  # its notes are repeated when the page is written
        pages = []
        for run, future in zip(folders, films, strict=True):
            notes += _notes(run, future)
            pages.append(pool.submit(page, run))
        for done, (run, future) in enumerate(zip(folders, pages, strict=True), 1):
            notes += _notes(run, future)
            progress(CaseProgress(f"pictures of {run.name}", done, len(folders), 0.0))
        figures.exception()
        notes += _notes(study, pool.submit(_attempt, study, _write))
    return list(dict.fromkeys(notes))


def page(folder: Path) -> list[str]:
    """Write the page of a run or of a study; return why it could not be made."""
    from fem_impact.pages.write import write_report

    return _attempt(folder, write_report)


def film(run: Path, frames: int) -> list[str]:
    """Write the film of a run that stored its motion; return notes on it, or why it could not be made."""
    from fem_impact.films.film import render
    from fem_impact.films.timeline import Span

    if not (run / "fields.vtkhdf").is_file():
        return []
    return _attempt(run, lambda place: render(place, span=Span(frames=frames)).notes)


def _draw(study: Path) -> None:
    from fem_impact.pages.study_page import draw_study

    draw_study(study)


def _write(study: Path) -> None:
    from fem_impact.pages.write import write_report

    write_report(study, again=False)


def _notes(run: Path, drawn: Future[list[str]]) -> list[str]:
    try:
        return drawn.result()
    except BrokenExecutor as error:
        return [f"{run.name}: {error}"]


def _attempt(place: Path, make: Callable[[Path], object]) -> list[str]:
    """Return the notes of making something, or why it could not be made."""
    try:
        made = make(place)
    except FemImpactError as error:
        return [f"{place.name}: {error}"]
    return list(made) if isinstance(made, tuple) else []
