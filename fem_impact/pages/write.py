"""Reports and films of finished runs and studies, written one by one or in parallel."""

from collections.abc import Callable, Iterable
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import nullcontext
from functools import partial
from pathlib import Path

from fem_impact.errors import FemImpactError, ResultError
from fem_impact.files.atomic import write_text
from fem_impact.films.film import render
from fem_impact.films.movement import STUDY_FRAMES, Span
from fem_impact.jobs.executors import LocalProcesses, cores
from fem_impact.pages.run_page import run_page
from fem_impact.pages.study_page import draw_study, study_page
from fem_impact.progress import CaseProgress, ProgressMeter


def write_report(result_dir: str | Path, again: bool = True) -> Path:
    """Write ``report.html`` into a result folder and return its path.

    Figures and film are embedded. The figures and their data are also written to ``figures/``.

    Parameters
    ----------
    result_dir : path
        The folder of a study (study.json) or of a run (outcome.json).
    again : bool, optional
        False: figures of a study that `draw_study` has drawn are not drawn again.

    Raises
    ------
    ResultError
        The folder holds neither, or its files are damaged.
    MissingLibraryError
        matplotlib is not installed.
    OutputPathError
        The folder cannot be written.
    """
    folder = Path(result_dir)
    if (folder / "study.json").is_file():
        return write_text(folder / "report.html", study_page(folder, again))
    if (folder / "outcome.json").is_file():
        return write_text(folder / "report.html", run_page(folder))
    raise ResultError(
        f"{folder}: holds neither outcome.json nor study.json; give the folder of a run or a study."
    )


def present(
    runs: Iterable[Path], study: Path, progress: ProgressMeter, executor: Executor | None = None
) -> list[str]:
    """Write film and page of each run and the page of the study; return what could not be made.

    Parameters
    ----------
    runs, study : folders
    progress : called after the page of each run
    executor : processes on this machine, which have the libraries of the runs loaded; new ones when None
    """
    folders, notes = list(runs), list[str]()
    few = max(1, min(cores(), len(folders)))
    with LocalProcesses(few) if executor is None else nullcontext(executor) as pool:
        films = [pool.submit(film, run) for run in folders]  # the longest work first
        figures = pool.submit(_attempt, study, draw_study)  # its notes are repeated when the page is written
        pages = []
        for run, future in zip(folders, films, strict=True):
            notes += _notes(run, future)
            pages.append(pool.submit(page, run))
        for done, (run, future) in enumerate(zip(folders, pages, strict=True), 1):
            notes += _notes(run, future)
            progress(CaseProgress(f"pictures of {run.name}", done, len(folders), 0.0))
        figures.exception()
        notes += _notes(study, pool.submit(_attempt, study, partial(write_report, again=False)))
    return list(dict.fromkeys(notes))


def page(folder: Path) -> list[str]:
    """Write the page of a run or of a study; return why it could not be made."""
    return _attempt(folder, write_report)


def film(run: Path) -> list[str]:
    """Write the film of a run that stored its motion; return notes on it, or why it could not be made."""
    if not (run / "fields.vtkhdf").is_file():
        return []
    return _attempt(run, lambda folder: render(folder, span=Span(frames=STUDY_FRAMES)).notes)


def _notes(run: Path, drawn: Future[list[str]]) -> list[str]:
    try:
        return drawn.result()
    except BrokenExecutor as error:
        return [f"{run.name}: {error}"]


def _attempt(folder: Path, make: Callable[[Path], object]) -> list[str]:
    """Return the notes of making something, or why it could not be made."""
    try:
        result = make(folder)
    except FemImpactError as error:
        return [f"{folder.name}: {error}"]
    return list(result) if isinstance(result, tuple) else []
