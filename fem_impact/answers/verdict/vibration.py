"""What leaving vibration out changes: one pair of twins, by the reduced model or by finite elements.

A scene stands beside its twin: the same contact under a rod that cannot vibrate, at any inclination. How far
the reduced model's change is off is known from scenes drawn at random that ran by both models as such pairs
(`fem_impact.case.measured.vibration_pairs`): the half-width of a change is found as that of a number, by
where the scene stands among the stored ones (`fem_impact.run.modal_error.Stored`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import cos, hypot, inf, sin
from typing import Literal

import numpy as np

from fem_impact.answers.refine import extrapolate, needed
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import NAMES, with_prerequisites
from fem_impact.case.measured import vibration_pairs
from fem_impact.case.plates import half_space_error, is_thin
from fem_impact.errors import SceneError
from fem_impact.outcome.keys import Key, Unknown, known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import SHARES
from fem_impact.run.modal_error import Stored, digs_in, farness, place_of, unit_of, unlike, widened_by
from fem_impact.run.simulate import simulate
from fem_impact.scene.types import Scene
from fem_impact.scene.units import format_quantity

CHANGED: Mapping[str, Key] = {
    "e": KEY_TABLE["e_edge"],
    "energy": KEY_TABLE["E_r_over_E_0"],
    "friction": KEY_TABLE["W_friction_over_E_0"],
}
"""Numbers whose change by vibration is judged, and their keys."""
LEAST = 0.02
"""Change below which errors no longer fall with it."""


def scale_of_change(change: float) -> float:
    """Return the scale of the error of a change by vibration: that change itself, at least `LEAST`."""
    return max(abs(change), LEAST)


def known_error(case: Case, whole: Outcome, of: str, change: float) -> tuple[float, tuple[str, ...]]:
    """Return the half-width of the reduced model's change of a number, and in what the scene is unlike all.

    Where an edge digs in as in no stored scene the motion itself is open, and no change of it is known.

    Parameters
    ----------
    case : of the scene
    whole : outcome by the reduced model, with vibration
    of : number of `CHANGED`
    change : of that number by vibration, to which the half-width is in proportion
    """
    at, table = place_of(case, whole), stored()
    half = inf
    if not (digs_in(whole) or isinstance(whole.half_widths, Unknown)):
        half = table.half_width(np.array(at), [*CHANGED].index(of), farness(at, whole, table))
        if of == "e":
            half *= widened_by(unit_of("V_n_m_per_s", whole), case.contact.approach)
    widest = 1 + abs(change)  # of numbers that lie between 0 and 1, and so their change between -1 and 1
    return min(half * scale_of_change(change), widest), unlike(at, whole, table)


def off_sentence(of: str, half: float, far: tuple[str, ...]) -> str:
    """Say what the half-width of a change is."""
    text = (
        f"The reduced model's change of {of} by vibration is off by less than {half:.2g} in nine of ten such "
        f"scenes, by {len(stored().places)} that finite elements computed as well."
    )
    return f"{text} None of them is like this one in {', '.join(far)}: it is wider." if far else text


# confidence of their half-widths: about a hundred scenes that know a change would make one of 0.9 wider by a
# quarter, where finite elements decide anyway
EVEN = 0.5


@cache
def stored() -> Stored:
    """Return the stored scenes; their errors are those of the changes, over `scale_of_change`."""
    return Stored.of(vibration_pairs(), (*CHANGED,), EVEN)


VIBRATION = "vibration"
UNFELT = "contact-heating"
"""It watches the motion, which does not feel it: the twin has no need of it."""


def twins(scene: Scene) -> tuple[Scene, Scene]:
    """Return the scene with a rod that vibrates, and the same scene with one that cannot.

    Both have the effects that the scene calls for; vibration is in the first one even where the scene would
    leave it out as small, because its size is the question. No field is kept of either, and the heat of the
    contact is followed in the first one alone.

    Raises
    ------
    SceneError
        A spin lifts the contact point off the barrier.
    """
    on = {*Case(scene).active, VIBRATION}
    free = tuple(name for name in NAMES if name in on)
    stiff = tuple(with_prerequisites([name for name in free if name not in (VIBRATION, UNFELT)]))
    plain = replace(scene, measured=None, save=replace(scene.save, frames=0))
    return replace(plain, effects=free), replace(plain, effects=stiff)


def inclined(scene: Scene, angle: float) -> Scene:
    """Return the scene at another inclination, rad: rod, velocity and fall are turned together.

    The velocity is that over the barrier. The spin stays, and so does how the rod stands to the vertical
    where the barrier's slope is stated.

    Raises
    ------
    SceneError
        The turned velocity points away from the barrier.
    """
    impact, seen, moving = scene.impact, scene.relative, scene.barrier
    speed, way = hypot(seen.v_n, seen.v_t), angle + seen.beside
    slope = None if impact.slope is None else impact.slope + angle - impact.angle
    v_n, v_t = -speed * cos(way), -speed * sin(way)
    if v_n >= 0.0:
        problem = "turns the fall so that it leads away from the barrier."
        raise SceneError(problem, key="impact.angle", value=format_quantity(angle, "angle"))
    v_n, v_t = v_n + moving.v_n, v_t + moving.v_t
    turned = replace(impact, angle=angle, v_n=v_n, v_t=v_t, height=None, speed=None, slope=slope)
    return replace(scene, impact=turned, measured=None)


REDUCED, MESHES = "the reduced model", "meshes of finite elements"
"""What a change of e rests on."""

COUNTS = (
    " The band of a share of the energy is at least {:.2g} % of E_0, by which two independent counts of the "
    "vibration (by modes and without them) or the energy balance of the finer mesh are off."
)

# of a number's own half-width, that of its change by vibration on levels has at least: two levels may agree
# by chance in the change alone. Of 156 changes (e, energy, friction) on 52 levels of 37 drawn scenes (seeds
# 20262801 and 20262802; one to three levels more) 142 lay within what the changes tell, 152 within this
SHARE = 0.1
# times so wide it is on two levels of which the coarser does not resolve its contact: nothing shows then that
# the change converges. Of 102 such changes 95 lay within 1 time, 100 within 2, of 120 on other levels 119
UNSHOWN = 2.0

RANGE = "the range of the values extrapolated with every order of convergence from 3/4 up"
ONCE = f"; the band is {extrapolate.ONE_RUN:g} times {RANGE}, as each mesh runs once,"
TWICE_AS_WIDE = f", all {UNSHOWN:g} times so wide, as the coarser of both does not resolve the contact"
TWICE = f", both at two places of the barrier's grid; the band is {RANGE} and the scatter by these,"

THIN_PLATE = (
    " The plate is thin beside the contact, and a half-space under it in this model: the {:.2g} by which e "
    "may be off is added."
)

CALLED: Mapping[str, str] = {
    "e": "e",
    "energy": "the energy that the body keeps, of E_0,",
    "friction": "the work of friction, of E_0,",
}
"""What the numbers of `CHANGED` are called in a sentence."""

Answer = Literal["yes", "no", "undecided"]
GradedAnswer = Literal["yes", "no", "probably yes", "probably no", "undecided"]
# of the half-width of a change, that which is taken for a probable answer. A fifth of the changes of e by the
# reduced model lie further off on one side (.447 by 101 stored ones, each told by the others); fewer do of
# its other numbers and on levels (.14 to .29). On levels of 44 drawn scenes (seeds 20262801 to 20262803),
# with limits of .01 to .1, one to three levels more confirm 150 of 158 probable answers and all 350 sure ones
PROBABLE = 0.45
WORST_FIRST: tuple[GradedAnswer, ...] = ("no", "probably no", "undecided", "probably yes", "yes")
PROBABLY: Mapping[Answer, GradedAnswer] = {"yes": "probably yes", "no": "probably no"}
"""Probable answers, by the sure one that the smaller half-width would give."""
Pair = tuple[Outcome, Outcome]
"""With vibration and without it, on the same mesh."""


@dataclass(frozen=True, slots=True)
class VibrationEffect:
    """The change of a number by vibration at one inclination.

    Attributes
    ----------
    of : which number, of `CHANGED`
    angle : rad
    value : the number with vibration less that of the twin that cannot vibrate
    band : half-width that should hold the error of ``value``
    E_vib, E_vib_band : energy of vibration over E_0, and its half-width
    free, stiff : the outcomes, of the finest mesh where there are several
    source : where value and band come from, as a sentence
    model : what all of it rests on
    errors : half-widths of shares of E_0, by their names in an outcome's energy, as far as they are known
    alike : whether scenes like this one were computed by the reduced model and finite elements, or finite
        elements computed this one
    heat : mean temperature of the patch, K, and its half-width, None where levels do not tell them
    """

    of: str
    angle: float
    value: float
    band: float
    E_vib: float
    E_vib_band: float
    free: Outcome
    stiff: Outcome
    source: str
    model: str
    errors: Mapping[str, float]
    alike: bool = True
    heat: tuple[float, float] | None = None

    def at_least(self, off: float) -> "VibrationEffect":
        """Return the change with a band no smaller than ``off``, an error that finite elements showed."""
        if off <= self.band:
            return self
        text = f"At the scene's own inclination it is off by {off:.2g}: so much counts at all others."
        return replace(self, band=off, source=f"{self.source} {text}")

    @property
    def is_known(self) -> bool:
        """Whether the band is smaller than the change of a number between 0 and 1 can be."""
        return self.band < 1.0

    @property
    def told(self) -> str:
        """Value and band as text."""
        if not self.is_known:
            half = f"the half-width told, {self.band:.2g}, holds every change there can be"
            return f"an amount that is not known: {half}"
        return f"{self.value:+.3f} ± {self.band:.3f}"

    def answer(self, tolerance: float) -> Answer:
        """Say whether rigid theory may be used if the number may be off by ``tolerance``."""
        if abs(self.value) - self.band > tolerance:
            return "no"
        return "yes" if abs(self.value) + self.band <= tolerance else "undecided"

    def graded(self, tolerance: float) -> GradedAnswer:
        """Return the answer, and where it is undecided the probable one: right in four of five such scenes.

        None is probable where the change is not known, or the scene unlike all that tell its error.
        """
        sure = self.answer(tolerance)
        if sure != "undecided" or not (self.alike and self.is_known):
            return sure
        return PROBABLY.get(replace(self, band=PROBABLE * self.band).answer(tolerance), sure)

    def holds_against(self, meshes: "VibrationEffect", tolerance: float) -> bool:
        """Say whether this stands beside finite elements that do not decide: they agree, and know less well.

        Only the widths choose between the two, so that what stands holds as often as it is told to.
        """
        agree = abs(self.value - meshes.value) <= self.band + meshes.band
        return self.alike and agree and self.band < meshes.band and meshes.answer(tolerance) == "undecided"

    def over(self, tolerance: float) -> float:
        """Return the band over the one with which there would be an answer."""
        margin = abs(tolerance - abs(self.value))
        return self.band / margin if margin else inf


def unfinished(pair: Pair, of: str = "e") -> str:
    """Return why a pair of twins says nothing of a number, empty where it does.

    A run that ended before another place strikes tells those of the impact before. One by the reduced model
    that does not know how wrong it is says nothing.
    """
    band = pair[0].validity.model_band
    if pair[0].provenance.fidelity == "modal" and isinstance(band, Unknown):
        return band.reason
    for run, which in zip(pair, ("with", "without"), strict=True):
        if isinstance(value := CHANGED[of].of(run), Unknown):
            return f"the run {which} vibration gives no {of}: {value.reason}"
    return ""


def modal_pair(scene: Scene) -> Pair:
    """Return the twins of a scene by the reduced model."""
    free, stiff = twins(scene.untargeted)
    return simulate(free, "modal"), simulate(stiff, "modal")


def modal_effect(scene: Scene, pair: Pair, of: str = "e") -> VibrationEffect:
    """Return what the reduced model says of the change of a number, with its known error.

    Shares of E_0 have the half-widths that the run itself tells. Where e changes less than mu does, its
    change passes through zero near the scene, and is as little known as that of mu is large.
    """
    value, case = difference(pair, of), Case(scene.untargeted, "modal")
    mu, stiff_mu = (or_none(one.restitution.mu) or 0.0 for one in pair)
    turned = abs(mu - stiff_mu) if of == "e" else 0.0
    half, far = known_error(case, pair[0], of, max(abs(value), turned))
    e = or_none(pair[0].restitution.edge.e)
    thin = half_space_error(case.bodies) * abs(1.0 if e is None else e) if is_thin(case.bodies) else 0.0
    halves = {share.key.path[-1]: pair[0].estimate(share.key)[1] for share in SHARES}
    shares = {name: half for name, half in halves.items() if half is not None}
    return VibrationEffect(
        of,
        scene.impact.angle,
        value,
        half + thin,
        known(pair[0].energy.vibration),
        shares["vibration"],
        *pair,
        off_sentence(of, half, far) + THIN_PLATE.format(thin) * bool(thin),
        REDUCED,
        shares,
        not far,
    )


def solid_effect(levels: Sequence[extrapolate.MeshRuns], of: str = "e") -> VibrationEffect | None:
    """Return what finite elements say on the levels of a scene and its twin, from coarse to fine.

    It is None where fewer than two levels give a coefficient of both, or the last does not resolve its
    contact.
    """
    useful = [level for level in levels if not any(unfinished(pair, of) for pair in pairs_of(level))]
    used = useful[-3:]
    limits, bands = extrapolate.level_limits([replace(level, runs=level.runs[::2]) for level in used])
    if isinstance(limits, Unknown) or isinstance(bands, Unknown):
        return None
    coarse, fine = used[-2:]
    free, stiff = pairs_of(fine)[0]
    changes = [[difference(pair, of) for pair in pairs_of(level)] for level in used]
    sizes, wide = zip(*((level.size, level.wide) for level in used), strict=True)
    value, own = extrapolate.level_limit(sizes, changes, wide)
    unshown = len(used) == 2 and not coarse.wide
    band = max(own, SHARE * bands[CHANGED[of].name]) * (UNSHOWN if unshown else 1.0)
    E_vib, E_vib_band = (of[extrapolate.VIBRATION.name] for of in (limits, bands))
    floor = extrapolate.vibration_floor(free)
    lost = needed.unresolved_heat(limits, bands, free, fine.across)
    errors = {
        key.path[-1]: max(abs(limits[key.name] - known(key.of(free))) + bands[key.name], floor)
        for key in (*(share.key for share in SHARES), KEY_TABLE["W_skin_over_E_0"])
        if key.name in bands
    }
    return VibrationEffect(
        of,
        free.motion.alpha,
        value,
        band,
        E_vib,
        E_vib_band,
        replace(free, heat=needed.known_heat(free, lost, pairs_of(coarse)[0][0])),
        stiff,
        f"Finite elements on {len(levels)} levels, the last two with cells of {_size(coarse)} and "
        f"{_size(fine)} at the contact{ONCE if len(changes[-1]) == 1 else TWICE} at least half of the "
        f"change before and at least {SHARE:g} of the half-width of {CALLED[of]} itself"
        f"{TWICE_AS_WIDE * unshown}." + COUNTS.format(100 * floor),
        MESHES,
        errors,
        heat=(limits[needed.TEMPERATURE], bands[needed.TEMPERATURE]) if needed.TEMPERATURE in bands else None,
    )


def pairs_of(level: extrapolate.MeshRuns) -> list[Pair]:
    """Return the outcomes with vibration and without it on a level, by the places of the grid."""
    return list(zip(level.runs[::2], level.runs[1::2], strict=True))


def _size(level: extrapolate.MeshRuns) -> str:
    return f"{level.size * 1e3:.3g} mm"


def difference(pair: Pair, of: str) -> float:
    """Return a number with vibration less that without it."""
    key = CHANGED[of]
    return float(known(key.of(pair[0])) - known(key.of(pair[1])))


def worst(effects: Sequence[VibrationEffect], tolerance: float) -> VibrationEffect:
    """Return the change of several inclinations that answers worst, and of these the largest."""

    def order(effect: VibrationEffect) -> tuple[int, float]:
        return WORST_FIRST.index(effect.graded(tolerance)), -abs(effect.value)

    return min(effects, key=order)
