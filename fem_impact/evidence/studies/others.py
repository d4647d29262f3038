"""Tests of other people beside the solver (ASME V&V 20): rods shot at an anvil, spheres that slide on glass.

Rods flatten as in `fem_impact.evidence.problems.taylor_bar`, whose wall is rigid and without friction; a
sphere is a scene. Nothing is fitted: strengths are those of the library, friction that quoted with the tests.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, exp, inf, radians, sin, sqrt
from typing import Any

import numpy as np
from scipy.stats import chi2, f

from fem_impact import Scene, Unknown
from fem_impact.answers.refine.extrapolate import level_limits
from fem_impact.answers.refine.work import Levels, LevelsJob
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.v_and_v import COVERAGE, LEVEL, Comparison, joint
from fem_impact.arrays import Array
from fem_impact.evidence.data import read_table
from fem_impact.evidence.problems import taylor_bar
from fem_impact.evidence.problems.problem import defaults
from fem_impact.evidence.studies.report_parts import comparison_table, error_panel, rests_on
from fem_impact.figures.panels import Picture
from fem_impact.jobs.job import Failure
from fem_impact.scene.library import material
from fem_impact.scene.read import read_dict
from fem_impact.tables.table import Table

SPEED, RADIUS = 3.9, 2.5e-3  # of the spheres, m/s and m
READ = {"e_t": 0.003, "Omega": 7.0}
"""Standard uncertainties of points read off a figure, by two people: they differ by .0021 and 3 rad/s (root
mean square), and by up to .2 degrees, which is .0016 and 6 rad/s where the curves are steep."""
FASTER = {"aluminium-6061-t6": 1.3, "steel-4340": 1.22}
"""Flow stress at the rates of these rods, 1e3 to 1e4 /s, over the library's, at most. 6061-T6: 388 MPa at
2500 /s and a strain of .05 for 299 (tests by Fish, stored beside those of the rods). 4340: by its own law of
the rate, from .002 to 1e4 /s."""
SLICES = 32  # cells along a rod; half as many tell the error of the mesh
KHARAZ = "kharaz-2001"
Results = Mapping[str, Levels | Failure]


@dataclass(frozen=True, slots=True)
class Rod:
    """A rod shot at an anvil: sizes, m, and speed, m/s; final length and foot over those before, or NaN."""

    series: str
    metal: str
    length: float
    diameter: float
    speed: float
    final: float
    foot: float

    @property
    def drive(self) -> float:
        """Return rho v^2 over the yield stress."""
        metal = material(self.metal)
        return metal.rho * self.speed**2 / (metal.yield_stress or 0.0)

    def flattened(self, slices: int, factor: float = 1.0) -> Array:
        """Return final length and foot over those before, with a flow stress ``factor`` times higher."""
        metal = material(self.metal)
        start, top = metal.yield_stress or 0.0, metal.ultimate_stress or 0.0
        flow = {"yield_stress": factor * start, "hardening": factor * considere_modulus(start, top)}
        sizes = {"length": self.length, "radius": self.diameter / 2, "speed": self.speed}
        p = {**defaults("taylor"), **sizes, **flow, "E": metal.E, "nu": metal.nu, "rho": metal.rho}
        shape, *_ = taylor_bar.strike(p, slices)
        return np.asarray(shape / (self.length, self.diameter / 2))


def considere_modulus(start: float, top: float) -> float:
    """Return the plastic modulus H, Pa, of the linear law through a yield and an ultimate stress.

    By Considere's criterion the load is largest where the true stress is H, at the strain 1 - start/H; there
    the stress over the first section is ``top``.

    Examples
    --------
    >>> H = considere_modulus(276e6, 310e6)
    >>> f"{H / 1e6:.0f} MPa {H * exp(276e6 / H - 1) / 1e6:.0f} MPa"
    '466 MPa 310 MPa'
    """
    from scipy.optimize import brentq

    return float(brentq(lambda H: H * exp(start / H - 1) - top, start, 100 * top))


def rods() -> tuple[Rod, ...]:
    """Return the rods in the order of the file."""
    rows = ([*row.values()] for row in read_table("studies/data/taylor_rods.csv"))
    return tuple(
        Rod(series, metal, *(float(cell or "nan") for cell in cells)) for series, metal, *cells in rows
    )


def spheres() -> dict[str, tuple[str, float, float]]:
    """Return quantity, angle, degrees, and measured value of each point, by the name of its job."""
    names = {"e_t": "e_t", "omega_rad_s": "Omega"}
    rows = read_table("studies/data/kharaz2001.csv")
    points = [(row["quantity"], float(row["impact_angle_deg"]), float(row["value"])) for row in rows]
    return {f"{names[q]} at {at:.1f} deg": (names[q], at, value) for q, at, value in points if q in names}


def sphere_scene(angle: float) -> Scene:
    """Return the sphere of alumina that strikes glass at an angle from the normal, degrees."""
    quoted = {"source": "quoted with the tests in MFiX, test DEM05"}
    alumina = {"name": "alumina-of-kharaz", "E": "380 GPa", "nu": 0.23, "rho": "4000 kg/m3", **quoted}
    glass = {"name": "glass-of-kharaz", "E": "70 GPa", "nu": 0.25, "rho": "2500 kg/m3", **quoted}
    v_n, v_t = -SPEED * cos(radians(angle)), -SPEED * sin(radians(angle))
    tables: dict[str, Any] = {
        "id": f"{KHARAZ}-{angle:.0f}",
        "projectile": {"shape": "ball", "diameter": f"{2 * RADIUS} m", "material": alumina},
        "barrier": {"material": glass},
        "surface": {"state": "custom", "friction": 0.092, **quoted},
        "impact": {"angle": "0 deg", "v_n": f"{v_n!r} m/s", "v_t": f"{v_t!r} m/s"},
        "save": {"frames": 0},
    }
    return read_dict(tables)


def plan(request: Request, results: Results) -> list[LevelsJob]:
    """Return the levels of the spheres; the rods, a few seconds each, are computed at the end."""
    return [LevelsJob(name, sphere_scene(at)) for name, (_, at, _) in _asked(spheres(), request).items()]


def _asked(points: dict[str, Any], request: Request) -> dict[str, Any]:
    return dict([*points.items()][3:4]) if request.quick else points


@dataclass(frozen=True, slots=True)
class OthersSeries:
    """Comparisons of one series (k of them) and the covariance (k, k) of their errors.

    ``scatters`` are of each number what it is of, whose scatter it shares, and the degrees of freedom of
    that, infinite where it is known.
    """

    name: str
    comparisons: tuple[Comparison, ...]
    C: Array
    scatters: tuple[tuple[str, float], ...]

    @property
    def together(self) -> tuple[float, float]:
        """Return distance squared of all errors, and the probability of a larger one without error.

        Lengths have one scatter and feet another, each estimated from few tests: their degrees of freedom are
        added up as by Satterthwaite 1946 (doi:10.2307/3002019), of the parts that they make of C.
        """
        E = np.array([comparison.E for comparison in self.comparisons])
        k, distance = len(E), joint(E, self.C)[0]
        parts = np.diag(np.linalg.inv(self.C)) * [one.u_D**2 for one in self.comparisons]
        sums = {
            of: sum(p for p, one in zip(parts, self.scatters, strict=True) if one == of)
            for of in self.scatters
        }
        size = sum(float(total) ** 2 / dof for (_, dof), total in sums.items())
        return distance, float(f.sf(distance / k, k, k**2 / size) if size else chi2.sf(distance, k))


def compared_rods(tests: Sequence[Rod]) -> OthersSeries:
    """Return lengths and feet of one series beside those computed; one flow stress moves all of them.

    The scatter of single tests is that about their own curve over rho v^2.
    """
    lengths, comparisons, moved, scatters = {}, [], [], []
    for name, column in (("final", 0), ("foot", 1)):
        scatter, dof = _scatter(tests, name)
        for at, rod in enumerate(tests):
            measured = getattr(rod, name)
            if np.isnan(measured):
                continue
            if at not in lengths:
                fine, coarse = rod.flattened(SLICES), rod.flattened(SLICES // 2)
                lengths[at] = fine, coarse, rod.flattened(SLICES // 2, FASTER[rod.metal]) - coarse
            S, coarse, change = (values[column] for values in lengths[at])
            part = ("length", "foot")[column]
            label = f"{part} at {rod.speed:.0f} m/s, L/D {rod.length / rod.diameter:.1f}"
            u_num, moves = abs(S - coarse) / COVERAGE, change / sqrt(3)  # uniform from the nominal value
            one = Comparison(rod.series, label, S, measured, u_num, abs(moves), scatter)
            comparisons.append(replace(one, dof=dof * (one.u_val / scatter) ** 4 if scatter else inf))
            moved.append(moves)
            scatters.append((part, dof if scatter else inf))
    alone = [comparison.u_num**2 + comparison.u_D**2 for comparison in comparisons]
    C = np.outer(moved, moved) + np.diag(alone)
    return OthersSeries(tests[0].series, tuple(comparisons), C, tuple(scatters))


def _scatter(tests: Sequence[Rod], name: str) -> tuple[float, int]:
    """Return the standard deviation of tests about 1 + a x + b x^2 and its degrees of freedom.

    x is rho v^2 over the yield stress.
    """
    x, y = np.array([(rod.drive, getattr(rod, name)) for rod in tests]).T
    x, y = x[~np.isnan(y)], y[~np.isnan(y)]
    powers = np.column_stack([x, x**2][: max(1, min(2, len(x) - 1))])
    left = y - 1 - powers @ np.linalg.lstsq(powers, y - 1)[0]
    dof = max(1, len(x) - powers.shape[1])
    return float(sqrt(left @ left / dof)), dof


def compared_spheres(request: Request, results: Results) -> OthersSeries | None:
    """Return tangential restitution and spin of the spheres beside those computed."""
    comparisons = []
    for name, (quantity, at, measured) in _asked(spheres(), request).items():
        levels = results.get(name)
        if not isinstance(levels, Levels):
            continue
        limits, bands = level_limits(levels.meshes)
        if isinstance(limits, Unknown) or isinstance(bands, Unknown):
            continue
        key, scale = "Omega_rad_per_s", -1.0
        if quantity == "e_t":
            key, scale = "V_t_m_per_s", -1 / (SPEED * sin(radians(at)))
        S, u_num = scale * limits[key], abs(scale) * bands[key] / COVERAGE
        comparisons.append(Comparison(KHARAZ, name, S, measured, u_num, 0.0, READ[quantity]))
    if not comparisons:
        return None
    C = np.diag([comparison.u_val**2 for comparison in comparisons])
    return OthersSeries(KHARAZ, tuple(comparisons), C, (("reading", inf),) * len(comparisons))


def conclude(request: Request, results: Results) -> StudyReport:
    """Return every series beside the solver."""
    every = rods()
    sphere = compared_spheres(request, results)
    compared = [sphere] if sphere else []
    for name in [*dict.fromkeys(rod.series for rod in every)][: 1 if request.quick else None]:
        tests = [rod for rod in every if rod.series == name]
        compared.append(compared_rods(tests[:3] if request.quick else tests))
    numbers = [comparison for series in compared for comparison in series.comparisons]
    table = [
        (
            series.name,
            len(series.comparisons),
            sum(comparison.in_error for comparison in series.comparisons),
            float(np.mean([comparison.E / comparison.D for comparison in series.comparisons])),
            *series.together,
            "rejected" if series.together[1] < LEVEL else "agrees",
        )
        for series in compared
    ]
    head = ("series", "numbers", "in error", "mean E/D", "D2", "p", "jointly")
    sentences = [_sentence(series) for series in compared]
    return StudyReport(
        "others",
        "Tests of other people: rods on anvils, spheres on glass (ASME V&V 20)",
        sentences,
        [_picture(compared)],
        [
            Sheet("series", "Each series", Table.of(head, table)),
            Sheet("others", "Every number: E = S - D", comparison_table(numbers, "series", "number")),
        ],
        rests_on("others", LEVEL=LEVEL, aluminium=FASTER["aluminium-6061-t6"], steel=FASTER["steel-4340"]),
        conclusions=[("others", sentence) for sentence in sentences],
    )


def _sentence(series: OthersSeries) -> str:
    wrong = [comparison for comparison in series.comparisons if comparison.in_error]
    D2, p = series.together
    worst = max(series.comparisons, key=lambda comparison: abs(comparison.E / comparison.u_val))
    return (
        f"{series.name}: {len(wrong)} of {len(series.comparisons)} numbers show an error of the model; "
        f"together they {'do not agree' if p < LEVEL else 'agree'} with the tests (D2 = {D2:.3g}, "
        f"p = {p:.2g}). Farthest: {worst.quantity}, {worst.S:.4g} for {worst.D:.4g} measured, "
        f"u_val {worst.u_val:.2g}."
    )


def _picture(every_series: Sequence[OthersSeries]) -> Picture:
    errors = {
        series.name: [(at, comparison.E / comparison.u_val) for comparison in series.comparisons]
        for at, series in enumerate(every_series)
    }
    caption = "Errors over their uncertainty; beyond about 2, more where tests are few, the model has one."
    return Picture("others", caption, (error_panel("Errors", tuple(errors), errors),), columns=1)
