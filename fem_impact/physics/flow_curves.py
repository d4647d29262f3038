"""Flow curves of the laws of Ramberg and Osgood and of Johnson and Cook."""

from __future__ import annotations

import numpy as np

from fem_impact.physics.hardening import Hardening, TabulatedHardening

PROOF_STRAIN = 0.002  # plastic strain of the proof stress through which Ramberg and Osgood's law goes
ELASTIC_STRAIN = 1e-4  # plastic strain at which it counts as yielding: it has no yield point of its own
FIRST, LAST, POINTS = 1e-4, 5.0, 60  # plastic strains of a table of Johnson and Cook's law, and their number


def ramberg_osgood(proof_stress: float, n: float) -> Hardening:
    """Return sigma = proof_stress (p / .002)^(1/n), p plastic strain, Pa; it begins to flow at p = .0001.

    There the curve is shifted to its yield point: strains are `ELASTIC_STRAIN` too small, the proof stress
    is met.

    Examples
    --------
    >>> law = ramberg_osgood(276e6, 20.0)
    >>> print(round(float(law.flow_stress(0.002)) / 1e6), round(float(law.flow_stress(0.1)) / 1e6))
    276 335
    """
    start = proof_stress * (1 + PROOF_STRAIN / ELASTIC_STRAIN) ** (-1 / n)
    return Hardening(start, 1 / ELASTIC_STRAIN, 1 / n)


def johnson_cook(
    A: float, B: float, n: float, heat: float = 0.0, span: float = 1.0, m: float = 1.0
) -> TabulatedHardening:
    """Return sigma = (A + B p^n) (1 - T*^m), Pa, of a material that keeps the heat of its flow.

    Johnson & Cook 1985, doi:10.1016/0013-7944(85)90052-9, eq 1 at the slowest rate. T* is the rise of the
    temperature over the ``span`` from there to melting, K, and grows by ``heat`` (K/Pa: the share of the
    work that is heat over density and heat capacity) times sigma dp. Where the curve would fall it is held:
    softening has no unique answer on any mesh.

    Examples
    --------
    >>> print(round(float(johnson_cook(90e6, 292e6, 0.31).flow_stress(0.5)) / 1e6))
    325
    """
    strain = np.concatenate([[0.0], np.geomspace(FIRST, LAST, POINTS)])
    cold = A + B * strain**n
    stress, rise = cold.copy(), 0.0
    for k in range(1, len(strain)):
        step = strain[k] - strain[k - 1]
        rise += heat * stress[k - 1] * step
        stress[k] = cold[k] * (1 - min(rise / span, 1.0) ** m)
    held = np.maximum.accumulate(stress)
    return TabulatedHardening(tuple(zip(strain.tolist(), held.tolist(), strict=True)))
