"""Groups of an outcome that every fidelity fills in the same way: motion, coefficients, heat."""

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, cos, hypot, inf, pi, sin

import rigid
from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import is_wanted
from fem_impact.case.shaft import gives_elsewhere
from fem_impact.outcome.groups import ArmCoefficients, BarrierMotion, Restitution, RodMotion
from fem_impact.outcome.keys import Num, Unknown, known, unknown
from fem_impact.physics.contact import ContactPair
from fem_impact.physics.contact_law import BEGINS, FULLY_PLASTIC
from fem_impact.physics.hardening import rate_factor, strain_rate
from fem_impact.run.tests import tests_of
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

NO_TABLE = "the scene repeats no measured set, so no table gives its arms"
MASSIVE = Unknown("the barrier is massive")
UPRIGHT = Unknown("the barrier does not turn")
TURNING = Unknown("the barrier turns: rigid theory's arms are those of one that does not")
UNBENT = Unknown("the plate-bending effect is off")
CUT_OFF = Unknown("the run ended before the last separation was certain")
UNSHEARED = Unknown("in this contact law the skin of the body that yields first alone is sheared")
UNDETERMINED = Unknown("the contact point does not approach, or no moment acts about the mass centre: 0 / 0")
NO_PUSH = Unknown("gravity has drawn the projectile to the barrier more than that has pushed it away")
RESIDUAL_LIMIT = 1e-4  # of E_0: above it a run failed
OPEN_LEDGER = "The energy ledger misses"  # how the reason begins, which a level looks for
EARLY = 0.02
"""Plastic strain at which the strengths of two bodies that flow are held against each other."""
MOST_OF_LAST = 0.7  # see `part_of_last`
DEEP = 0.2  # plastic strain at a wedge, that of an indentation as deep as wide (Tabor 1951)
# pressure under which a square edge flows over that of a half-space. Without friction and hardening it is .69
# in plane strain: slip lines turn by 45 deg, in the mean of both sides of the edge, not by 90 (Hill 1950, The
# Mathematical Theory of Plasticity, chapter 9); of 44 runs by finite elements 42 bear out this one, 40 that
SQUARE = 0.8
ROUND = 0.25
"""Turn of an outline within the contact, over 90 degrees, up to which it bears as a half-space does."""
SOON = 1.0  # of a contact's time: the other end may have come down before its end in another model
NEAR_END = 1.5  # of the time that parts two impacts, up to which a gap may lie on its other side
ROUND_OFF = 1e-6  # a moment impulse over that of the normal impulse at arm d_d: below it there is none


def gravity_of(scene: Scene) -> float:
    """Return the gravity, m/s2, of flights: 0 only where the scene leaves the effect out."""
    return rigid.GRAVITY if is_wanted("gravity", scene.effects) else 0.0


def pull_of(scene: Scene) -> tuple[float, float]:
    """Return the accelerations of flights by gravity, m/s2, out of -n and -t."""
    g, vertical = gravity_of(scene), scene.impact.vertical
    return g * cos(vertical), g * sin(vertical)


def next_strike(case: Case, V_n: float, Omega: float) -> float | None:
    """Return when, s from now, a body strikes again as it leaves the barrier with V_n, m/s, and Omega, rad/s.

    Its mass centre still comes down, or it turns another part down faster than it rises: so far gravity, by
    which each body comes down, is left out. When is told with it. None of a body that does not strike so.
    """
    body = case.contact.body
    if abs(Omega) * hypot(body.length, body.diameter) < V_n:  # no part of it comes down
        return None
    from rigid.strikes import FlightState, next_touch, outline

    shape, alpha = outline(body), case.scene.relative.angle
    height = shape.corners[shape.lowest(alpha, Omega)].arms(alpha)[1]
    state = FlightState(0.0, height, 0.0, alpha, V_n, 0.0, Omega)
    if next_touch(shape, state, 0.0) is None:
        return None
    touch = next_touch(shape, state, pull_of(case.scene)[0])
    return None if touch is None else touch[0]


