"""How far the reduced model is off for a scene: half-widths that hold nine in ten finite-element results.

Scenes drawn at random ran by both models (`fem_impact.case.measured.reduced_pairs`). Where a scene stands
among them is told by the numbers of `Place`. The error expected there is the mean of the stored ones, of
which each counts the more the nearer its scene stands. A half-width is a multiple of it as in jackknife+
(Barber et al. 2021, doi:10.1214/20-AOS1965): the multiple is each stored scene's own error over what the
others let expect of it, and that of the scene is taken which holds `HELD` of all with confidence
(`fem_impact.case.measured.tolerance_rank`). No distribution is assumed, only that the scene is of the kind of
those that were drawn.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from math import exp, hypot, inf, log10, sqrt
from typing import NamedTuple, Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.case.measured import CONFIDENCE, reduced_pairs, tolerance_rank
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.physics.contact import ContactPair
from fem_impact.physics.contact_law import contact_law
from fem_impact.scene.barrier import Barrier

HELD = 0.9
"""Share of differences from finite elements that a half-width holds."""
# standard deviations of the stored numbers at which a scene counts exp(-1/2), and how many scenes the mean
# over all of them counts for: about the least widths of stored scenes that are left out one by one, which
# change by a tenth from .5 to 2 and from 1 to 10
NEAR, COMMON = 1.5, 1.0
VIBRATION = "E_vib_over_E_0"
PLOUGHS = 0.1
"""Impulse ratio beyond friction, of the form of a dent, that no stored scene comes near; the most is .095."""
# speed over that of approach, up to which errors of e do not grow with it in the stored scenes, and the most
GRAZING = 3.1
LEAST_VIBRATION = 0.005  # of E_0, below which errors of the vibration energy no longer fall with it
TOLD = (
    *("e_edge", "mu", "V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s"),
    *("E_r_over_E_0", VIBRATION, "W_friction_over_E_0"),
)
"""Keys of the numbers whose error is stored, the last three shares of E_0."""
# over the part of the plastic work that the body takes which yields last: see `part_of_last`
SPLIT = 0.6
PLASTIC = ("E_plastic_rod_over_E_0", "E_plastic_barrier_over_E_0")
CARRIED = ("W_radiated_over_E_0", "W_plate_over_E_0", "W_damping_over_E_0")
FACTORS = ("peak_force_N", "dent_m", "flash_rise_K")
"""Numbers that are held against limits; their errors are natural logarithms of the ratio of both models."""
COLUMNS = (*TOLD, *FACTORS)
"""Numbers whose errors are stored, in the order of `Stored.errors`."""


class Place(NamedTuple):
    """Where a scene stands: decimal logarithms of dimensionless numbers, each within the ends of `ENDS`.

    Attributes
    ----------
    yields : speed of approach over that at which the contact begins to yield
    rings : first bending period over the estimated time of contact
    sticks : friction over the impulse ratio at which sliding stops
    wall, edge : wall of a tube, or largest radius of a solid body within half a diameter of where it touches,
        and radius of the edge that touches, over the estimated depth of the contact
    turns : mass of the body over that which its contact feels
    """

    yields: float
    rings: float
    sticks: float
    wall: float
    edge: float
    turns: float


ENDS = (-1.0, 2.5), (-1.5, 1.5), (-1.5, 1.5), (-0.5, 2.0), (-2.0, 2.0), (0.0, 1.0)
"""Lower and upper end of each number of `Place`: what lies beyond one behaves as at the end."""
CALLED = (
    *("speed over that at which it yields", "bending period over time of contact"),
    *("friction over the ratio at which it sticks", "wall over depth of the contact"),
    *("edge over depth of the contact", "mass over that which the contact feels"),
)
"""What the numbers of `Place` are called in a sentence."""


def place_of(case: Case, outcome: Outcome) -> Place:
    """Return where a scene stands that the reduced model has computed."""
    return place_at(case.contact, case.bodies.bending_period, or_none(outcome.restitution.mu_c) or 0.0)


def place_at(pair: ContactPair, bending_period: float, stops: float) -> Place:
    """Return where an impact stands: how both touch, period, s, and the ratio at which sliding stops."""
    law, depth = contact_law(pair), pair.estimate.depth
    begins = sqrt(0.8 * law.yield_force * law.yield_depth / pair.effective_mass) if law.limit < inf else inf
    body, (x, z) = pair.body, pair.touch_point
    bore = float(body.inner_radius(np.array(z))) if hasattr(body, "inner_radius") else 0.0
    # a solid nose that touches with its pole is no thin wall: its body begins within half a diameter
    near = (
        z if bore else np.clip(np.linspace(z - 0.5 * body.diameter, z + 0.5 * body.diameter), 0, body.length)
    )
    numbers = Place(
        yields=pair.approach / begins,
        rings=bending_period / pair.estimate.duration,
        sticks=pair.f / abs(stops) if stops else inf,
        wall=(max(float(body.radius(np.asarray(near)).max()), abs(x)) - bore) / depth,
        edge=pair.principal_radii[0] / depth,
        turns=pair.reduced[0] / pair.effective_mass,
    )
    return Place(
        *(
            min(max(log10(number) if number > 0.0 else -inf, low), high)
            for number, (low, high) in zip(numbers, ENDS, strict=True)
        )
    )


@dataclass(frozen=True)
class Stored:
    """Scenes by both models.

    Attributes
    ----------
    places : (n, 6) numbers of `Place`
    errors : (n, k) distances of both models in each of `TOLD`, over `scale_of`, and of `FACTORS`; nan where
        it is not known
    confidence : with which half-widths hold `HELD` of all scenes
    """

    places: Array
    errors: Array
    confidence: float = CONFIDENCE

    @classmethod
    def of(
        cls, rows: Sequence[Mapping[str, float]], names: Sequence[str], confidence: float = CONFIDENCE
    ) -> Self:
        """Return the scenes of a table: `Place` and the distances of some numbers, by name."""
        places, errors = ([[row[name] for name in of] for row in rows] for of in (Place._fields, names))
        return cls(np.array(places), np.abs(errors), confidence)

    @cached_property
    def spread(self) -> Array:
        """Return standard deviations (6,) of the places."""
        return np.asarray(self.places.std(axis=0))

    @cached_property
    def _judged(self) -> list[tuple[Array, Array, Array, float]]:
        """Return of each column which errors are known, these, each over what the others let expect of it.

        Beside them stands the widest half-width that one of the stored scenes would be told.
        """
        near, columns = np.array([self._near(place) for place in self.places]), []
        for every in self.errors.T:
            known = np.isfinite(every)
            errors, weights = every[known], near[np.ix_(known, known)] + COMMON / known.sum()
            expected = np.diagonal(_without_each(weights, errors))
            columns.append(
                (known, errors, errors / expected, float((errors / expected).max() * expected.max()))
            )
        return columns

    def _near(self, place: Array) -> Array:
        """Return (n,) how much each stored scene counts at a place (6,)."""
        away = (place - self.places) / (NEAR * self.spread)
        return np.asarray(np.exp(-0.5 * (away**2).sum(axis=1)))

    def half_width(self, place: Array, of: int, far: float = 0.0) -> float:
        """Return the half-width, as ``errors`` are, of the number of a column at a place (6,).

        Of a scene that lies so ``far``, 0 to 1, beyond the stored ones it has gone this share of its way to
        the widest that one of them would be told, unless it is wider.
        """
        known, errors, ratios, widest = self._judged[of]
        halves = np.sort(ratios * _without_each(self._near(place)[known] + COMMON / len(errors), errors))
        typical = float(halves[tolerance_rank(len(errors), HELD, self.confidence) - 1])
        return typical + far * max(widest - typical, 0.0)

    def far(self, place: Array) -> float:
        """Return how far a place (6,) lies beyond all stored ones, from 0 to 1 at `NEAR` spreads."""
        ends = self.places.min(axis=0), self.places.max(axis=0)
        beyond = np.abs(place - np.clip(place, *ends)) / (NEAR * self.spread)
        return float(min(beyond.max(), 1.0))

    def outside(self, place: Array) -> tuple[str, ...]:
        """Return which numbers of a place (6,) lie beyond all stored ones, as `CALLED`."""
        beyond = (place < self.places.min(axis=0)) | (place > self.places.max(axis=0))
        return tuple(name for name, far in zip(CALLED, beyond, strict=True) if far)


def _without_each(weights: Array, errors: Array) -> Array:
    """Return (..., n) the means of errors (n,) by weights (..., n) over all of them but each."""
    parts = weights * errors
    return np.asarray(
        (parts.sum(axis=-1, keepdims=True) - parts) / (weights.sum(axis=-1, keepdims=True) - weights)
    )


def unit_of(key: str, outcome: Outcome) -> float:
    """Return 1, the speed over the barrier, m/s, or that over the radius of gyration, by a key's unit.

    The speed is that of all of E_0: a body that turns may strike fast though its mass centre hardly moves.
    """
    motion, unit = outcome.motion, KEY_TABLE[key].unit
    speed = sqrt(2.0 * outcome.energy.E_0 / motion.mass)
    return {"m/s": speed, "rad/s": speed / sqrt(motion.k_squared)}.get(unit, 1.0)


def scale_of(key: str, outcome: Outcome) -> float:
    """Return the scale of errors of a number: `unit_of`, and of the vibration energy that energy itself."""
    if key != VIBRATION:
        return unit_of(key, outcome)
    return max(or_none(outcome.energy.vibration) or 0.0, LEAST_VIBRATION)


def half_widths(place: Place, outcome: Outcome, approach: float, last: float = 0.0) -> dict[str, float]:
    """Return half-widths, by key, of those numbers that an outcome of the reduced model knows.

    Where the form of a dent gives more impulse along the barrier than any stored scene shows, all that is
    beyond friction may be wrong, and with it what that impulse gives the motion. ``approach``, m/s, is
    that of the contact point; ``last`` the part of the plastic work that the body takes which yields last.
    """
    at, table, far = np.array(place), stored(), farness(place, outcome)
    told = {key: or_none(KEY_TABLE[key].of(outcome)) for key in (*TOLD, *PLASTIC, *CARRIED)}
    values = {key: value for key, value in told.items() if value is not None}
    halves = {
        key: table.half_width(at, of, far) * scale_of(key, outcome)
        for of, key in enumerate(TOLD)
        if key in values
    }
    if "e_edge" in halves:
        halves["e_edge"] *= widened_by(unit_of("V_n_m_per_s", outcome), approach)
    # the plastic work is what the other shares leave
    plastic = [key for key in PLASTIC if values.get(key)]
    if not outcome.motion.friction:  # nothing rubs; along an elastic body nothing pushes at all
        halves["W_friction_over_E_0"] = 0.0
        if not plastic and "V_n_m_per_s" in halves:  # which an impact that was cut off does not know
            arm = abs(known(outcome.restitution.edge.d_c)) / outcome.motion.k_squared
            turned = halves["V_n_m_per_s"] * arm
            halves |= {"mu": 0.0, "V_t_m_per_s": 0.0, "Omega_rad_per_s": turned}
    others = sum(halves.get(key, 0.0) for key in TOLD[-3:])
    whole = sum(values[key] for key in plastic)
    for key in plastic:
        halves[key] = others * values[key] / whole + SPLIT * last * whole
    for key in CARRIED:  # no stored scene tells their errors: what all others leave open
        if values.get(key):
            halves[key] = others
    for key in (*TOLD[-3:], *plastic, *CARRIED):  # shares lie between 0 and 1
        if key in halves:
            halves[key] = min(halves[key], max(values[key], 1.0 - values[key]))
    beyond = _beyond_friction(outcome)
    if digs_in(outcome):
        halves["mu"] = max(halves["mu"], beyond)
        for key, change in _by_impulse(beyond, outcome, approach).items():
            if key in halves:
                halves[key] = hypot(halves[key], change)  # beside what is open at a known impulse
    if (force := or_none(outcome.contact.peak_force)) is not None:
        halves["peak_force_N"] = force * (factor_of(place, "peak_force_N", far) - 1.0)
    if or_none(outcome.restitution.paper.e) is not None:
        halves["e_paper"] = halves["e_edge"]  # arms a little apart take nearly the same approach
    return halves


def with_barrier(struck: Barrier, outcome: Outcome, halves: Mapping[str, float]) -> dict[str, float]:
    """Return half-widths, by key, with those of a free barrier: what is open between both bodies they share.

    The stored scenes are of heavy barriers. Momentum says what the barrier has of it, the lever of the struck
    point what its spin has.
    """
    mass, base, rod = outcome.motion.mass, struck.mass, dict(halves)
    if base is None or "V_n_m_per_s" not in rod:
        return rod
    ways = "V_n_m_per_s", "V_t_m_per_s"
    if struck.inertia is None:
        rod |= {key: rod[key] * base / (mass + base) for key in ways}
    n, t = (rod[key] * mass / base for key in ways)
    spin = base * (n * abs(struck.centre_offset) + t * abs(struck.centre_depth or 0.0))
    moved, inertia = outcome.barrier, struck.inertia or inf
    most = sqrt(2.0 * outcome.energy.E_0 / inertia) - abs(or_none(moved.Omega_b) or 0.0)  # by the energy
    spin = min(spin / inertia, max(most, 0.0))
    pairs = [(base, known(moved.V_bn) - moved.v_bn, n), (base, known(moved.V_bt) - moved.v_bt, t)]
    pairs.append((struck.inertia or 0.0, or_none(moved.Omega_b) or 0.0, spin))
    energy = sum(of * (abs(speed) + 0.5 * half) * half for of, speed, half in pairs)
    share = energy / outcome.energy.E_0
    rod |= {"V_bn_m_per_s": n, "V_bt_m_per_s": t, "barrier_Omega_rad_per_s": spin}
    return rod | {"E_barrier_over_E_0": min(share, 1.0)}


def with_waves(
    share: float, outcome: Outcome, halves: Mapping[str, float], approach: float
) -> dict[str, float]:
    """Return half-widths, by key, that hold waves in the barrier, which the reduced model leaves out.

    They take a ``share`` of the normal energy. ``approach``, m/s, is that of the contact point.
    """
    e, wider = or_none(outcome.restitution.edge.e), dict(halves)
    if not share or e is None or "E_r_over_E_0" not in halves:
        return wider
    slower = e - sqrt(max(e**2 - share, 0.0))
    more = {"e_edge": slower, "V_n_m_per_s": slower * approach}
    more["E_r_over_E_0"] = share * min(approach / unit_of("V_n_m_per_s", outcome), 1.0) ** 2
    return wider | {key: halves[key] + by for key, by in more.items() if key in halves}


def widened_by(speed: float, approach: float) -> float:
    """Return how many times wider that of e is, where the approach, m/s, is slow beside the speed, m/s.

    What is left of such an approach is as open as the speeds that it is over.
    """
    return max(speed / (GRAZING * approach), 1.0)


def _by_impulse(ratio: float, outcome: Outcome, approach: float) -> dict[str, float]:
    """Return by how much an impulse ratio more changes numbers of the motion, by key, at one normal impulse.

    An impulse along the barrier at the arm d_d turns the body, and the contact point beside the mass centre
    then leaves faster or slower by d_c of that spin (the rigid equations of motion).
    """
    motion, arms = outcome.motion, outcome.restitution.edge
    d_c, d_d = known(arms.d_c), known(arms.d_d)
    slid = ratio * abs(known(motion.V_n) - motion.v_n)
    turned = slid * abs(d_d) / motion.k_squared
    left = turned * abs(d_c)
    return {"V_t_m_per_s": slid, "Omega_rad_per_s": turned, "e_edge": left / approach}


def factor_of(place: Place, name: str, far: float) -> float:
    """Return the factor that holds nine in ten ratios of both models in one of `FACTORS` at a place.

    It is wider of a scene that lies ``far``, 0 to 1, beyond the stored ones.
    """
    return exp(stored().half_width(np.array(place), COLUMNS.index(name), far))


def unlike(place: Place, outcome: Outcome, table: Stored | None = None) -> tuple[str, ...]:
    """Return in what a scene is unlike all stored ones, of which one place touched, of a table."""
    return (*(table or stored()).outside(np.array(place)), *unheard(outcome))


def farness(place: Place, outcome: Outcome, table: Stored | None = None) -> float:
    """Return how far a scene lies beyond them, 0 to 1; 1 where it touches as none of them does."""
    return 1.0 if unheard(outcome) else (table or stored()).far(np.array(place))


def unheard(outcome: Outcome) -> tuple[str, ...]:
    """Return how a scene touches as no stored one does: of those hardly one lands flat, and sends waves."""
    several = ("the number of places that touch",) * (len(or_none(outcome.contact.sites) or ()) > 1)
    flat = ("what lands flat",) * (or_none(outcome.energy.radiated) is not None)
    again = ("when it touches again",) * isinstance(outcome.contact.strikes_again, Unknown)
    return (*several, *flat, *again, *("how an edge digs in",) * digs_in(outcome))


def digs_in(outcome: Outcome) -> bool:
    """Say whether the form of a dent gives more impulse along the barrier than any stored scene shows."""
    return _beyond_friction(outcome) > PLOUGHS


def _beyond_friction(outcome: Outcome) -> float:
    """Return the impulse ratio beyond that of friction, 0 where it is less or not known."""
    return max(abs(or_none(outcome.restitution.mu) or 0.0) - outcome.motion.friction, 0.0)


def sentence(place: Place, outcome: Outcome) -> str:
    """Say what the half-widths are, and where they are wider as the scene is unlike the stored ones."""
    text = (
        f"Half-widths hold nine in ten results of finite elements, by {len(stored().places)} scenes that "
        "both models computed; they say nothing of the change of a number by vibration."
    )
    in_what, far = unlike(place, outcome), 100 * farness(place, outcome)
    if not in_what:
        return text
    half = "the largest of all" if far == 100 else f"{far:.2g} % of the way to the largest of all"
    return f"{text} None of them is like this one in {', '.join(in_what)}: its half-widths are {half}."


@cache
def stored() -> Stored:
    """Return the stored scenes."""
    return Stored.of(reduced_pairs(), COLUMNS)
