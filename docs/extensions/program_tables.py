"""Parts of pages that are made from the program: tables that stand in the pages, and long texts.

A table stands between ``<!-- from-program: NAME -->`` and ``<!-- end -->``, so that the raw file holds it; a
test compares it, and ``python docs/extensions/program_tables.py`` writes all of them anew. A long text comes
in place of the directive ``{from-program} NAME`` when the documentation is built. NAME is a function of
`TABLES` or `TEXTS`, which returns Markdown.
"""

import argparse
import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import get_args

from sphinx.util.docutils import SphinxDirective

from fem_impact.case.effects.registry import EFFECTS
from fem_impact.cli.parser import build_parser, every_command
from fem_impact.cli.study import REPORT, STUDIES
from fem_impact.errors import EXIT_CODES
from fem_impact.evidence.problems.problem import PROBLEMS, problem
from fem_impact.outcome.record import KEYS
from fem_impact.pages.bibliography import references
from fem_impact.scene import fields, library
from fem_impact.scene.fields import Parameter
from fem_impact.scene.material import FAMILIES
from fem_impact.scene.units import DIMENSIONS
from fem_impact.tables.table import Table

WIDTH = 100  # of the help of a command


def scene_numbers() -> str:
    """Every number of a scene, table by table."""
    head = ("key", "meaning", "SI unit", "if left out", "allowed", "source of the default")
    parts = []
    for name, group in _groups():
        rows = [(f"`{f.key}`", f.meaning, f.si_unit, _default(f, name), f.bounds, f.source) for f in group]
        rows += [(f"`{key}`", *words) for key, words in _WORDS.get(name, {}).items()]
        parts += [f"### {_PLACES.get(name, f'`[{name}]`')}", Table.of(head, rows, left=range(6)).markdown()]
    return "\n\n".join(parts)


_PLACES = {"material": "`[projectile.material]` and `[barrier.material]`", "top": "Before the first table"}
_PLACES |= {
    "tube": "`[projectile]`, of a tube",
    "motion": "`[impact]` on a barrier that moves",
    "point": "A point of `projectile.profile` or `projectile.bore`",
    "shape": "`[projectile]`, of a `shape`",
    "sliding": "`surface.sliding_law`, a table",
    "layer": "A layer of `barrier.layers`",
}
_LAWS = {"rate": fields.RATES, "flow": fields.FLOWS}
_PLACES["skin"] = "`skin` of a material"
_PLACES |= {
    f"{key} {law}": f'`{key}` of a material, with `law = "{law}"`'
    for key, laws in _LAWS.items()
    for law in laws
}
_WORDS = {
    "surface": {
        "state": ("what the friction is known of", "text", "`pair`", "see Words", ""),
        "source": ("where your own friction is from", "text", "must be given beside `custom`", "", ""),
        "sliding_law": ("how friction changes with speed", "text or table", "it does not", "see Words", ""),
    }
}
"""Keys without a number that belong to the table of a group."""
_OPTIONAL = ("top", "surface")  # a shipped surface brings its friction along


def _groups() -> Iterator[tuple[str, tuple[Parameter, ...]]]:
    for name, value in vars(fields).items():
        if _parameters(value):
            yield name.strip("_").lower(), value
    for key, laws in _LAWS.items():
        yield from ((f"{key} {law}", numbers) for law, numbers in laws.items() if numbers)


def _parameters(value: object) -> bool:
    return isinstance(value, tuple) and bool(value) and all(isinstance(one, Parameter) for one in value)


def _default(field: Parameter, group: str) -> str:
    if field.default is not None:
        return f"{field.write(field.default)}"
    return field.derived or ("not used" if group in _OPTIONAL else "must be given")


def scene_choices() -> str:
    """Keys that take one of a few words."""
    choices = {
        "law of a material": fields.FlowLaw,
        "shape of a material's skin": fields.SkinShape,
        "barrier.boundary": fields.Boundary,
        "barrier.support": fields.Support,
        "accuracy.element": fields.Element,
        "accuracy.yielding_element": fields.YieldingElement,
        "accuracy.fine_zone": fields.FineZone,
        "accuracy.unresolved": fields.Unresolved,
        "save.fields": fields.Fields,
    }
    rows = [(f"`{key}`", ", ".join(f"`{word}`" for word in get_args(kind))) for key, kind in choices.items()]
    rows += [("`family of a material`", ", ".join(f"`{word}`" for word in FAMILIES))]
    rows += [("`surface.state`", ", ".join(f"`{word}`" for word in [*library.surfaces(), "pair", "custom"]))]
    return Table.of(("key", "one of"), rows, left=range(2)).markdown()


def scene_units() -> str:
    """Units that a scene may be written in."""
    rows = [
        (name, ", ".join(f"`{unit.symbol}`" for unit in dimension.units), f"`_{dimension.suffix}`")
        for name, dimension in DIMENSIONS.items()
    ]
    return Table.of(("quantity", "units", "ending of the key in SI"), rows, left=range(3)).markdown()


