"""What the solver's meshes cost in accuracy, from the theory of their elements.

Tolerances of the problems are made of these errors at the problem's own parameters. Each is an upper bound in
the runs named with it.
"""

from __future__ import annotations


def contact_error(size: float, half: float) -> float:
    """Return the relative error of a contact's stiffness, cells of edge ``size``, half-axis ``half``, m.

    Pressure that ends within a cell acts at its nodes: a second moment of size^2 / 4 over half^2. Of a steel
    ball on a plane the stiffness (by the contact time, its power -0.4) is 6 % low with 2 cells over the
    radius, 0.9 to 2 % with 3.5, 0.2 to 0.6 % with 6.
    """
    return (size / (2 * half)) ** 2


def lean_error(size: float, half: float) -> float:
    """Return the share of the interface's lean that a mesh misses.

    Normals at the nodes average their quads, and so the lean with the skin's steep return beside the contact,
    one cell at either end of both bodies: 0.55 of it is missed with 2.2 cells over the half-axis, 0.27 with
    4.4.
    """
    return min(1.0, 2 * size / half)


def radiation_error() -> float:
    """Return the relative error of what a block radiates, found 1 to 13 % high: the contact is no point."""
    return 0.15


def wave_error(wave: float, height: float) -> float:
    """Return how slow a wave number, 1/m, is on lumped slices of ``height``, m: (k h)^2 / 24.

    Of a chain of masses, omega = (2 c / h) sin(k h / 2). Longitudinal modes of round bars have 0.77 of it.
    """
    return (wave * height) ** 2 / 24


def section_error(nu: float, across: float, wave: float) -> float:
    """Return the relative error of a bending frequency from the cells of a round section.

    ``across`` is their number over the diameter, ``wave`` the wave number times the section's radius.
    Straight cell edges do not follow the section as it curves (displacements nu (x^2 - y^2) / 2), which costs
    energy as nu^2 / 2 times the square of a cell over the radius: frequencies of bars with 8 cells are 0.06 %
    low for nu = 0, 0.36 % high for nu = 0.49. Shear over the section is lumped as waves are.
    """
    cell = 2 / across
    return cell**2 * (nu**2 / 4 + wave**2 / 24)
