"""How much softer a body is under a load on its edge than a plane body: the wedge."""

from math import pi, sin


def wedge_compliance(half_angle: float) -> tuple[float, float]:
    """Return the compliance of a wedge under a load on its edge, over that of a half-plane.

    The stress is radial, 2 P cos(theta) / (r (2 a + sin 2 a)) under a load P a metre along the bisector, and
    2 P sin(theta) / (r (2 a - sin 2 a)) across it, with half the angle a of the wedge (Michell 1902;
    Timoshenko and Goodier 1970, Theory of Elasticity, section 38). The energies at one r compare.

    Parameters
    ----------
    half_angle : half the angle between the faces, rad, above 0 and up to pi / 2

    Returns
    -------
    tuple[float, float]
        For a load along the bisector and across it in the plane of the section.

    Examples
    --------
    >>> [round(part, 2) for part in wedge_compliance(pi / 4)]
    [1.22, 5.5]
    >>> wedge_compliance(pi / 2)
    (1.0, 1.0)
    """
    twice = 2.0 * half_angle
    return pi / (twice + sin(twice)), pi / (twice - sin(twice))
