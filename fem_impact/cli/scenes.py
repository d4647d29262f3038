"""The command ``scenes``: shipped scenes and materials, known pairs of friction, what packages add."""

import math
import sys

from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import print_json, print_table
from fem_impact.options import FIDELITIES
from fem_impact.plugins import listed
from fem_impact.scene import library
from fem_impact.scene.shipped import load
from fem_impact.scene.types import digest
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped


def scenes(options: Options) -> int:
    """List the shipped scenes or materials, the pairs whose friction is known, or what packages add."""
    if options.materials:
        return _materials(options)
    if options.friction:
        return _friction(options)
    if options.added:
        return _added(options)
    rows = [
        {
            "id": scene.id,
            "title": scene.title,
            "speed": f"{math.hypot(scene.relative.v_n, scene.relative.v_t):.2f} m/s",
            "measured": scene.measured,
            "digest": digest(scene),
        }
        for scene in map(load, library.shipped())
    ]
    if options.json:
        print_json({"scenes": rows})
    else:
        columns = "id", "speed", "title"
        texts = [[row[key] for key in columns] for row in rows]
        print_table(Table.of(columns, texts, left=range(3)), options)
    return 0


HEAD = ("material", "E_Pa", "nu", "rho_kg_per_m3", "yield_stress_Pa", "ultimate_stress_Pa")


def _materials(options: Options) -> int:
    """List the shipped materials with their values, then the source of each value."""
    known = library.materials()
    rows = [
        (name, m.E, m.nu, m.rho, *(x if x < math.inf else None for x in (m.yield_stress, m.ultimate_stress)))
        for name, m in known.items()
    ]
    if options.json:
        listed = [
            {
                **dict(zip(HEAD, row, strict=True)),
                "aliases": list(library.aliases_of(name)),
                "family": library.family_of(library.material(name)),
                "about": library.about(name),
                "intervals": library.intervals_of(name),
                "sources": library.sources_of(name),
            }
            for name, row in zip(known, rows, strict=True)
        ]
        print_json({"materials": listed})
        return 0
    texts = [(row[0], *("none" if x is None else f"{x:.4g}" for x in row[1:])) for row in rows]
    print_table(Table.of(HEAD, texts), options)
    for name in known:
        other = ", ".join(library.aliases_of(name))
        lines = ["", *wrapped(f"{name}{f' ({other})' if other else ''}: {library.about(name)}")]
        for key, value, interval, source in library.sourced_values(name):
            spread = f" ({interval})" if interval else ""
            lines += wrapped(f"{' '.join(filter(None, (key, value)))}{spread}: {source}", "  ")
        sys.stdout.writelines(f"{line}\n" for line in lines)
    return 0


def _friction(options: Options) -> int:
    """List the dry pairs of materials of which friction is known."""
    pairs = library.friction_pairs()
    if options.json:
        print_json({"pairs": pairs})
        return 0
    rows = [(" on ".join(pair["families"]), pair["low"], pair["high"], pair["source"]) for pair in pairs]
    print_table(Table.of(("pair, dry", "f from", "to", "source"), rows, left=(0, 3)), options)
    return 0


def _added(options: Options) -> int:
    """List what other installed packages add, and the fidelities that compute it."""
    from fem_impact.case.effects.registry import EFFECTS  # which imports numpy

    rows = [
        (group, name, package, EFFECTS[name].fidelities if group == "effects" else FIDELITIES)
        for group, name, package in listed()
    ]
    if options.json:
        head = ("kind", "name", "package", "fidelities")
        print_json({"added": [dict(zip(head, row, strict=True)) for row in rows]})
        return 0
    texts = [(*row, ", ".join(fidelities)) for *row, fidelities in rows]
    head = ("kind", "name", "package", "computed by")
    print_table(Table.of(head, texts, left=range(4)), options)
    return 0
