"""A dropped rod to be assessed: its distance from the measured sets, and as a scene and back."""

import math
from dataclasses import dataclass
from typing import Any, Literal

from fem_impact.errors import SceneError
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import BESIDE, Impact
from fem_impact.scene.library import materials, surface, surfaces
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.types import Scene
from rigid import GRAVITY, SHAPES, Arms, Projectile, drop_velocities
from rigid.experiments import MeasuredSet, measured_sets
from rigid.inputs import Floats

Surface = Literal["machined", "contaminated", "cleaned"]
NEAR = {"length": math.log(2.0), "alpha": math.radians(20.0), "speed": math.log(2.0)}
"""Unit of distance between cases: a factor 2 in length, 20 degrees, a factor 2 in speed."""
FAST, STEEP = math.log(1.5), math.radians(10.0)
"""A set counts for the measured range of angles within FAST (log of speed), of speeds within STEEP (rad)."""

DENSITY = 7850.0
"""Density of the measured steel rods, kg/m3."""

HIGHEST = 1000.0
"""Height of fall, m, above which the resistance of the air would have to count."""

TIP_RADII = {"A": 0.007, "B": 0.003, "plain": 0.0}
"""Radius of each measured tip, m (a plain tip has a sharp edge); other tips have no default."""


@dataclass(frozen=True, slots=True)
class RodDropInput:
    """A rod that falls without spin on an inclined steel plate.

    Attributes
    ----------
    rod : Projectile
        Length, diameter, tip (m) and density (kg/m3).
    height : float
        Drop height, m.
    alpha : float
        Inclination, rad, between 0 and pi/2.
    surface : "machined", "contaminated" or "cleaned"
        State of tip and plate.
    """

    rod: Projectile
    height: float
    alpha: float
    surface: str

    def __post_init__(self) -> None:
        if not 0 < self.height < HIGHEST:
            raise SceneError(
                f"must be above 0 and below {HIGHEST:g} m.", key="height=", value=f"{self.height:.3g} m"
            )
        if not 0 < self.alpha < math.pi / 2:
            flat = "a rod that falls flat on its end has no one contact point."
            problem = f"must lie between 0 and 90 degrees; {flat}"
            raise SceneError(problem, key="angle=", value=f"{math.degrees(self.alpha):.3g} deg")

    @property
    def velocity(self) -> tuple[float, float]:
        """v_n and v_t just before impact (Eq 27-28), m/s."""
        v_n, v_t = drop_velocities(self.height, self.alpha)
        return float(v_n), float(v_t)

    @property
    def speed(self) -> float:
        """Speed of fall, m/s."""
        return math.hypot(*self.velocity)

    @property
    def arms(self) -> Arms:
        """Arms of the lowest point of the tip, m."""
        return self.rod.arms(self.alpha)

    def body(self, d_c: Floats) -> dict[str, Any]:
        """Return arms, m, with another d_c, and k2, m2, by name."""
        return {"d_c": d_c, "d_d": self.arms.d_d, "k2": self.rod.k2}


def sets_of(surface: str) -> tuple[MeasuredSet, ...]:
    """Return the measured sets of one surface state."""
    return tuple(s for s in measured_sets() if s.surface == surface)


def weights_of(case: RodDropInput) -> dict[str, float]:
    """Return inverse-distance weights of the measured sets of this surface (Shepard, distance^-4), sum 1.

    A measured case has weight on its own set alone, a case between two sets on both; sets with less than
    2 % are left out.
    """
    near = {s.id: max(_distance(case, s), 0.02) ** -4 for s in sets_of(case.surface)}
    counted = {name: w for name, w in near.items() if w >= 0.02 * sum(near.values())}
    return {name: w / sum(counted.values()) for name, w in counted.items()}


def _distance(case: RodDropInput, s: MeasuredSet) -> float:
    """Return the distance in length, angle and speed in units of `NEAR`.

    1 more lies between a tip with a flat face, whose edge strikes (B, plain), and a round nose (A).
    """
    faces = (tip.face > 0 for tip in (case.rod.nose, SHAPES[s.tip](s.diameter / 2, s.tip_radius)))
    steps = (
        math.log(case.rod.length / s.length) / NEAR["length"],
        (case.alpha - s.alpha) / NEAR["alpha"],
        math.log(case.speed / s.speed) / NEAR["speed"],
        float(len({*faces}) == 2),
    )
    return math.hypot(*steps)


def unmeasured(case: RodDropInput) -> tuple[str, ...]:
    """Return sentences on few tests on this surface, and on quantities outside the measured range."""
    if case.surface == "machined":
        return outside_of(case)
    sets = sets_of(case.surface)
    speeds = " and ".join(f"{speed:.2f}" for speed in sorted(s.speed for s in sets))
    narrow = (
        f"{case.surface} surfaces were measured with one rod (240 mm), at one angle (45 degrees), at "
        f"{speeds} m/s, in {sum(len(s.motion['v_n']) for s in sets)} tests: anything else is an extrapolation"
    )
    return (narrow, *outside_of(case))


