"""How far the reduced model's effect of vibration is known to be off, beside the finite elements.

The costs that ship with the package hold, for each measured set, the finite elements on their coarsest mesh
with vibration and without it; the reduced model runs beside them. The change of e by vibration is
therefore known of both.
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
from fem_impact.outcome.keys import known, or_none
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
LIKE = log(1.5)
"""Largest difference of the logarithms of T1/tau between a scene and a set whose error counts for it."""


@dataclass(frozen=True, slots=True)
class ModelDiscrepancy:
    """One scene by both models: the change of e by vibration, and shares of E_0 by `COMPARED`."""

    name: str
    scene: Scene
    modal: float
    solid: float
    shares_modal: Mapping[str, float]
    shares_solid: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class KnownError:
    """Largest error of the reduced model over comparable scenes.

    Attributes
    ----------
    change_of_e : of the change of e by vibration
    shares : of shares of E_0, by `COMPARED`
    compared : the scenes whose errors these are
    alike : whether these scenes have a near T1/tau and the same materials; else they are all there are
    """

    change_of_e: float
    shares: Mapping[str, float]
    compared: tuple[str, ...]
    alike: bool

    @property
    def sentence(self) -> str:
        """Say the error and what it was found on."""
        scenes = ", ".join(self.compared)
        which = (
            f"scenes of like T1/tau ({scenes})"
            if self.alike
            else f"all scenes that were computed both ways ({scenes}), none "
            "of which has a like T1/tau and these materials"
        )
        return (
            f"Beside the finite elements the reduced model's change of e by vibration is off by up to "
            f"{self.change_of_e:.2g}, its E_vib by up to {self.shares['vibration']:.2g} of E_0, over {which}."
        )


def known_error(scene: Scene) -> KnownError:
    """Return how far the reduced model may be off for a scene."""
    ratio = screening(Case(scene).bodies).ratio
    same = [name for name in stored() if _materials(_stored(name)) == _materials(scene)]
    near = [name for name in same if abs(log(screening(Case(_stored(name)).bodies).ratio / ratio)) <= LIKE]
    counted = [discrepancy(name) for name in near or stored()]
    return KnownError(
        max(abs(one.modal - one.solid) for one in counted),
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
    stiff = next(one for one in settings if one["name"].endswith("without vibration"))["value"]
    meshes = [one for one in settings if one["kind"] == "mesh"]
    coarse = max(meshes, key=lambda one: one["tip_size_m"])["value"]
    fine = min(meshes, key=lambda one: one["tip_size_m"])["value"]
    whole, twin = (simulate(one, "modal") for one in (scene, twins(scene)[1]))
    return ModelDiscrepancy(
        name,
        scene,
        known(whole.restitution.edge.e) - known(twin.restitution.edge.e),
        coarse["e"] - stiff["e"],
        {name: or_none(getattr(whole.energy, name)) or 0.0 for name in COMPARED},
        {name: of(fine) for name, of in COMPARED.items()},
    )