def strikes_again(case: Case, V_n: float, Omega: float) -> str:
    """Return that a body strikes again as it leaves the barrier, an empty text if it does not."""
    if not V_n > 0:
        return "The mass centre still comes nearer to the barrier, so that the rod strikes again later."
    after = next_strike(case, V_n, Omega)
    if after is None:
        return ""
    when = f"about {plain(1e3 * after)} ms later" if after > 0.0 else "at once"
    return f"The rod turns another part down faster than it rises, so that it strikes again {when}."


def open_end(case: Case, contacts: Array | None, V_n: float, Omega: float, other_end: float = inf) -> str:
    """Return that it is open whether a next contact belongs to the impact, nothing where it is not.

    ``contacts`` (k, 2) are start and end, s, of each; V_n, m/s, and Omega, rad/s, those after the last one;
    ``other_end``, s, is how much later the other end strikes, for which the impact ended.
    """
    if contacts is None or not len(contacts):
        return ""
    took = float((contacts[:, 1] - contacts[:, 0]).max())
    if other_end < SOON * took:
        return (
            f"The other end strikes {1e6 * other_end:.0f} us after a contact of {1e6 * took:.0f} us. So soon "
            "another model, or another mesh, may count it as the same impact"
        )
    limit, gaps = case.one_impact, [float(gap) for gap in contacts[1:, 0] - contacts[:-1, 1]]
    after = next_strike(case, V_n, Omega)
    # it leaves turned and moved by about what it would be after half of the contact's time
    gaps += [] if after is None else [after - 0.5 * float(contacts[-1, 1] - contacts[-1, 0])]
    near = [gap for gap in gaps if limit / NEAR_END < gap < limit * NEAR_END]
    if not near:
        return ""
    return (
        f"It touches again after {1e6 * near[0]:.0f} us; what touches again within {1e6 * limit:.0f} us "
        "counts as the same impact. So near that limit another model, or another mesh, may count otherwise"
    )


def flow_omitted(case: Case) -> str:
    """Return what a model without a mesh leaves out of a body that would yield elsewhere, else nothing."""
    gives = gives_elsewhere(case.bodies)
    return f"Left out: {gives}." if gives else ""


def motion(case: Case, V_n: float, V_t: float, Omega: float, mass: float, k2: float) -> RodMotion:
    """Return motion before and after (m/s, rad/s, gravity removed) and the rod's constants (kg, m2).

    ``V_n`` and ``V_t`` are those seen from the barrier as it was before the impact.
    """
    return RodMotion(
        friction=case.contact.f,
        alpha=case.scene.impact.angle,
        mass=mass,
        k_squared=k2,
        gamma=case.bodies.body.gamma,
        v_n=case.scene.impact.v_n,
        v_t=case.scene.impact.v_t,
        V_n=float(V_n) + case.scene.barrier.v_n,
        V_t=float(V_t) + case.scene.barrier.v_t,
        Omega=float(Omega),
    )


def after(motion: RodMotion) -> tuple[float, float, float]:
    """Return V_n and V_t, m/s, and Omega, rad/s, or raise ResultError where they are not known."""
    return known(motion.V_n), known(motion.V_t), known(motion.Omega)


def relative(motion: RodMotion, barrier: BarrierMotion) -> tuple[float, float, float]:
    """Return V_n and V_t as seen from the barrier after the impact, m/s, and the rod's Omega, rad/s."""
    V_n, V_t, Omega = after(motion)
    return V_n - known(barrier.V_bn), V_t - known(barrier.V_bt), Omega


def apart(case: Case) -> tuple[float, float]:
    """Return the rod's mass centre from that of a barrier that turns at first contact (n, t), m.

    The mass centre of the rod lies d_d above and d_c up the slope from the struck point.
    """
    d_c, d_d = case.contact.arms
    return d_d + (case.scene.barrier.centre_depth or 0.0), d_c - case.scene.barrier.centre_offset


