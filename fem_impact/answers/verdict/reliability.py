"""How far the reduced model's effect of vibration is known to be off, beside the finite elements.

The costs that ship with the package hold, for each measured set, the levels of a default run with vibration
and without it; the reduced model runs beside them. The change of e by vibration is therefore known of both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import log
from typing import TYPE_CHECKING

from fem_impact.answers.verdict.screening import screening
from fem_impact.answers.verdict.twins import twins
from fem_impact.case.case import Case
from fem_impact.case.measured import summary
from fem_impact.outcome.keys import Key, known, or_none
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


COMPARED: Mapping[str, Callable[[Mapping[str, float]], float]] = {
    "vibration": lambda stored: stored["E_vib"],
    "rigid": lambda stored: 1.0 - stored["E_lt"] - stored["E_ln"],
    "friction": lambda stored: stored["friction"],
    "plastic": lambda stored: stored["plastic"],
}
"""Shares of E_0, by their names in an outcome's energy, from the stored values of the finite elements."""
CHANGED: Mapping[str, tuple[Key, Callable[[Mapping[str, float]], float]]] = {
    "e": (KEY_TABLE["e_edge"], lambda stored: stored["e"]),
    "energy": (KEY_TABLE["E_r_over_E_0"], COMPARED["rigid"]),
    "friction": (KEY_TABLE["W_friction_over_E_0"], COMPARED["friction"]),
}
"""Numbers whose change by vibration is judged: their keys, and their stored values by finite elements."""
LIKE = log(1.5)
"""Largest difference of the logarithms of T1/tau between a scene and a set whose error counts for it."""


@dataclass(frozen=True, slots=True)
class ModelDiscrepancy:
    """One scene by both models: changes by vibration, by the names of `CHANGED`, and shares by `COMPARED`."""

    name: str
    scene: Scene
    modal: Mapping[str, float]
    solid: Mapping[str, float]
    shares_modal: Mapping[str, float]
    shares_solid: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class KnownError:
    """Largest error of the reduced model over comparable scenes.

    Attributes
    ----------
    changes : of the changes by vibration, by `CHANGED`
    shares : of shares of E_0, by `COMPARED`
    compared : the scenes whose errors these are
    alike : whether these scenes have a near T1/tau and the same materials; else they are all there are
    """

    changes: Mapping[str, float]
    shares: Mapping[str, float]
    compared: tuple[str, ...]
    alike: bool

    def sentence(self, of: str) -> str:
        """Say the error of the change of a number and what it was found on."""
        scenes = ", ".join(self.compared)
        which = (
            f"scenes of like T1/tau ({scenes})"
            if self.alike
            else f"all scenes that were computed both ways ({scenes}), none "
            "of which has a like T1/tau and these materials"
        )
        return (
            f"Beside the finite elements the reduced model's change of {of} by vibration is off by up to "
            f"{self.changes[of]:.2g}, its E_vib by up to {self.shares['vibration']:.2g} of E_0, over {which}."
        )


def known_error(scene: Scene) -> KnownError:
    """Return how far the reduced model may be off for a scene."""
    ratio = screening(Case(scene).bodies).ratio
    same = [name for name in stored() if _materials(_stored(name)) == _materials(scene)]
    near = [name for name in same if abs(log(screening(Case(_stored(name)).bodies).ratio / ratio)) <= LIKE]
    counted = [discrepancy(name) for name in near or stored()]
    return KnownError(
        {of: max(abs(one.modal[of] - one.solid[of]) for one in counted) for of in CHANGED},
        {
            name: max(abs(one.shares_modal[name] - one.shares_solid[name]) for one in counted)
            for name in COMPARED
        },
        tuple(one.name for one in counted),
        bool(near),
    )


def _materials(scene: Scene) -> list[tuple[object, ...]]:
    """Return what the reduced model takes of both materials."""
    both = scene.projectile.material, scene.barrier.material
    return [(m.E, m.nu, m.rho, m.yield_stress, m.ultimate_stress, m.plastic_modulus, m.flow) for m in both]


def stored() -> tuple[str, ...]:
    """Return the names of the scenes that are stored with both models."""
    return tuple(summary()["scenes"])


@cache
def _stored(name: str) -> Scene:
    return read_dict(summary()["scenes"][name]["scene"])


@cache
def discrepancy(name: str) -> ModelDiscrepancy:
    """Return a stored scene computed by both models."""
    scene, settings = _stored(name), summary()["scenes"][name]["settings"]
    stiff = next(one for one in settings if one["name"] == "default run without vibration")["value"]
    solid = next(one for one in settings if one["default"])["value"]
    whole, twin = (simulate(one, "modal") for one in (scene, twins(scene)[1]))
    return ModelDiscrepancy(
        name,
        scene,
        {of: float(known(key.of(whole)) - known(key.of(twin))) for of, (key, _) in CHANGED.items()},
        {of: value(solid) - value(stiff) for of, (_, value) in CHANGED.items()},
        {name: or_none(getattr(whole.energy, name)) or 0.0 for name in COMPARED},
        {name: of(solid) for name, of in COMPARED.items()},
    )
