"""What is certain of a sequence of strikes: sequences over what is not known of inputs and of strikes.

Each is that of a rigid body whose strikes are moved from its law by as much as those of the run are, and by
what their model leaves open, as long as the same parts of the body strike.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile, zip_longest
from math import copysign, exp, hypot, log, pi, radians
from typing import Any, NamedTuple

import numpy as np

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.outcome.keys import Num, Unknown, keys_of, known, or_none
from fem_impact.outcome.strikes import PHASED, StrikeRecord, Strikes, StrikeSpread, other_end
from fem_impact.run import modal_error
from fem_impact.run.strikes import Followed
from fem_impact.scene.types import Scene
from rigid import critical_ratio
from rigid.strikes import FlightState, Strike

RUNS = 64
"""Sequences over what is not known."""
SEEN = 6
"""Strikes of each that are looked at: later ones are as good as drawn by lot."""
CURVE = radians(10.0), radians(86.0), 20
"""First and last inclination, rad, of a curve over it, and how many."""
INNER = 0.05, 0.95
"""Quantiles that are told."""
EXACT = Unknown(
    "rigid theory tells no error of its own, and the scene states no interval: surface.friction_low and "
    "friction_high, strikes.angle_error or speed_error"
)
FORCELESS = Unknown("one of the first strikes has no force: it is rigid, without duration")
PHASES = tuple(f"{name}_phase" for name in PHASED)
UNTOLD = "fidelity", "part", "damping", "taken", "other", "dent", "highest", "lowest"
"""What of a strike has no half-width: see `NO_ERROR`."""
NAMES = {key.path[-1]: key.name for key in keys_of(StrikeRecord) if key.path[-1] not in UNTOLD + PHASES}
"""Keys of the numbers that have half-widths."""
INTERVALS = "the stated intervals of friction, angle and speed"
BY = {
    "modal": "the half-widths of the reduced model's e, mu and friction in each of its strikes, and what "
    "vibration that comes in with another phase would change",
    "solid": "the half-widths that levels of meshes tell of e, mu and friction in strikes by finite elements",
    "rigid": "in strikes of a rigid body, how far it lies from the finer model in the last strike of that",
}
OPEN = {
    "solid": "the error of the mesh, which one mesh does not tell",
    "rigid": "the error of rigid theory, which a run with modes tells",
}


class Doubt(NamedTuple):
    """Half-widths of what the model of a strike gives, or places within them, nine in ten within -1 to 1.

    They are of e, of the size of the impulse ratio and of friction, J, which go together, of the vibration
    after it, J, and of the natural logarithm of the largest force.
    """

    e: float = 0.0
    mu: float = 0.0
    friction: float = 0.0
    vibration: float = 0.0
    force: float = 0.0


KNOWN = Doubt()
SHUFFLE, CYCLE = 15, 67
"""A number and a prime above `RUNS` that put the runs in another order for each strike: of all such numbers
the one with the least correlation, 0.26, of what the strikes of 64 runs are given."""


@dataclass(frozen=True, slots=True)
class Known:
    """A strike of the run, the same strike by the law of rigid runs, and what its model leaves open.

    ``doubt`` is None where nothing is known of that.
    """

    own: StrikeRecord
    law: StrikeRecord
    doubt: Doubt | None


def with_spread(case: Case, strikes: Strikes, meshed: Sequence[Doubt | None] = ()) -> Strikes:
    """Return strikes with what is certain of them; ``meshed`` is what levels of meshes leave open of each."""
    followed = or_none(strikes.each)
    if followed is None:
        return strikes
    try:
        each = _each(case, followed, meshed)
        if not (_varies(case) or any(strike.doubt for strike in each)):
            return without_spread(strikes, EXACT)
        plain = _run(case.scene, each)
        runs = [_run(scene, each, at) for scene, at in _drawn(case)]
    except SceneError as error:
        why = f"rigid theory does not follow the scene: its {error.key} {error.problem.rstrip('.')}"
        return without_spread(strikes, Unknown(why))
    alike = takewhile(
        lambda struck: len({one.part for one in struck}) == 1, zip(followed, plain, *runs, strict=False)
    )
    certain, length = len(list(alike)), case.contact.body.length
    ends = [other_end(run, length) for run in runs]
    # a strike of a part that the run's own is not of comes by the law of rigid runs, without a force
    forces = [
        strike.force / strike.impulse_n for strike in followed[:SEEN] if strike.force and strike.impulse_n
    ]
    push = max(forces) if len(forces) == len(followed[:SEEN]) else 0.0
    first, rubbed = other_end(plain, length), sum(strike.friction for strike in plain)
    later = known(strikes.friction) - sum(strike.friction for strike in followed[:SEEN])
    return replace(
        strikes,
        certain=certain,
        spread=tuple(
            _spread(
                number,
                [one for one in struck if one is not None],
                *([followed[number - 1], plain[number - 1]] if number <= certain else []),
            )
            for number, struck in enumerate(zip_longest(*runs), 1)
        ),
        holds=_holds(case, each),
        hardest_agree=_agree(followed, runs, lambda s: s.lost),
        force_agree=_agree(followed, runs, lambda s: s.force or s.impulse_n * push) if push else FORCELESS,
        heat_agree=_agree(followed, runs, lambda s: s.friction),
        friction_half=later + _half([sum(strike.friction for strike in run) for run in runs], rubbed),
        other_end_low=_moved(strikes.other_end, first, _quantile(ends, INNER[0])),
        other_end_high=_moved(strikes.other_end, first, _quantile(ends, INNER[1])),
    )


def without_spread(strikes: Strikes, why: Unknown) -> Strikes:
    """Return strikes of which nothing is certain, for a reason."""
    names = "certain", "spread", "holds", "friction_half", "other_end_low", "other_end_high"
    unknown: dict[str, Any] = dict.fromkeys((*names, "hardest_agree", "force_agree", "heat_agree"), why)
    return replace(strikes, **unknown)


def _each(case: Case, followed: Sequence[StrikeRecord], meshed: Sequence[Doubt | None] = ()) -> list[Known]:
    """Return the first strikes with those of the law and with what their models leave open."""
    records: list[Known] = []
    for number, one in enumerate(followed[:SEEN]):
        body = Followed.of(case)
        body.upto = 1
        begin = body.struck_as(one)
        body.go_on(begin)
        doubt: Doubt | None = None
        if one.fidelity == "modal":
            doubt = _by_stored(case, body, begin, one)
        elif one.fidelity == "solid":
            doubt = meshed[number] if number < len(meshed) else None
        elif finer := [old for old in records if old.own.fidelity != "rigid"]:
            doubt = _apart(finer[-1], one)
        records.append(Known(one, body.each[0], doubt))
    return records


def _apart(finer: Known, of: StrikeRecord) -> Doubt:
    """Return how far the law lies from the model of a ``finer`` strike, for one ``of`` another energy."""
    one, other = finer.own, finer.law
    share = of.before / one.before
    return Doubt(
        abs(one.e - other.e),
        abs(one.mu - other.mu),
        abs(one.friction - other.friction) * share,
        abs(one.vibration - other.vibration) * share,
        abs(log(one.force / other.force)) if one.force and other.force else 0.0,
    )


def _by_stored(case: Case, body: Followed, begin: FlightState, one: StrikeRecord) -> Doubt:
    """Return the half-widths of the reduced model for a strike, by the stored scenes that are like it."""
    pair = body.later(begin).contact
    (d_c, d_d), k2 = pair.arms, body.pull.k2
    stops = critical_ratio(pair.v_n, pair.v_t, e=one.e, d_c=d_c, d_d=d_d, k2=k2, omega=pair.omega)
    place = np.array(modal_error.place_at(pair, case.bodies.bending_period, float(stops)))
    table = modal_error.stored()
    e, mu, friction, vibration, force = (
        table.half_width(place, modal_error.COLUMNS.index(name), table.far(place))
        for name in ("e_edge", "mu", "W_friction_over_E_0", modal_error.VIBRATION, "peak_force_N")
    )
    vibrates = max(one.vibration, modal_error.LEAST_VIBRATION * one.before)
    louder = one.force_phase / one.force if one.force else 0.0
    return Doubt(
        hypot(e * modal_error.widened_by(hypot(pair.v_n, pair.v_t), pair.approach), one.e_phase),
        hypot(mu, one.mu_phase),
        hypot(friction * one.before, one.friction_phase) if pair.f else 0.0,
        hypot(vibration * vibrates, one.vibration_phase),
        hypot(force, louder),
    )


def _varies(case: Case) -> bool:
    """Return whether the scene states an interval of anything."""
    surface, errors = case.scene.surface, case.scene.strikes
    rubs = "friction" in case.active and surface.friction_low < surface.friction_high
    return bool(rubs or errors.angle_error or errors.speed_error)


def _holds(case: Case, each: Sequence[Known]) -> str:
    """Return what the sequences hold, and what they do not."""
    inside = {one.own.fidelity: BY[one.own.fidelity] for one in each if one.doubt}
    outside = {one.own.fidelity: OPEN[one.own.fidelity] for one in each if one.doubt is None}
    held = ", and ".join([*([INTERVALS] if _varies(case) else []), *inside.values()])
    return f"They hold {held}" + (f"; not {' nor '.join(outside.values())}." if outside else ".")


def _drawn(case: Case) -> Iterator[tuple[Scene, list[Doubt]]]:
    """Yield scenes whose friction, angle and speed seen from the barrier fill the stated intervals evenly.

    With each come places within what is not known of its first strikes, as good as independent of each other:
    finite elements lie now above and now below a coarser model from strike to strike.
    """
    scene, surface, impact = case.scene, case.scene.surface, case.scene.impact
    low, high, seen = surface.friction_low, surface.friction_high, scene.relative
    for run, share in enumerate(np.linspace(0.0, 1.0, RUNS).tolist(), 1):
        off = (2.0 * _halton(run, 2) - 1.0) * (scene.strikes.angle_error or 0.0)
        faster = 1.0 + (2.0 * _halton(run, 3) - 1.0) * (scene.strikes.speed_error or 0.0)
        moved = replace(
            impact,
            angle=min(max(impact.angle + off, -0.5 * pi), 0.5 * pi),
            v_n=faster * seen.v_n + scene.barrier.v_n,
            v_t=faster * seen.v_t + scene.barrier.v_t,
            omega=faster * seen.omega,
            height=None,
            speed=None,
            slope=impact.vertical,
        )
        drawn = replace(scene, surface=replace(surface, friction=low + share * (high - low)), impact=moved)
        yield drawn, [_place(run * SHUFFLE**strike % CYCLE) for strike in range(SEEN)]


def _place(run: int) -> Doubt:
    """Return places within what is not known of a strike, of which nine in ten lie within -1 to 1."""
    e, mu, vibration, force = ((2.0 * _halton(run, base) - 1.0) / modal_error.HELD for base in (5, 7, 11, 13))
    return Doubt(e, mu, mu, vibration, force)


def _halton(number: int, base: int) -> float:
    """Return the number's place in the unit interval by its digits in a base, which fill it evenly.

    `scipy.stats.qmc.Halton` does the same, but takes longer to import than all sequences take.
    """
    place, share = 0.0, 1.0
    while number:
        share /= base
        number, digit = divmod(number, base)
        place += share * digit
    return place


def _run(scene: Scene, each: Sequence[Known], at: Sequence[Doubt] = ()) -> list[StrikeRecord]:
    """Return the first strikes of a scene; ``at`` are places within what is not known of each."""
    body, at = Followed.of(Case.of(scene, "rigid")), at or [KNOWN] * len(each)
    mass, left = body.case.contact.body.mass, list(zip(each, at, strict=False))

    def moved(strike: Strike) -> Strike:
        before = strike.before
        if not left or left[0][0].own.part != body.part_of(before):
            left.clear()  # from here on another sequence
            return strike
        one, at = left.pop(0)
        doubt, record, law = one.doubt or KNOWN, one.own, one.law
        return strike.having(
            max(0.0, strike.e + record.e - law.e + at.e * doubt.e),
            strike.mu + record.mu - law.mu + copysign(1.0, record.mu) * at.mu * doubt.mu,
            max(
                0.0, strike.friction + (record.friction - law.friction + at.friction * doubt.friction) / mass
            ),
            body.pull.k2,
        )

    body.moved, body.upto = moved, min(SEEN, scene.impact.most_strikes or SEEN)
    body.go_on(body.coming)
    alike = takewhile(
        lambda three: three[0].part == three[1].own.part, zip(body.each, each, at, strict=False)
    )
    divided = [_divided(*three) for three in alike]
    return divided + body.each[len(divided) :]


def _divided(one: StrikeRecord, of: Known, at: Doubt) -> StrikeRecord:
    """Return a rigid strike that stands for ``of`` with that one's force and with its loss divided alike.

    Vibration is the same share of the energy before, the force is as large over the impulse; what is not
    known of both is added, and plastic work, if there is any, takes what they leave of the loss.
    """
    record, doubt = of.own, of.doubt or KNOWN
    share, push = one.before / record.before, one.impulse_n / (record.impulse_n or one.impulse_n)
    vibration = max(0.0, record.vibration * share + at.vibration * doubt.vibration)
    rest = share * (record.lost - record.friction - record.vibration - record.plastic)
    return replace(
        one,
        vibration=vibration,
        plastic=one.lost - one.friction - vibration - rest if record.plastic or one.plastic else 0.0,
        force=record.force and record.force * push * exp(at.force * doubt.force),
    )


def other_end_curve(scene: Scene) -> tuple[list[float], list[float]]:
    """Return inclinations, rad, and the other end's speed over that of the first strike, of a rigid body.

    Inclinations at which it does not strike by itself are left out.
    """
    curve = []
    for angle in np.linspace(*CURVE).tolist():
        angle = copysign(angle, scene.impact.angle)
        slope = scene.impact.vertical
        impact = replace(scene.impact, angle=angle, slope=slope, height=None, speed=None)
        run = _run(replace(scene, impact=impact), [])
        ratio = or_none(other_end(run, scene.projectile.rigid_body.length))
        curve += [(angle, ratio)] if ratio is not None else []
    return [angle for angle, _ in curve], [ratio for _, ratio in curve]


def _agree(
    followed: Sequence[StrikeRecord],
    runs: Sequence[Sequence[StrikeRecord]],
    size: Callable[[StrikeRecord], float],
) -> int:
    """Return how many runs have the same strike as the hardest by a size as the run's ``followed``."""
    hardest = [int(np.argmax([size(strike) for strike in run[:SEEN]])) for run in (followed, *runs)]
    return sum(strike == hardest[0] for strike in hardest[1:])


