"""The HTML page around the sections, and embedded figures, films and data files."""

from __future__ import annotations

import base64
import tomllib
from collections.abc import Callable, Iterable
from html import escape
from importlib import resources
from pathlib import Path
from string import Template

from fem_impact.errors import ResultError
from fem_impact.figures.style import Shape
from fem_impact.report.html import Markup, bullets, join, section

TYPES = {
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".gif": "image/gif",
    ".webp": "image/webp",
    ".mp4": "video/mp4",
}
"""Media type by suffix."""

FILMS = ("film.mp4", "film.webp", "film.gif")
"""Names of a run's film, in order of preference."""

Draw = Callable[[Path, Shape], Path]
"""Draws a figure to a path in a shape and returns the path."""


def page(title: str, kind: str, lead: str, footer: str, body: Iterable[Markup]) -> str:
    """Return the whole document; it refers to nothing outside itself.

    Parameters
    ----------
    title, kind, lead, footer : str
        Plain texts; escaped here.
    body : iterable of Markup
        The sections.
    """
    return Template(_data("page.html")).substitute(
        title=escape(title),
        kind=escape(kind),
        lead=escape(lead),
        footer=escape(footer),
        style=_data("style.css").strip(),
        body=join(body).text,
    )


def sources(named: Iterable[str]) -> Markup:
    """Return the section of papers behind what was used.

    Parameters
    ----------
    named : iterable of str
        Names of effects, and "film" where there is one.
    """
    wanted = {"always", *named}
    listed = tomllib.loads(_data("sources.toml"))["source"]
    return section("Sources", bullets(entry["text"] for entry in listed if wanted & set(entry["for"])))


def _data(name: str) -> str:
    return resources.files("fem_impact.report").joinpath("data", name).read_text(encoding="utf-8")


def picture(draw: Draw, stem: Path, alt: str, caption: str, since: Path | None = None) -> Markup:
    """Draw a figure twice, for desktop and phone, and return it embedded.

    Parameters
    ----------
    draw : callable
    stem : Path
        Path of the files without suffix: ``stem.svg``, ``stem.csv``, ``stem-narrow.svg``.
    alt : str
        Alternative text.
    caption : str
        Text below the figure.
    since : Path, optional
        File of the data shown: figures newer than it are not drawn again.
    """
    files = _files(stem)
    if since and all(file.is_file() and file.stat().st_mtime > since.stat().st_mtime for file in files):
        return _figure(_data_url(files[0]), _data_url(files[1]), alt, caption)
    wide, slim = _data_url(draw(files[0], "wide")), draw(files[1], "narrow")
    narrow = _data_url(slim)
    slim.with_suffix(".csv").unlink(missing_ok=True)  # equal to stem.csv
    return _figure(wide, narrow, alt, caption)


def stored_picture(stem: Path, caption: str) -> Markup:
    """Return a figure that a study drew, ``stem.svg`` and ``stem-narrow.svg``, embedded."""
    wide, narrow = map(_data_url, _files(stem))
    return _figure(wide, narrow, caption, caption)


def _files(stem: Path) -> tuple[Path, Path]:
    return stem.with_suffix(".svg"), stem.with_name(f"{stem.name}-narrow.svg")


def _figure(wide: str, narrow: str, alt: str, caption: str) -> Markup:
    inner = (
        f'<picture><source media="(max-width: 640px)" srcset="{narrow}">'
        f'<img src="{wide}" alt="{escape(alt)}"></picture>'
    )
    return Markup(f"<figure>{inner}<figcaption>{escape(caption)}</figcaption></figure>")


def download(path: Path, label: str) -> Markup:
    """Return a paragraph with the link to a CSV file embedded in the page."""
    return Markup(f"<p>{data_link(_bytes(path), path.name, label)}</p>")


def data_link(content: bytes, name: str, label: str) -> str:
    """Return the link to a CSV file embedded in the page."""
    text = base64.b64encode(content).decode("ascii")
    return f'<a download="{escape(name)}" href="data:text/csv;base64,{text}">{escape(label)}</a>'


def film(folder: Path, caption: str) -> Markup:
    """Return the run's film embedded, nothing when there is none."""
    path = next((folder / name for name in FILMS if (folder / name).is_file()), None)
    if path is None:
        return Markup("")
    data = _data_url(path)
    shown = f'<img src="{data}" alt="{escape(caption)}">'
    if path.suffix == ".mp4":
        shown = f'<video src="{data}" controls loop muted playsinline aria-label="{escape(caption)}"></video>'
    return Markup(f'<figure class="film">{shown}<figcaption>{escape(caption)}</figcaption></figure>')


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ResultError(f"{path}: cannot be read ({error.strerror}).") from error


def _data_url(path: Path) -> str:
    return f"data:{TYPES[path.suffix]};base64,{base64.b64encode(_bytes(path)).decode('ascii')}"
