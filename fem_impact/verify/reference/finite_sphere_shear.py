"""How far a ball under a tangential force differs from a half-space: the shift from its rigid motion.

A traction along t, distributed like Hertz' pressure, pushes a ball that its own inertia lets move and turn.
The mean shift of the skin under it, beyond the rigid motion of the ball, over the force is

    C_t(a) = 3 (2 - nu) / (20 G a) + chi_t(a / R) / (E_1* R),    E_1* = E_1 / (1 - nu_1^2),

the first term that of a half-space (Johnson, Contact Mechanics, 1985, section 3.6). The series is that of
`finite_sphere` one order around the axis higher, with torsion besides.
"""

from __future__ import annotations

from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from fem_impact.verify.reference.finite_sphere import (
    RESOLUTION,
    braked,
    legendre,
    pressure_rings,
    surface_shape,
)

__all__ = ["ball_shear"]

Array = NDArray[np.float64]


def _load(a: float, orders: int) -> tuple[Array, Array, Array, Array]:
    """Return norms (orders,) and series of the traction on a unit ball: radial, polar, torsional.

    With S = dP_n / d(theta) the fields are S cos(phi) along r, the surface gradient of S cos(phi), and r
    times that of S sin(phi); the last two have norms larger by n (n + 1).
    """
    theta, ring = pressure_rings(a)
    P, S = legendre(theta, orders)
    n = np.arange(orders)
    square = n * (n + 1)
    slope = -square[:, None] * P - S / np.tan(theta)
    norm = 2 * pi * np.maximum(square, 1) / (2 * n + 1)
    around = S / np.sin(theta)
    radial = pi * (S @ (ring * np.sin(theta))) / norm
    polar = pi * ((slope * np.cos(theta) + around) @ ring) / (np.maximum(square, 1) * norm)
    torsional = pi * ((around * np.cos(theta) + slope) @ ring) / (np.maximum(square, 1) * norm)
    return norm, radial, polar, torsional


def ball_shear(a: float, nu: float) -> float:
    """Return chi_t for a contact radius of ``a`` ball radii.

    Examples
    --------
    >>> round(ball_shear(0.05, 0.29), 3)
    0.802
    """
    orders = ceil(RESOLUTION / a)
    norm, radial, polar, torsional = _load(a, orders)
    n = np.arange(orders)
    out, along = surface_shape(nu, radial, polar)
    out[0] = along[0] = 0.0
    out[1], along[1] = braked(nu, float(polar[1]))
    twist = 2 * torsional / np.maximum(n - 1, 1)  # 2 G = 1
    twist[1] = 2 * torsional[1] / 7  # its moment is balanced by inertia, the mean turn is 0
    twist[0] = 0.0
    work = norm * (radial * out + n * (n + 1) * (polar * along + torsional * twist))
    stiffness = 1 / (1 - nu)  # E / (1 - nu^2) with 2 G = 1
    return float(stiffness * (work.sum() - 3 * (2 - nu) / (10 * a)))
