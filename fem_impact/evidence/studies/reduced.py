"""The reduced model beside the finite elements: measured sets, calibration, scenes it was not read from."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from math import cos, radians, sin

import numpy as np
import pandas
from scipy.stats import qmc

from fem_impact import Outcome, Scene, Unknown, load, replace_all
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.studies.declared import DeclaredSweep, table_of
from fem_impact.evidence.studies.rods import BODY, length_of
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.outcome.keys import Key
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import Table
from rigid.slenderness import EXPONENT

SEED = 20260301  # of the hypercube
COUNT, QUICK_COUNT = 24, 4
COARSE = {"accuracy.tip_size": "0.6 mm", "accuracy.barrier_size": "0.3 mm", "save.frames": 0}
SIDES = {
    "gamma": (10.0, 60.0),
    "angle_deg": (15.0, 65.0),
    "speed_m_per_s": (1.0, 5.0),
    "f": (0.0, 0.7),
    "tip_radius_mm": (2.0, 6.0),
    "barrier_yield_MPa": (200.0, 500.0),
    "barrier_ultimate_over_yield": (1.1, 1.8),
}
"""What varies evenly over the hypercube, with its ends; the rod's steel and 19 mm stay as they are."""
# gamma of rods of 100, 200, 60, 160, 100, 220 mm
CALIBRATION = tuple(
    dict(zip(SIDES, (0.001 * length / BODY**EXPONENT, *rest), strict=True))
    for length, *rest in (
        (100.0, 40.0, 1.5, 0.4, 5.0, 320.0, 446 / 320),
        (200.0, 50.0, 2.5, 0.5, 4.0, 320.0, 446 / 320),
        (60.0, 25.0, 3.0, 0.3, 2.0, 320.0, 446 / 320),
        (160.0, 60.0, 2.0, 0.7, 3.0, 320.0, 446 / 320),
        (100.0, 45.0, 2.5, 0.57, 3.0, 250.0, 480 / 250),
        (220.0, 35.0, 1.5, 0.2, 3.0, 400.0, 520 / 400),
    )
)
"""Impacts from which the two constants of `fem_impact.physics.contact_law` were read, with earlier inputs."""
MODELS = ("modal", "solid")
KEYS = {
    "e": (KEY_TABLE["e_edge"],),
    "mu": (KEY_TABLE["mu"],),
    "Omega": (KEY_TABLE["Omega_rad_per_s"],),
    "E_vib": (KEY_TABLE["E_vib_over_E_0"],),
    "skin": (KEY_TABLE["W_friction_over_E_0"], KEY_TABLE["W_skin_barrier_over_E_0"]),
}
"""Compared quantities, sums of their keys. The harder rod has no plastic work in the reduced model."""
HEAD = ("name", "group", *(f"{name}_{model}" for name in KEYS for model in MODELS))
NEAR_E, NEAR_VIBRATION, OF_VIBRATION = 0.06, 0.003, 0.25  # what counts as near: of e, of E_0, of itself


def design(count: int) -> list[dict[str, float]]:
    """Return the values of `SIDES` of each scene."""
    unit = qmc.LatinHypercube(len(SIDES), rng=np.random.default_rng(SEED)).random(count)
    values = qmc.scale(unit, *np.transpose([*SIDES.values()]))
    return [dict(zip(SIDES, map(float, row), strict=True)) for row in values]


def scene_of(row: dict[str, float], name: str) -> Scene:
    """Return a drop without spin as a scene, on elements twice as large as its own."""
    angle, speed, f = radians(row["angle_deg"]), row["speed_m_per_s"], row["f"]
    strength = row["barrier_yield_MPa"]
    changes: dict[str, str | int | float] = {
        "projectile.length": f"{length_of(row['gamma'], BODY):.6g} m",
        "projectile.tip_radius": f"{row['tip_radius_mm']:.6g} mm",
        "impact.angle": f"{row['angle_deg']:.6g} deg",
        "impact.v_n": f"{-speed * cos(angle):.6g} m/s",
        "impact.v_t": f"{-speed * sin(angle):.6g} m/s",
        "barrier.material.yield_stress": f"{strength:.6g} MPa",
        "barrier.material.ultimate_stress": f"{strength * row['barrier_ultimate_over_yield']:.6g} MPa",
        **dict.fromkeys(("surface.friction", "surface.friction_low", "surface.friction_high"), f),
    }
    scene = replace_all(load("t5b"), changes | COARSE)
    return replace(scene, id=name, title="Reduced model beside finite elements", measured=None)


