"""How long a mass without arms stays in contact."""

from __future__ import annotations

import numpy as np

from fem_impact.contact_law import ContactLaw
from fem_impact.modal.impact import reach
from fem_impact.modal.march import MOST_CONTACTS, Bounds, Start, drop

__all__ = ["contact_time"]

STEP, FREE = 2e-8, 1e-6  # s
LATEST = 1.0  # s


def contact_time(law: ContactLaw, mass: float, speed: float) -> float:
    """Return the contact time, s, of a rigid mass, kg, that falls along the normal with a speed, m/s."""
    start = Start(mass, 1.0, 0.0, 0.0, 0.0, 0.0, -speed, 0.0, 0.0, 0.0)
    bounds = Bounds(STEP, FREE, LATEST, reach(law, 0.5 * mass * speed**2))
    none, contacts = np.zeros(0), np.zeros((MOST_CONTACTS, 4))
    drop(start, law, none, none, none, bounds, contacts)
    return float(contacts[0, 1] - contacts[0, 0])
