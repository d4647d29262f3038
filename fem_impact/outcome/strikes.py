"""The strikes of a body from its first to its rest, as an outcome holds them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.outcome.keys import Num, Unknown, group, key, keys_of, known

if TYPE_CHECKING:
    import pandas

_N = " (number from 1)"
_PHASE = ", at most, where vibration comes in with another phase; 0 without modes or vibration"
PHASED = "e", "mu", "friction", "vibration", "force"
"""Numbers of a strike that the phase of what vibrates before it changes, as told under NAME_phase."""
NO_ERROR = (
    "no error is known of the loss factor of vibration in flight, of what the balance leaves, of dents and "
    "of gauges; a rigid strike has no force"
)
"""Why W_damping_J, E_vib_before_J, E_other_J, dents, gauges and some forces have no half-width."""


@group
class StrikeRecord:
    """One strike: when, where, with which motion before and after, and what each account got of it."""

    time: float = key("time_s", "s", "Since first contact.")
    fidelity: str = key("fidelity", "", "What computed it: rigid, modal or solid.")
    part: str = key("part", "", "What struck: tip, tail, face, side, or the surface of a ball.")
    x: float = key("x_m", "m", "Its place across the axis, above 0 on the side that came down first.")
    z: float = key("z_m", "m", "Its place along the axis, from the tip.")
    along: float = key("along_m", "m", "Where it struck the barrier, up the slope from the first contact.")
    alpha: float = key("alpha_rad", "rad", "Angle between axis and normal, counted on over full turns.")
    approach: float = key("approach_m_per_s", "m/s", "Speed of the place towards the barrier.")
    sliding: float = key("sliding_m_per_s", "m/s", "Velocity of the place up the slope.")
    v_n: float = key("v_n_m_per_s", "m/s", "Normal velocity of the mass centre before.")
    v_t: float = key("v_t_m_per_s", "m/s", "Tangential velocity of the mass centre before.")
    omega: float = key("omega_rad_per_s", "rad/s", "Spin before.")
    V_n: float = key("V_n_m_per_s", "m/s", "Normal velocity of the mass centre after.")
    V_t: float = key("V_t_m_per_s", "m/s", "Tangential velocity of the mass centre after.")
    Omega: float = key("Omega_rad_per_s", "rad/s", "Spin after.")
    e: float = key("e", "-", "Ratio of the normal velocities of the place.")
    mu: float = key("mu", "-", "Impulse ratio.")
    impulse_n: float = key("impulse_n_Ns", "N s", "Normal impulse on the body.")
    impulse_t: float = key("impulse_t_Ns", "N s", "Tangential impulse on the body.")
    force: float | None = key("peak_force_N", "N", "Largest normal force; null of a strike without duration.")
    dent: float | None = key(
        "dent_depth_m",
        "m",
        "Depth of the dent that stays where it struck; null of a strike without finite elements.",
    )
    highest: float | None = key(
        "gauge_strain_highest",
        "-",
        "Largest strain at `save.gauge`; null without a gauge or finite elements.",
    )
    lowest: float | None = key("gauge_strain_lowest", "-", "Smallest strain there; null likewise.")
    before: float = key("E_before_J", "J", "Kinetic energy of the rigid motion before.")
    after: float = key("E_after_J", "J", "Kinetic energy of the rigid motion after.")
    friction: float = key("W_friction_J", "J", "Friction.")
    plastic: float = key("E_plastic_J", "J", "Plastic work of both bodies.")
    damping: float = key(
        "W_damping_J", "J", "Viscous loss of the contact, and of the modes in the flight before."
    )
    vibration: float = key("E_vib_J", "J", "Vibration after it.")
    taken: float = key("E_vib_before_J", "J", "Vibration before it, after the damping of the flight.")
    other: float = key(
        "E_other_J", "J", "Waves, residual stress, bending of a plate, and what the balance misses."
    )
    e_phase: float = key("e_by_phase", "-", f"Change of e{_PHASE}.")
    mu_phase: float = key("mu_by_phase", "-", f"Change of mu{_PHASE}.")
    friction_phase: float = key("W_friction_by_phase_J", "J", f"Change of friction{_PHASE}.")
    vibration_phase: float = key("E_vib_by_phase_J", "J", f"Change of the vibration after it{_PHASE}.")
    force_phase: float = key("peak_force_by_phase_N", "N", f"Change of the largest force{_PHASE}.")

    @property
    def lost(self) -> float:
        """Energy that the rigid motion lost, J."""
        return self.before - self.after


@group
class StrikeSpread:
    """What strikes as one of the first strikes in sequences over the stated intervals of what comes in."""

    number: int = key("strike", "-", "Number of the strike, from 1.")
    tip: int = key("tip", "-", "Sequences in which the tip strikes.")
    tail: int = key("tail", "-", "Sequences in which the tail strikes.")
    other: int = key("other", "-", "Sequences in which a face, a side or a ball strikes.")
    none: int = key("none", "-", "Sequences that have ended before.")
    time_low: float = key("time_low_s", "s", "Time below which a twentieth of those that strike do.")
    time_high: float = key("time_high_s", "s", "Time above which a twentieth of them do.")
    approach_low: float = key("approach_low_m_per_s", "m/s", "Speed below which a twentieth of them come.")
    approach_high: float = key("approach_high_m_per_s", "m/s", "Speed above which a twentieth of them come.")
    half_widths: Mapping[str, float] = key(
        "half_widths",
        "as its number",
        "Half-widths about the numbers of the strike, by its keys; none from the first strike on that is not "
        "of the same part of the body in all sequences.",
    )


@group
class Strikes:
    """All strikes of a body that is followed beyond its first impact, and where its energy went."""

    until: str = key(
        "strikes_until", "", 'How far the body was to be followed: "first", "N strikes" or "rest".'
    )
    each: tuple[StrikeRecord, ...] | Unknown = key("strikes", "s, m, m/s, J", "Each strike that counts.")
    end: str | Unknown = key(
        "strikes_end",
        "",
        "How it ends: rests, rolls on, slides on, leaves, tumbles on, bounces on, loses nothing, jams, "
        "or goes on.",
    )
    because: str | Unknown = key("strikes_ended_because", "", "Why it ended, as a sentence.")
    time: Num = key("strikes_time_s", "s", "From first contact to the end; to the rest of a body that rests.")
    time_factor: Num = key(
        "strikes_time_factor",
        "-",
        "Factor within which the time to the rest lies: the largest of ten rods, rigid theory beside modes.",
    )
    way: Num = key("strikes_way_m", "m", "Way of the mass centre up the slope until then.")
    hardest_energy: int | Unknown = key(
        "strikes_hardest_by_energy", "-", f"Strike that took most from the rigid motion{_N}."
    )
    hardest_force: int | Unknown = key("strikes_hardest_by_force", "-", f"Strike of the largest force{_N}.")
    hardest_heat: int | Unknown = key("strikes_hardest_by_heat", "-", f"Strike of the most friction{_N}.")
    other_end: Num = key(
        "strikes_other_end_over_first",
        "-",
        "Largest speed at which the other end strikes over that of the first strike.",
    )
    certain: int | Unknown = key(
        "strikes_certain",
        "-",
        "First strikes that are of the same part of the body in 64 sequences, which fill the stated "
        "intervals of friction, angle and speed and the half-widths of each strike.",
    )
    spread: tuple[StrikeSpread, ...] | Unknown = key(
        "strikes_spread", "s, m/s", "The first strikes in those sequences."
    )
    holds: str | Unknown = key("strikes_errors_hold", "", "What those sequences and half-widths hold.")
    hardest_agree: int | Unknown = key(
        "strikes_hardest_agree",
        "-",
        "Of those 64 sequences, how many have the same strike as the hardest by energy.",
    )
    force_agree: int | Unknown = key(
        "strikes_hardest_by_force_agree",
        "-",
        "The same by force; a strike of another part than this run's has the largest force over impulse of "
        "this run's strikes.",
    )
    heat_agree: int | Unknown = key("strikes_hardest_by_heat_agree", "-", "The same by friction.")
    other_end_low: Num = key(
        "strikes_other_end_over_first_low",
        "-",
        "strikes_other_end_over_first, less by as much as a twentieth of those sequences stay below it.",
    )
    other_end_high: Num = key(
        "strikes_other_end_over_first_high", "-", "The same, more by as much as a twentieth exceed it."
    )
    gravity: Num = key("strikes_W_gravity_J", "J", "Work of gravity, all flights and contacts.")
    friction: Num = key("strikes_W_friction_J", "J", "Friction of all strikes, and of sliding between them.")
    friction_half: Num = key(
        "strikes_W_friction_half_J",
        "J",
        "Its half-width: nine in ten of those sequences, and all after six strikes.",
    )
    plastic: Num = key("strikes_E_plastic_J", "J", "Plastic work of all strikes.")
    damping: Num = key("strikes_W_damping_J", "J", "Viscous loss of all contacts, and damping of the modes.")
    other: Num = key("strikes_E_other_J", "J", "What else the strikes took: see E_other_J of each.")
    settled: Num = key(
        "strikes_settled_J", "J", "Energy of what is too weak to count as a strike, lost without rebound."
    )
    left: Num = key("strikes_left_J", "J", "Energy of motion and vibration at the end.")
    residual: Num = key(
        "strikes_residual_over_E_0", "-", "What the balance over all strikes misses, over E_0."
    )

    def half_width(self, number: int, name: str) -> Num:
        """Return the half-width of a number of a strike, from 1, by its key, or why there is none.

        Raises
        ------
        UsageError
            Strikes have no such number.
        """
        names = [one.name for one in keys_of(StrikeRecord)]
        if name not in names:
            hint = did_you_mean(name, names, f"Give one of {', '.join(names)}.")
            raise UsageError("is no number of a strike.", key="name=", value=name, remedy=hint)
        if isinstance(self.spread, Unknown):
            return self.spread
        if isinstance(self.certain, Unknown) or number > self.certain:
            return Unknown(f"it is not certain what strike {number} is of: see strikes_spread")
        half = self.spread[number - 1].half_widths.get(name)
        return Unknown(NO_ERROR) if half is None else half

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a row a strike, with the columns of its JSON (ResultError: there are none)."""
        import pandas

        columns = tuple(keys_of(StrikeRecord))
        rows = [[one.of(strike) for one in columns] for strike in known(self.each)]
        return pandas.DataFrame(rows, columns=[one.name for one in columns])


def other_end(each: Sequence[StrikeRecord], length: float) -> Num:
    """Return the largest speed at which the other end strikes over that of the first strike."""
    if each[0].part == "surface":
        return Unknown("a ball has no other end")
    first = each[0].z < 0.5 * length
    others = [one.approach for one in each if (one.z < 0.5 * length) != first and one.part in ("tip", "tail")]
    if not others:
        return Unknown("the other end does not strike by itself")
    return max(others) / each[0].approach
