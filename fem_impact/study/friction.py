"""What the uncertain friction does: each set again at the ends of its interval, on the coarser mesh."""

from __future__ import annotations

from typing import Any

from fem_impact.outcome import Outcome
from fem_impact.scene import replace_all
from fem_impact.study.cases import Case, Failure

SHOWN = (
    ("e", "e_paper"),
    ("mu", "mu"),
    ("Omega", "Omega_rad_per_s"),
    ("vibration/E_0", "E_vib_over_E_0"),
    ("friction/E_0", "W_friction_over_E_0"),
)


def friction_cases(coarse: Case) -> dict[str, Case]:
    """Return the coarser case with the lowest and the highest friction of its surface."""
    surface = coarse.scene.surface
    ends = {"low": surface.friction_low, "high": surface.friction_high}
    place, name = coarse.out.parent, coarse.out.name
    return {
        end: Case(replace_all(coarse.scene, {"surface.friction": f}), place / f"{name}-friction-{end}")
        for end, f in ends.items()
    }


def friction_rows(
    low: Outcome | Failure, coarse: Outcome | Failure, high: Outcome | Failure
) -> list[dict[str, Any]]:
    """Return one row a quantity: its values at the lowest, stated and highest friction."""
    if not (isinstance(low, Outcome) and isinstance(coarse, Outcome) and isinstance(high, Outcome)):
        return []
    return [
        {
            "set": coarse["scene_id"],
            "quantity": name,
            "f": [o["friction_f"] for o in (low, coarse, high)],
            "model": [o[key] for o in (low, coarse, high)],
        }
        for name, key in SHOWN
    ]


def friction_notes(rows: list[dict[str, Any]]) -> list[str]:
    """Return a sentence a set on what its friction interval does to e and mu."""
    kept = {(row["set"], row["quantity"]): row for row in rows}
    return [
        f"{name}: friction from {row['f'][0]:g} to {row['f'][2]:g} moves e from {row['model'][0]:.3f} to "
        f"{row['model'][2]:.3f} and mu from {kept[name, 'mu']['model'][0]:.3f} to "
        f"{kept[name, 'mu']['model'][2]:.3f} (coarser mesh; {row['model'][1]:.3f} and "
        f"{kept[name, 'mu']['model'][1]:.3f} at the stated f = {row['f'][1]:g})."
        for (name, quantity), row in kept.items()
        if quantity == "e"
    ]
