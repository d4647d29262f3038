"""Dropped rods of the studies: rods that differ in size, tip, speed, angle, friction and yielding."""

from dataclasses import dataclass, replace
from math import cos, radians, sin

from fem_impact import Scene, load, replace_all
from fem_impact.evidence.references.free_modes import bending_period
from fem_impact.scene.fields import FlowLaw
from fem_impact.scene.impact import Impact
from fem_impact.scene.library import surfaces
from fem_impact.scene.material import Surface
from fem_impact.scene.types import Save
from rigid.slenderness import EXPONENT

PAPER_RODS = {"0.24 m": 0.24, "0.12 m": 0.12, "0.08 m": 0.08}
"""Lengths, m, of the three rods of 19 mm."""

PAPER = load("t5b")
"""Scene whose steels, barrier and tip all dropped rods have: tip B, the edge of the face, rounded by 3 mm."""

READINGS: dict[FlowLaw, Scene] = {
    "tensile": PAPER,
    "hardness": replace_all(
        PAPER, {"projectile.material.law": "hardness", "barrier.material.law": "hardness"}
    ),
}
"""That scene with the flow curve of both steels from their ultimate stress, and from their hardness."""

STATES = {"frictionless": 0.0} | dict(
    sorted((name, surface.friction) for name, surface in surfaces().items())
)
"""f of no friction and of the shipped surface states, in the order of their names."""

KINDS = {False: "elastic", True: "yielding"}
"""Kind of contact by whether both bodies yield."""

PLAIN = {"yielding": "machined", "elastic": "frictionless"}
"""Surface state, by kind of contact, at which other inputs are changed and the partition is drawn."""

BODY, TIP = 0.019, 0.003  # m: diameter and edge radius of the paper's rods


def length_of(gamma: float, diameter: float = BODY) -> float:
    """Return the length, m, of a rod of slenderness gamma, m^-0.3815 (Eq 29)."""
    return float(gamma * diameter**EXPONENT)


@dataclass(frozen=True, slots=True)
class DroppedRod:
    """A rod that falls on the plate without spin: lengths in m, angle in degrees, speed in m/s.

    With ``yields`` both bodies yield, on the flow curve that ``law`` names (see `Material`); without
    ``vibrates`` the rod is rigid, on the same contact. A ``tip_radius`` of None is in proportion to the
    diameter.
    """

    length: float
    angle: float = 45.0
    friction: float = 0.0
    yields: bool = False
    diameter: float = BODY
    tip_radius: float | None = None
    speed: float = 2.1
    vibrates: bool = True
    law: FlowLaw = "tensile"

    @property
    def gamma(self) -> float:
        """Slenderness, m^-0.3815."""
        return float(self.length / self.diameter**EXPONENT)

    @property
    def name(self) -> str:
        """Identifier of rounded numbers: lengths in um, angle in 0.01 deg, f in 0.001, speed in mm/s."""
        kind = ("y" if self.yields else "e") + ("v" if self.vibrates else "r")
        kind += "" if self.law == "tensile" else self.law[0]
        lengths = (self.length * 1e6, self.diameter * 1e6, self.radius * 1e6)
        numbers = (*lengths, self.angle * 1e2, self.friction * 1e3, self.speed * 1e3)
        return "-".join([kind, *(str(round(n)) for n in numbers)])

    @property
    def inputs(self) -> dict[str, float | str]:
        """Columns of a table: slenderness and inputs, units in their names, angle in degrees."""
        return {
            "gamma": self.gamma,
            "diameter_m": self.diameter,
            "length_m": self.length,
            "speed_m_per_s": self.speed,
            "angle_deg": self.angle,
            "f": self.friction,
            "contact": KINDS[self.yields],
            "law": self.law,
        }

    @property
    def radius(self) -> float:
        """Edge radius of the tip, m."""
        return TIP * self.diameter / BODY if self.tip_radius is None else self.tip_radius

    @property
    def first_period(self) -> float:
        """First bending period of the rod, s."""
        steel = PAPER.projectile.material
        return bending_period(steel.E, steel.nu, steel.rho, self.length, self.diameter / 2)

    def scene(self) -> Scene:
        """Return the scene, on the mesh that it gets by itself.

        It has effects by their numbers but for vibration, yielding and gravity, which the study sets. The
        contact's heat does not act on the motion, so it is not watched.
        """
        vibration = "vibration" if self.vibrates else "-vibration"
        bodies = () if self.yields else ("-rod-plasticity", "barrier-elastic")
        angle, paper, f = radians(self.angle), READINGS[self.law], self.friction
        shipped = (surface for surface in surfaces().values() if surface.friction == f)
        return replace(
            paper,
            id=self.name,
            title=f"gamma {self.gamma:.1f}, {self.angle:g} deg, {self.speed:g} m/s, f {f:g}",
            projectile=replace(
                paper.projectile, length=self.length, diameter=self.diameter, tip_radius=self.radius
            ),
            surface=next(shipped, Surface("custom", f, f, f, "point of a study")),
            impact=Impact(angle, -self.speed * cos(angle), -self.speed * sin(angle)),
            effects=("auto", vibration, *bodies, "-gravity", "-contact-heating"),
            save=Save(frames=0),
            measured=None,
        )
