"""What the solver's meshes cost in accuracy, from the theory of their elements.

Tolerances of the problems are made of these errors at the problem's own parameters. Each is an upper bound in
the runs named with it.
"""

from dataclasses import dataclass
from math import pi

RADIATION_ERROR = 0.15
"""Relative error of what a block radiates, found 1 to 13 % high: the contact is no point."""


def contact_error(size: float, half: float) -> float:
    """Return the relative error of a contact's stiffness, cells of edge ``size``, half-axis ``half``, m.

    Pressure that ends within a cell acts at its nodes: a second moment of size^2 / 4 over half^2. Of a steel
    ball on a plane the stiffness (by the contact time, its power -0.4) is 6 % low with 2 cells over the
    radius, 0.9 to 2 % with 3.5, 0.2 to 0.6 % with 6.
    """
    return (size / (2 * half)) ** 2


def grid_force_error(size: float, half: float) -> float:
    """Return the relative error of the largest force and the time where nodes stand on a square grid.

    One stands at the middle, the others join ring by ring, so that the slope of the force rises in steps. On
    a half-space, with each node in the middle of a square of even pressure, the largest force is off by at
    most 0.1 (size / half)^2 with 1.1 to 6.5 cells over the half-axis, the time by less.
    """
    return 0.1 * (size / half) ** 2


def graded_error(reach: float) -> float:
    """Return the relative error of a contact's stiffness where fine cells end at ``reach`` contact radii.

    A point force has 4 / (3 pi reach) of Hertz' approach beyond. Two rows of cells on each level outside the
    zone make edges of a quarter of the distance r. The strain falls as r^-2: even strains miss (2 h / r)^2 /
    12 of the energy, those of incompatible modes, linear along one edge, half of that. With a zone of twice
    the reach a slow ball was 0.35 % less stiff, beside 0.34 % by this.
    """
    return 4 / (3 * pi * reach) * (2 / 4) ** 2 / 24


def grid_radiation_error(size: float, half: float) -> float:
    """Return the relative error of what such a contact radiates, the mean square of its force's rate.

    It feels the steps of the slope: off by at most 0.65 (size / half)^3 on the same half-space, with 1.8 to
    6.5 cells.
    """
    return 0.65 * (size / half) ** 3


def lean_error(size: float, half: float) -> float:
    """Return the share of the interface's lean that a mesh misses.

    Normals at the nodes average their quads, and so the lean with the skin's steep return beside the contact,
    one cell at either end of both bodies: 0.55 of it is missed with 2.2 cells over the half-axis, 0.27 with
    4.4.
    """
    return min(1.0, 2 * size / half)


def end_error(half: float, reach: float) -> float:
    """Return the relative error of a contact's stiffness on a block that ends at ``reach``, m.

    A point force F moves one of two like bodies by F (1 - nu^2) / (pi E r) at a distance r: 2 / (3 pi)
    half / r of Hertz' approach, 3 F / (4 E* half). The springs at the faces stand for that; this bound takes
    none of it as right.
    """
    return 2 / (3 * pi) * half / reach


def boundary_error(reach: float, wave: float) -> float:
    """Return the relative error of what a block's boundary at ``reach``, m, radiates.

    Its springs and dashpots are those of a slow force: the error goes as (k r)^2, with the wave number k of
    shear waves that run ``wave``, m, while the contact lasts, half a period. Balls at 0.1 to 8 m/s radiate
    1.2 to 2 times that too much.
    """
    return 2 * (pi * reach / wave) ** 2


def wave_error(wave: float, height: float) -> float:
    """Return how slow a wave number, 1/m, is on lumped slices of ``height``, m: (k h)^2 / 24.

    Of a chain of masses, omega = (2 c / h) sin(k h / 2). Longitudinal modes of round bars have 0.77 of it.
    """
    return (wave * height) ** 2 / 24


@dataclass(frozen=True, slots=True)
class BarMesh:
    """A round bar of slices: Poisson's ratio, cells over the diameter, radius, m, height of a slice, m."""

    nu: float
    across: float
    radius: float
    height: float

    def _cell(self, wave: float) -> float:
        """Return the square of a cell times the wave number, both by the radius."""
        return (2 / self.across * wave * self.radius) ** 2

    def bending_error(self, wave: float) -> float:
        """Return that of a bending frequency of a wave number, 1/m.

        Slices; shear lumped over the section; its polygon's moment; straight edges that do not follow the
        section as it curves across the bending; cells that are not square and stiffen where volume is kept.
        Of bars with 8 cells, those of 0.5 m are 0.01 to 0.02 % high for nu = 0 and 0.29, those of 120 mm
        0.06 % low, but 0.36 % high for nu = 0.49.
        """
        locking = 1.4e-3 * 2 * self.nu / (1 - 2 * self.nu)
        section = (2 / self.across) ** 2 * (self.nu**2 / 32 + locking + 2e-3)
        return wave_error(wave, self.height) + self._cell(wave) / 12 + section

    def stretching_error(self, wave: float) -> float:
        """Return that of a longitudinal frequency: slices, and lateral inertia lumped over the section."""
        return wave_error(wave, self.height) + self.nu**2 * self._cell(wave) / 24

    def twisting_error(self, length: float) -> float:
        """Return that of the first torsional frequency: slices, and the section at its ends.

        Of the second part, with R / L, bars of 47.5 to 240 mm with 8 and 12 cells have 0.45 to 0.9.
        """
        ends = 0.1 * (2 / self.across) ** 2 * self.radius / length
        return wave_error(pi / length, self.height) + ends
