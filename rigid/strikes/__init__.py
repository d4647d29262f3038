"""Strikes of a rigid body from the first to rest: outline, flight, contacts that are held, and records."""

from ..rounds import Round
from .course import LEAST, MOST, RUNAWAY, Moved, as_it_is, sequence
from .flight import FlightState, clears, next_touch
from .held import Ending, Held, Pull, hold
from .outline import Outline, outline
from .record import Approach, Finish, Phase, Sequence, Strike

__all__ = [
    "LEAST",
    "MOST",
    "RUNAWAY",
    "Approach",
    "Ending",
    "Finish",
    "FlightState",
    "Held",
    "Moved",
    "Outline",
    "Phase",
    "Pull",
    "Round",
    "Sequence",
    "Strike",
    "as_it_is",
    "clears",
    "hold",
    "next_touch",
    "outline",
    "sequence",
]
