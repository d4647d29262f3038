"""Shares of E_0 after an impact and accounts of the energy ledger over time, with labels and colours."""

from dataclasses import dataclass
from typing import Literal

from fem_impact.outcome.groups import Energy
from fem_impact.outcome.keys import Key, Num, Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.tables.text import plain

Place = Literal["terminal", "figure", "comparison", "report", "study"]
"""Where shares are listed: the terminal, the figures of runs, the comparison of model and measurement, the
HTML report, and the tables of a study."""


@dataclass(frozen=True, slots=True)
class EnergyShare:
    """One share of E_0.

    Attributes
    ----------
    key : key of its value in an outcome, with unit and meaning
    label : name in tables and figures
    colour : name of a colour in the palette of the figures
    shown : the places that list it
    """

    key: Key
    label: str
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


def _share(name: str, label: str, colour: str, *shown: Place) -> EnergyShare:
    always: tuple[Place, ...] = ("terminal", "report")
    return EnergyShare(KEY_TABLE[f"{name}_over_E_0"], label, colour, frozenset({*always, *shown}))


SHARES = (
    _share("E_r", "rigid motion", "blue", "figure", "study"),
    _share("E_vib", "vibration", "night", "figure", "comparison", "study"),
    _share("W_friction", "friction", "green", "figure", "comparison", "study"),
    _share("E_plastic_rod", "plastic rod", "purple", "figure", "comparison", "study"),
    _share("E_plastic_barrier", "plastic barrier", "vermilion", "figure", "comparison", "study"),
    _share("E_locked_rod", "energy locked in rod", "sky", "figure", "comparison"),
    _share("E_locked_barrier", "energy locked in barrier", "orange", "figure", "comparison"),
    _share("W_radiated", "radiated", "yellow", "figure", "comparison"),
    _share("W_plate", "bending of the plate", "brown", "figure"),
    _share("E_barrier", "motion of the barrier", "olive", "figure"),
    _share("W_contact_dissipation", "numerical loss at contact", "grey", "figure"),
    _share("W_damping", "damping", "sand", "figure"),
    _share("E_contact", "held by the contact", "grey"),
)
"""All shares, in the order of tables and figures. They add up to one and `ADDED`."""
IF_ON = ("damping", "contact", "plate", "barrier")
"""Shares that are left out where they are not known: their effects are off."""
ADDED = _share("W_gravity", "added by gravity", "grey")
"""Work of gravity: no share that E_0 goes to, but energy that comes to it."""


def shares(place: Place) -> tuple[EnergyShare, ...]:
    """Return the shares that a place lists."""
    return tuple(share for share in SHARES if place in share.shown)


ABOVE = "vibration above its modes"
"""Label of what stands beside the vibration where its modes do not hold all of it."""
_SEEN = 5e-4
"""Least share that is listed of it."""


def above_modes(energy: Energy) -> float:
    """Return the share of E_0 that vibrates above the modes, 0 where it is not known or hardly any.

    Without it the shares do not add up: E_vib counts the modes alone.
    """
    modes, whole = or_none(energy.vibration), or_none(energy.vibration_check)
    above = 0.0 if modes is None or whole is None else whole - modes
    return above if above > _SEEN else 0.0


HEATS = KEY_TABLE["W_skin_over_E_0"]
"""Work that can heat the contact: friction, and the plastic work near both surfaces."""

WORKS = "W_friction", "E_plastic_rod", "E_plastic_barrier"


def heat_ends(outcome: Outcome) -> str:
    """Say between what `HEATS` lies where it has no half-width: friction, and that with all plastic work.

    Nothing where it is not known or has one, or where friction has none either.
    """
    skin, half = outcome.estimate(HEATS)
    return "" if half is not None or isinstance(skin, Unknown) else work_ends(outcome)


def work_ends(outcome: Outcome) -> str:
    """Say the same wherever friction has a half-width, nothing elsewhere."""
    (rubbed, half_rubbed), *flowed = (outcome.estimate(f"{name}_over_E_0") for name in WORKS)
    if half_rubbed is None or isinstance(rubbed, Unknown):
        return ""
    high = rubbed + half_rubbed + sum((or_none(work) or 0.0) + (error or 0.0) for work, error in flowed)
    others = [share.key for share in SHARES if share.key.name.removesuffix("_over_E_0") not in WORKS]
    kept = sum(
        max((or_none(value) or 0.0) - error, 0.0)
        for value, error in map(outcome.estimate, others)
        if error is not None
    )
    left = 1.0 + max(or_none(outcome.energy.gravity) or 0.0, 0.0) - kept
    least, greatest = (plain(100 * end, 2) for end in (max(rubbed - half_rubbed, 0.0), min(high, left)))
    return (
        f"it lies between {least} % (friction) and {greatest} % (friction and all plastic work, or what "
        "other shares leave), errors included"
    )


@dataclass(frozen=True, slots=True)
class LedgerAccount:
    """One account of the energy ledger over time: column of history.csv (J), label, name of its colour."""

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
    LedgerAccount("W_contact_dissipation_J", "numerical loss at contact", "grey"),
)
"""Accounts of history.csv from bottom to top of the stacked figure, without gravity and the residual."""

OF_SOME = (
    LedgerAccount("W_plate_J", "bending of the plate", "brown"),
    LedgerAccount("E_contact_J", "held by the contact", "ink"),
)
"""Accounts that history.csv has only of runs with their effect, or of the reduced model."""
