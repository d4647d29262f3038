"""From the end of a finite-element run to the quantities of the study: its outcome."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import rigid
from fem_impact.case.effects.heating import halves
from fem_impact.errors import RunError
from fem_impact.outcome.groups import (
    BarrierMotion,
    Contact,
    ContactInterval,
    EffectChoice,
    Energy,
    Heat,
    RodMotion,
    RunCost,
    Validity,
)
from fem_impact.outcome.keys import Num, Unknown, known, unknown
from fem_impact.outcome.record import Outcome
from fem_impact.physics.contact import between, fall
from fem_impact.physics.flash import flash
from fem_impact.run.common import (
    CUT_OFF,
    MASSIVE,
    UNBENT,
    after,
    angular_momentum_error,
    barrier_motion,
    comes_down,
    gravity_warning,
    heat,
    momentum_error,
    motion,
    open_ledger,
    provenance,
    relative,
    restitution,
    too_slow,
    validity,
)
from fem_impact.run.doubts import doubts
from fem_impact.run.markers import replay
from fem_impact.run.resolution import unresolved, without, without_end

if TYPE_CHECKING:
    from fem_impact.solid.run import SolidResult


RINGING, LEAST = 0.1, 1e-4  # of E_vib and of E_0: so much above the modes is told
STIFF = Unknown("the vibration effect is off: the rod is rigid behind its nose")
IN_WAVES = Unknown(
    "in a plate meshed through its thickness it is not told from the bending waves: W_plate holds both"
)
ONE_MESH = "error unknown: run a second tip size, or `fem-impact cost`"


def reduce(result: SolidResult) -> Outcome:
    """Return the Outcome of a run.

    Raises
    ------
    RunError
        If the run ended before the rod touched the barrier: there is no impact to reduce.
    """
    if not result.model.book.intervals:
        past = f"{result.time * 1e6:.3g} us, {result.steps} steps"
        raise RunError(f"There was no contact in {past}. {result.reason}")
    case, moved = result.case, _motion(result)
    fallen = (case.slots.gravity or 0.0) * between(result.model.book.table[:, :2])
    error = momentum_error(case, moved, *result.base, fallen)
    struck = barrier_motion(case, *result.base, error)
    if (turn := result.turned) is not None:
        error = angular_momentum_error(case, moved, struck, *turn)
        struck = replace(struck, Omega_b=turn.spin, angular_momentum_error=error)
    coefficients, energy = restitution(case, moved, struck, fallen), _energy(result, moved)
    origin = provenance(case, _choices(result))
    reason = unresolved(result)
    withheld = bool(reason) and case.scene.accuracy.unresolved == "withhold"
    failed = open_ledger(result.worst / result.E_0) or too_slow(case, result.model.book.table[:, :2])
    cut = failed or ("" if result.separated else result.reason)
    doubted = [] if withheld or cut else doubts(origin, moved, coefficients, energy)
    outcome = Outcome(
        provenance=origin,
        validity=_validity(result, failed, relative(moved, struck)[0], doubted),
        motion=moved,
        barrier=struck,
        restitution=coefficients,
        energy=energy,
        contact=_contact(result, moved, struck),
        heat=_heat(result, coefficients.edge.E_lt, energy.vibration),
        cost=_cost(result),
    )
    outcome = without(outcome, Unknown(reason)) if withheld else outcome
    return without_end(outcome, cut) if cut else outcome


def _choices(result: SolidResult) -> tuple[EffectChoice, ...]:
    """Return the choice of effects; measured shares of the run time take the place of expected ones."""
    return tuple(
        replace(choice, share=result.shares.get(choice.name, choice.share)) for choice in result.case.choices
    )


def _validity(result: SolidResult, failed: str, V_n: float, doubts: list[str]) -> Validity:
    case, contacts = result.case, result.model.book.table[:, :2]
    return validity(
        case,
        result.finished and not failed,
        failed or result.reason,
        V_n,
        ONE_MESH,
        warnings=[*_doubts(result), *doubts, *gravity_warning(case, contacts), *case.warnings],
    )


def _doubts(result: SolidResult) -> list[str]:
    told = (unresolved(result), *result.warnings, *_ringing(result), *_untimed(result))
    return [sentence for sentence in told if sentence]


def _ringing(result: SolidResult) -> list[str]:
    """Tell of vibration above the modes where it is not small beside theirs."""
    vibration, E_0 = result.flight.energy, result.E_0
    above = sum(result.vibration_check or (vibration,)) - vibration
    if above <= max(RINGING * vibration, LEAST * E_0):
        return []
    return [
        f"E_vib lacks {above / E_0:.1e} of E_0 that vibrates above its {len(result.flight.a)} modes and that "
        "E_vib_check holds: fine cells of the tip ring by themselves, or the blow was too short for modes. "
        "Compare twice the accuracy.across, or another accuracy.tip_size or grid_shift."
    ]


def _untimed(result: SolidResult) -> list[str]:
    """Tell which effects' shares of the run time are not known, and why."""
    names = [name for name, share in result.shares.items() if share is None]
    if not names:
        return []
    return [
        f"The share of the run time of {', '.join(names)} is not known: it was too short for the processor's "
        "clock beside the rest."
    ]


