"""The directory of a run or study: names of its files, older results set aside, drafts removed."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from fem_impact.files.atomic import make_directory
from fem_impact.files.digests import DIGESTS

CHECKPOINT = "run.checkpoint"
BESIDE = ("contacts.csv", "history.csv", "fields.vtkhdf", "waves.h5")
"""Files beside an outcome, whose digests stand in `DIGESTS`."""
COMPUTED = (CHECKPOINT, "outcome.json", *BESIDE, DIGESTS)
"""Files that a run computes."""
DERIVED = ("scene.toml", "row.json", "report.html", "figures", "film*")
"""The scene, and files made from those of the run."""
PUBLISHED = ("study.json", "summary.md", "*.csv", "sweep.parquet")
"""The report of a study or sweep; its outcomes stay in the store."""


def set_aside(out: Path) -> Path | None:
    """Move an older run, or the report of an older study, to a directory in ``out``; return it.

    What was made from their files goes with them.
    """
    names = COMPUTED if not (out / "study.json").exists() else (*COMPUTED, *PUBLISHED)
    computed = {path for name in names for path in out.glob(name)}
    if not computed:
        return None
    place = _free(out, max(path.stat().st_mtime for path in computed))
    make_directory(place)
    for path in computed | {path for name in DERIVED for path in out.glob(name)}:
        path.rename(place / path.name)
    return place


def remove_drafts(out: Path) -> None:
    """Remove the drafts that a killed run left; nobody else may write there (`directory_lock`)."""
    for name in map(Path, ("scene.toml", *COMPUTED)):
        for draft in out.glob(f".{name.stem}-????????{name.suffix}"):
            draft.unlink()


def remove_scene_alone(out: Path) -> None:
    """Remove the scene of a run that ended before it computed: alone it does not show whose it is."""
    if not any((out / name).exists() for name in COMPUTED):
        (out / "scene.toml").unlink(missing_ok=True)


def earlier(out: Path) -> list[Path]:
    """Return the directories of older runs, the oldest first."""
    return sorted(out.glob("earlier-*"))


def _free(out: Path, written: float) -> Path:
    """Return a new name by the time, s since 1970, when the run was last written."""
    stem = f"earlier-{datetime.fromtimestamp(written, UTC):%Y-%m-%dT%H-%M-%SZ}"
    names = (stem, *(f"{stem}-{number}" for number in range(2, 1000)))
    return next(out / name for name in names if not (out / name).exists())
