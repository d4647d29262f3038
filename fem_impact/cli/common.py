"""What several commands need: changed scenes, progress meters, checked paths, printed JSON."""

from __future__ import annotations

import json
import math
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.cli.options import Options
from fem_impact.errors import OutputPathError, ResultError, UsageError
from fem_impact.files.run_directory import COMPUTED, stranger

if TYPE_CHECKING:
    from fem_impact.case.size import RunSize
    from fem_impact.scene.types import Scene

RESULT_FILES = ("outcome.json", "study.json")
TOLD = ("projectile", "barrier", "surface", "impact")
"""Tables of a scene whose changed values its title tells."""


def changed_scene(id_or_path: str, changes: Sequence[str]) -> Scene:
    """Load a scene and apply the changes of the command line; the changed scene is checked once.

    Its title tells the values of projectile, barrier, surface and impact that were changed.
    """
    from fem_impact.scene.shipped import load_to_change, replace, replace_all, titled

    given = read_changes(changes)
    scene = load_to_change(id_or_path, given)
    if not given:
        return scene
    made = replace_all(scene, given)
    shown = {key: value for key, value in given.items() if key.split(".")[0] in TOLD}
    return replace(made, "title", titled(scene.title, shown)) if shown and made.title == scene.title else made


def headed(scene_id: str, title: str) -> str:
    """Return the line that names a scene; one without a title has its id for it."""
    return scene_id if title == scene_id else f"{scene_id}: {title}"


def read_changes(changes: Sequence[str]) -> dict[str, Any]:
    """Return key and value of each ``key=value``; a value is TOML where it can be, text otherwise."""
    read = [_one(change) for change in changes]
    keys = [key for key, _ in read]
    if twice := [key for key in keys if keys.count(key) > 1]:
        raise UsageError("is given twice.", key=f"--set {twice[0]}", remedy="Keep one of the two.")
    return dict(read)


def _one(change: str) -> tuple[str, Any]:
    key, equals, text = change.partition("=")
    if not equals or not key.strip():
        raise UsageError(
            "is not of the form key=value.",
            key="--set",
            value=change,
            remedy="Write --set accuracy.tip_size='0.5 mm'.",
        )
    return key.strip(), _changed_value(key.strip(), text.strip())


def _changed_value(key: str, text: str) -> Any:
    if key == "effects" and not text.startswith("[") and "," in text:
        return [name.strip() for name in text.split(",")]
    try:
        return tomllib.loads(f"value = {text}")["value"] if "\n" not in text else text
    except (ValueError, RecursionError):
        return text


def checked_out(out: Path) -> Path:
    """Make the directory for results and check that it can be written.

    Raises
    ------
    OutputPathError
        It is a file, lies below a file, holds anything but results of the program, or cannot be written.
    """
    try:
        _refuse_files(out)
        _refuse_strangers(out)
        out.mkdir(parents=True, exist_ok=True)
        _prove_writable(out)
    except OutputPathError:
        raise
    except (OSError, ValueError) as error:
        raise OutputPathError(_cannot(out, error)) from None
    return out


def checked_file(out: Path) -> Path:
    """Return a file path whose directory exists and can be written."""
    try:
        if out.is_dir():
            raise OutputPathError(f"{out}: is a directory. Give the name of a file with --out.")
        _refuse_files(out.parent)
        _prove_writable(out.parent)
    except OutputPathError:
        raise
    except (OSError, ValueError) as error:
        raise OutputPathError(_cannot(out.parent, error)) from None
    return out


def checked_result(result: Path) -> Path:
    """Return a directory that holds results.

    Raises
    ------
    ResultError
        It is missing, is a file, or holds no results.
    """
    if not result.exists():
        raise ResultError(f"{result}: there is no such directory. Name one that `fem-impact run` wrote.")
    if not result.is_dir():
        raise ResultError(f"{result}: is a file, not the directory of a result. {_directory_for(result)}")
    if not any((result / name).is_file() for name in RESULT_FILES):
        if (result / "history.csv").is_file():
            way = f"Go on with `fem-impact run {result / 'scene.toml'} --resume --out {result}`."
            raise ResultError(f"{result}: the run here did not come to its end. {way}")
        if any(result.glob("*/study.json")):
            line = f"fem-impact study report --out {result / 'report'}"
            raise ResultError(f"{result}: holds studies. Name one, or write a page over all: {line}")
        names = " or ".join(RESULT_FILES)
        raise ResultError(f"{result}: holds no {names}. Name a directory that `fem-impact run` wrote.")
    return result


