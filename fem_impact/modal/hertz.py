"""The contact that does not yield: Hertz' with a row of tangential springs, and perhaps a viscous part."""

import numpy as np

from fem_impact.fem.kernels import inlined
from fem_impact.modal.motion import SPRINGS, Springs
from fem_impact.physics.contact_law import ContactLaw


@inlined
def press(depth: float, rate: float, law: ContactLaw) -> tuple[float, float, float]:
    """Return the normal force, N, contact radius, m, and the part of the force that is viscous, N.

    The whole is Hertz' and the viscous one at a ``rate`` of the depth, m/s, or 0 where that would pull.
    """
    if depth <= 0.0:
        return 0.0, 0.0, 0.0
    elastic = law.stiffness * depth**1.5
    viscous = max(1.5 * law.stiffness * law.lag * np.sqrt(depth) * rate, -elastic) if law.lag > 0.0 else 0.0
    return elastic + viscous, np.sqrt(law.R * depth), viscous


def springs_over(radius: float) -> Springs:
    """Return springs over a contact radius, m, in even steps of area: close at the rim, where slip begins."""
    edge = radius * np.sqrt(np.linspace(0.0, 1.0, SPRINGS + 1))
    return Springs(0.5 * (edge[1:] + edge[:-1]), 2 * np.diff(edge), np.zeros(SPRINGS))


@inlined
def grip(springs: Springs, moved: float, F: float, a: float, law: ContactLaw) -> float:
    """Move the contact's tangential springs by ``moved``, m, and return their force, N.

    A row of springs, each bound to its share f q(x) of Coulomb's limit, maps the Cattaneo-Mindlin contact of
    round bodies with its history exactly (Popov & Hess 2015, doi:10.1007/978-3-642-53876-6); springs beyond
    the contact radius ``a`` are free of force.
    """
    place, width, shift = springs
    stiffness, total = 0.5 * law.shear, 0.0
    load = law.friction * 0.75 * F / (a * stiffness)
    for i in range(len(place)):
        limit = load * max(0.0, 1.0 - (place[i] / a) ** 2)
        shift[i] = min(max(shift[i] + moved, -limit), limit)
        total += width[i] * shift[i]
    # the rim cuts through a spring: the sum must not exceed Coulomb's limit by its share
    most = law.friction * F
    return min(max(stiffness * total, -most), most)


@inlined
def stored(depth: float, springs: Springs, law: ContactLaw) -> tuple[float, float]:
    """Return the energies, J, that the contact holds: Hertz', and that of its springs."""
    total, F = 0.0, law.stiffness * max(depth, 0.0) ** 1.5
    for i in range(len(springs.shift)):
        total += springs.width[i] * springs.shift[i] ** 2
    return 0.4 * F * depth, 0.25 * law.shear * total
