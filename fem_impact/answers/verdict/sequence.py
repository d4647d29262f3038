"""The verdict on a sequence of strikes: may rigid theory be used for it, and for the hardest strike."""

from dataclasses import replace

from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.strikes import StrikeRecord, Strikes
from fem_impact.run.simulate import simulate
from fem_impact.scene.impact import Following
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
    number, E_0 = known(modal.hardest_energy), known(modal.each)[0].before
    ours, theirs = (known(one.each)[:number] for one in (rigid, modal))
    hardest = [one.part for one in ours] == [one.part for one in theirs]
    if hardest:
        hardest = abs(ours[-1].approach - theirs[-1].approach) <= tolerance * theirs[-1].approach
        hardest &= abs(ours[-1].lost - theirs[-1].lost) <= tolerance * E_0
    lost = [(known(one.friction), _all_lost(one)) for one in (rigid, modal)]
    whole = hardest and all(abs(a - b) <= tolerance * E_0 for a, b in zip(*lost, strict=True))
    rigidly, by_modes = (f"{lost_all:.3g} J, {rubbed:.3g} J of it by friction" for rubbed, lost_all in lost)
    ratios = modal.other_end, rigid.other_end
    ends = ("not by itself" if isinstance(one, Unknown) else f"{one:.3g} times" for one in ratios)
    return [
        f"{_answer(hardest)}: rigid theory for the hardest strike, number {number} by the reduced model: "
        f"{_struck(theirs, number)}; by rigid theory {_struck(ours, number)}.",
        f"{_answer(whole)}: rigid theory for the whole sequence, which loses {by_modes} by the reduced "
        f"model and {rigidly} by rigid theory (allowed: {tolerance:g} of a speed and of E_0).",
        "The other end strikes {} as fast as the first strike came by the reduced model, by rigid theory "
        "{}.".format(*ends),
    ]


def _answer(holds: bool) -> str:
    return "YES" if holds else "NO"


def _all_lost(strikes: Strikes) -> float:
    return sum(known(part) for part in (strikes.friction, strikes.plastic, strikes.damping, strikes.settled))


def _struck(each: tuple[StrikeRecord, ...], number: int) -> str:
    if len(each) < number:
        return "there is no such strike"
    one = each[number - 1]
    return f"the {one.part} at {one.approach:.3g} m/s, which takes {one.lost:.3g} J"