def _directory_for(file: Path) -> str:
    """Return what to name instead of a file: its directory if that holds results, or how to make some."""
    if any((file.parent / name).is_file() for name in (*RESULT_FILES, *COMPUTED)):
        return f"Name the directory that it lies in: {file.parent}"
    if file.suffix == ".toml":
        return f"Compute the scene by `fem-impact run {file}`, which prints its directory at the end."
    return "Name the one that `fem-impact run` printed at its end."


def _refuse_files(out: Path) -> None:
    for place in (out, *out.parents):
        if place.exists() and not place.is_dir():
            what = "is a file" if place == out else f"lies below {place}, which is a file"
            raise OutputPathError(f"{out}: {what}. Choose another directory with --out.")


def _refuse_strangers(out: Path) -> None:
    foreign = stranger(out) if out.is_dir() else None
    if foreign:
        raise OutputPathError(
            f"{out}: the directory holds other files, such as {foreign.name}, and results would mix with "
            "them. Choose an empty or a new directory with --out."
        )


def _prove_writable(directory: Path) -> None:
    with tempfile.TemporaryFile(dir=directory):
        pass


def _cannot(out: Path, error: Exception) -> str:
    reason = getattr(error, "strerror", None) or str(error)
    return f"{out}: cannot be written ({reason}). Choose another directory with --out."


@contextmanager
def told_kept(out: Path, options: Options) -> Iterator[None]:
    """Say at the end which older results of a directory were set aside, and where they are."""
    from fem_impact.files.run_directory import earlier

    before = earlier(out)
    try:
        yield
    finally:
        for place in earlier(out):
            if place not in before and not options.quiet:
                sys.stderr.write(f"Older results that were in {out} are kept in {place}\n")


def stated_budget(options: Options) -> float | None:
    """Return the time, s, of ``--budget``, None where it is not given."""
    from fem_impact.scene.units import option_quantity

    if not options.budget:
        return None
    stated = option_quantity(options.budget, "time", "--budget")
    if stated <= 0:
        raise UsageError("must lie above 0.", key="--budget", value=options.budget)
    if options.fidelity in ("rigid", "modal"):
        problem = f"is for finite elements, and --fidelity {options.fidelity} runs none."
        raise UsageError(problem, key="--budget", value=options.budget, remedy="Leave out one of the two.")
    return stated


def print_json(document: Any) -> None:
    """Print one JSON document; NaN and infinity raise ValueError."""
    sys.stdout.write(json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False) + "\n")


def say_kept(scene: Scene, options: Options) -> None:
    """Say what ``--set`` left as it was: velocities at another angle, a bore in a longer projectile."""
    changed = set(read_changes(options.changes))
    _say_fall(scene, changed)
    rod = scene.projectile
    longer = bool({"projectile.length", "projectile.length_m"} & changed)
    if rod.segments and longer and "projectile.segments" not in changed:
        kept = ", ".join(f"{1e3 * part.to:.4g} mm" for part in rod.segments[:-1])
        sys.stderr.write(
            f"fem-impact: the segments still end at {kept or 'the tail'}; the last one ends at the new tail\n"
        )
    if rod.open_at_tail and longer and "projectile.bore" not in changed:
        sys.stderr.write("fem-impact: the bore ends at the new tail\n")
    elif rod.bore and longer and "projectile.bore" not in changed:
        ends = f"{1e3 * rod.bore[0][0]:.4g} to {1e3 * rod.bore[-1][0]:.4g} mm"
        sys.stderr.write(
            f"fem-impact: warning: the bore is that of the old length, {ends} from the tip. Another one: "
            '--set projectile.bore=\'[["0 mm", "6 mm"], ["400 mm", "6 mm"]]\'\n'
        )


def _say_fall(scene: Scene, changed: set[str]) -> None:
    impact = scene.impact
    stated = any(key.startswith(("impact.v_", "impact.speed", "impact.height")) for key in changed)
    if stated or not {"impact.angle", "impact.angle_rad"} & changed or impact.height:
        return
    speed = math.hypot(impact.v_n, impact.v_t)
    if impact.speed:
        named = scene.projectile.shape
        falls = "the ball falls" if getattr(named, "name", "") == "ball" else "the rod falls along its axis"
        sentence = f"{falls} as fast as before, {speed:.4g} m/s"
    else:
        sentence = (
            "warning: v_n and v_t are those of the old angle. A fall as fast at the new one: "
            f"--set impact.speed='{speed:.4g} m/s'"
        )
    sys.stderr.write(f"fem-impact: {sentence}\n")


def shown_path(path: str) -> str:
    """Return a path from the working directory where it lies there, else as it is."""
    place = Path(path)
    return str(place.relative_to(Path.cwd())) if place.is_relative_to(Path.cwd()) else path


def size_text(size: RunSize) -> str:
    """Return numbers of elements and steps in words."""
    from fem_impact.case.size import about

    return f"{about(size.rod + size.barrier)} elements, {about(size.steps)} steps"
