"""How far the reduced model's effect of vibration is known to be off, beside the finite elements.

The costs that ship with the package hold, for each measured set, the levels of a default run with vibration
and without it; the reduced model runs beside them. The change by vibration is therefore known of both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import log
from statistics import median
from typing import TYPE_CHECKING

from fem_impact.answers.verdict.screening import screening
from fem_impact.answers.verdict.twins import twins
from fem_impact.case.case import Case
from fem_impact.case.measured import summary
from fem_impact.outcome.keys import Key, known
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


CHANGED: Mapping[str, tuple[Key, Mapping[str, float]]] = {
    "e": (KEY_TABLE["e_edge"], {"e": 1.0}),
    "energy": (KEY_TABLE["E_r_over_E_0"], {"E_lt": -1.0, "E_ln": -1.0}),
    "friction": (KEY_TABLE["W_friction_over_E_0"], {"friction": 1.0}),
}
"""Numbers whose change by vibration is judged: their keys, and the stored numbers of which they are sums."""
LIKE = log(1.5)
"""Largest difference of the logarithms of T1/tau between a scene and a set whose error counts for it."""


@dataclass(frozen=True, slots=True)
class ModelDiscrepancy:
    """One scene by both models, its numbers by the names of `CHANGED`.

    Attributes
    ----------
    modal, solid : changes by vibration
    band : half-width of the finite elements' number with vibration
    """

    name: str
    modal: Mapping[str, float]
    solid: Mapping[str, float]
    band: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class KnownError:
    """Largest error of the reduced model over comparable scenes, no less than finite elements have there.

    Twins on one mesh share most of that error, so that the middle of the scenes' bands counts.

    Attributes
    ----------
    changes : of the changes by vibration, by `CHANGED`
    compared : the scenes whose errors these are
    alike : whether these scenes have a near T1/tau and the same materials; else they are all there are
    """

    changes: Mapping[str, float]
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
            f"Beside the finite elements, whose own band counts, the reduced model's change of {of} by "
            f"vibration is off by up to {self.changes[of]:.2g} over {which}."
        )


def known_error(scene: Scene) -> KnownError:
    """Return how far the reduced model may be off for a scene."""
    ratio = screening(Case(scene).bodies).ratio
    same = [name for name in stored() if _materials(_stored(name)) == _materials(scene)]
    near = [name for name in same if abs(log(screening(Case(_stored(name)).bodies).ratio / ratio)) <= LIKE]
    counted = [discrepancy(name) for name in near or stored()]
    return KnownError(
        {of: _largest(counted, of) for of in CHANGED},
        tuple(one.name for one in counted),
        bool(near),
    )


def _largest(scenes: Sequence[ModelDiscrepancy], of: str) -> float:
    """Return the largest difference of both models in a change, at least the middle band."""
    off = max(abs(one.modal[of] - one.solid[of]) for one in scenes)
    return max(off, median(one.band[of] for one in scenes))


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
    run = next(one for one in settings if one["default"])
    whole, twin = (simulate(one, "modal") for one in (scene, twins(scene)[1]))

    def stored_sum(of: str, number: Callable[[str], float]) -> float:
        return sum(weight * number(part) for part, weight in CHANGED[of][1].items())

    return ModelDiscrepancy(
        name,
        {of: float(known(key.of(whole)) - known(key.of(twin))) for of, (key, _) in CHANGED.items()},
        {of: stored_sum(of, lambda part: run["value"][part] - stiff[part]) for of in CHANGED},
        {
            of: abs(stored_sum(of, lambda part: run["error"][part] * abs(run["value"][part])))
            for of in CHANGED
        },
    )
