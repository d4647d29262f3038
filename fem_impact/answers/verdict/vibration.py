"""What leaving vibration out changes: one pair of twins, by the reduced model or by finite elements."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from fem_impact.answers.refine import extrapolate
from fem_impact.answers.verdict.reliability import CHANGED, known_error, sentence
from fem_impact.answers.verdict.twins import twins
from fem_impact.case.case import Case
from fem_impact.case.plates import half_space_error, is_thin
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import SHARES
from fem_impact.run.simulate import simulate
from fem_impact.scene.types import Scene

REDUCED, MESHES = "the reduced model", "meshes of finite elements"
"""What a change of e rests on."""

COUNTS = (
    " The band of a share of the energy is at least {:.2g} % of E_0, by which two independent counts of the "
    "vibration (by modes and without them) or the energy balance of the finer mesh are off."
)

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

    def at_least(self, off: float) -> "VibrationEffect":
        """Return the change with a band no smaller than ``off``, an error that finite elements showed."""
        if off <= self.band:
            return self
        told = f"At the scene's own inclination it is off by {off:.2g}: so much counts at all others."
        return replace(self, band=off, source=f"{self.source} {told}")

    @property
    def told(self) -> str:
        """Value and band as text."""
        return f"{self.value:+.3f} ± {self.band:.3f}"

    def answer(self, tolerance: float) -> Answer:
        """Say whether rigid theory may be used if the number may be off by ``tolerance``."""
        if abs(self.value) - self.band > tolerance:
            return "no"
        return "yes" if abs(self.value) + self.band <= tolerance else "undecided"


def unfinished(pair: Pair, of: str = "e") -> str:
    """Return why a pair of twins says nothing of a number, empty where it does.

    A run that ended before another place strikes tells those of the impact before.
    """
    for run, which in zip(pair, ("with", "without"), strict=True):
        if or_none(CHANGED[of].of(run)) is None:
            return f"the run {which} vibration gives no {of}: {run.validity.stopped_because}"
    return ""


def modal_pair(scene: Scene) -> Pair:
    """Return the twins of a scene by the reduced model."""
    free, stiff = twins(untargeted(scene))
    return simulate(free, "modal"), simulate(stiff, "modal")


def modal_effect(scene: Scene, pair: Pair, of: str = "e") -> VibrationEffect:
    """Return what the reduced model says of the change of a number, with its known error.

    Shares of E_0 have the half-widths that the run itself tells; all plastic work that of the shares beside
    it together, with which it adds up to one.
    """
    value, case = difference(pair, of), Case(untargeted(scene))
    half, far = known_error(case, pair[0], of, value)
    thin = (
        half_space_error(case.bodies) * abs(known(pair[0].restitution.edge.e))
        if is_thin(case.bodies)
        else 0.0
    )
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
        sentence(of, half, far) + THIN_PLATE.format(thin) * bool(thin),
        REDUCED,
        {**shares, "plastic": sum(shares.values())},
        not far,
    )


def solid_effect(levels: Sequence[extrapolate.MeshRuns], of: str = "e") -> VibrationEffect | None:
    """Return what finite elements say on the levels of a scene and its twin, from coarse to fine.

    It is None where fewer than two levels give a coefficient of both, or the last does not resolve its
    contact.
    """
    useful = [level for level in levels if not unfinished(pair_of(level), of)]
    used = useful[-3:]
    limits, bands = extrapolate.level_limits([replace(level, runs=level.runs[:1]) for level in used])
    if isinstance(limits, Unknown) or isinstance(bands, Unknown):
        return None
    coarse, fine = used[-2:]
    free, stiff = pair_of(fine)
    changes, wide = [[difference(pair_of(level), of)] for level in used], [level.wide for level in used]
    value, band = extrapolate.level_limit([level.size for level in used], changes, wide)
    E_vib, E_vib_band = (of[extrapolate.VIBRATION.name] for of in (limits, bands))
    floor = extrapolate.vibration_floor(free)
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
        free,
        stiff,
        f"Finite elements on {len(levels)} levels, the last two with cells of {_size(coarse)} and "
        f"{_size(fine)} at the contact; the band is {extrapolate.ONE_RUN:g} times the range of the limits of "
        "all orders of convergence from 3/4 up, as each mesh runs once, and at least half of the change "
        "before." + COUNTS.format(100 * floor),
        MESHES,
        errors,
    )


def pair_of(level: extrapolate.MeshRuns) -> Pair:
    """Return the outcomes with vibration and without it on a level."""
    free, stiff = level.runs
    return free, stiff


def _size(level: extrapolate.MeshRuns) -> str:
    return f"{level.size * 1e3:.3g} mm"


def difference(pair: Pair, of: str) -> float:
    """Return a number with vibration less that without it."""
    key = CHANGED[of]
    return float(known(key.of(pair[0])) - known(key.of(pair[1])))


def largest(effects: Sequence[VibrationEffect]) -> VibrationEffect:
    """Return the largest change of several inclinations."""
    return max(effects, key=lambda effect: abs(effect.value))


def untargeted(scene: Scene) -> Scene:
    """Return the scene without the error that it asks for: the verdict chooses fidelity and meshes itself."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))
