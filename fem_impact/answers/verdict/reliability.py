"""How far the reduced model's change of a number by vibration is off, beside finite elements.

Scenes drawn at random ran by both models, with a body that vibrates and with one that cannot
(`fem_impact.case.measured.vibration_pairs`). The half-width of a change is found as that of a number: by
where the scene stands among the stored ones (`fem_impact.run.modal_error.Stored`).
"""

from collections.abc import Mapping
from functools import cache

import numpy as np

from fem_impact.case.case import Case
from fem_impact.case.measured import vibration_pairs
from fem_impact.outcome.keys import Key
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.run.modal_error import Stored, farness, place_of, unlike

CHANGED: Mapping[str, Key] = {
    "e": KEY_TABLE["e_edge"],
    "energy": KEY_TABLE["E_r_over_E_0"],
    "friction": KEY_TABLE["W_friction_over_E_0"],
}
"""Numbers whose change by vibration is judged, and their keys."""
LEAST = 0.02
"""Change below which errors no longer fall with it."""


def scale_of_change(change: float) -> float:
    """Return the scale of the error of a change by vibration: that change itself, at least `LEAST`."""
    return max(abs(change), LEAST)


def known_error(case: Case, whole: Outcome, of: str, change: float) -> tuple[float, tuple[str, ...]]:
    """Return the half-width of the reduced model's change of a number, and in what the scene is unlike all.

    Parameters
    ----------
    case : of the scene
    whole : outcome by the reduced model, with vibration
    of : number of `CHANGED`
    change : of that number by vibration
    """
    at, table = place_of(case, whole), stored()
    half = table.half_width(np.array(at), [*CHANGED].index(of), farness(at, whole, table))
    widest = 1 + abs(change)  # of numbers that lie between 0 and 1, and so their change between -1 and 1
    return min(half * scale_of_change(change), widest), unlike(at, whole, table)


def sentence(of: str, half: float, far: tuple[str, ...]) -> str:
    """Say what the half-width of a change is."""
    told = (
        f"The reduced model's change of {of} by vibration is off by less than {half:.2g} in nine of ten such "
        f"scenes, by {len(stored().places)} that finite elements computed as well."
    )
    return f"{told} None of them is like this one in {', '.join(far)}: it is wider." if far else told


@cache
def stored() -> Stored:
    """Return the stored scenes; their errors are those of the changes, over `scale_of_change`."""
    return Stored.of(vibration_pairs(), (*CHANGED,))
