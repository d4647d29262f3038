"""The command ``scenes``: the shipped scenes and materials."""

from __future__ import annotations

import math

from fem_impact.cli.options import Options
from fem_impact.cli.parser import CommandParser
from fem_impact.cli.terminal import print_json, print_table
from fem_impact.scene.library import materials, shipped
from fem_impact.scene.shipped import load
from fem_impact.scene.write import digest
from fem_impact.tables.table import Table


def add_options(parser: CommandParser) -> None:
    """State the command and its options."""
    parser.state(scenes, "fem-impact scenes", "fem-impact scenes --materials")
    parser.add_argument("--materials", action="store_true", help="list the shipped materials instead")


def scenes(options: Options) -> int:
    """List the shipped scenes, or the shipped materials."""
    if options.materials:
        return _materials(options)
    rows = [
        {
            "id": scene.id,
            "title": scene.title,
            "speed": f"{math.hypot(scene.relative.v_n, scene.relative.v_t):.2f} m/s",
            "measured": scene.measured,
            "digest": digest(scene),
        }
        for scene in map(load, shipped())
    ]
    if options.json:
        print_json({"scenes": rows})
    else:
        columns = "id", "speed", "title"
        print_table(
            Table.of(columns, [[row[key] for key in columns] for row in rows], left=range(3)), options
        )
    return 0


def _materials(options: Options) -> int:
    """List the shipped materials with their values."""
    head = ("material", "E_Pa", "nu", "rho_kg_per_m3", "yield_stress_Pa", "ultimate_stress_Pa")
    rows = [
        (name, m.E, m.nu, m.rho, *(x if x < math.inf else None for x in (m.yield_stress, m.ultimate_stress)))
        for name, m in materials().items()
    ]
    if options.json:
        print_json({"materials": [dict(zip(head, row, strict=True)) for row in rows]})
    else:
        texts = [(row[0], *("none" if x is None else f"{x:.4g}" for x in row[1:])) for row in rows]
        print_table(Table.of(head, texts), options)
    return 0