def _motion(result: SolidResult) -> RodMotion:
    """Return velocities before and after; what gravity gave the rod in contact and after it is taken out."""
    case, m, alpha = result.case, result.motion, result.case.scene.impact.angle
    fallen = fall(case.slots.gravity, result.time, result.model.book.table[:, :2])
    V_n, V_t = m.V_n + fallen * np.cos(alpha), m.V_t + fallen * np.sin(alpha)
    return motion(case, V_n, V_t, m.Omega, m.mass, m.inertia / m.mass)


def _energy(result: SolidResult, moved: RodMotion) -> Energy:
    a, E_0, barrier = result.accounts, result.E_0, result.case.scene.barrier
    V_n, V_t, Omega = after(moved)
    seen, k2 = (V_n - barrier.v_n, V_t - barrier.v_t), moved.k_squared
    kept = float(rigid.kinetic_energy(*seen, Omega, mass=moved.mass, k2=k2))
    given = 0.5 * (barrier.mass or 0.0) * (result.base[0] ** 2 + result.base[1] ** 2)
    given += 0.5 * (barrier.inertia or 0.0) * (result.turned.spin if result.turned else 0.0) ** 2
    stiff, vibration, floor = result.model.rod_stiffness is None, result.flight.energy, result.worst
    check = result.vibration_check
    locked = a["strain_rod"] - (check[1] if check else result.flight.strain)
    locked += a["kinetic_rod"] - result.motion.kinetic if stiff else 0.0  # the nose rings a little
    held = a["strain_barrier"] + a["kinetic_barrier"] - given
    sheared = {body: part * a[f"plastic_{body}"] for body, part in result.skin_shares.items()}
    bending = result.case.slots.bending is not None  # then what the plate holds are its waves

    def share(energy: float) -> float:
        return float(energy / E_0)

    return Energy(
        E_0=E_0,
        rigid=share(kept),
        vibration=STIFF if stiff else share(vibration),
        vibration_check=share(sum(check)) if check else STIFF if stiff else _unchecked(result),
        vibration_floor=STIFF if stiff else share(floor),
        below_floor=STIFF if stiff else bool(vibration < floor),
        friction=share(a["friction"]),
        skin=share(a["friction"] + sheared["rod"] + sheared["barrier"]),
        skin_rod=share(sheared["rod"]),
        skin_barrier=share(sheared["barrier"]),
        plastic_rod=share(a["plastic_rod"]),
        plastic_barrier=share(a["plastic_barrier"]),
        locked_rod=share(locked),
        locked_barrier=IN_WAVES if bending else share(held),
        radiated=share(a["radiated"]),
        plate=share(a["plate"] + held * bending) if result.case.slots.plate or bending else UNBENT,
        barrier=share(given) if barrier.mass else MASSIVE,
        closing=share(a["closing"]),
        damping=_if_on("material-damping", result, share(a["damping"])),
        contact=Unknown("what a contact holds is strain energy of the meshed bodies"),
        gravity=_if_on("gravity", result, share(kept - result.motion.kinetic - a["gravity"])),
        residual=share(a["residual"]),
        added_mass=share(result.added_energy),
    )


def _if_on(effect: str, result: SolidResult, share: float) -> Num:
    return share if effect in result.case.active else Unknown(f"the {effect} effect is off")


def _unchecked(result: SolidResult) -> Unknown:
    if result.finished:
        return Unknown("the strain that the last forces release was not found")
    return CUT_OFF


def _heat(result: SolidResult, E_lt: Num, vibration: Num) -> Heat:
    """Return flash temperature and bound, and rigid theory's friction loss less the vibration in it."""
    watch = result.heat
    if watch is None or not watch.power:
        return unknown(Heat, "the contact-heating effect is off")
    power, patch, speed = (np.array(values) for values in (watch.power, watch.patch, watch.speed))
    flux = np.divide(power, patch, out=np.zeros_like(power), where=patch > 0)
    found = flash(np.array(watch.t), flux, np.sqrt(patch / np.pi), speed, *halves(result.case.bodies))
    peaks = (float(power.max()), float(flux.max()), float(patch.max()))
    less = vibration if isinstance(vibration, Unknown) else known(E_lt) - vibration
    return heat(result.case, found, *peaks, less)


def _contact(result: SolidResult, moved: RodMotion, struck: BarrierMotion) -> Contact:
    intervals = (
        ContactInterval(start=i.start, end=i.end, impulse_n=float(i.impulse_n), impulse_t=float(i.impulse_t))
        for i in result.model.book.intervals
    )
    return Contact(
        intervals=tuple(intervals),
        strikes_again=comes_down(relative(moved, struck)[0]) if result.finished else CUT_OFF,
        peak_force=result.peak_force,
        markers=replay(result, *after(moved)[:2]),
    )


def _cost(result: SolidResult) -> RunCost:
    g, cost = result.model.geometry, result.cost
    rod, barrier = len(g.rod.mesh.cells), len(g.barrier.cells) if g.barrier is not None else 0
    return RunCost(
        steps=result.steps,
        element_steps=result.steps * (rod + barrier),
        elements_rod=rod,
        elements_barrier=barrier,
        elements_yielding=sum(z.count for z in result.model.zones),
        wall=cost.wall,
        cpu=cost.cpu,
        setup_wall=cost.setup_wall,
        setup_cpu=cost.setup_cpu,
        peak_memory=cost.memory_MB,
        min_step=cost.smallest_step,
        tip_size=g.tip_size,
        barrier_size=g.barrier_size if g.barrier is not None else Unknown("the barrier is rigid"),
        mass_scaling=result.model.scaling,
    )
