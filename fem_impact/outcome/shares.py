"""The shares of E_0 and the accounts of the ledger over time: names, colours, and where each is shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fem_impact.outcome.groups import Energy
from fem_impact.outcome.keys import Key, Num
from fem_impact.outcome.record import KEY_TABLE

Place = Literal["terminal", "figure", "comparison", "report", "study"]
"""Where shares are listed: the terminal, figures of one or many runs, model beside measurement, pages,
the ledger of a study's runs and its families of meshes."""

Group = Literal["motion", "contact", "flow", "outgoing"]
"""Kinds of shares: left in the rod's motion, lost at the contact, to plastic flow, carried out or in."""


@dataclass(frozen=True, slots=True)
class EnergyShare:
    """One share of E_0.

    Attributes
    ----------
    key : its value in an outcome, with unit and meaning
    label : name in tables and figures
    group : its kind
    colour : name in the palette of the figures
    shown : the places that list it
    """

    key: Key
    label: str
    group: Group
    colour: str
    shown: frozenset[Place]

    @property
    def title(self) -> str:
        """Label of the fraction, such as ``vibration/E_0``."""
        return f"{self.label}/E_0"

    def of(self, energy: Energy) -> Num:
        """Return the share in an outcome's energy."""
        share: Num = getattr(energy, self.key.path[-1])
        return share


def _share(name: str, label: str, group: Group, colour: str, *shown: Place) -> EnergyShare:
    always: tuple[Place, ...] = ("terminal", "report")
    return EnergyShare(KEY_TABLE[f"{name}_over_E_0"], label, group, colour, frozenset({*always, *shown}))


SHARES = (
    _share("E_r", "rigid motion", "motion", "blue", "figure", "study"),
    _share("E_vib", "vibration", "motion", "night", "figure", "comparison", "study"),
    _share("W_friction", "friction", "contact", "green", "figure", "comparison", "study"),
    _share("E_plastic_rod", "plastic rod", "flow", "purple", "figure", "comparison", "study"),
    _share("E_plastic_barrier", "plastic barrier", "flow", "vermilion", "figure", "comparison", "study"),
    _share("E_locked_rod", "locked in rod", "flow", "sky", "figure", "comparison"),
    _share("E_locked_barrier", "locked in barrier", "flow", "orange", "figure", "comparison"),
    _share("W_radiated", "radiated", "outgoing", "yellow", "figure", "comparison"),
    _share("W_closing", "contact closing", "contact", "grey", "figure"),
    _share("W_damping", "damping", "outgoing", "sand", "figure"),
    _share("E_contact", "held by the contact", "contact", "grey"),
    _share("W_gravity", "gravity", "outgoing", "grey"),
)
"""Every share, in the order of tables and figures; what gravity adds is no part of E_0 and no area."""


def shares(place: Place) -> tuple[EnergyShare, ...]:
    """Return the shares that a place lists."""
    return tuple(share for share in SHARES if place in share.shown)


@dataclass(frozen=True, slots=True)
class LedgerAccount:
    """An account of the ledger over time: its column of history.csv, J, its label, its colour's name."""

    column: str
    label: str
    colour: str


ACCOUNTS = (
    LedgerAccount("E_kinetic_rod_J", "kinetic rod", "blue"),
    LedgerAccount("E_strain_rod_J", "strain rod", "sky"),
    LedgerAccount("E_plastic_rod_J", "plastic rod", "purple"),
    LedgerAccount("W_friction_J", "friction", "green"),
    LedgerAccount("E_plastic_barrier_J", "plastic barrier", "vermilion"),
    LedgerAccount("E_strain_barrier_J", "strain barrier", "orange"),
    LedgerAccount("E_kinetic_barrier_J", "kinetic barrier", "sand"),
    LedgerAccount("W_radiated_J", "radiated", "yellow"),
    LedgerAccount("W_damping_J", "damping", "night"),
    LedgerAccount("W_closing_J", "contact closing", "grey"),
)
"""Accounts of history.csv from the bottom of a figure to its top; gravity and the residual are no areas."""
