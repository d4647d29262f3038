"""Bending of a body shorter than wide: a disc or a ring, free all around, as a thin plate.

A mode w = W(r) cos(n theta) of a thin plate obeys nabla^4 W = k^4 W, w^2 = k^4 D / (rho h) with
D = E h^3 / (12 (1 - nu^2)): W is a sum of J_n(kr), I_n(kr) and, of a ring, Y_n(kr), K_n(kr). At a free edge
bending moment and Kirchhoff's edge force vanish (A. W. Leissa, Vibration of Plates, NASA SP-160, 1969,
chapter 2). Shear and rotary inertia, which the thin plate leaves out, lengthen the period.
"""

from math import pi, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.physics.plate import bending_stiffness
from fem_impact.scene.projectile import ProjectileSpec

SADDLE = 2  # nodal diameters of the lowest mode
LOWEST, HIGHEST, STEPS = 0.3, 6.0, 200  # of k a, in which the first root lies, and places looked at
THINNEST = 0.99  # largest inner over outer radius: with a narrower rim the four waves are too much alike


def free_plate_root(waves: int, nu: float, hole: float = 0.0) -> float:
    """Return the lowest k a of a free plate of radius a with ``waves`` nodal diameters.

    ``hole`` is the radius of a hole over a.

    Examples
    --------
    >>> [round(free_plate_root(n, 0.33) ** 2, 2) for n in (2, 0)]
    [5.26, 9.07]
    """
    from scipy.optimize import brentq  # .1 s, for which no help text should wait

    share = min(hole, THINNEST)

    def determinant(k: float) -> float:
        return float(np.linalg.det(_free_edges(k, waves, nu, share)))

    places = np.linspace(LOWEST, HIGHEST, STEPS)
    signs = np.sign([determinant(k) for k in places])
    first = int(np.flatnonzero(signs[1:] != signs[:-1])[0])
    return float(brentq(determinant, places[first], places[first + 1]))


def _free_edges(k: float, waves: int, nu: float, hole: float) -> Array:
    """Return moment and edge force of each wave at each edge of the unit plate, (2, 2) or (4, 4), scaled."""
    from scipy import special

    kinds = [(special.jv, special.jvp, -1.0), (special.iv, special.ivp, 1.0)]
    if hole > 0:
        kinds += [(special.yv, special.yvp, -1.0), (special.kv, special.kvp, 1.0)]
    columns = []
    for wave, slope, sign in kinds:
        column = []
        for r in (1.0, hole)[: len(kinds) // 2]:
            w, dw, laplace = wave(waves, k * r), k * slope(waves, k * r), sign * k**2
            bent = (1 - nu) * (dw / r - waves**2 * w / r**2)
            sheared = (1 - nu) * waves**2 / r**2 * (dw - w / r)
            column += [laplace * w - bent, laplace * dw - sheared]
        columns.append(np.array(column) / np.abs(column).max())
    return np.stack(columns, axis=1)


def disc_period(rod: ProjectileSpec) -> float:
    """Return the longest period, s, of a body that bends as a plate.

    A body that is closed at one end or both bends as the thinner of the plates that close it, which its wall
    holds: the period is the longest there may be.
    """
    metal, thickness, hole = rod.material, rod.length, 0.0
    if rod.bore:
        first, last = rod.bore[0][0], rod.bore[-1][0]
        closing = [h for h in (first, rod.length - last) if h > 0]
        if closing:
            thickness = min(closing)
        else:
            _, outer, inner = rod.wall()
            hole = float((inner / outer).mean())
    root = free_plate_root(SADDLE, metal.nu, hole)
    speed = sqrt(bending_stiffness(metal.E, metal.nu, thickness) / (metal.rho * thickness))
    return 2 * pi * (0.5 * rod.diameter / root) ** 2 / speed
