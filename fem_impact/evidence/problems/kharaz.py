"""An alumina sphere on glass beside measured rebounds: Kharaz, Gorham and Salman 2001.

Nothing is fitted: elastic constants and friction are those with which the experiment is quoted
(``problems/data/kharaz2001.csv``), the density of the glass is a handbook value.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from importlib.resources import files
from math import atan2, cos, degrees, radians, sin

from fem_impact.evidence.problems.spheres import AFTER, ball_mass, plain_hertz, sphere_model
from fem_impact.evidence.problems.watch import run_strike
from fem_impact.evidence.references.hertz import contact_modulus
from fem_impact.evidence.references.sphere import oblique_sphere, pair_nu
from fem_impact.tables.table import Cell, Table

VALUES = {
    "radius": 2.5e-3,
    "speed": 3.9,
    "f": 0.092,
    "E": 380e9,
    "nu": 0.23,
    "rho": 4000.0,
    "barrier_E": 70e9,
    "barrier_nu": 0.25,
    "barrier_rho": 2500.0,
    "block": 1.0,
    "cells": 2.5,
    "across": 16.0,
}
"""Parameters of `fem_impact.evidence.problems.spheres`, SI: alumina on soda-lime glass."""

QUANTITIES = ("e_t", "rebound_deg", "omega_rad_s")


@dataclass(frozen=True, slots=True)
class Measured:
    """One measured point: e_t, rebound_deg or omega_rad_s at an impact angle, degrees from the normal."""

    quantity: str
    angle: float
    value: float


def measured() -> tuple[Measured, ...]:
    """Return the points in the order of the file."""
    text = (
        files("fem_impact.evidence.problems").joinpath("data", "kharaz2001.csv").read_text(encoding="utf-8")
    )
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = csv.DictReader(lines)
    return tuple(Measured(r["quantity"], float(r["impact_angle_deg"]), float(r["value"])) for r in rows)


def by_theory(angle: float) -> dict[str, float]:
    """Return the three quantities at an impact angle, degrees, by Hertz, Mindlin and Coulomb (e = 1)."""
    p = VALUES
    v_n, v_t = p["speed"] * cos(radians(angle)), p["speed"] * sin(radians(angle))
    alumina, glass = (p["E"], p["nu"]), (p["barrier_E"], p["barrier_nu"])
    body = p["radius"], ball_mass(p), p["f"]
    back = oblique_sphere(contact_modulus(*alumina, *glass), pair_nu(alumina, glass), *body, v_n, v_t)
    return _told(back.centre_t, v_n, v_t, back.spin / p["radius"])


def on_mesh(angle: float, cells: float = VALUES["cells"]) -> dict[str, float]:
    """Return the three quantities at an impact angle, degrees, by finite elements (half a minute)."""
    p = {**VALUES, "cells": cells}
    v_n, v_t = p["speed"] * cos(radians(angle)), p["speed"] * sin(radians(angle))
    touch = plain_hertz(p, v_n)
    model = sphere_model(p, touch, v_n, v_t, p["f"])
    found = run_strike(model, AFTER * touch.duration, touch.duration).motion
    return _told(-found.V_t, found.V_n, v_t, -found.Omega)


def _told(back: float, V_n: float, v_t: float, spin: float) -> dict[str, float]:
    """Return the quantities from tangential and normal speed after, tangential speed before, spin."""
    return dict(zip(QUANTITIES, (back / v_t, degrees(atan2(back, V_n)), spin), strict=True))


def table() -> Table:
    """Return every measured point beside the theory, and the difference."""
    rows: list[list[Cell]] = []
    for point in measured():
        computed = by_theory(point.angle)[point.quantity]
        rows.append([point.quantity, point.angle, point.value, computed, computed - point.value])
    return Table.of(("quantity", "impact_angle_deg", "measured", "computed", "difference"), rows)
