"""Material damping of the rod's vibration, mode by mode."""

from math import pi

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec

# where the rod's material states none: upper end of 2e-4 to 6e-4 for iron, Cremer, Heckl & Petersson 2005,
# doi:10.1007/b137728 (read as quoted in manuals of engineering programs, halved to viscous ratios)
LOSS_FACTOR = 6e-4


def loss_factor(bodies: Bodies) -> float:
    """Return the loss factor of the rod's modes: the largest that its materials state, or that of iron."""
    return max(_stated(bodies), default=LOSS_FACTOR)


def states_loss(bodies: Bodies) -> bool:
    """Return whether a material of the rod states a loss factor."""
    return bool(_stated(bodies))


def _stated(bodies: Bodies) -> list[float]:
    """Return the loss factors that the rod's materials state."""
    return [metal.loss_factor for metal in bodies.rod.materials if metal.loss_factor is not None]


def number(bodies: Bodies) -> float:
    """Return the share of the vibration that is damped while the impact lasts, eta omega_1 (tau + T1)."""
    period = bodies.bending_period
    return 2 * pi * loss_factor(bodies) * (bodies.estimate.duration + period) / period


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the loss factor."""
    spec.loss_factor = loss_factor(bodies)
