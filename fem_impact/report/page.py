"""The page around the sections."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from html import escape
from importlib import resources
from string import Template

from fem_impact.report.html import Markup, bullets, join, section

__all__ = ["page", "sources"]


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
