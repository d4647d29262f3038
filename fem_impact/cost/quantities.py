"""Quantities whose error the ladder reports, and the scale that an error is divided by."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import hypot, sqrt
from typing import TYPE_CHECKING, Any

from fem_impact.errors import SceneError, UsageError

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["QUANTITIES", "TARGETED", "Quantity", "chosen"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number of an outcome.

    Attributes
    ----------
    name, unit : str
    keys : keys of the outcome whose sum it is
    floor : below it an error is no longer divided by the quantity but by the floor, so that a vanishing
        quantity needs no infinite accuracy; for Omega in units of speed over radius of gyration
    """

    name: str
    unit: str
    keys: tuple[str, ...]
    floor: float

    def value(self, outcome: Mapping[str, Any]) -> float | None:
        """Return the value, None where the fidelity does not know it."""
        parts = [outcome[key] for key in self.keys]
        return None if None in parts else float(sum(parts))

    def scale(self, value: float, outcome: Mapping[str, Any]) -> float:
        """Return what an error is divided by."""
        unit = 1.0
        if self.unit == "rad/s":
            unit = hypot(outcome["v_n_m_per_s"], outcome["v_t_m_per_s"]) / sqrt(outcome["k_squared_m2"])
        return max(abs(value), self.floor * unit)


# 2 % of the floor of a share is 1e-4 of E_0, as far as vibration is asked for
SHARE = 0.005
QUANTITIES = (
    Quantity("e", "-", ("e_edge",), 0.05),
    Quantity("mu", "-", ("mu",), 0.05),
    Quantity("Omega", "rad/s", ("Omega_rad_per_s",), 0.1),
    Quantity("E_vib", "E_0", ("E_vib_over_E_0",), SHARE),
    Quantity("E_lt", "E_0", ("E_lt_edge_over_E_0",), SHARE),
    Quantity("E_ln", "E_0", ("E_ln_edge_over_E_0",), SHARE),
    Quantity("plastic", "E_0", ("E_plastic_rod_over_E_0", "E_plastic_barrier_over_E_0"), SHARE),
    Quantity("friction", "E_0", ("W_friction_over_E_0",), SHARE),
    Quantity("peak force", "N", ("peak_force_N",), 0.0),
)
TARGETED = ("e", "E_vib")
"""What a target means unless other quantities are named."""


def chosen(names: Iterable[str], scene: Scene | None = None) -> tuple[str, ...]:
    """Return names of quantities after checking them, `TARGETED` if there are none.

    Raises
    ------
    UsageError
        For an unknown name.
    SceneError
        For one that no run of the ``scene`` knows.
    """
    wanted = tuple(names)
    rigid = scene is not None and "vibration" not in scene.active
    if rigid and "E_vib" in wanted:
        raise SceneError(
            "is not known here: the vibration effect is off.",
            key="--of",
            value="E_vib",
            remedy='Name others, or add "vibration" to the effects of the scene.',
        )
    known = [quantity.name for quantity in QUANTITIES]
    for name in wanted:
        if name not in known:
            raise UsageError(
                "is not a quantity of interest.", key="--of", value=name, remedy=f"Known: {', '.join(known)}."
            )
    return wanted or tuple(name for name in TARGETED if not (rigid and name == "E_vib"))
