"""Balances of energy and momentum, and the sign of friction work, which every run must obey."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.solid.run import SolidResult
from fem_impact.tables.table import read_csv

LEDGER = 1e-3  # of E_0: most that the ledger may miss, to either side
FED = 1e-6  # of E_0: most that friction may give back between two rows of the history
MOMENTUM = 1e-3  # of the momentum at the start plus the impulse
SPIN = 2e-3  # of the same for angular momentum, whose best-fit angle holds to second order only


@dataclass(frozen=True, slots=True)
class Balance:
    """The balances of a run, each as a share.

    Attributes
    ----------
    residual : largest miss of the ledger over E_0, growth : largest gain of energy over E_0
    fed : largest energy that friction gave between two rows over E_0
    momentum, spin : misses of linear and angular momentum over their size
    """

    residual: float
    growth: float
    fed: float
    momentum: float
    spin: float

    def faults(self) -> list[str]:
        """Return a sentence for each balance that does not hold."""
        limits = (
            (self.residual, LEDGER, "the ledger misses {:.1e} of E_0"),
            (self.growth, LEDGER, "the energy grew by {:.1e} of E_0"),
            (self.fed, FED, "friction fed {:.1e} of E_0"),
            (self.momentum, MOMENTUM, "momentum misses {:.1e}"),
            (self.spin, SPIN, "angular momentum misses {:.1e}"),
        )
        return [sentence.format(value) for value, most, sentence in limits if not value <= most]


def balance(result: SolidResult, history: Path) -> Balance:
    """Return the balances of a finished or stopped run."""
    table = read_csv(history)
    E_0 = result.E_0
    heat = table.numbers("W_friction_J")
    # what linear and angular momentum about the origin miss of the contact's impulses
    motion, impact, view = result.motion, result.case.scene.impact, result.view
    x = result.model.start[0][view.places]
    centre = view.mass @ x / view.mass.sum()
    weight = (result.case.slots.gravity or 0.0) * result.time
    down = weight * np.array([-np.sin(impact.angle), -np.cos(impact.angle)])
    middle = 0.5 * (centre + np.asarray(motion.centre))  # mean place of the mass centre
    moment = motion.mass * (middle[2] * down[0] - middle[0] * down[1])
    p = 2 * result.model.book.impulse
    m = motion.mass
    gained = m * (np.array([motion.V_t - impact.v_t, motion.V_n - impact.v_n]) - down)
    size = m * float(np.hypot(impact.v_t, impact.v_n)) + float(np.abs(p[:2]).sum())
    before = motion.inertia * impact.omega + m * (centre[2] * impact.v_t - centre[0] * impact.v_n)
    turned = motion.spin - before + p[2] - moment
    arm = float(np.linalg.norm(centre))
    momentum, spin = float(np.linalg.norm(gained - p[:2])) / size, abs(float(turned)) / (size * arm)
    return Balance(
        residual=result.worst / E_0,
        growth=float(np.max(-table.numbers("residual_J"), initial=0.0)) / E_0,
        fed=float(np.max(-np.diff(heat), initial=0.0)) / E_0,
        momentum=momentum,
        spin=spin,
    )