def outside_of(case: RodDropInput) -> tuple[str, ...]:
    """Return a sentence on each quantity of the case outside the range measured on its surface."""
    rod, sets, outside = case.rod, sets_of(case.surface), list[str]()
    lengths = sorted({s.length for s in sets})
    if not any(math.isclose(rod.length, x) for x in lengths):
        known = ", ".join(f"{1e3 * x:g}" for x in lengths)
        measured = f"measured on {case.surface} surfaces were rods of {known} mm"
        outside.append(f"length {1e3 * rod.length:g} mm: {measured}")
    if not math.isclose(rod.diameter, 0.019):
        outside.append(f"diameter {1e3 * rod.diameter:g} mm: only rods of 19 mm were measured")
    if not any(rod.tip == s.tip and math.isclose(rod.tip_radius, s.tip_radius) for s in sets):
        known = " or ".join(sorted({f"{s.tip} with {1e3 * s.tip_radius:g} mm" for s in sets}))
        tip = f"tip {rod.tip} with a radius of {1e3 * rod.tip_radius:g} mm"
        outside.append(f"{tip}: measured on {case.surface} surfaces was tip {known}")
    # angle and speed, each near the other, beside the sets of the nearest measured length
    length = min((s.length for s in sets), key=lambda x: abs(math.log(rod.length / x)))
    same = [s for s in sets if s.length == length]
    as_fast = [s for s in same if abs(math.log(case.speed / s.speed)) <= FAST] or same
    as_steep = [s for s in same if abs(case.alpha - s.alpha) <= STEEP] or same
    angles = sorted(math.degrees(s.alpha) for s in as_fast)
    speeds = sorted(s.speed for s in as_steep)
    its_tests, degrees = f"the {1e3 * length:g} mm rod was measured", math.degrees(case.alpha)
    near = "" if as_fast == same else " at about this speed"
    if not angles[0] - 0.05 <= degrees <= angles[-1] + 0.05:
        span = _span(angles, "degrees", ".0f")
        outside.append(f"angle {degrees:g} degrees: {its_tests} at {span}{near}")
    near = "" if as_steep == same else " at about this angle"
    if not 0.95 * speeds[0] <= case.speed <= 1.05 * speeds[-1]:
        outside.append(f"speed {case.speed:.2f} m/s: {its_tests} at {_span(speeds, 'm/s', '.2f')}{near}")
    return tuple(outside)


def _span(values: list[float], unit: str, form: str) -> str:
    low, high = format(values[0], form), format(values[-1], form)
    return f"{low} {unit} only" if low == high else f"{low} to {high} {unit}"


ROD, PLATE = "rod-steel", "plate-steel"


def scene_of(case: RodDropInput) -> Scene:
    """Return the scene of a dropped rod of the measured steels."""
    steels, rod = materials(), case.rod
    v_n, v_t = case.velocity
    return Scene(
        id="dropped-rod",
        title=f"a steel rod dropped {case.height:g} m on a {case.surface} plate",
        projectile=ProjectileSpec(rod.length, rod.diameter, rod.tip, rod.tip_radius, steels[ROD]),
        barrier=Barrier(steels[PLATE]),
        surface=surface(case.surface),
        impact=Impact(case.alpha, v_n, v_t),
    )


def dropped(scene: Scene) -> RodDropInput:
    """Return the dropped rod that a scene states.

    Raises
    ------
    SceneError
        The measured tests do not apply: another shape, barrier, material or surface than theirs, spin, or a
        velocity that no fall along the axis has.
    """
    if reason := _not_measured(scene):
        remedy = "Give a scene that is, such as t5b with another length, height or angle."
        raise SceneError(f"is not what the measured tests are about: {reason}.", key=scene.id, remedy=remedy)
    rod, impact = scene.projectile, scene.impact
    body = Projectile(rod.length, rod.diameter, rod.tip, rod.tip_radius, DENSITY)
    height = math.hypot(impact.v_n, impact.v_t) ** 2 / (2 * GRAVITY)
    return RodDropInput(body, height, abs(impact.angle), scene.surface.state)


def _not_measured(scene: Scene) -> str:
    steels, impact, known = materials(), scene.impact, surfaces().values()
    pairs: tuple[tuple[str, Any, Any], ...] = (
        ("rod", scene.projectile.material, steels[ROD]),
        ("barrier", scene.barrier.material, steels[PLATE]),
    )
    if not scene.projectile.is_rod:
        return "they are about solid rods with a tip"
    plate = scene.barrier
    if plate.layers or plate.thickness is not None or plate.mass is not None or plate.v_n or plate.v_t:
        return "they are about a massive plate of one metal at rest"
    if scene.restitution is not None or scene.effects != ("auto",):
        return "they are about bodies of which the program chooses restitution and effects"
    for body, mine, measured in pairs:
        if mine != measured:
            return f"they are about a {body} of {measured.name}, not of {mine.name}"
    if scene.surface not in known:
        return f"they are about {', '.join(s.state for s in known)} surfaces, not {scene.surface.state} ones"
    if impact.omega or abs(impact.beside) > BESIDE:
        return "their rods fell along their axis without spin"
    return ""
