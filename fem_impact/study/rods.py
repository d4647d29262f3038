"""Scenes of the studies over slenderness: drops over diameter, tip, speed, angle, friction, yielding."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin

from fem_impact.scene.library import materials
from fem_impact.scene.types import Accuracy, Barrier, Impact, ProjectileSpec, Save, Scene, Surface
from rigid.slenderness import EXPONENT

PAPER_RODS = {"0.24 m": 0.24, "0.12 m": 0.12, "0.08 m": 0.08}
"""Lengths, m, of the three rods of 19 mm."""

STATES = {"frictionless": 0.0, "contaminated": 0.16, "cleaned": 0.42, "machined": 0.57}
"""f of the surface states at which maps are drawn; all but 0 are those of `fem_impact.scene.surfaces`."""

BODY, TIP = 0.019, 0.003  # m: diameter and edge radius of the paper's rods
LATEST = 8e-3  # s, end of a run: a slender rod's second contact comes some bending periods after the first
MAP_NOTES = (
    "Dropped without spin: v_n = -v cos(alpha), v_t = -v sin(alpha); no gravity during the impact.",
    "Edge radius 3 mm on 19 mm and in proportion to other diameters; steels of the paper.",
    "Modal: a round contact of the same sqrt(R1 R2), no ploughing, no shear flow under a sticking tip.",
)


def length_of(gamma: float, diameter: float = BODY) -> float:
    """Return the length, m, of a rod of slenderness gamma, m^-0.3815 (Eq 29)."""
    return float(gamma * diameter**EXPONENT)


@dataclass(frozen=True, slots=True)
class Drop:
    """A rod that falls on the plate without spin: lengths in m, angle in degrees, speed in m/s.

    With ``yields`` both bodies yield; without ``vibrates`` the rod is rigid, on the same contact. A
    ``tip_radius`` of None is in proportion to the diameter.
    """

    length: float
    angle: float = 45.0
    friction: float = 0.0
    yields: bool = False
    diameter: float = BODY
    tip_radius: float | None = None
    speed: float = 2.1
    vibrates: bool = True

    @property
    def gamma(self) -> float:
        """Slenderness, m^-0.3815."""
        return float(self.length / self.diameter**EXPONENT)

    @property
    def name(self) -> str:
        """Identifier of rounded numbers: lengths in um, angle in 0.01 deg, f in 0.001, speed in mm/s."""
        kind = ("y" if self.yields else "e") + ("v" if self.vibrates else "r")
        lengths = (self.length * 1e6, self.diameter * 1e6, self.radius * 1e6)
        numbers = (*lengths, self.angle * 1e2, self.friction * 1e3, self.speed * 1e3)
        return "-".join([kind, *(str(round(n)) for n in numbers)])

    @property
    def radius(self) -> float:
        """Edge radius of the tip, m."""
        return TIP * self.diameter / BODY if self.tip_radius is None else self.tip_radius

    def scene(self, tip_size: float | None = None) -> Scene:
        """Return the scene; ``tip_size``, m, is for the solid fidelity."""
        steels, angle, f = materials(), radians(self.angle), self.friction
        names = (
            *(("vibration",) if self.vibrates else ()),
            *(("friction",) if f else ()),
            *(("rod-plasticity", "barrier-elastoplastic") if self.yields else ("barrier-elastic",)),
            "large-rotation",
        )
        accuracy = Accuracy(max_time=LATEST)
        return Scene(
            id=self.name,
            title=f"gamma {self.gamma:.1f}, {self.angle:g} deg, {self.speed:g} m/s, f {f:g}",
            projectile=ProjectileSpec(self.length, self.diameter, "B", self.radius, steels["rod-steel"]),
            barrier=Barrier(steels["plate-steel"]),
            surface=Surface("custom", f, f, f, "point of a map"),
            impact=Impact(angle, -self.speed * cos(angle), -self.speed * sin(angle)),
            effects=names,
            accuracy=replace(accuracy, tip_size=tip_size) if tip_size else accuracy,
            save=Save(frames=0),
        )
