"""HTML elements, and the page around the sections with embedded figures, films and data files."""

import base64
import gzip
import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

from fem_impact.errors import MissingLibraryError, ResultError
from fem_impact.figures.live import live
from fem_impact.figures.panels import Picture
from fem_impact.figures.still import draw
from fem_impact.files.atomic import make_directory
from fem_impact.pages.bibliography import behind
from fem_impact.tables.table import Table
from fem_impact.tables.text import markup


@dataclass(frozen=True, slots=True)
class Markup:
    """HTML that is already escaped."""

    text: str


def join(parts: Iterable[Markup]) -> Markup:
    """Return the non-empty parts, one a line."""
    return Markup("\n".join(part.text for part in parts if part.text))


def paragraph(content: str | Markup, kind: str = "") -> Markup:
    """Return a paragraph, nothing for an empty text."""
    shown = f' class="{escape(kind)}"' if kind else ""
    text = _safe(content)
    return Markup(f"<p{shown}>{text}</p>" if text else "")


def place(name: str, content: Markup) -> Markup:
    """Return a block with the id ``name``."""
    return Markup(f'<div id="{escape(name)}">\n{content.text}\n</div>')


def section(title: str, *content: Markup) -> Markup:
    """Return a section, titled where there is a title, nothing when it would be empty."""
    inner = join(content).text
    head = f"<h2>{markup(title)}</h2>\n" if title else ""
    return Markup(f"<section>\n{head}{inner}\n</section>" if inner else "")


def details(title: str, *content: Markup) -> Markup:
    """Return a block that can be unfolded."""
    return Markup(f"<details><summary>{markup(title)}</summary>\n{join(content).text}\n</details>")


def bullets(items: Iterable[str | Markup]) -> Markup:
    """Return a list, nothing when it is empty."""
    lines = "\n".join(f"<li>{_safe(item)}</li>" for item in items)
    return Markup(f"<ul>\n{lines}\n</ul>" if lines else "")


def table(rows: Table, caption: str = "", compact: bool = False) -> Markup:
    """Return a table, nothing when it has no rows."""
    return Markup(rows.html(caption, compact))


def signed(text: str) -> str:
    """Return a number as text with the signs of a page: ± and a true minus."""
    return text.replace("+-", "±").replace("-", "−")


def versions_text(versions: Mapping[str, str]) -> str:
    """Return the names and versions of the program and its libraries, one after the other."""
    return ", ".join(f"{name} {version}" for name, version in versions.items())


def _safe(content: str | Markup) -> str:
    return content.text if isinstance(content, Markup) else markup(str(content))


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


def page(title: str, kind: str, lead: str, footer: str, body: Iterable[Markup]) -> str:
    """Return the whole document around its sections; it refers to nothing outside itself.

    ``title``, ``kind``, ``lead`` and ``footer`` are plain texts, escaped here.
    """
    content = join(body).text
    policy, scripts = _scripts() if 'class="live"' in content else ("", "")
    return Template(_data("page.html")).substitute(
        policy=policy,
        scripts=scripts,
        title=escape(title),
        heading=markup(title),
        kind=escape(kind),
        lead=markup(lead),
        footer=escape(footer),
        style=_data("style.css").strip(),
        body=content,
    )


@cache
def _scripts() -> tuple[str, str]:
    """Return what a page with figures may run, by digest, and the elements: Plotly compressed, and its use.

    Raises
    ------
    MissingLibraryError
        plotly is not installed.
    """
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise MissingLibraryError("Pages with figures need plotly: pip install plotly.") from error
    library, script = get_plotlyjs(), _data("figures.js")
    digests = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
        for text in (library, script)
    )
    packed = base64.b64encode(gzip.compress(library.encode(), mtime=0)).decode()
    elements = (
        '<noscript><p class="notice">The figures of this page need JavaScript; without it they are pictures '
        "in the folder figures beside it.</p></noscript>\n"
        f'<script id="library" type="application/gzip">{packed}</script>\n<script>{script}</script>'
    )
    return f"; script-src {digests}", elements


