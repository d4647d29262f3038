"""Which places of the rod touched, how wide and how deep: the sites of contact of an impact."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from fem_impact.case.case import Case
from fem_impact.modal.motion import SITE, Touched
from fem_impact.modal.rod import ModalRod
from fem_impact.modal.sites import skin
from fem_impact.modal.touch import flow_of


@dataclass(frozen=True, slots=True)
class PressedSite:
    """One place of contact, as finite elements record it.

    Attributes
    ----------
    start, end : first and last touch, s
    impulse_n, impulse_t : on the rod, N s
    low, high : ends along t of the skin that was pressed, m, as it lay before, from what touched first
    width : across the plane of motion, m; depth : largest indentation of the barrier, m
    """

    start: float
    end: float
    impulse_n: float
    impulse_t: float
    low: float
    high: float
    width: float
    depth: float


def pressed_sites(case: Case, rod: ModalRod, held: Touched) -> tuple[PressedSite, ...]:
    """Return the places of contact in the order of their first touch."""
    found = [_pressed(case, rod, held, s) for s in np.flatnonzero(held.site[:, SITE.end] > 0.0).tolist()]
    return tuple(sorted(found, key=lambda site: site.start))


def _pressed(case: Case, rod: ModalRod, held: Touched, s: int) -> PressedSite:
    flow, of = flow_of(held, s), held.site[s]
    across = 2.0 * of[SITE.deepest] if flow.yields else of[SITE.deepest]  # a Hertzian contact is narrower
    half, wide = sqrt(flow.R1 * across), sqrt(flow.R2 * across)
    middle = skin(rod.sites, s, float(of[SITE.turned]))[0] + case.contact.arms[0]
    if flow.yields and flow.ploughs:
        depth = float(of[SITE.deepest])
    else:
        depth = float(of[SITE.force]) * _flexibility(case) / (2.0 * sqrt(half * wide))
    return PressedSite(
        start=float(of[SITE.start]),
        end=float(of[SITE.end]),
        impulse_n=float(of[SITE.impulse_n]),
        impulse_t=float(of[SITE.impulse_t]),
        low=middle - half,
        high=middle + half,
        width=2.0 * wide,
        depth=depth,
    )


def _flexibility(case: Case) -> float:
    """Return (1 - nu^2) / E of the barrier, 1/Pa; 0 of a rigid one."""
    pair = case.contact
    return (1 - pair.barrier.nu**2) / pair.barrier.E if pair.compliant else 0.0