def _half(values: Sequence[float], plain: float) -> float:
    """Return the larger way from a plain value to the quantiles of values."""
    return float(np.abs(np.quantile(values, INNER) - plain).max())


def _spread(
    number: int,
    struck: Sequence[StrikeRecord],
    record: StrikeRecord | None = None,
    plain: StrikeRecord | None = None,
) -> StrikeSpread:
    """Return what strikes in which of the runs as the strike of a ``number``, from 1.

    Where it is of the same part in all of them, that lies about the run's ``record``, whose numbers have
    half-widths: the ways from the ``plain`` sequence, in which nothing is moved.
    """
    parts = Counter(one.part for one in struck)
    time, approach = (
        np.quantile([getattr(one, key) for one in struck], INNER)
        + (getattr(record, key) - getattr(plain, key) if record and plain else 0.0)
        for key in ("time", "approach")
    )
    return StrikeSpread(
        number=number,
        tip=parts["tip"],
        tail=parts["tail"],
        other=len(struck) - parts["tip"] - parts["tail"],
        none=RUNS - len(struck),
        time_low=float(time[0]),
        time_high=float(time[1]),
        approach_low=float(approach[0]),
        approach_high=float(approach[1]),
        half_widths={
            name: _half([getattr(one, key) for one in struck], getattr(plain, key))
            for key, name in NAMES.items()
            if getattr(plain, key) is not None
        }
        if plain
        else {},
    )


def _moved(value: Num, plain: Num, to: Num) -> Num:
    """Return a ratio moved as far as from that of the plain sequence ``to`` another, or why it is unknown."""
    missing = next((one for one in (value, plain, to) if isinstance(one, Unknown)), None)
    return missing if missing is not None else known(value) + known(to) - known(plain)


def _quantile(ratios: Sequence[Num], share: float) -> Num:
    """Return a quantile of the ratios, or why one of them is not known."""
    missing = next((one for one in ratios if isinstance(one, Unknown)), None)
    if missing is not None:
        return missing
    return float(np.quantile([known(one) for one in ratios], share))
