"""Free-free modes of the meshed rod: eigenproblem, projection of a motion, exact free flight."""

from fem_impact.modes.eigen import RodModes, no_modes, rod_modes
from fem_impact.modes.motion import Flight, RigidMotion, flight, rigid_motion
from fem_impact.modes.stiffness import MassStiffness

__all__ = [
    "Flight",
    "MassStiffness",
    "RigidMotion",
    "RodModes",
    "flight",
    "no_modes",
    "rigid_motion",
    "rod_modes",
]
