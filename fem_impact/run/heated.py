"""The heat of the contact, and the temperature that no spot exceeds."""

from dataclasses import replace
from math import inf

import numpy as np

from fem_impact.case.case import Case
from fem_impact.case.effects.heating import halves
from fem_impact.outcome.groups import Heat
from fem_impact.outcome.keys import Num, Unknown
from fem_impact.physics.flash import Flash, flash_bound
from fem_impact.physics.plate import contact_time
from fem_impact.scene.inputs import first_melting, melting
from fem_impact.scene.types import Scene

HARD = "neither body yields, so that no hardness limits the pressure of a touching spot"
LEAST, MELTS = "at least", "melt; melting is left out"
"""Begin and end of the reason of a temperature beyond a melting point."""


def heat(
    case: Case,
    flash: Flash,
    power: float,
    flux: float,
    patch: float,
    less_vibration: Num,
    fastest: float = 0.0,
) -> Heat:
    """Return the heat of the contact: peaks of power, W, flux, W/m2, and patch, m2, of the whole contact.

    ``fastest`` is the highest sliding speed, m/s, that was computed.
    """
    ambient, ignition = case.scene.heating.ambient, case.scene.heating.ignition
    temperature = below_melting(case.scene, ambient + flash.peak, LEAST + " {limit:.0f} K; ")
    return Heat(
        patch=patch,
        power=power,
        flux=flux,
        rise=temperature if isinstance(temperature, Unknown) else flash.peak,
        temperature=temperature,
        ignition=ignition,
        time_above_ignition=flash.time_above(ignition - ambient),
        bound=_bound(case, ambient, float(np.ptp(flash.t)), fastest),
        less_vibration=less_vibration,
    )


def beyond_melting(temperature: Num) -> bool:
    """Say whether a temperature is not known because a body melts."""
    return isinstance(temperature, Unknown) and temperature.reason.endswith(MELTS)


def open_melting(told: Heat) -> Heat:
    """Return a heat whose error leaves open whether a body melts: a melting point is not its least."""

    def without(value: Num) -> Num:
        sure = isinstance(value, Unknown) and beyond_melting(value) and value.reason.startswith(LEAST)
        return Unknown(value.reason.partition("; ")[2]) if isinstance(value, Unknown) and sure else value

    return replace(told, rise=without(told.rise), temperature=without(told.temperature))


def _bound(case: Case, ambient: float, lasted: float, fastest: float) -> Num:
    """Return the temperature, K, that no spot exceeds; without both melting points none can be told.

    It counts no less than the time, s, and the speed, m/s, that were computed, three contact times on a plate
    that bends, and the first period of bending, in which a slender body strikes again.
    """
    over = case.slots.friction_over_speed
    largest = case.bodies.friction * (max(over[1]) if over else 1.0)
    on_plate = 3 * contact_time(case.contact) if case.slots.plate else 0.0
    seconds = max(lasted, on_plate, case.bodies.bending_period)
    rise = flash_bound(case.contact, largest, halves(case.bodies), seconds, fastest)
    known_of = melting(case.scene)
    unstated = [f"heating.{body}_melting" for body in ("rod", "barrier") if body not in known_of]
    if rise == inf:
        return Unknown(HARD)
    if unstated:
        missing = " and ".join(unstated)
        return Unknown(
            f"not resolved: conduction of heat alone has no end where a body melts; state {missing}"
        )
    return below_melting(case.scene, ambient + rise)


def below_melting(scene: Scene, temperature: float, known: str = "") -> Num:
    """Return a temperature of the contact, K; it is not known where a body melts: latent heat is left out.

    ``known`` is what is said of it then, of the melting point ``limit``.
    """
    lowest, name = first_melting(scene)
    if temperature < lowest:
        return temperature
    return Unknown(
        f"{known.format(limit=lowest)}not resolved: conduction of heat alone gives {temperature:.0f} K, "
        f"above {lowest:.0f} K, where {name} begins to {MELTS}"
    )
