"""Which effects a scene calls for: each number against its threshold, and what the scene forces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from math import isfinite
from typing import TYPE_CHECKING

from fem_impact.case.effects.registry import AUTO, BARRIERS, EFFECTS, NAMES, check_effects, grounded
from fem_impact.case.effects.slots import Harm, quick_impact
from fem_impact.case.measured import expected_shares
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import EffectChoice
from fem_impact.physics.beam_impact import BeamImpact
from fem_impact.physics.contact import approach, arms

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


SLOWEST = 1e-6  # m/s, of the contact point: below it nothing is computed
UNFELT = ("contact-heating",)  # what the motion does not feel is watched or not, never missed


@dataclass(frozen=True, slots=True)
class Choice:
    """What was decided about one effect.

    Attributes
    ----------
    on : it is in the model; forced : because the scene says so, or out of it for that reason
    needed : its number is above its threshold and what it needs is there
    number : the dimensionless number; harm : what leaving it out changes
    share : of the run time, about; None where it is off
    """

    name: str
    on: bool
    forced: bool
    needed: bool
    number: float
    harm: Harm
    share: float | None

    def told(self, share: float | None) -> EffectChoice:
        """Return the choice as an outcome holds it, with its share of the run time."""
        effect = EFFECTS[self.name]
        return EffectChoice(
            name=self.name,
            on=self.on,
            forced=self.forced,
            needed=self.needed,
            measure=effect.measure,
            number=self.number if isfinite(self.number) else None,
            threshold=effect.threshold,
            source=effect.source,
            change_of_e=self.harm.e,
            change_of_vibration=self.harm.E_vib,
            sentence=effect.sentence if self.on else effect.absence,
            share=share,
        )


def _require_approach(scene: Scene) -> None:
    """Refuse a spin that takes the lowest point away from the barrier as the rod comes down (SceneError)."""
    speed = approach(scene)
    if speed < SLOWEST:
        raise SceneError(
            f"lifts the contact point off the barrier at {max(-speed, 0.0):.3g} m/s: "
            "another part would strike.",
            key="impact.omega",
            value=f"{scene.impact.omega:.3g} rad/s",
            remedy=f"Keep it under {abs(scene.relative.v_n / arms(scene)[0]):.4g} rad/s, or turn it round.",
        )


def active(scene: Scene) -> tuple[str, ...]:
    """Return the effects in the model of a scene, in the order in which they enter it.

    Raises
    ------
    SceneError
        If the scene names an effect that is none, none or two barriers, or one without what it needs, or if
        the contact point does not come towards the barrier: the numbers of the effects are of an approach.
    """
    _require_approach(scene)
    check_effects(scene.effects)
    on = decided(scene)[2] if AUTO in scene.effects else set(scene.effects)
    return tuple(name for name in NAMES if name in on)


def resolved(scene: Scene) -> Scene:
    """Return the scene with the list of the effects in its model instead of what it states of them."""
    return replace(scene, effects=active(scene))


def choices(scene: Scene) -> tuple[Choice, ...]:
    """Decide every effect of a scene."""
    number, needed, on = decided(scene)
    forced, share = {name for name in NAMES if _forced(name, scene)}, expected_shares(on)
    return tuple(
        Choice(
            *(name, name in on, name in forced, name in needed, number[name]),
            *(_harm(everything(scene), name), share.get(name)),
        )
        for name in NAMES
    )


@cache
def decided(scene: Scene) -> tuple[dict[str, float], set[str], set[str]]:
    """Return the number of each effect, the effects that are needed, and those that are on."""
    whole = everything(scene)
    number = {name: effect.number(whole) for name, effect in EFFECTS.items()}
    needed = _grounded({name for name in NAMES if number[name] > EFFECTS[name].threshold})
    return number, needed, _grounded(_chosen(scene, needed))


def _harm(whole: Scene, name: str) -> Harm:
    told = EFFECTS[name].harm
    return told(whole) if told else left_out(whole, name)


def neglected(scene: Scene) -> tuple[str, ...]:
    """Return a sentence for each effect that the scene forces off although it matters."""
    barrier = next(BARRIERS.index(name) for name in active(scene) if name in BARRIERS)
    missed = [
        choice
        for choice in choices(scene)
        if choice.needed and not choice.on and choice.name not in BARRIERS[: barrier + 1]
    ]
    return tuple(_warning(choice) for choice in missed if choice.name not in UNFELT)


def everything(scene: Scene) -> Scene:
    """Return the scene with all effects on that it does not force off; one that lists them stays as it is."""
    if AUTO not in scene.effects:
        return resolved(scene)
    barrier = next((name for name in scene.effects if name in BARRIERS), BARRIERS[-1])
    off = {name for name in NAMES if f"-{name}" in scene.effects}
    wanted = set(NAMES) - set(BARRIERS) - off | {barrier}
    return replace(scene, effects=tuple(_with_grounds(wanted)))


def _chosen(scene: Scene, needed: set[str]) -> set[str]:
    if AUTO not in scene.effects:
        return set(scene.effects)
    off = {name for name in NAMES if f"-{name}" in scene.effects}
    wanted = (needed | set(scene.effects)) - off - {AUTO}
    barrier = next((name for name in scene.effects if name in BARRIERS), None)
    return wanted - set(BARRIERS) | {barrier or next(name for name in reversed(BARRIERS) if name in needed)}


def _grounded(wanted: set[str]) -> set[str]:
    """Keep the strongest barrier, a rigid one for want of others, and drop what has no ground."""
    barrier = next((name for name in reversed(BARRIERS) if name in wanted), BARRIERS[0])
    return set(_with_grounds(wanted - set(BARRIERS) | {barrier}))


def _with_grounds(wanted: set[str]) -> list[str]:
    return grounded([name for name in NAMES if name in wanted])


def _forced(name: str, scene: Scene) -> bool:
    if AUTO not in scene.effects:
        return True
    barrier = name in BARRIERS and any(b in scene.effects for b in BARRIERS)
    return barrier or name in scene.effects or f"-{name}" in scene.effects


def _warning(choice: Choice) -> str:
    effect, harm = EFFECTS[choice.name], choice.harm
    parts = [f"e may be off by about {harm.e:.1g}"] if round(harm.e, 6) else []
    parts += [f"E_vib may be off by about {harm.E_vib:.1g} of E_0"] if round(harm.E_vib, 6) else []
    return (
        f"{choice.name} is left out by the scene although {effect.measure} is {choice.number:.2g}, above "
        f"{effect.threshold:g}{': ' if parts else ''}{', '.join(parts)}."
    )


def left_out(scene: Scene, name: str) -> Harm:
    """Return how a strike changes when an effect is left out; a barrier gives way to the next weaker one."""
    barrier = name in BARRIERS
    others = [other for other in active(scene) if other != name and not (barrier and other in BARRIERS)]
    weaker = [BARRIERS[BARRIERS.index(name) - 1]] if barrier else []
    whole, less = (_struck(scene, [*others, *names]) for names in ([name], weaker))
    return Harm(min(abs(less.e - whole.e), 1.0), min(abs(less.E_vib - whole.E_vib), 1.0))


def _struck(scene: Scene, effects: list[str]) -> BeamImpact:
    return quick_impact(replace(scene, effects=tuple(grounded(effects))))
