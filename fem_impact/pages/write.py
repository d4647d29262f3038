"""Write the report of a run or a study."""

from __future__ import annotations

from pathlib import Path

from fem_impact.errors import ResultError
from fem_impact.files.atomic import write_text
from fem_impact.pages.run_page import run_page
from fem_impact.pages.study_page import study_page


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
