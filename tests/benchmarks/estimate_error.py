"""How far the quick estimates of what an effect changes are off, beside the finite elements.

Run ``python tests/benchmarks/estimate_error.py``: it compares the estimates that ``check`` prints with the
stored runs of the measured sets that leave one effect out (``case/data/summary.json``), and writes the
largest differences as ``case/data/estimate-error.csv``, where ``check`` reads them.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from fem_impact.case.choose import choices
from fem_impact.case.measured import summary
from fem_impact.files.atomic import write_text
from fem_impact.scene.read import read_dict
from fem_impact.tables.table import Table

TABLE = Path(__file__).parents[2] / "fem_impact" / "case" / "data" / "estimate-error.csv"
COLUMNS = ("effect", "scenes", "e", "E_vib_over_E_0")
SOFTER = "with an elastic barrier"  # the setting that stands for leaving barrier-elastoplastic out


def errors() -> list[tuple[str, int, float, float]]:
    """Return for each effect the number of scenes and the largest errors of the estimates."""
    found = defaultdict(list)
    for cost in summary()["scenes"].values():
        harm = {choice.name: choice.harm for choice in choices(read_dict(cost["scene"]))}
        for one in cost["settings"]:
            name = one["name"].partition("without ")[2]
            name = "barrier-elastoplastic" if one["name"].endswith(SOFTER) else name
            if one["kind"] == "effect" and name in harm:
                scale = {key: cost["quantities"][key]["scale"] for key in ("e", "E_vib")}
                changed = [(one["error"][key] or 0.0) * scale[key] for key in scale]
                if name == "vibration":  # without vibration there is none: all of it is the change
                    changed[1] = abs(cost["quantities"]["E_vib"]["limit"])
                found[name].append((abs(harm[name].e - changed[0]), abs(harm[name].E_vib - changed[1])))
    return [
        (name, len(rows), max(e for e, _ in rows), max(v for _, v in rows)) for name, rows in found.items()
    ]


if __name__ == "__main__":
    rows = [(name, count, f"{e:.3g}", f"{v:.3g}") for name, count, e, v in errors()]
    write_text(TABLE, Table.of(COLUMNS, rows).csv())
    print(TABLE.read_text(encoding="utf-8"))