def barrier_motion(case: Case, base_n: float, base_t: float, error: Num) -> BarrierMotion:
    """Return the motion of the barrier; ``base_n`` and ``base_t``, m/s, are what the impact added to it."""
    barrier = case.scene.barrier
    return BarrierMotion(
        mass=MASSIVE if barrier.mass is None else barrier.mass,
        v_bn=barrier.v_n,
        v_bt=barrier.v_t,
        V_bn=barrier.v_n + float(base_n),
        V_bt=barrier.v_t + float(base_t),
        Omega_b=UPRIGHT,
        angular_momentum_error=UPRIGHT,
        momentum_error=MASSIVE if barrier.mass is None else error,
    )


def momentum_error(case: Case, motion: RodMotion, base: Sequence[float], fallen: Sequence[float]) -> float:
    """Return the change of the momentum of rod and free barrier over that of the rod before.

    ``fallen`` (n, t), m/s, is what gravity gave the rod, as far as its motion still holds it.
    """
    before, M = case.scene.relative, case.scene.barrier.mass or 0.0
    V_n, V_t, _ = after(motion)
    gained_n = motion.mass * (V_n - motion.v_n + fallen[0]) + M * base[0]
    gained_t = motion.mass * (V_t - motion.v_t + fallen[1]) + M * base[1]
    return hypot(gained_n, gained_t) / (motion.mass * hypot(before.v_n, before.v_t))


def angular_momentum_error(
    case: Case,
    motion: RodMotion,
    barrier: BarrierMotion,
    Omega_b: float,
    start: tuple[float, float],
    away: tuple[float, float],
    fallen: tuple[float, float],
) -> float:
    """Return the change of the angular momentum of rod and barrier about their common mass centre.

    It is over the rod's momentum as seen from the barrier times the distance of the mass centres before.
    ``start`` and ``away`` (n, t), m, are the rod's mass centre from the barrier's before and after.
    ``fallen`` (n, t), m/s, is what gravity gave the rod, as far as its motion still holds it: it pulls at the
    rod alone, half way between ``start`` and ``away``.
    """
    before, struck, (start_n, start_t) = case.scene.relative, case.scene.barrier, start
    inertia, M = struck.inertia or 0.0, struck.mass or 0.0
    reduced_mass = motion.mass * M / (motion.mass + M)
    V_n, V_t, Omega = relative(motion, barrier)
    orbit = reduced_mass * (away[0] * V_t - away[1] * V_n - start_n * before.v_t + start_t * before.v_n)
    orbit += 0.5 * reduced_mass * ((start_n + away[0]) * fallen[1] - (start_t + away[1]) * fallen[0])
    spun = motion.mass * motion.k_squared * (Omega - before.omega) + inertia * Omega_b
    scale = motion.mass * hypot(before.v_n, before.v_t) * hypot(start_n, start_t)
    return abs(orbit + spun) / scale


def as_on_massive(case: Case, motion: RodMotion, barrier: BarrierMotion) -> RodMotion:
    """Return the motion relative to the barrier, of the mass and k^2 that a massive one would have met so."""
    share = 1.0 if case.scene.barrier.mass is None else 1 / (1 + motion.mass / case.scene.barrier.mass)
    V_n, V_t, _ = relative(motion, barrier)
    return replace(
        motion,
        mass=motion.mass * share,
        k_squared=motion.k_squared / share,
        v_n=motion.v_n - barrier.v_bn,
        v_t=motion.v_t - barrier.v_bt,
        V_n=V_n,
        V_t=V_t,
    )