def scenes(request: Request) -> dict[str, Scene]:
    """Return the measured sets, the impacts of the calibration and the hypercube; that alone if quick."""
    drawn = design(QUICK_COUNT if request.quick else COUNT)
    hypercube = {f"reduced-{i}": scene_of(row, f"reduced-{i}") for i, row in enumerate(drawn)}
    if request.quick:
        return hypercube
    measured = {name: replace_all(load(name), {"save.frames": 0}) for name in MEASURED_SETS}
    read_from = {f"calibration-{i}": scene_of(row, f"calibration-{i}") for i, row in enumerate(CALIBRATION)}
    return {**measured, **read_from, **hypercube}


def group_of(name: str) -> str:
    """Return the group of a scene by its name."""
    return {"calibration": "calibration", "reduced": "hypercube"}.get(name.split("-")[0], "measured")


def _sum(keys: Sequence[Key], run: Outcome) -> float | None:
    values = [key.of(run) for key in keys]
    return None if any(isinstance(value, Unknown) for value in values) else float(sum(values))


def report_of(table: pandas.DataFrame) -> StudyReport:
    """Return the study of scenes: near or not, and a panel a quantity; ``table`` as `table_of`."""
    rows = [(name, group_of(name), *row) for name, row in zip(table.index, table.to_numpy(), strict=True)]
    groups = {group: members.astype(float) for group, members in table.groupby(group_of, sort=False)}
    sentences = [_near("all", table.astype(float))] if len(groups) > 1 else []
    sentences += [_near(group, members) for group, members in groups.items()]
    panels = tuple(_panel(name, groups) for name in KEYS)
    return StudyReport(
        "reduced",
        "The reduced model beside the finite elements",
        sentences,
        [Picture("beside", "Each scene by both models; on the line they agree.", panels)] if rows else (),
        [Sheet("beside", "Every scene by both models", Table.of(HEAD, rows))],
        ["Finite elements on one mesh: its error is part of the difference."],
        conclusions=[("beside", sentence) for sentence in sentences],
    )


def _near(group: str, table: pandas.DataFrame) -> str:
    """Return how many scenes of a group are near in e and in vibration, and the median differences."""
    e, vibration = ((table[name, "modal"] - table[name, "solid"]).abs() for name in ("e", "E_vib"))
    near = e <= NEAR_E
    close = vibration <= np.maximum(NEAR_VIBRATION, OF_VIBRATION * table["E_vib", "solid"])
    return (
        f"{group}: e within {NEAR_E:g} in {near.sum()} of {len(table)} scenes, vibration within "
        f"{OF_VIBRATION:.0%} or {NEAR_VIBRATION:g} of E_0 in {close.sum()}, both in {(near & close).sum()}; "
        f"median difference of e {e.median():.3f}, of vibration {vibration.median():.4f} of E_0."
    )


def _panel(name: str, groups: dict[str, pandas.DataFrame]) -> Panel:
    """Return one quantity by both models, a colour a group."""
    series = [
        Series(group, members[name, "solid"], members[name, "modal"], "points")
        for group, members in groups.items()
    ]
    solid = np.concatenate([members[name, "solid"] for members in groups.values()])
    ends = np.array([np.nanmin(solid), np.nanmax(solid)])
    unit = KEYS[name][0].unit
    label = name if unit in ("", "-", "1") else f"{name}, {unit}"
    equal = Series("equal", ends, ends)
    return Panel(name, f"finite elements, {label}", f"reduced model, {label}", (*series, equal))


_SWEEP = DeclaredSweep(
    scenes,
    lambda _, scene: {model: (scene, model) for model in MODELS},
    lambda runs: report_of(
        table_of(runs, {name: partial(_sum, keys) for name, keys in KEYS.items()}, MODELS)
    ),
)
plan, conclude = _SWEEP.plan, _SWEEP.conclude
