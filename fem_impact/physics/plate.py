"""Bending of a wide plate under a blow: its impedance, Zener's number, and its bending waves.

A point force F moves an infinite thin plate at F / Z, Z = 8 sqrt(D rho h), D = E h^3 / (12 (1 - nu^2)): the
plate takes energy like a dashpot, for bending waves carry it away (drive-point mobility of an infinite plate,
Cremer, Heckl & Petersson 2005, Structure-Borne Sound, doi:10.1007/b137728). A striker of mass m and Hertz
stiffness k at speed v touches for 3.2 T, T = (m / (k sqrt(v)))^(2/5), and lambda = m / (Z T) says how much of
its energy goes that way (Zener 1941, doi:10.1103/PhysRev.59.669; derived in the open in Mathematics 2021, 9,
2222).
"""

from math import pi, sqrt

from fem_impact.physics.contact import ContactPair
from fem_impact.physics.contact_law import contact_law

MAIN_LOBE = 1.5  # highest frequency of a half-sine pulse over 1 / its duration: the end of its main lobe


def bending_stiffness(E: float, nu: float, thickness: float) -> float:
    """Return D, N m, of a plate (Pa, -, m).

    Examples
    --------
    >>> round(bending_stiffness(210e9, 0.3, 10e-3))
    19231
    """
    return E * thickness**3 / (12 * (1 - nu**2))


def plate_impedance(E: float, nu: float, rho: float, thickness: float) -> float:
    """Return Z = 8 sqrt(D rho h), N s/m, of an infinite plate under a point force (Pa, -, kg/m3, m).

    Examples
    --------
    >>> round(plate_impedance(210e9, 0.3, 7850.0, 10e-3))
    9829
    """
    return 8 * sqrt(bending_stiffness(E, nu, thickness) * rho * thickness)


def zener_number(pair: ContactPair) -> float:
    """Return lambda = m / (Z T) with the effective mass of the rod, 0 for a barrier that does not bend."""
    if pair.plate is None:
        return 0.0
    m, v = pair.effective_mass, max(pair.approach, 1e-6)
    T = (m / (contact_law(pair).stiffness * sqrt(v))) ** 0.4
    return float(m / (plate_impedance(*pair.plate) * T))


def contact_time(pair: ContactPair) -> float:
    """Return about how long a plate that bends is touched, s.

    That of a massive barrier times 1 + lambda, which is no less than Zener's equation gives up to lambda = 2.
    """
    return pair.estimate.duration * (1 + zener_number(pair))


def least_span(pair: ContactPair) -> float:
    """Return the width, m, of a plate from whose edges no wave of the pulse comes back while it lasts.

    The fastest bending waves of a pulse of duration tau are those of the frequency at the end of its main
    lobe, omega = 3 pi / tau. They travel at their group speed from the middle to the edge and back.
    """
    assert pair.plate is not None, "a plate that bends has a thickness"
    tau = contact_time(pair)
    return 2 * bending_speed(*pair.plate, 2 * pi * MAIN_LOBE / tau) * tau


def bending_speed(E: float, nu: float, rho: float, thickness: float, omega: float) -> float:
    """Return the phase speed, m/s, of bending waves in a thin plate (Pa, -, kg/m3, m) at ``omega``, rad/s.

    It is (D / (rho h))^(1/4) sqrt(omega); their group speed is twice as large.
    """
    return float((bending_stiffness(E, nu, thickness) / (rho * thickness)) ** 0.25 * sqrt(omega))


def pulse_wave(E: float, nu: float, rho: float, thickness: float, time: float) -> tuple[float, float]:
    """Return the phase speed, m/s, of a pulse's bending waves, and how far, m, they go and come back in it.

    A half-sine pulse of duration ``time``, s, is of the frequency omega = pi / time; its fastest waves are
    those at the end of its main lobe, at their group speed. In plates that are thick beside their waves,
    shear limits both speeds to about that of shear waves.
    """
    shear = sqrt(E / (2 * (1 + nu) * rho))
    middle, fastest = (
        bending_speed(E, nu, rho, thickness, omega) for omega in (pi / time, 2 * pi * MAIN_LOBE / time)
    )
    return min(middle, shear), 0.5 * min(2 * fastest, shear) * time


def plate_waves(pair: ContactPair) -> tuple[float, float]:
    """Return the `pulse_wave` of the contact of two bodies, of which the barrier is a plate that bends."""
    assert pair.plate is not None, "a plate that bends has a thickness"
    return pulse_wave(*pair.plate, contact_time(pair))