def restitution(case: Case, motion: RodMotion, barrier: BarrierMotion, fallen: float = 0.0) -> Restitution:
    """Return impulse ratios, and the coefficients with the three sets of arms, of the relative motion.

    ``fallen`` is the speed, m/s, that gravity gave the rod in flights between contacts: a part of the motion,
    but no impulse.
    The centre of the impulse is the point at the height of the geometric contact where the moment
    impulse vanishes: d_c = (k^2 (Omega - omega) + d_d (V_t - v_t)) / (V_n - v_n), so e_m = -1.
    """
    if not isinstance(barrier.Omega_b, Unknown):
        return _on_turning(case, motion, barrier, barrier.Omega_b, fallen)
    (d_c, d_d), omega, m = case.contact.arms, case.scene.impact.omega, as_on_massive(case, motion, barrier)
    before, (V_n, V_t, Omega) = (m.v_n, m.v_t), after(m)
    if V_n <= m.v_n:
        none = unknown(ArmCoefficients, NO_PUSH.reason)
        return Restitution(mu=NO_PUSH, mu_c=NO_PUSH, paper=none, edge=none, impulse=none)
    e = float(rigid.restitution(m.v_n, V_n, Omega, d_c, omega))
    spin, alpha = m.k_squared * (Omega - omega), case.scene.impact.vertical
    centre = (spin + d_d * (V_t - m.v_t)) / (V_n - m.v_n)
    tests = tests_of(case.scene)
    table = tests.arms if tests else None
    E_0 = float(rigid.kinetic_energy(m.v_n, m.v_t, omega, mass=motion.mass, k2=motion.k_squared))
    return Restitution(
        mu=float(rigid.impulse_ratio(*before, V_n + fallen * cos(alpha), V_t + fallen * sin(alpha))),
        mu_c=float(rigid.critical_ratio(*before, e=e, d_c=d_c, d_d=d_d, k2=m.k_squared, omega=omega)),
        paper=_with_arms(float(table.d_c), float(table.d_d), omega, m, E_0)
        if table
        else unknown(ArmCoefficients, NO_TABLE),
        edge=_with_arms(d_c, d_d, omega, m, E_0),
        impulse=_with_arms(centre, d_d, omega, m, E_0),
    )


def _on_turning(
    case: Case, motion: RodMotion, barrier: BarrierMotion, Omega_b: float, fallen: float
) -> Restitution:
    """Return the coefficients on a barrier that turns: of the velocities of the two points that touch.

    The works of the normal and the tangential impulse are those of the mean relative velocity of the points.
    """
    (d_c, d_d), omega, struck = case.contact.arms, case.scene.impact.omega, case.scene.barrier
    depth, offset = struck.centre_depth or 0.0, struck.centre_offset
    V_n, V_t, Omega = after(motion)
    P_n, P_t = motion.mass * (V_n - motion.v_n), motion.mass * (V_t - motion.v_t)
    before_n = motion.v_n - barrier.v_bn + d_c * omega
    before_t = motion.v_t - barrier.v_bt - d_d * omega
    after_n = V_n + d_c * Omega - known(barrier.V_bn) - Omega_b * offset
    after_t = V_t - d_d * Omega - known(barrier.V_bt) - Omega_b * depth
    seen = case.scene.relative
    E_0 = float(rigid.kinetic_energy(seen.v_n, seen.v_t, omega, mass=motion.mass, k2=motion.k_squared))
    edge = ArmCoefficients(
        d_c=d_c,
        d_d=d_d,
        e=-after_n / before_n,
        e_m=TURNING,
        E_ln=-0.5 * P_n * (before_n + after_n) / E_0,
        E_lt=-0.5 * P_t * (before_t + after_t) / E_0,
    )
    other, alpha = unknown(ArmCoefficients, TURNING.reason), case.scene.impact.vertical
    still = V_n + fallen * cos(alpha), V_t + fallen * sin(alpha)
    pushed = still[0] > motion.v_n
    mu: Num = float(rigid.impulse_ratio(motion.v_n, motion.v_t, *still)) if pushed else NO_PUSH
    return Restitution(mu=mu, mu_c=TURNING, paper=other, edge=edge, impulse=other)


