"""The reference of ``oblique-rod`` at a problem's parameters, and what the errors of a mesh make of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf, pi, sin

from fem_impact.evidence.problems.discretisation import BarMesh, contact_error, lean_error, radiation_error
from fem_impact.evidence.problems.problem import Values
from fem_impact.evidence.references.free_modes import free_bar_flexibility
from fem_impact.evidence.references.hertz import (
    SPAN,
    Ellipse,
    SpringRow,
    contact_ellipse,
    contact_modulus,
    equivalent_radius,
    hertz,
    row_lean,
    tangential_ratio,
)
from fem_impact.evidence.references.oblique import ObliqueRebound, ObliqueRod, oblique_drop, oblique_rod
from fem_impact.evidence.references.rod_edge import edge_excess
from fem_impact.evidence.references.waves import radiation_resistance, shear_resistance
from rigid import Projectile

PATCHES = 0.6, 0.8, 1.0  # contact radii over the largest whose static excess is taken
USUAL = 1  # of them; the excess along t falls with the logarithm of the radius
REACH = 1.2  # contact radii of the whole mass that the springs reach
SECOND = 7.853  # wave number of the second bending mode times the length


@dataclass(frozen=True, slots=True)
class Change:
    """A change of the reference.

    Attributes
    ----------
    stiffness, frequency, waves : of the contact, the modes and the barrier's radiation, relative
    friction : of Coulomb's coefficient; patch : index into `PATCHES`
    """

    stiffness: float = 0.0
    frequency: float = 0.0
    waves: float = 0.0
    friction: float = 0.0
    patch: int = USUAL


@dataclass(frozen=True, slots=True)
class RodDrop:
    """An oblique drop of a rod that touches with its rounded edge."""

    p: Values
    rod: Projectile

    @property
    def E_star(self) -> float:
        """Return E* of rod and barrier, Pa."""
        p = self.p
        return contact_modulus(p["E"], p["nu"], p["barrier_E"] if p["elastic_barrier"] else inf, p["nu"])

    @property
    def ellipse(self) -> Ellipse:
        """Return the contact of the edge's radius and the one around the rod."""
        return contact_ellipse(self.p["tip_radius"], self._around())

    @property
    def radius(self) -> float:
        """Return the radius, m, of the sphere as stiff as the tip."""
        return equivalent_radius(self.p["tip_radius"], self._around())

    def _around(self) -> float:
        return float(self.rod.contact_point(self.p["angle"])[0]) / sin(self.p["angle"])

    def touch(self) -> float:
        """Return the largest contact radius, m, of the equivalent sphere without friction and vibration."""
        d_c = float(self.rod.arms(self.p["angle"])[0])
        mass = self.rod.mass / (1 + d_c**2 / self.rod.k2)
        return hertz(self.E_star, self.radius, mass, self.p["v_n"]).radius

    def modal(self, patch: int) -> ObliqueRod:
        """Return rigid motion, the modes of a flat rod of the mass, and what the edge adds to them."""
        p, rod, R = self.p, self.rod, self.p["diameter"] / 2
        rho, z = map(float, rod.contact_point(p["angle"]))
        d_c, d_d = map(float, rod.arms(p["angle"]))
        length = rod.mass / (p["rho"] * pi * R**2)
        touch = rho, z - (p["length"] - length)
        size = (p["E"], p["nu"], p["rho"], length, R, p["angle"])
        modal = oblique_rod(*size, (rod.mass, rod.k2), (d_c, d_d), touch)
        halves = (self.ellipse.half_axes(share * self.touch() / R) for share in PATCHES)
        excess = edge_excess(p["nu"], rod.tip_radius / R, p["angle"], tuple(halves))[patch]
        static = free_bar_flexibility(p["nu"], length / R, p["angle"], (touch[0] / R, touch[1] / R))
        return replace(modal, edge=rod.tip_radius, give=(static + excess) / (p["E"] * R) - modal.static())

    def row(self, change: Change) -> SpringRow:
        """Return the springs of the contact."""
        p, stiffer = self.p, (1 + change.stiffness) * self.E_star
        reach = REACH * hertz(stiffer, self.radius, self.rod.mass, p["v_n"]).radius
        ratio, f = tangential_ratio(p["nu"], self.ellipse.axes), p["f"] + change.friction
        return SpringRow(stiffer, ratio * stiffer, self.radius, f, reach, self.lean())

    def lean(self) -> float:
        """Return the slope of the interface over friction and contact radius, 1/m; none on a rigid plane."""
        p = self.p
        G = p["barrier_E"] / (2 + 2 * p["nu"])
        return row_lean(self.E_star, p["nu"], G, self.radius, self.ellipse) if p["elastic_barrier"] else 0.0

    def rebound(self, change: Change) -> ObliqueRebound:
        """Return the motion after the last contact."""
        p, modal = self.p, self.modal(change.patch)
        modal = replace(modal, omega=(1 + change.frequency) * modal.omega)
        block = p["barrier_E"], p["nu"], p["rho"]
        heard = (1 + change.waves) * p["elastic_barrier"]
        waves = heard * radiation_resistance(*block), heard * shear_resistance(*block)
        return oblique_drop(modal, self.row(change), -p["v_n"], -p["v_t"], p["max_time"], waves)

    def sideways(self) -> float:
        """Return the share of friction that acts across t on a rigid plane, where it slides throughout.

        Pressing draws in the rod's skin by (1 - 2 nu)(1 + nu) p b / (2 E) at the end of the half-axis b
        (Johnson, Contact Mechanics, 1985, Eq 3.41b), in half the contact time; over the sliding speed that is
        the slope of friction to t, whose half square has a mean of a fifth under the pressure.
        """
        p, touch = self.p, self.touch()
        F = 4 * self.E_star * touch**3 / (3 * self.radius)
        a, b = self.ellipse.half_axes(touch)
        drawn = (1 - 2 * p["nu"]) * (1 + p["nu"]) * 1.5 * F / (pi * a * b) * b / (2 * p["E"])
        speed = 2 * drawn / (SPAN * touch**2 / self.radius / p["v_n"])
        return min(1.0, 0.1 * (speed / max(p["v_t"], speed)) ** 2)

    def errors(self, size: float) -> Iterator[Change]:
        """Yield what cells of edge ``size``, m, at the contact get wrong, and the reference's own choice."""
        p, half = self.p, self.ellipse.half_axes(self.touch())[0]
        yield Change(stiffness=-contact_error(size, half))
        if p["elastic_barrier"]:
            yield Change(friction=self.lean() * p["f"] * self.touch() * lean_error(size, half))
            yield Change(waves=radiation_error())
        else:
            yield Change(friction=-p["f"] * self.sideways())
        mesh = BarMesh(p["nu"], p["across"], p["diameter"] / 2, p["diameter"] / p["across"])
        yield Change(frequency=mesh.bending_error(SECOND / p["length"]))
        yield from (Change(patch=i) for i in range(len(PATCHES)) if i != USUAL)
