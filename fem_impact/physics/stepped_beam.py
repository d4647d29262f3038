"""Bending and stretching of a body of any profile: linear elements of Timoshenko's beam and of a bar.

Shear is integrated at the middle of each element, so that slender bodies do not lock; `ELEMENTS` of them give
the first frequencies of uniform beams within 2e-4.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.scene.material import Material
from fem_impact.scene.projectile import ProjectileSpec
from rigid import Faceted

ELEMENTS = 120
MODES = 20  # largest number of bending and of stretching modes


class Sections(NamedTuple):
    """Elements of a beam: their ends (n + 1,), m, and what each has over its length, SI, (n,) each.

    ``EI``, ``EA`` and ``GA`` (with the shear coefficient) are stiffnesses, ``m`` and ``j`` mass and rotatory
    inertia of a metre.
    """

    z: Array
    EI: Array
    EA: Array
    GA: Array
    m: Array
    j: Array


class BeamModes(NamedTuple):
    """Elastic free-free modes at the ends of the elements; their squares times mass add up to 1.

    ``bent`` and ``stretched`` (k,) are circular frequencies, rad/s; ``w``, ``angle`` (k, n + 1) the
    deflection, kg^-1/2, and the turn of the sections, kg^-1/2/m; ``u`` (k, n + 1) the displacement along the
    axis.
    """

    z: Array
    bent: Array
    w: Array
    angle: Array
    stretched: Array
    u: Array


def shear_coefficient(nu: Array, hollow: Array) -> Array:
    """Return Cowper's coefficient of round sections, ``hollow`` the inner over the outer radius.

    G. R. Cowper, J. Appl. Mech. 33 (1966) 335, doi:10.1115/1.3625046.
    """
    both = (1 + hollow**2) ** 2
    return np.asarray(6 * (1 + nu) * both / ((7 + 6 * nu) * both + (20 + 12 * nu) * hollow**2))


def elastic_constants(metals: Sequence[Material], of: Ints) -> tuple[Array, Array, Array]:
    """Return E, Pa, nu and rho, kg/m3, of places, each ``of`` one of the metals."""
    E, nu, rho = np.array([(metal.E, metal.nu, metal.rho) for metal in metals]).T
    return E[of], nu[of], rho[of]


def sections(rod: ProjectileSpec) -> Sections:
    """Return the elements of a projectile, ends of segments and bore among their ends."""
    body, ends, bore = rod.body(), [part.to for part in rod.segments[:-1]], [z for z, _ in rod.bore]
    z = np.unique(np.concatenate([np.linspace(0.0, rod.length, ELEMENTS + 1), ends, bore]).round(12))
    if isinstance(body, Faceted):
        return _faceted(body, z, rod.materials, rod.cell_materials())
    x, weight = np.polynomial.legendre.leggauss(3)
    place = 0.5 * (z[1:] + z[:-1])[:, None] + 0.5 * np.diff(z)[:, None] * x
    outer, inner = body.radius(place), body.inner_radius(place)
    E, nu, rho = elastic_constants(rod.materials, np.searchsorted(ends, place))
    area, second = np.pi * (outer**2 - inner**2), np.pi / 4 * (outer**4 - inner**4)
    shear = shear_coefficient(nu, np.divide(inner, outer, out=np.zeros_like(outer), where=outer > 0))
    means = [E * second, E * area, shear * E / (2 * (1 + nu)) * area, rho * area, rho * second]
    return Sections(z, *(mean @ weight / 2 for mean in means))


def _faceted(body: Faceted, z: Array, steels: list[Material], of: Ints) -> Sections:
    """Return the elements of a body of any section, with the shear coefficient of a round one, hollow or not.

    ``of`` (m,) says of which of ``steels`` each of its parts is; those side by side bend about the axis of
    their stiffness.
    """
    E, nu, rho = elastic_constants(steels, of)
    (mass, turning), (EA, EI) = body.sections(z).T, body.sections(z, E / rho).T
    outer, inner = body.wall(0.5 * (z[1:] + z[:-1]))
    hollow = np.divide(inner, outer, out=np.zeros_like(outer), where=outer > 0)
    shear = shear_coefficient(body.sections(z, 1 + nu)[:, 0] / mass - 1, hollow)
    return Sections(z, EI, EA, shear * body.sections(z, E / rho / (2 * (1 + nu)))[:, 0], mass, turning)


@lru_cache(maxsize=32)
def beam_modes(rod: ProjectileSpec) -> BeamModes:
    """Return the free-free modes of a turned projectile."""
    s = sections(rod)
    stretched, u = _elastic(*_stretching(s), rigid=1)
    bent, both = _elastic(*_bending(s), rigid=2)
    return BeamModes(s.z, bent, both[:, ::2], both[:, 1::2], stretched, u)


def _elastic(stiffness: Array, mass: Array, rigid: int) -> tuple[Array, Array]:
    """Return circular frequencies (k,) and shapes (k, n) of the lowest modes above the rigid ones."""
    from scipy.linalg import eigh

    squares, shapes = eigh(stiffness, mass, subset_by_index=[rigid, rigid + MODES - 1])
    return np.sqrt(squares), np.asarray(shapes.T)


def _assembled(parts: Array, size: int, step: int) -> Array:
    """Return the sum (size, size) of element matrices (n, k, k), each ``step`` unknowns behind the last."""
    whole, k = np.zeros((size, size)), parts.shape[1]
    for number, part in enumerate(parts):
        whole[step * number : step * number + k, step * number : step * number + k] += part
    return whole


def _linear_mass(line: Array, h: Array) -> Array:
    """Return the consistent masses (n, 2, 2) of linear elements with ``line`` a metre."""
    return np.asarray((line * h / 6)[:, None, None] * np.array([[2.0, 1.0], [1.0, 2.0]]))


def _stretching(s: Sections) -> tuple[Array, Array]:
    h, n = np.diff(s.z), len(s.z)
    spring = (s.EA / h)[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return _assembled(spring, n, 1), _assembled(_linear_mass(s.m, h), n, 1)


def _bending(s: Sections) -> tuple[Array, Array]:
    """Return stiffness and mass over (w, angle) of each end; the shear strain is w' - angle."""
    h, n = np.diff(s.z), 2 * len(s.z)
    one, half = np.ones_like(h), 0.5 * h
    shear = np.stack([-one, -half, one, -half], axis=1)
    turn = np.array([0.0, -1.0, 0.0, 1.0])
    K = (s.GA / h)[:, None, None] * shear[:, :, None] * shear[:, None, :]
    K = K + (s.EI / h)[:, None, None] * np.outer(turn, turn)
    M = np.zeros((len(h), 4, 4))
    M[:, ::2, ::2], M[:, 1::2, 1::2] = _linear_mass(s.m, h), _linear_mass(s.j, h)
    return _assembled(K, n, 2), _assembled(M, n, 2)
