"""The one bibliography of program and documentation: BibTeX entries, each with what rests on it."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources

ENTRY = re.compile(r"^@(?P<kind>\w+)\{(?P<key>\w+),\n(?P<fields>.*?)^\}\n", re.MULTILINE | re.DOTALL)
FIELD = re.compile(r"^  (\w+) = \{(.*)\},$", re.MULTILINE)
OURS = ("of", "for")
"""Fields that BibTeX does not know: what is taken from an entry, and what rests on it."""


@dataclass(frozen=True, slots=True)
class Reference:
    """An entry of ``references.bib``: its kind, key and fields."""

    kind: str
    key: str
    fields: Mapping[str, str]

    @property
    def used_for(self) -> frozenset[str]:
        """Effects, studies and fidelities that rest on it; "always" is every run."""
        return frozenset(self.fields["for"].split(", "))

    @property
    def text(self) -> str:
        """The entry as a line of plain text."""
        get = self.fields.get
        number = f" ({get('number')})" if get("number") else ""
        issue = f"{get('volume', '')}{number}".strip()
        place = " ".join(part for part in (get("journal", get("booktitle", "")), issue) if part)
        ends = (place, get("pages", "").replace("--", "-"), get("institution", ""), get("publisher", ""))
        line = ", ".join(part for part in (*ends, get("year", "")) if part)
        title = f"{get('title')}. " if get("title") else ""
        authors = get("author", "").replace(" and others", " et al.").replace(" and ", ", ").strip("{}")
        link = f" doi:{get('doi')}" if get("doi") else f" {get('url')}" if get("url") else ""
        of = f" ({get('of')})" if get("of") else ""
        return f"{authors}: {title}{line}.{link}{of}".replace(" .", "")

    @property
    def bibtex(self) -> str:
        """The entry as BibTeX, without the fields of this program."""
        lines = [f"  {name} = {{{value}}}," for name, value in self.fields.items() if name not in OURS]
        return "\n".join([f"@{self.kind}{{{self.key},", *lines, "}"])


@cache
def references() -> tuple[Reference, ...]:
    """Return every entry in the order of the file."""
    text = resources.files("fem_impact.pages").joinpath("data", "references.bib").read_text(encoding="utf-8")
    return tuple(
        Reference(entry["kind"], entry["key"], dict(FIELD.findall(entry["fields"])))
        for entry in ENTRY.finditer(text)
    )


def behind(named: Iterable[str]) -> list[Reference]:
    """Return the entries behind effects, studies and fidelities, and those behind every run."""
    used = {"always", *named}
    return [one for one in references() if used & one.used_for]
