"""Pictures and films as data inside the page."""

from __future__ import annotations

import base64
from collections.abc import Callable
from html import escape
from pathlib import Path

from fem_impact.errors import ResultError
from fem_impact.figures import Shape
from fem_impact.report.html import Markup

__all__ = ["FILMS", "data_link", "download", "film", "picture", "stored_picture"]

TYPES = {
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".gif": "image/gif",
    ".webp": "image/webp",
    ".mp4": "video/mp4",
}
FILMS = ("film.mp4", "film.webp", "film.gif")
"""Names under which a run's film is looked for, best first."""

Draw = Callable[[Path, Shape], Path]


def picture(draw: Draw, stem: Path, alt: str, caption: str, since: Path | None = None) -> Markup:
    """Draw a figure twice, for desktop and phone, and return it embedded.

    Parameters
    ----------
    draw : callable
        Draws to a path in a shape and returns the path.
    stem : Path
        Where the pictures and their data stay: ``stem.svg``, ``stem.csv``, ``stem-narrow.svg``.
    alt : str
        For who cannot see it.
    caption : str
        Below the figure.
    since : Path, optional
        The file whose data it shows: pictures drawn after it are taken as they are.
    """
    if since is not None and _drawn(stem, since):
        wide, narrow = (_data(file) for file in _files(stem))
        return _figure(wide, narrow, alt, caption)
    files = _files(stem)
    wide, slim = _data(draw(files[0], "wide")), draw(files[1], "narrow")
    narrow = _data(slim)
    slim.with_suffix(".csv").unlink(missing_ok=True)  # the same numbers stand beside the wide one
    return _figure(wide, narrow, alt, caption)


def stored_picture(stem: Path, caption: str) -> Markup:
    """Return a figure that a study drew, ``stem.svg`` and ``stem-narrow.svg``, embedded."""
    wide, narrow = (_data(file) for file in _files(stem))
    return _figure(wide, narrow, caption, caption)


def _files(stem: Path) -> tuple[Path, Path]:
    return stem.with_suffix(".svg"), stem.with_name(f"{stem.name}-narrow.svg")


def _drawn(stem: Path, since: Path) -> bool:
    return all(file.is_file() and file.stat().st_mtime > since.stat().st_mtime for file in _files(stem))


def _figure(wide: str, narrow: str, alt: str, caption: str) -> Markup:
    inner = (
        f'<picture><source media="(max-width: 640px)" srcset="{narrow}">'
        f'<img src="{wide}" alt="{escape(alt)}"></picture>'
    )
    return Markup(f"<figure>{inner}<figcaption>{escape(caption)}</figcaption></figure>")


def download(path: Path, words: str) -> Markup:
    """Return a link to a file that the page carries inside."""
    return Markup(f"<p>{data_link(_bytes(path), path.name, words)}</p>")


def data_link(held: bytes, name: str, words: str) -> str:
    """Return the link to a CSV file inside the page."""
    text = base64.b64encode(held).decode("ascii")
    return f'<a download="{escape(name)}" href="data:text/csv;base64,{text}">{escape(words)}</a>'


def film(folder: Path, caption: str) -> Markup:
    """Return the run's film embedded, nothing when there is none."""
    found = next((folder / name for name in FILMS if (folder / name).is_file()), None)
    if found is None:
        return Markup("")
    data = _data(found)
    shown = f'<img src="{data}" alt="{escape(caption)}">'
    if found.suffix == ".mp4":
        shown = f'<video src="{data}" controls loop muted playsinline aria-label="{escape(caption)}"></video>'
    return Markup(f'<figure class="film">{shown}<figcaption>{escape(caption)}</figcaption></figure>')


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ResultError(f"{path}: cannot be read ({error.strerror}).") from error


def _data(path: Path) -> str:
    held = _bytes(path)
    return f"data:{TYPES[path.suffix]};base64,{base64.b64encode(held).decode('ascii')}"