def sources(named: Iterable[str]) -> Markup:
    """Return the section of papers behind what was used: effects by name, and "film" where there is one."""
    papers = bullets(one.text for one in behind(["figures", *named]))
    return section("Sources", details("Papers behind what was used", papers))


def _data(name: str) -> str:
    return resources.files("fem_impact.pages").joinpath("data", name).read_text(encoding="utf-8")


def figure(picture: Picture, figures: Path, since: Path | None = None) -> Markup:
    """Return a picture with hover and zoom; as SVG, with its numbers, it is written into ``figures``.

    Files newer than ``since``, the file of the data shown, are not written again.
    """
    drawn = make_directory(figures) / f"{picture.name}.svg"
    if not since or not drawn.is_file() or drawn.stat().st_mtime <= since.stat().st_mtime:
        draw(picture, drawn)
    return live_figure(live(picture))


def figure_with_data(picture: Picture, figures: Path, since: Path | None) -> Markup:
    """Return a picture as `figure` does, and the link to its numbers."""
    shown = figure(picture, figures, since)
    return join([shown, download(figures / f"{picture.name}.csv", "its data")])


def stored_figure(stem: Path) -> Markup:
    """Return a figure that a study stored, ``stem.json``. Raises ResultError where it is none."""
    path = stem.with_suffix(".json")
    try:
        return live_figure(json.loads(_bytes(path)))
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise ResultError(f"{path}: not a figure of this version; run the study again ({error}).") from error


def live_figure(shown: dict[str, Any]) -> Markup:
    """Return panels that the page's script draws, their legend and caption, of `fem_impact.figures.live`."""
    parts = ("data", "layout", "frames")
    drawn = [{name: panel[name] for name in parts if name in panel} for panel in shown["panels"]]
    # no text within can end the element
    text = json.dumps(drawn, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    panels = "\n".join(map(_panel, shown["panels"]))
    signs = (
        f'<span><b style="color:{escape(colour)}">{escape(sign)}</b> {label}</span>'
        for sign, colour, label in shown["legend"]
    )
    legend = f'<p class="legend">{" ".join(signs)}</p>' if shown["legend"] else ""
    return Markup(
        f'<figure class="live"><script type="application/json">{text}</script>\n'
        f'<div class="panels" style="--columns:{int(shown["columns"])}">\n{panels}\n</div>\n'
        f"{legend}<figcaption>{shown['caption']}</figcaption></figure>"
    )


def _panel(panel: dict[str, Any]) -> str:
    title = f"<h3>{panel['title']}</h3>" if panel["title"] else ""
    area = f'<div class="plot" role="img" aria-label="{escape(panel["alt"])}"'
    return f'<div>{title}{area} style="height:{int(panel["height"])}px"></div></div>'


def download(path: Path, label: str) -> Markup:
    """Return a paragraph with the link to a CSV file embedded in the page."""
    return Markup(f"<p>{data_link(_bytes(path), path.name, label)}</p>")


def data_link(content: bytes, name: str, label: str) -> str:
    """Return the link to a CSV file embedded in the page."""
    text = base64.b64encode(content).decode("ascii")
    return f'<a download="{escape(name)}" href="data:text/csv;base64,{text}">{escape(label)}</a>'


def image(path: Path, alt: str) -> Markup:
    """Return a picture embedded."""
    return Markup(f'<figure><img src="{_embedded(path)}" alt="{escape(alt)}"></figure>')


def film_of(folder: Path) -> Path | None:
    """Return the film of a run in a format that a page can show, None where there is none."""
    return next((folder / name for name in FILMS if (folder / name).is_file()), None)


def film(path: Path, caption: str) -> Markup:
    """Return a film embedded."""
    data, words = _embedded(path), escape(caption)
    shown = f'<img src="{data}" alt="{words}">'
    if path.suffix == ".mp4":
        shown = f'<video src="{data}" controls loop muted playsinline aria-label="{words}"></video>'
    return Markup(f'<figure class="film">{shown}<figcaption>{words}</figcaption></figure>')


def _embedded(path: Path) -> str:
    return f"data:{TYPES[path.suffix]};base64,{base64.b64encode(_bytes(path)).decode('ascii')}"


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ResultError(f"{path}: cannot be read ({error.strerror}).") from error
