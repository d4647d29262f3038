"""Pages of evidence: what a command found, with its day, machine and commit."""

import os
import platform
import re
import shutil
import subprocess
from datetime import UTC, datetime
from pathlib import Path

import fem_impact
from fem_impact.cli.parser import Options
from fem_impact.cli.paths import checked_file
from fem_impact.errors import OutputPathError, UsageError
from fem_impact.files.atomic import read_text, write_text

MADE = "Made by `"


def asked_page(options: Options) -> Path | None:
    """Return the page that ``--page`` names, None where it is left out; raises as `checked_page`."""
    return checked_page(options.page) if options.page else None


def checked_page(option: str) -> Path:
    """Return the path of a page that may be written: a new file, or an older page of a command.

    Raises
    ------
    UsageError
        It is no Markdown file, or holds something else.
    OutputPathError
        Its directory is not there or cannot be written.
    """
    path = Path(option)
    if path.suffix != ".md":
        remedy = "Write a name that ends in .md."
        raise UsageError("is no Markdown file.", key="--page", value=option, remedy=remedy)
    if not path.parent.is_dir():
        raise OutputPathError(f"{path.parent}: there is no such directory. Make it before, or change --page.")
    if path.exists() and f"\n{MADE}" not in read_text(path):
        remedy = "Name a new file, or a page that a command wrote."
        raise UsageError("holds something else.", key="--page", value=option, remedy=remedy)
    return checked_file(path)


def write_page(path: Path, title: str, about: str, command: str, body: str) -> None:
    """Write a page: title, what it shows, the command with day, machine and commit, and the result."""
    parts = (f"# {title}", about, f"{_made(command)}.", body.strip())
    write_text(path, "\n\n".join(part for part in parts if part) + "\n")


def _made(command: str) -> str:
    """Return the line that tells what made a page, without its end."""
    return f"{MADE}{command}` on {datetime.now(UTC):%Y-%m-%d}, {machine()}, {version()}"


def write_study_page(path: Path, command: str, summary: str, folder: Path) -> None:
    """Write the page of a study from its summary, its figures in a folder beside it.

    Where the summary names the command with its numbers of runs, the page tells day, machine and commit too.
    """
    figures = re.findall(r"\]\(figures/([\w-]+)\.png\)", summary)
    beside = path.with_suffix("")
    for name in figures:
        beside.mkdir(exist_ok=True)
        shutil.copyfile(folder / "figures" / f"{name}.svg", beside / f"{name}.svg")
    text = re.sub(r"\]\(figures/([\w-]+)\.png\)", rf"]({beside.name}/\1.svg)", summary)
    write_text(path, text.replace(f"\n`{command}`:", f"\n{_made(command)}:", 1))


def machine() -> str:
    """Return processor and number of cores."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        text = ""
    model = re.search(r"^model name\s*: (.+)$", text, re.MULTILINE)
    return f"{model[1] if model else platform.machine()}, {os.cpu_count()} cores"


def version() -> str:
    """Return the commit of the sources, or the version of the package where they are no repository."""
    root = str(Path(fem_impact.__file__).parents[1])
    line = "git", "-C", root, "describe", "--always", "--dirty", "--exclude=*"
    try:
        done = subprocess.run(line, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "commit not known"
    return f"commit {done.stdout.strip().replace('-dirty', ' with changes')}"
