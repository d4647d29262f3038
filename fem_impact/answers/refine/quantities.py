"""Quantities whose errors are reported for each setting, and the scales that errors are divided by."""

from collections.abc import Iterable
from dataclasses import dataclass

from fem_impact.case.case import Case
from fem_impact.errors import SceneError, UsageError
from fem_impact.outcome.keys import Key, Num, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.run.modal_error import unit_of
from fem_impact.scene.types import Scene


@dataclass(frozen=True, slots=True)
class TargetQuantity:
    """A number of an outcome.

    Attributes
    ----------
    name, unit : str
    keys : keys of the outcome whose sum it is
    floor : least scale, so that a vanishing quantity needs no infinite accuracy; for Omega in units of speed
        over radius of gyration
    """

    name: str
    unit: str
    keys: tuple[Key, ...]
    floor: float

    def scale(self, value: float, outcome: Outcome) -> float:
        """Return the scale that an error is divided by."""
        return max(abs(value), self.floor * unit_of(self.keys[0].name, outcome))


def sum_of(keys: Iterable[Key], outcome: Outcome) -> float | None:
    """Return the sum of those keys that the fidelity of an outcome knows, None where that is none."""
    values: list[Num] = [key.of(outcome) for key in keys]
    parts = [part for value in values if (part := or_none(value)) is not None]
    return float(sum(parts)) if parts else None


def _quantity(name: str, unit: str, floor: float, *keys: str) -> TargetQuantity:
    return TargetQuantity(name, unit, tuple(KEY_TABLE[key] for key in keys), floor)


SHARE = 0.005  # floor of shares of E_0: 2 % of it are 1e-4 of E_0, the accuracy wanted of E_vib
QUANTITIES = (
    _quantity("e", "-", 0.05, "e_edge"),
    _quantity("mu", "-", 0.05, "mu"),
    _quantity("Omega", "rad/s", 0.1, "Omega_rad_per_s"),
    _quantity("E_vib", "E_0", SHARE, "E_vib_over_E_0"),
    _quantity("E_lt", "E_0", SHARE, "E_lt_edge_over_E_0"),
    _quantity("E_ln", "E_0", SHARE, "E_ln_edge_over_E_0"),
    _quantity("plastic", "E_0", SHARE, "E_plastic_rod_over_E_0", "E_plastic_barrier_over_E_0"),
    _quantity("friction", "E_0", SHARE, "W_friction_over_E_0"),
    _quantity("peak force", "N", 0.0, "peak_force_N"),
)
FLOORS = (
    f"of e and mu at least of 0.05, of an energy at least of {100 * SHARE:g} % of E_0, of Omega at least of "
    "a tenth of speed over radius of gyration"
)
"""Floors of the scales in words."""
TARGETED = ("e", "E_vib")
"""Quantities that a target error applies to unless others are named."""


def chosen(asked: Iterable[str], scene: Scene | None = None) -> tuple[str, ...]:
    """Return names of quantities after checking them, `TARGETED` if there are none.

    Raises
    ------
    UsageError
        For an unknown name.
    SceneError
        For one that no run of the ``scene`` knows.
    """
    wanted = tuple(asked)
    rigid = scene is not None and "vibration" not in Case(scene).active
    if rigid and "E_vib" in wanted:
        raise SceneError(
            "is not known here: the vibration effect is off.",
            key="of=",
            value="E_vib",
            remedy='Name others, or add "vibration" to the effects of the scene.',
        )
    names = [quantity.name for quantity in QUANTITIES]
    for name in wanted:
        if name not in names:
            remedy = f"Known: {', '.join(names)}."
            raise UsageError("is not a quantity of interest.", key="of=", value=name, remedy=remedy)
    return wanted or tuple(name for name in TARGETED if not (rigid and name == "E_vib"))
