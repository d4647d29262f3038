"""What the elasticity of a rod does to a yielding blow before anything vibrates.

Behind the contact the rod gives way like a spring of flexibility s, the sum of phi^2/omega^2 over its modes.
A blow that is slow beside their periods, of energy E = m* v^2/2, on a contact of force F(d) at the depth d,

    E = int F dd + s F^2 / 2

gives the last term back: it never reaches the contact, so that less of it flows plastically and e rises.
"""

from __future__ import annotations

from math import sqrt

from scipy.optimize import brentq

from fem_impact.contact_law import ContactLaw, contact_law
from fem_impact.modal.impact import plastic_work
from fem_impact.modal.rod import modal_rod
from fem_impact.study.rods import Drop

__all__ = ["static_restitution"]


def static_restitution(drop: Drop) -> float:
    """Return e of a frictionless drop whose rod gives way elastically and is left without vibration."""
    scene = drop.scene()
    rod, law = modal_rod(scene), contact_law(scene)
    mass = rod.mass / (1 + rod.centre_t**2 / rod.k2)
    energy = 0.5 * mass * scene.impact.v_n**2
    flexibility = float((rod.along_n**2 / rod.omega**2).sum())

    def too_deep(depth: float) -> float:
        force, work = _loading(law, depth)
        return work + 0.5 * flexibility * force**2 - energy

    return sqrt(1 - plastic_work(law, brentq(too_deep, 0.0, drop.radius)) / energy)


def _loading(law: ContactLaw, depth: float) -> tuple[float, float]:
    """Return force, N, and work, J, of first loading to a depth, m."""
    elastic = min(depth, law.yield_depth)
    beyond, force = depth - elastic, law.stiffness * elastic**1.5
    return force + law.slope * beyond, 0.4 * force * elastic + (force + 0.5 * law.slope * beyond) * beyond
