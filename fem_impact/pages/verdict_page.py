"""The verdict on a page to print and sign, and as the box that heads a report."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from fem_impact.answers.verdict.assess import Verdict
from fem_impact.answers.verdict.chart import chart
from fem_impact.answers.verdict.screening import screening
from fem_impact.answers.verdict.sentences import Line, screening_lines
from fem_impact.figures.still import draw
from fem_impact.files.atomic import make_directory, write_text
from fem_impact.files.digests import signed
from fem_impact.pages.page import Markup, bullets, figure, page, paragraph, section, sources, table
from fem_impact.scene.inputs import inputs
from fem_impact.scene.types import Scene
from fem_impact.scene.write import to_toml
from fem_impact.tables.text import markup


def verdict_box(lines: Sequence[Line], answer: str = "") -> Markup:
    """Return titled sentences as the box that heads a page; ``answer`` gives its colour."""
    rows = "\n".join(
        f"<p><strong>{markup(title)}</strong> {markup(sentence)}</p>" for title, sentence in lines
    )
    return Markup(f'<div class="verdict {escape(answer)}">\n{rows}\n</div>')


def screening_box(scene: Scene, name: str) -> Markup:
    """Return the box of a run that has no twin: the closed-form screening, and how to get the verdict.

    ``name`` is what the command takes: the id of a shipped scene, or the path of its file.
    """
    return verdict_box(screening_lines(screening(scene), name))


def write_verdict(verdict: Verdict, document: dict[str, Any], out: Path) -> Path:
    """Write ``verdict.html``, ``verdict.json``, ``scene.toml`` and the design chart; return the page's path.

    Raises
    ------
    MissingLibraryError
        matplotlib or plotly is not installed.
    """
    make_directory(out)
    write_text(out / "scene.toml", to_toml(verdict.scene))
    write_text(out / "verdict.json", json.dumps(signed(document), indent=1, allow_nan=False) + "\n")
    picture, figures = chart(verdict), make_directory(out / "figures")
    draw(picture, figures / f"{picture.name}.png")
    return write_text(out / "verdict.html", verdict_page(verdict, document, figure(picture, figures)))


def verdict_page(verdict: Verdict, document: dict[str, Any], charted: Markup) -> str:
    """Return the page: verdict and what it rests on, chart, inputs with sources, what it does not cover."""
    scene, free = verdict.scene, verdict.here.free
    following = [("Next step:", document["next_step"])] if document["next_step"] else []
    body = (
        verdict_box([*document["box"], *following], verdict.answer),
        section("What the verdict rests on", _titled(document["basis"])),
        section("This scene among other rods", charted),
        section("Inputs and their sources", table(inputs(scene))),
        section("What the verdict does not cover", bullets(document["not_covered"])),
        section("Statement of the scene", Markup(f"<pre>{escape(to_toml(scene))}</pre>")),
        _signatures(),
        sources(free.provenance.effects),
    )
    versions = ", ".join(f"{name} {version}" for name, version in document["versions"].items())
    footer = (
        f"Computed {free.provenance.created_utc} with {versions}. Digest of the scene "
        f"{document['scene_digest']}."
    )
    lead = f"{scene.title}. Change of e that may be neglected: {verdict.tolerance:g}."
    return page(f"May rigid theory be used: {scene.id}", "verdict", lead, footer, body)


def _titled(lines: Sequence[Line]) -> Markup:
    return bullets(
        Markup(f"<strong>{markup(title)}</strong>: {markup(sentence)}") for title, sentence in lines
    )


def _signatures() -> Markup:
    lines = paragraph("Assessed by, date: ______________________    Checked by, date: ______________________")
    return section("Signatures", lines)
