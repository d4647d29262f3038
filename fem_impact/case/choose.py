"""Which effects a scene calls for: each number against its threshold, and what the scene forces."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.registry import ADDED, AUTO, BARRIERS, EFFECTS, NAMES, with_prerequisites
from fem_impact.case.measured import expected_shares
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import EffectChoice
from fem_impact.scene.types import Scene

SLOWEST = 1e-6  # m/s, of the contact point: below it nothing is computed
UNFELT = ("contact-heating",)  # what the motion does not feel is watched or not, never missed


@dataclass(frozen=True, slots=True)
class Decision:
    """The number of each effect, and the names of those that are needed and of those in force."""

    number: dict[str, float]
    needed: set[str]
    on: set[str]


def require_approach(bodies: Bodies) -> None:
    """Refuse a spin that takes the lowest point away from the barrier as the rod comes down (SceneError)."""
    pair = bodies.contact
    if pair.approach < SLOWEST:
        side = "under" if pair.arms[0] > 0 else "above"
        raise SceneError(
            f"lifts the contact point off the barrier at {max(-pair.approach, 0.0):.3g} m/s: "
            "another part would strike.",
            key="impact.omega",
            value=f"{bodies.scene.impact.omega:.3g} rad/s",
            remedy=f"Keep it {side} {-pair.v_n / pair.arms[0]:.4g} rad/s, or turn it round.",
        )


def all_effects(scene_effects: Sequence[str]) -> tuple[str, ...]:
    """Return all effects but those that a scene forces off; those of a scene that lists them are its own."""
    if AUTO not in scene_effects:
        return tuple(name for name in NAMES if name in scene_effects)
    barrier = next((name for name in scene_effects if name in BARRIERS), BARRIERS[-1])
    return _with_barrier(set(_weighed(scene_effects)) - _forced_off(scene_effects), barrier)


def decide(whole: Bodies) -> Decision:
    """Return what is decided of the effects of a scene, from bodies with `all_effects` in force."""
    scene_effects = whole.scene.effects
    number = {name: EFFECTS[name].number(whole) for name in _weighed(scene_effects)}
    above = {name for name in number if number[name] > EFFECTS[name].threshold}
    strongest = next((name for name in reversed(BARRIERS) if name in above), BARRIERS[0])
    needed = set(_with_barrier(above, strongest))
    if AUTO not in scene_effects:
        return Decision(number, needed, set(scene_effects))
    wanted = (needed | set(scene_effects)) - _forced_off(scene_effects) - {AUTO}
    barrier = next((name for name in scene_effects if name in BARRIERS), strongest)
    return Decision(number, needed, set(_with_barrier(wanted, barrier)))


def choices(scene: Scene, decision: Decision) -> tuple[EffectChoice, ...]:
    """Return each effect with its number, threshold and source, and about its share of the run time."""
    share = expected_shares(decision.on)
    return tuple(
        EffectChoice(
            name=name,
            on=name in decision.on,
            forced=_is_forced(name, scene.effects),
            needed=name in decision.needed,
            measure=effect.measure,
            number=decision.number[name] if isfinite(decision.number[name]) else None,
            threshold=effect.threshold,
            source=effect.source,
            sentence=effect.sentence if name in decision.on else effect.absence,
            share=share.get(name),
        )
        for name, effect in ((name, EFFECTS[name]) for name in decision.number)
    )


def neglected(choices: Sequence[EffectChoice]) -> tuple[str, ...]:
    """Return a sentence for each effect that the scene forces off although it matters."""
    in_force = {choice.name for choice in choices if choice.on}
    weaker = BARRIERS[: 1 + next(at for at, name in enumerate(BARRIERS) if name in in_force)]
    return tuple(
        f"{choice.name} is left out by the scene although {choice.measure} is "
        f"{inf if choice.number is None else choice.number:.2g}, above {choice.threshold:g}."
        for choice in choices
        if choice.needed and not choice.on and choice.name not in (*weaker, *UNFELT)
    )


def _weighed(scene_effects: Sequence[str]) -> list[str]:
    """Return the effects of the program, and those of other packages that the scene names."""
    return [name for name in NAMES if name not in ADDED or name in scene_effects]


def _forced_off(scene_effects: Sequence[str]) -> set[str]:
    return {name for name in NAMES if f"-{name}" in scene_effects}


def _with_barrier(wanted: set[str], barrier: str) -> tuple[str, ...]:
    """Return effects in order, with this barrier alone and without what lacks its prerequisites."""
    names = wanted - set(BARRIERS) | {barrier}
    return tuple(with_prerequisites([name for name in NAMES if name in names]))


def _is_forced(name: str, scene_effects: Sequence[str]) -> bool:
    if AUTO not in scene_effects:
        return True
    barrier = name in BARRIERS and any(b in scene_effects for b in BARRIERS)
    return barrier or name in scene_effects or f"-{name}" in scene_effects
