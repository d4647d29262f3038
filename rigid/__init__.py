"""Rigid impulse-momentum theory of a projectile on a massive barrier.

Axes: n out of the barrier, t up the slope; the contact point lies at -d_c t - d_d n from the mass
centre; v_n, v_t < 0 before impact; Omega is positive turning n towards t. SI units throughout.
Equation numbers are those of Averill, Ingram, Holborn and Battersby (see ``experiments/data/README.md``).
"""

from .arms import Arms, corner_arms
from .coefficients import Coefficients, coefficients, impulse_ratio, restitution
from .drop import GRAVITY, drop_velocities
from .errors import DataError, ImpactError, RigidError, ShapeError
from .losses import Losses, PredictedLosses, kinetic_energy, losses, predicted_losses
from .massive import Motion, critical_ratio, phi, solve
from .projectile import TIPS, Projectile
from .slenderness import LIMIT, LIMIT_MM, behaves_rigidly, in_millimetres, slenderness

__all__ = [
    "GRAVITY",
    "LIMIT",
    "LIMIT_MM",
    "TIPS",
    "Arms",
    "Coefficients",
    "DataError",
    "ImpactError",
    "Losses",
    "Motion",
    "PredictedLosses",
    "Projectile",
    "RigidError",
    "ShapeError",
    "behaves_rigidly",
    "coefficients",
    "corner_arms",
    "critical_ratio",
    "drop_velocities",
    "impulse_ratio",
    "in_millimetres",
    "kinetic_energy",
    "losses",
    "phi",
    "predicted_losses",
    "restitution",
    "slenderness",
    "solve",
]
