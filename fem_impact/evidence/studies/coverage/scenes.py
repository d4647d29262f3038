"""Scenes drawn at random over all that the program is meant for, by a seed: the same ones everywhere.

Each family of projectiles has as many scenes as every other. Within a family the numbers lie evenly over
their ranges (a Halton sequence), and kinds of barrier and metals take turns. Beside them stand the twelve
bodies, each at five angles, and for every two scenes of a family one of its shapes that hardly yields.
"""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import cos, log, pi, radians, sin
from pathlib import Path

import numpy as np
import tomli_w
from scipy.stats import qmc

from fem_impact import load
from fem_impact.evidence.studies.coverage import bodies, families
from fem_impact.scene.library import materials
from fem_impact.scene.types import MEASURED_SETS, Scene, to_toml

SEED = 20261126
"""Of the scenes by which the reduced model tells its error."""
OWN = "twelve bodies"
"""Name of the family of `TWELVE`."""
GENTLE = "hardly yielding"
"""Name of the family of scenes that stay elastic or just yield: brittle bodies at any speed, slow metals."""
TESTED = "measured sets"
"""Name of the family of the thirteen measured sets."""
RANGES: Mapping[str, tuple[float, float]] = {
    "diameter": (5e-3, 40e-3),  # m, even in its logarithm
    "speed": (0.1, 20.0),  # m/s, even in its logarithm
    "slenderness": (0.0, 1.0),  # share of the family's own range
    "first": (0.0, 1.0),  # shares of the ranges of what else the shape needs
    "second": (0.0, 1.0),
    "angle": (-90.0, 90.0),  # deg
    "fall": (-60.0, 60.0),  # deg, from the barrier's normal to the velocity, above 0 down the slope
    "spin": (-1.0, 1.0),  # over the spin with which the ends move at half the normal velocity; see SPINNING
    "friction": (-0.1, 1.0),  # below 0: none
    "barrier": (0.0, 1.0),  # share of the range of what its kind needs
}
EVEN_LOGARITHM = ("diameter", "speed")
SPINNING = 0.5  # half of the scenes: those with a number ``spin`` beyond this, of either sign
STEELS = ("rod-steel", "steel-4340", "stainless-304", "c45", "100cr6")
LIGHT = ("aluminium-6061-t6", "aluminium-7075-t6", "titanium-6al-4v", "magnesium-az31b", "aluminium-2024-t3")
SOFT = ("plate-steel", "copper", "aluminium-1350-h14", "s235", "magnesium-az31b")
HARD = ("100cr6", "42crmo4", "alumina", "tungsten-heavy-alloy", "titanium-6al-4v")
BRITTLE = ("alumina", "soda-lime-glass", "silicon-nitride")
SLOWER = 20.0  # times, metals that hardly yield: 5 mm/s to 1 m/s; slower is no impact under gravity
KINDS = ("massive", "plate", "free", "layers")
"""Kinds of barrier: a half-space, a plate that bends, a body free to move, a layer on another metal."""
BENCH: Mapping[str, tuple[float, float]] = {**RANGES, "speed": (0.5, 5.0)}
"""Ranges of the twelve bodies, which strike massive barriers; m/s."""


@dataclass(frozen=True, slots=True)
class DrawnScene:
    """A scene of the study.

    Attributes
    ----------
    name : unique, and the scene's id
    family : of its projectile
    tables : of the scene as in its file; a mesh file is named there and made by `scene`
    body, sizes : of that mesh, see `fem_impact.evidence.studies.coverage.bodies`; empty where there is none
    """

    name: str
    family: str
    tables: families.Tables
    body: str
    sizes: Mapping[str, float]

    @property
    def group(self) -> str:
        """Its kind of barrier."""
        barrier = self.tables["barrier"]
        names = {"layers": "layers", "mass": "free", "support": "plate"}
        return next((kind for key, kind in names.items() if key in barrier), KINDS[0])

    def scene(self, folder: Path) -> Scene:
        """Write scene and mesh into a folder, and return the scene as read from there.

        Raises
        ------
        SceneError
            The program refuses what is stated.
        """
        if self.body:
            bodies.write(self.body, self.sizes, folder / self.tables["projectile"]["mesh"])
        path = folder / f"{self.name}.toml"
        path.write_text(tomli_w.dumps(self.tables), encoding="utf-8")
        return load(path)


