"""Rigid impulse-momentum theory of a projectile on a barrier.

`solve` takes a massive barrier, `solve_free` one of finite mass that moves freely (Brach's theory of two
bodies), `General` external impulses and changed inertia as well, `sliding_path` resolves friction.

Axes: n out of the barrier, t up the slope; the contact point lies at -d_c t - d_d n from the mass
centre; v_n, v_t < 0 before impact; Omega is positive turning n towards t. SI units throughout.
Equation numbers are those of Averill, Ingram, Holborn and Battersby (see ``experiments/data/README.md``).
"""

from . import shapes
from .arms import Arms, corner_arms, point_arms, touch_arms
from .coefficients import Coefficients, coefficients, impulse_centre, impulse_ratio, restitution
from .drop import GRAVITY, drop_velocities
from .faceted import Faceted
from .finite import FreeMotion, solve_free
from .general import General
from .inputs import DataError, ImpactError, RigidError, ShapeError, TooLongError
from .losses import (
    Losses,
    PredictedLosses,
    closure_defect,
    kinetic_energy,
    losses,
    pinned_loss,
    predicted_losses,
)
from .massive import Motion, critical_ratio, phi, solve
from .nose import SHAPES, Nose
from .path.eq22 import interval_ratio, painleve_threshold
from .path.resolve import End, SlidingPath, path_over_speed, sliding_path
from .projectile import Projectile
from .slenderness import LIMIT, LIMIT_MM, behaves_rigidly, in_millimetres, slenderness
from .touch import Touch
from .turned import Turned
from .uncertainty import Errors, Estimate, bootstrap, first_order
from .worst import WorstCase, worst_case

Body = Projectile | Turned | Faceted
"""What strikes a barrier."""

__all__ = [
    "GRAVITY",
    "LIMIT",
    "LIMIT_MM",
    "SHAPES",
    "Arms",
    "Body",
    "Coefficients",
    "DataError",
    "End",
    "Errors",
    "Estimate",
    "Faceted",
    "FreeMotion",
    "General",
    "ImpactError",
    "Losses",
    "Motion",
    "Nose",
    "PredictedLosses",
    "Projectile",
    "RigidError",
    "ShapeError",
    "SlidingPath",
    "TooLongError",
    "Touch",
    "Turned",
    "WorstCase",
    "behaves_rigidly",
    "bootstrap",
    "closure_defect",
    "coefficients",
    "corner_arms",
    "critical_ratio",
    "drop_velocities",
    "first_order",
    "impulse_centre",
    "impulse_ratio",
    "in_millimetres",
    "interval_ratio",
    "kinetic_energy",
    "losses",
    "painleve_threshold",
    "path_over_speed",
    "phi",
    "pinned_loss",
    "point_arms",
    "predicted_losses",
    "restitution",
    "shapes",
    "slenderness",
    "sliding_path",
    "solve",
    "solve_free",
    "touch_arms",
    "worst_case",
]
