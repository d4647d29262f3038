"""What an outcome holds, group by group, and what limits trust in it: sentences, each with its kind."""

from collections.abc import Iterable, Mapping
from typing import Literal

from fem_impact.outcome.keys import Num, Unknown, group, or_none

LimitationKind = Literal["input", "model", "range", "resolution", "result", "run"]


@group
class Limitation:
    """A sentence that limits how far a record may be trusted, with the kind of its cause.

    ========== ==================================================================================
    input      What scene and materials do not state, or leave out although its number matters
    model      What the model leaves out, idealises or takes from elsewhere
    range      Where the scene leaves what was measured
    resolution What elements, fine zones and modes do not resolve, or hardly
    result     A number that an impact on a resting barrier does not give by itself, and its cause
    run        What the computation did not do: write a frame, time an effect, reach a wanted error
    ========== ==================================================================================
    """

    kind: LimitationKind
    text: str


def limitations(kind: LimitationKind, *texts: str) -> tuple[Limitation, ...]:
    """Return the limitations of one kind that sentences state; an empty one states none."""
    return tuple(Limitation(kind=kind, text=text) for text in texts if text)


HEAVIEST_FIRST: tuple[LimitationKind, ...] = ("run", "resolution", "result", "input", "range", "model")
"""Kinds in the order in which they are told: what makes a number wrong before what the model leaves out."""
WRONG_NUMBERS = HEAVIEST_FIRST[:3]
"""Kinds that may make the numbers of this run wrong, told beside them."""


def by_weight(of: Iterable[Limitation]) -> tuple[Limitation, ...]:
    """Return limitations with the heaviest first, those of a kind in the order given."""
    return tuple(sorted(of, key=lambda one: HEAVIEST_FIRST.index(one.kind)))


def texts(of: Iterable[Limitation], *kinds: LimitationKind) -> tuple[str, ...]:
    """Return the sentences of limitations, heaviest first, of some ``kinds`` or of all."""
    return tuple(one.text for one in by_weight(of) if not kinds or one.kind in kinds)


ARMS = ("paper", "edge", "impulse")
"""The three sets of contact arms that every coefficient is given with."""


@group
class EffectChoice:
    """What was decided about one effect."""

    name: str
    on: bool
    forced: bool
    needed: bool
    measure: str
    number: float | None
    threshold: float
    source: str
    sentence: str
    share: float | None


@group
class Provenance:
    """Where a record comes from."""

    fidelity: str
    scene_id: str
    scene_title: str
    scene_digest: str
    created_utc: str
    versions: Mapping[str, str]
    effects: tuple[str, ...]
    effect_choices: tuple[EffectChoice, ...] | Unknown


@group
class Validity:
    """How far to trust a record: its end, what it leaves out, the error that was asked for and reached."""

    finished: bool
    stopped_because: str
    limitations: tuple[Limitation, ...]
    accuracy_target: Num
    achieved_error: Num
    achieved_wall: Num
    mesh_limit: Mapping[str, float] | Unknown
    mesh_band: Mapping[str, float] | Unknown
    model_band: Mapping[str, float] | Unknown


@group
class RodMotion:
    """The projectile and its motion at first contact and after the last separation, gravity removed."""

    friction: float
    alpha: float
    mass: float
    k_squared: float
    gamma: float
    v_n: float
    v_t: float
    V_n: Num
    V_t: Num
    Omega: Num


@group
class BarrierMotion:
    """The barrier as a whole, before and after the impact, in the frame of the projectile's velocities."""

    mass: Num
    v_bn: float
    v_bt: float
    V_bn: Num
    V_bt: Num
    Omega_b: Num
    angular_momentum_error: Num
    momentum_error: Num


@group
class ArmCoefficients:
    """Coefficients and losses by rigid impulse-momentum theory with one set of contact arms."""

    d_c: Num
    d_d: Num
    e: Num
    e_m: Num
    E_ln: Num
    E_lt: Num


@group
class Restitution:
    """Impulse ratio, and the coefficients with three sets of contact arms."""

    mu: Num
    mu_c: Num
    paper: ArmCoefficients
    edge: ArmCoefficients
    impulse: ArmCoefficients

    @property
    def tests_state_arms(self) -> bool:
        """Whether there are tests, with arms of their own beside the tip's."""
        return or_none(self.paper.e) not in (None, or_none(self.edge.e))


@group
class Energy:
    """Where the energy at first contact is after the last separation: E_0 in J, the rest as shares of it.

    Of a run that did not finish they are the energies at its stop.
    """

    E_0: float
    rigid: Num
    vibration: Num
    vibration_check: Num
    vibration_floor: Num
    below_floor: bool | Unknown
    friction: Num
    skin: Num
    skin_rod: Num
    skin_barrier: Num
    plastic_rod: Num
    plastic_barrier: Num
    locked_rod: Num
    locked_barrier: Num
    radiated: Num
    plate: Num
    barrier: Num
    contact_dissipation: Num
    damping: Num
    contact: Num
    gravity: Num
    residual: float
    added_mass: Num

    @property
    def plastic(self) -> Num:
        """Plastic work of both bodies over E_0; what is not known of one is in the other's."""
        if isinstance(self.plastic_rod, Unknown) and isinstance(self.plastic_barrier, Unknown):
            return self.plastic_rod
        return sum(or_none(work) or 0.0 for work in (self.plastic_rod, self.plastic_barrier))


@group
class ContactInterval:
    """One interval of contact, with its impulses on the whole projectile."""

    start: float
    end: float
    impulse_n: float
    impulse_t: float

    @property
    def duration(self) -> float:
        """Length of the interval, s."""
        return self.end - self.start


@group
class ContactSite:
    """One place of contact: the skin of the projectile that was pressed, as it lay before."""

    start: float
    end: float
    impulse_n: float
    impulse_t: float
    low_t: float
    high_t: float
    width: float
    depth: float


@group
class Markers:
    """Motion after the impact as the camera's two markers would give it."""

    V_n: Num
    V_t: Num
    Omega: Num
    V_cn: Num
    V_ct: Num


@group
class Readings:
    """What else a test may measure: the dent that stays, and the strain of a gauge on the projectile."""

    dent_depth: Num
    dent_volume: Num
    gauge_highest: Num
    gauge_lowest: Num


@group
class Contact:
    """The contact over time, and what a camera would have seen of the motion that it leaves."""

    intervals: tuple[ContactInterval, ...] | Unknown
    sites: tuple[ContactSite, ...] | Unknown
    strikes_again: bool | Unknown
    peak_force: Num
    readings: Readings
    markers: Markers


@group
class Heat:
    """What friction heats the contact to."""

    patch: Num
    power: Num
    flux: Num
    rise: Num
    temperature: Num
    ignition: Num
    time_above_ignition: Num
    bound: Num
    less_vibration: Num


@group
class RunCost:
    """What the run took."""

    steps: int | Unknown
    element_steps: int | Unknown
    elements_rod: int | Unknown
    elements_barrier: int | Unknown
    elements_yielding: int | Unknown
    wall: float
    cpu: float
    setup_wall: Num
    setup_cpu: Num
    peak_memory: Num
    min_step: Num
    tip_size: Num
    barrier_size: Num
    mass_scaling: Num

    @property
    def whole_wall(self) -> float:
        """Wall time of time loop and set-up, s; a set-up that is not known counts nothing."""
        return self.wall + (or_none(self.setup_wall) or 0.0)

    @property
    def whole_cpu(self) -> float:
        """Processor time of time loop and set-up, s; a set-up that is not known counts nothing."""
        return self.cpu + (or_none(self.setup_cpu) or 0.0)
