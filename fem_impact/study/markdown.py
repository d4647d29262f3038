"""The study as Markdown tables, one row a set: beside the measurement, where the energy went, friction."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fem_impact.compare import Row

COMPARED = ("e", "mu", "Omega", "E_ln/E_0", "E_lt/E_0", "E_r/E_0")
SHARES = (
    ("rigid motion", "E_r_over_E_0"),
    ("vibration", "E_vib_over_E_0"),
    ("friction", "W_friction_over_E_0"),
    ("plastic rod", "E_plastic_rod_over_E_0"),
    ("plastic barrier", "E_plastic_barrier_over_E_0"),
    ("locked in", "E_locked_rod_over_E_0"),
    ("radiated", "W_radiated_over_E_0"),
)


def summary(rows: list[dict[str, Any]], comparison: list[Row], friction: list[dict[str, Any]]) -> str:
    """Return the tables, with that of the friction interval if it was computed."""
    tables = [_beside(comparison), _shares(rows), *([_friction(friction)] if friction else [])]
    return "\n\n".join(tables) + "\n"


def table(head: list[str], body: list[list[str]]) -> str:
    """Return a Markdown table: the first column to the left, the others to the right."""
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *body]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _beside(comparison: list[Row]) -> str:
    cells = {(row["set"], row["quantity"]): _cell(row) for row in comparison if row["quantity"] in COMPARED}
    names = list(dict.fromkeys(row["set"] for row in comparison))
    return table(["set", *COMPARED], [[name, *(cells[name, q] for q in COMPARED)] for name in names])


def _cell(row: Row) -> str:
    """Return model +- band / measured mean +- SD, and a mark: bold inside, ? undecided, plain else."""
    digits = 1 if row["quantity"] == "Omega" else 3
    band = f" ± {row['band']:.{digits}f}" if row["band"] is not None else ""
    model = f"{row['model']:.{digits}f}{band}"
    measured = f"{row['measured_mean']:.{digits}f} ± {row['measured_sd']:.{digits}f}"
    if row["verdict"] == "inside":
        return f"**{model}** / {measured}"
    return f"{model} / {measured}{' ?' if row['verdict'].startswith('undecided') else ''}"


def _shares(outcomes: list[dict[str, Any]]) -> str:
    head = ["set", *(f"{words}, %" for words, _ in SHARES), "residual", "steps", "CPU s"]
    body = []
    for o in outcomes:
        shares = [_percent(o, key) for _, key in SHARES]
        body.append(
            [o["scene_id"], *shares, f"{o['residual_over_E_0']:.0e}", f"{o['steps']}", f"{o['cpu_s']:.0f}"]
        )
    return table(head, body)


def _percent(outcome: Mapping[str, Any], key: str) -> str:
    value, band = 100 * outcome[key], (outcome["bands"] or {}).get(key)
    digits = 2 if abs(value) < 10 else 1
    return f"{value:.{digits}f}" + (f" ± {100 * band:.{digits}f}" if band is not None else "")


def _friction(friction: list[dict[str, Any]]) -> str:
    """Return a row a set: f and, at its low / stated / high value, each quantity on the coarser mesh."""
    names = list(dict.fromkeys(row["set"] for row in friction))
    quantities = list(dict.fromkeys(row["quantity"] for row in friction))
    cells = {(row["set"], row["quantity"]): " / ".join(f"{x:.3g}" for x in row["model"]) for row in friction}
    f = {row["set"]: " / ".join(f"{x:g}" for x in row["f"]) for row in friction}
    return table(["set", "f", *quantities], [[n, f[n], *(cells[n, q] for q in quantities)] for n in names])
