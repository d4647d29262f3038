"""The shares of E_0: name, colour, and where each is shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fem_impact.outcome.groups import Energy
from fem_impact.outcome.keys import Key, Num
from fem_impact.outcome.record import KEY_TABLE

__all__ = ["SHARES", "EnergyShare", "Place", "shares"]


Place = Literal["terminal", "figure", "comparison", "report"]
"""Where shares are listed: the terminal, figures of one or many runs, model beside measurement, pages."""

ALL: frozenset[Place] = frozenset({"terminal", "figure", "comparison", "report"})


@dataclass(frozen=True, slots=True)
class EnergyShare:
    """One share of E_0.

    Attributes
    ----------
    key : its value in an outcome, with unit and meaning
    label : name in tables and figures
    colour : name in the palette of the figures
    shown : the places that list it
    """

    key: Key
    label: str
    colour: str
    shown: frozenset[Place] = ALL

    def of(self, energy: Energy) -> Num:
        """Return the share in an outcome's energy."""
        share: Num = getattr(energy, self.key.path[-1])
        return share


def _share(name: str, label: str, colour: str, *hidden: Place) -> EnergyShare:
    return EnergyShare(KEY_TABLE[f"{name}_over_E_0"], label, colour, ALL - {*hidden})


SHARES = (
    _share("E_r", "rigid motion", "blue", "comparison"),
    _share("E_vib", "vibration", "night"),
    _share("W_friction", "friction", "green"),
    _share("E_plastic_rod", "plastic rod", "purple"),
    _share("E_plastic_barrier", "plastic barrier", "vermilion"),
    _share("E_locked_rod", "locked in rod", "sky"),
    _share("E_locked_barrier", "locked in barrier", "orange"),
    _share("W_radiated", "radiated", "yellow"),
    _share("W_closing", "contact closing", "grey", "comparison"),
    _share("W_damping", "damping", "sand", "comparison"),
    _share("E_contact", "held by the contact", "grey", "comparison", "figure"),
    _share("W_gravity", "gravity", "grey", "comparison", "figure"),
)
"""Every share, in the order of tables and figures; what gravity adds is no part of E_0 and no area."""


def shares(place: Place) -> tuple[EnergyShare, ...]:
    """Return the shares that a place lists."""
    return tuple(share for share in SHARES if place in share.shown)