def drawn(count: int, angles: int, seed: int = SEED) -> list[DrawnScene]:
    """Return so many scenes of each family, half as many of its shapes that hardly yield, and others.

    The others are the twelve bodies at so many of their angles and, if any, by the own seed the measured
    sets. More of them hold the fewer, so that stored runs are kept.
    """
    random = [one for family in families.FAMILIES for one in _of_family(family, count, seed)]
    tests = _of_tests() if angles and seed == SEED else ()
    return [*random, *_gentle(count // 2, seed), *_of_twelve(angles, seed), *tests]


def _of_family(family: str, count: int, drawn_by: int) -> Iterator[DrawnScene]:
    """Yield the scenes of a family."""
    seed = drawn_by, [*families.FAMILIES].index(family)
    rows, turns = _rows(RANGES, count, seed), _metals(count, seed)
    kinds = _turns(KINDS, count, np.random.default_rng([*seed, 1]))
    for at, (values, kind, (rod, metal)) in enumerate(zip(rows, kinds, turns, strict=True)):
        projectile = families.FAMILIES[family](values)
        barrier = _barrier(kind, metal, projectile, rod, values["barrier"])
        name = f"{family.replace(', ', '-').replace(' ', '-')}-{at}"
        yield _stated(name, family, projectile, rod, barrier, values)


def _gentle(rounds: int, drawn_by: int) -> Iterator[DrawnScene]:
    """Yield rounds of the turned families that hardly yield: in turns brittle bodies and slow metals."""
    turned = [family for family in families.FAMILIES if family != "own mesh"]
    seed, count = (drawn_by, len(families.FAMILIES) + 1), rounds * len(turned)
    metals = _metals(count, seed)
    rods, barriers = (_turns(BRITTLE, count, np.random.default_rng([*seed, at])) for at in (4, 5))
    kinds = _turns(
        KINDS[:3], count, np.random.default_rng([*seed, 1])
    )  # none of layers: so stored scenes stay
    for at, (values, kind) in enumerate(zip(_rows(RANGES, count, seed), kinds, strict=True)):
        slow, projectile = at % 2 == 1, families.FAMILIES[turned[at % len(turned)]](values)
        rod, struck = metals[at] if slow else (rods[at], barriers[at])
        barrier = _barrier(kind, struck, projectile, rod, values["barrier"])
        speed = values["speed"] / (SLOWER if slow else 1.0)
        yield _stated(f"gentle-{at}", GENTLE, projectile, rod, barrier, {**values, "speed": speed})


def _of_twelve(angles: int, drawn_by: int) -> Iterator[DrawnScene]:
    """Yield the twelve bodies at their first angle, all of them at their second, and so on."""
    seed, count = (drawn_by, len(families.FAMILIES)), angles * len(families.TWELVE)
    numbers = zip(_rows(BENCH, count, seed), _metals(count, seed), strict=True)
    for at in range(angles):
        for body, (projectile, every) in families.TWELVE.items():
            values, (rod, metal) = next(numbers)
            name = f"{body} at {every[at]:g} deg".replace(" -", " minus ").replace(" ", "-")
            yield _stated(name, OWN, projectile, rod, {"material": metal}, {**values, "angle": every[at]})


def _of_tests() -> Iterator[DrawnScene]:
    """Yield the measured sets."""
    for name in MEASURED_SETS:
        tables = tomllib.loads(to_toml(load(name)))
        yield DrawnScene(name, TESTED, {**tables, "save": {"frames": 0}}, "", {})


def _rows(
    ranges: Mapping[str, tuple[float, float]], count: int, seed: Sequence[int]
) -> list[families.Values]:
    """Return so many rows of numbers, each column evenly over its range."""
    if not count:
        return []
    ends = [[log(end) for end in r] if name in EVEN_LOGARITHM else r for name, r in ranges.items()]
    points = qmc.Halton(len(ranges), rng=np.random.default_rng(seed)).random(count)
    rows = qmc.scale(points, *np.transpose(ends))
    even = np.array([name in EVEN_LOGARITHM for name in ranges])
    rows[:, even] = np.exp(rows[:, even])
    return [dict(zip(ranges, map(float, row), strict=True)) for row in rows]


def _metals(count: int, seed: Sequence[int]) -> list[tuple[str, str]]:
    """Return materials of projectile and barrier."""
    rods, struck = np.random.default_rng([*seed, 2]), np.random.default_rng([*seed, 3])
    return [*zip(_turns((*STEELS, *LIGHT), count, rods), _turns((*SOFT, *HARD), count, struck), strict=True)]


def _turns(names: Sequence[str], count: int, rng: np.random.Generator) -> list[str]:
    """Return so many names: rounds of all of them, each round in another order."""
    rounds = -(-count // len(names))
    return [names[at] for _ in range(rounds) for at in rng.permutation(len(names))][:count]


def _barrier(
    kind: str, metal: str, projectile: families.DrawnProjectile, rod: str, share: float
) -> families.Tables:
    """Return the table of a barrier whose size follows that of the projectile."""
    table: families.Tables = {"material": metal}
    if kind == "plate":
        thickness = families.between(share, 0.3, 1.2) * projectile.diameter
        return table | {"thickness": families.metres(thickness), "support": "infinite"}
    if kind == "free":
        cylinder = pi / 4 * projectile.diameter**2 * projectile.length
        mass = materials()[rod].rho * cylinder * projectile.filled
        return table | {"mass": f"{mass * 30.0**share:.4g} kg"}
    if kind == "layers":
        base = SOFT[0] if metal != SOFT[0] else LIGHT[0]
        layer = {
            "thickness": families.metres(families.between(share, 0.1, 0.6) * projectile.diameter),
            "material": metal,
        }
        return {"material": base, "layers": [layer]}
    return table


def _stated(
    name: str,
    family: str,
    projectile: families.DrawnProjectile,
    rod: str,
    barrier: families.Tables,
    values: families.Values,
) -> DrawnScene:
    """Return a scene with the material, barrier, motion and friction that were drawn."""
    shape = projectile.tables or {"mesh": f"{name}.vtu", "mesh_unit": "m", "mesh_symmetry": "half"}
    if projectile.body and projectile.length < projectile.diameter:
        shape = shape | {"mesh_tip": "-z"}
    f = round(max(0.0, values["friction"]), 3)
    fall, speed = radians(values["fall"]), values["speed"]
    v_n, spin = -speed * cos(fall), values["spin"]
    omega = spin * abs(v_n) / max(projectile.length, projectile.diameter) if abs(spin) > SPINNING else 0.0
    tables: families.Tables = {
        "id": name,
        "projectile": {**shape, "material": rod},
        "barrier": barrier,
        "surface": {"state": "custom", "friction": f, "source": "drawn at random"},
        "impact": {
            "angle": f"{values['angle']:.4g} deg",
            "v_n": f"{v_n:.4g} m/s",
            "v_t": f"{-speed * sin(fall):.4g} m/s",
            "omega": f"{omega:.4g} rad/s",
        },
        "save": {"frames": 0},
    }
    return DrawnScene(name, family, tables, projectile.body, projectile.sizes)