def _with_arms(d_c: float, d_d: float, omega: float, m: RodMotion, E_0: float) -> ArmCoefficients:
    """Return coefficients and losses over E_0, J, with one set of arms, m."""
    V_n, V_t, Omega = after(m)
    velocities = (m.v_n, m.v_t, V_n, V_t, Omega)
    body = {"d_c": d_c, "d_d": d_d, "k2": m.k_squared, "omega": omega}
    lost = rigid.losses(*velocities, **body, mass=m.mass)
    e: Num = UNDETERMINED
    e_m: Num = UNDETERMINED
    if m.v_n + d_c * omega < 0:
        coefficients = rigid.coefficients(*velocities, **body)
        e, moment = float(coefficients.e), d_c * (V_n - m.v_n) - d_d * (V_t - m.v_t) + m.k_squared * omega
        if abs(moment) > ROUND_OFF * d_d * (V_n - m.v_n):
            e_m = float(coefficients.e_m)
    return ArmCoefficients(
        d_c=d_c, d_d=d_d, e=e, e_m=e_m, E_ln=float(lost.E_ln) / E_0, E_lt=float(lost.E_lt) / E_0
    )


def rod_flows(case: Case) -> bool:
    """Return whether it is the rod that flows at the contact, by the contact law of the softer body."""
    return bool(case.contact.rod_yields and case.contact.softer == case.contact.rod)


def part_of_last(case: Case) -> float:
    """Return the part, 0 to 0.7, of the plastic work that the body takes which yields last.

    What counts is how strong both bodies are where most of the metal flows, by plastic strains of `EARLY` at
    the rate of the indentation: a body that the mean pressure of full flow in the weaker one does not make
    yield takes none, and one that is so much weaker `MOST_OF_LAST`. In between the part follows the third
    power of the distance from that ratio. In 47 runs by finite elements (edges at 45 degrees and round noses
    at 10; 26 with nine pairs of metals, of which in 17 the one that yields first hardens beyond the other)
    the part was 0.4 to 1.6 times that. An edge that is pressed in as a wedge strains more, and its metal can
    give way to the side: in 47 of 50 other runs (sharp edges at 4 to 70 degrees, chamfers, rounded edges and
    noses, 1 to 6 m/s, 18 pairs of metals; six ran after the rule was chosen, and five of them) the part was
    within 0.6 times that and 0.03 more.
    """
    pair, laws = case.contact, (case.slots.rod_law, case.slots.barrier_law)
    if len(pair.yielding) < 2:
        return 0.0
    pace, wedge = strain_rate(pair.estimate), _wedge(pair)
    strain = EARLY + wedge * (DEEP - EARLY)
    flows = [rate_factor(law.rate, pace) * float(law.flow_stress(strain)) for law in laws if law]
    flows[0] *= 1.0 - wedge * (1.0 - SQUARE)
    first, last = flows if pair.softer == pair.rod else flows[::-1]
    most = FULLY_PLASTIC / BEGINS
    less = 0.5 * max((most - max(first / last, last / first)) / (most - 1.0), 0.0) ** 3
    return MOST_OF_LAST * (less if first <= last else 1.0 - less)


def _wedge(pair: ContactPair) -> float:
    """Return how much of a square edge is pressed in: 0 of a round, 1 where its sides, at 90 degrees, touch.

    It is what the chords from the lowest point to both ends of the contact turn by, over 90 degrees, beyond
    the `ROUND` of a rounded one.
    """
    depth = pair.estimate.depth
    turned = sum(atan2(depth, reach) for reach in pair.body.reaches(pair.angle, depth))
    return min(max((turned / (0.5 * pi) - ROUND) / (1.0 - ROUND), 0.0), 1.0)


def plastic_shares(case: Case, share: float, skin: float = 0.0) -> tuple[float, float]:
    """Return plastic work of rod and barrier of that of both; the barrier's holds that of its ``skin``."""
    last = part_of_last(case) * share
    if rod_flows(case):
        return share - last, last
    last = max(min(last, share - skin), 0.0)
    return last, share - last