def materials() -> str:
    """Shipped materials with their values, other names and states."""
    rows = [
        (
            f"`{name}`",
            ", ".join(library.aliases_of(name)),
            f"{m.E / 1e9:.4g}",
            f"{m.nu:g}",
            f"{m.rho:g}",
            _strength(m.yield_stress),
            _strength(m.ultimate_stress),
            library.about(name),
        )
        for name, m in library.materials().items()
    ]
    strengths = ("yield stress, MPa", "ultimate stress, MPa")
    head = ("name", "also", "E, GPa", "nu", "rho, kg/m3", *strengths, "state")
    return Table.of(head, rows, left=(0, 1, 7)).markdown()


def _strength(stress: float) -> str:
    return f"{stress / 1e6:.4g}" if stress < math.inf else "none"


def material_sources() -> str:
    """Every value of every shipped material, its interval where one is known, and where it was read."""
    head = ("key", "value", "interval", "source")
    tables = {
        name: Table.of(head, library.sourced_values(name), left=range(4)) for name in library.materials()
    }
    return "\n\n".join(f"### {name}\n\n{table.markdown()}" for name, table in tables.items())


def friction_pairs() -> str:
    """Dry pairs of materials with the interval of their friction and its source."""
    rows = [
        (" on ".join(pair["families"]), f"{pair['low']:g} to {pair['high']:g}", pair["source"])
        for pair in library.friction_pairs()
    ]
    return Table.of(("pair", "f", "source"), rows, left=range(3)).markdown()


def surfaces() -> str:
    """Shipped states of the surface with friction and source."""
    rows = [
        (name, s.friction, f"{s.friction_low} to {s.friction_high}", s.source)
        for name, s in library.surfaces().items()
    ]
    return Table.of(("state", "f", "interval", "source"), rows, left=(0, 3)).markdown()


def effects() -> str:
    """Every effect with the number that decides about it."""
    rows = [
        (f"`{e.name}`", e.sentence, ", ".join(e.fidelities), e.measure, f"{e.threshold:g}", e.source)
        for e in EFFECTS.values()
    ]
    head = ("effect", "what it adds", "computed by", "number", "on above", "source of the threshold")
    return Table.of(head, rows, left=(0, 1, 2, 3, 5)).markdown()


def problems() -> str:
    """Every problem with a known answer."""
    rows = [(f"`{name}`", problem(name).words) for name in PROBLEMS]
    return Table.of(("problem", "what is compared"), rows, left=range(2)).markdown()


def outcome_keys() -> str:
    """Every key of outcome.json."""
    head = "| key | kind | unit | null | meaning |\n|---|---|---|---|---|"
    null = {True: "with a reason", False: "never"}
    rows = [
        f"| `{key.name}` | {key.kind} | {key.unit} | {null[key.nullable]} | {key.meaning} |" for key in KEYS
    ]
    return "\n".join([head, *rows]) + "\n"


def commands() -> str:
    """Return the help of every command."""
    parts = []
    for name, command in every_command(build_parser()):
        command.formatter_class = _wide(command.formatter_class)
        parts += [f"## {name}", f"```text\n{command.format_help().rstrip()}\n```"]
    return "\n\n".join(parts)


def _wide(base: type[argparse.HelpFormatter]) -> type[argparse.HelpFormatter]:
    """Return a formatter of one width, whatever terminal builds the pages."""
    return type(
        "Wide",
        (base,),
        {"__init__": lambda self, prog, **more: base.__init__(self, prog, width=WIDTH, **more)},
    )


def studies() -> str:
    """Every study with its size."""
    rows = [(f"`{name}`", study.about, study.size, study.quick) for name, study in STUDIES.items()]
    rows += [("`report`", f"{REPORT[0].upper()}{REPORT[1:]}.", "computes nothing", "")]
    head = ("study", "what it does", "size and processor time", "with `--quick`")
    return Table.of(head, rows, left=range(4)).markdown()


def exit_codes() -> str:
    """Exit codes of the command."""
    return Table.of(("exit code", "meaning"), EXIT_CODES.items(), left=range(2)).markdown()


def bibliography() -> str:
    """Every entry of the bibliography under its key."""
    return "\n\n".join(f"({one.key})=\n\n`{one.key}` {one.text}" for one in references())


def _named(*makers: Callable[[], str]) -> dict[str, Callable[[], str]]:
    return {make.__name__.replace("_", "-"): make for make in makers}


TABLES = _named(
    *(scene_numbers, scene_choices, scene_units, materials, friction_pairs, surfaces, effects, problems),
    *(outcome_keys, studies, exit_codes),
)
TEXTS = _named(material_sources, commands, bibliography)
PLACE = re.compile(r"(<!-- from-program: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
DOCS = Path(__file__).parents[1]
PAGES = sorted(page for page in DOCS.glob("*/*.md") if PLACE.search(page.read_text("utf-8")))


def filled(page: str) -> str:
    """Return the text of a page with its tables as the program is."""
    return PLACE.sub(lambda found: f"{found[1]}\n{TABLES[found[2]]().strip()}\n\n{found[3]}", page)


class FromProgram(SphinxDirective):
    """Insert a long text."""

    required_arguments = 1

    def run(self):
        """Return the nodes of the part."""
        return self.parse_text_to_nodes(TEXTS[self.arguments[0]](), allow_section_headings=True)


def setup(app):
    """Register the directive."""
    app.add_directive("from-program", FromProgram)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    for path in PAGES:
        path.write_text(filled(path.read_text("utf-8")), encoding="utf-8")
