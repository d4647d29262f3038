"""Uncertainty of impact coefficients that are worked out from measured velocities."""

from .bootstrap import bootstrap
from .estimate import Errors, Estimate
from .first_order import first_order
from .propagate import sensitivities

__all__ = ["Errors", "Estimate", "bootstrap", "first_order", "sensitivities"]
