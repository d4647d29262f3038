"""The verdict on a sequence of strikes: may rigid theory be used for it, and for the hardest strike."""

from __future__ import annotations

from dataclasses import replace

from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.strikes import StrikeRecord, Strikes
from fem_impact.run.simulate import simulate
from fem_impact.scene.strikes import Following
from fem_impact.scene.types import Scene


def sequence_verdict(scene: Scene, tolerance: float) -> list[str]:
    """Return sentences: rigid theory beside the reduced model in the hardest strike and in all of them.

    ``tolerance`` is the share of a speed and of E_0 that may be neglected.

    Raises
    ------
    SceneError
        A model cannot compute the scene.
    """
    plain = replace(scene, strikes=replace(scene.strikes, fidelity=Following().fidelity))
    rigid, modal = (simulate(plain, fidelity).strikes for fidelity in ("rigid", "modal"))
    for strikes in (rigid, modal):
        if isinstance(strikes.each, Unknown):
            return [f"The sequence is not known: {strikes.each.reason}."]
    number = known(modal.hardest_energy)
    hardest = _hardest(rigid, modal, number, tolerance)
    whole = hardest and _same_books(rigid, modal, tolerance)
    return [
        f"{_answer(hardest)}: rigid theory for the hardest strike, number {number} by the reduced model: "
        f"{_struck(known(modal.each)[number - 1])}; by rigid theory {_at(known(rigid.each), number)}.",
        f"{_answer(whole)}: rigid theory for the whole sequence, which loses {_lost(modal)} by the reduced "
        f"model and {_lost(rigid)} by rigid theory (allowed: {tolerance:g} of a speed and of E_0).",
        _other_end(rigid, modal),
    ]


def _answer(holds: bool) -> str:
    return "YES" if holds else "NO"


def _hardest(rigid: Strikes, modal: Strikes, number: int, tolerance: float) -> bool:
    """Return whether both agree in a strike of a number, and in what strikes until then."""
    ours, theirs = known(rigid.each)[:number], known(modal.each)[:number]
    if [one.part for one in ours] != [one.part for one in theirs]:
        return False
    speed = abs(ours[-1].approach - theirs[-1].approach) <= tolerance * theirs[-1].approach
    return speed and abs(ours[-1].lost - theirs[-1].lost) <= tolerance * theirs[0].before


def _same_books(rigid: Strikes, modal: Strikes, tolerance: float) -> bool:
    """Return whether both lose as much by friction and in all."""
    E_0 = known(modal.each)[0].before
    pairs = ((known(one.friction), _all_lost(one)) for one in (rigid, modal))
    return all(abs(a - b) <= tolerance * E_0 for a, b in zip(*pairs, strict=True))


def _all_lost(strikes: Strikes) -> float:
    return sum(known(part) for part in (strikes.friction, strikes.plastic, strikes.damping, strikes.settled))


def _struck(one: StrikeRecord) -> str:
    return f"the {one.part} at {one.approach:.3g} m/s, which takes {one.lost:.3g} J"


def _at(each: tuple[StrikeRecord, ...], number: int) -> str:
    return _struck(each[number - 1]) if len(each) >= number else "there is no such strike"


def _lost(strikes: Strikes) -> str:
    return f"{_all_lost(strikes):.3g} J, {known(strikes.friction):.3g} J of it by friction"


def _other_end(rigid: Strikes, modal: Strikes) -> str:
    """Return how much faster the other end strikes than the first end did, by both."""
    ratios = (rigid.other_end, modal.other_end)
    ours, theirs = ("not by itself" if isinstance(one, Unknown) else f"{one:.3g} times" for one in ratios)
    return (
        f"The other end strikes {theirs} as fast as the first strike came by the reduced model, by rigid "
        f"theory {ours}."
    )
