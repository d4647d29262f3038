"""From the end of a finite-element run to the quantities of the study: its outcome."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import rigid
from fem_impact.case.cells import advice
from fem_impact.case.effects.heating import halves, why_off
from fem_impact.case.shaft import bends_beyond
from fem_impact.errors import RunError
from fem_impact.outcome.groups import ContactSite, Energy, Heat, Readings, RodMotion, RunCost, limitations
from fem_impact.outcome.keys import Num, Unknown, known, or_none, unknown
from fem_impact.physics.contact import fall
from fem_impact.physics.flash import flash
from fem_impact.run.assemble import ImpactEnd, Reduction
from fem_impact.run.common import CUT_OFF, MASSIVE, UNBENT, after
from fem_impact.run.heated import heat
from fem_impact.run.markers import replay
from fem_impact.run.resolution import NOT_RESOLVED, unresolved
from fem_impact.run.unusual import LEAST_RATIO, PLOUGHING, pierced
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.dent import dent

if TYPE_CHECKING:
    from fem_impact.case.case import Case
    from fem_impact.case.record import Site
    from fem_impact.outcome.record import Outcome
    from fem_impact.solid.run import SolidResult


MOST_E = 1.2  # of an impact whose energy comes back by friction and bending
TRAPPED = 0.02  # of E_0 in waves of a block that lets none out: e may change by half of it
RINGING, LEAST = 0.1, 1e-4  # of E_vib and of E_0: so much above the modes is told
STIFF = Unknown("the vibration effect is off: the body is rigid behind its nose")
IN_WAVES = Unknown(
    "in a plate meshed through its thickness it is not told from the bending waves: W_plate holds both"
)
UNRELEASED = Unknown("the strain that the last forces release was not found")
UNGAUGED = "the scene has no strain gauge: give save.gauge, its distance from the tip"
NO_SECTIONS = "the strain along the axis is read from the equal slices of a turned body that deforms"
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
    case, m, contacts = result.case, result.motion, result.model.book.table
    # what gravity gave the rod beside its impact is taken out
    vertical = case.scene.impact.vertical
    fallen_n, fallen_t = fall(case.slots.gravity, vertical, result.time, contacts[:, :2])
    V_n = m.V_n + fallen_n
    end = ImpactEnd(
        V_n=V_n,
        V_t=m.V_t + fallen_t,
        Omega=m.Omega,
        mass=m.mass,
        k2=m.inertia / m.mass,
        base=result.base,
        leaving=float(V_n) - result.base[0],
        contacts=contacts,
        missing=result.worst / result.E_0,
        finished=result.finished,
        reason=result.reason,
        other_end=result.other_end,
        turn=result.turned,
    )
    reduction = Reduction.of(case, end)
    energy, narrow = _energy(result, reduction.motion), unresolved(result) or _held(reduction, case)
    read = readings(result)
    # measured shares of the run time take the place of expected ones
    choices = (replace(choice, share=result.shares.get(choice.name, choice.share)) for choice in case.choices)
    return reduction.outcome(
        energy,
        replay(result, *after(reduction.motion)[:2]),
        _heat(result, reduction.restitution.edge.E_lt, energy.vibration),
        _cost(result),
        peak_force=result.peak_force,
        choices=tuple(choices),
        unmeshed=ONE_MESH,
        limited=(
            *limitations("resolution", narrow, _ringing(result), _trapped(result.case, energy)),
            *result.limitations,
            *limitations(
                "result",
                bends_beyond(case.bodies, (or_none(energy.vibration) or 0.0) * energy.E_0),
                pierced(case, result.record, known(read.dent_depth)),
            ),
            *limitations("run", _untimed(result)),
        ),
        withheld=narrow if case.scene.accuracy.unresolved == "withhold" else "",
        sites=tuple(map(_site, result.record.sites)),
        readings=read,
    )


def readings(result: SolidResult) -> Readings:
    """Return the dent that a run leaves and the strains at its gauge."""
    contact, depth, volume = result.model.contact, 0.0, 0.0
    if isinstance(contact, SurfaceContact) and "barrier-elastoplastic" in result.case.active:
        depth, volume = dent(contact.barrier, result.state.x)
    highest: Num = Unknown(UNGAUGED if result.case.scene.save.gauge is None else NO_SECTIONS)
    lowest = highest
    if result.strain is not None:
        highest, lowest = float(result.strain.max()), float(result.strain.min())
    return Readings(dent_depth=depth, dent_volume=volume, gauge_highest=highest, gauge_lowest=lowest)


def _held(reduction: Reduction, case: Case) -> str:
    """Return why a contact counts as not resolved whose e and mu are both beyond what friction explains.

    A single row of nodes on an edge may be caught by one facet and thrown back: e was 3.8 on such a mesh.
    """
    e, mu = or_none(reduction.restitution.edge.e), or_none(reduction.restitution.mu)
    f = reduction.motion.friction
    if e is None or mu is None or e <= MOST_E or abs(mu) <= PLOUGHING * f + LEAST_RATIO:
        return ""
    return (
        f"{NOT_RESOLVED} e = {e:.3g} with mu = {mu:.3g} beyond f = {f:g}: single nodes were caught by the "
        f"facets of few cells. {advice(case.bodies)}"
    )


def _site(site: Site) -> ContactSite:
    """Return a place of contact of the whole rod; the record has that of the half model."""
    return ContactSite(
        start=site.start,
        end=site.end,
        impulse_n=site.impulse_n,
        impulse_t=site.impulse_t,
        low_t=site.low[0],
        high_t=site.high[0],
        width=2 * site.high[1] if site.low[1] <= 0 else site.high[1] - site.low[1],
        depth=site.depth,
    )


def _ringing(result: SolidResult) -> str:
    """Tell of vibration above the modes where it is not small beside theirs."""
    vibration, E_0 = result.flight.energy, result.E_0
    above = sum(result.vibration_check or (vibration,)) - vibration
    if above <= max(RINGING * vibration, LEAST * E_0):
        return ""
    return (
        f"E_vib lacks {above / E_0:.1e} of E_0 that vibrates above its {len(result.flight.a)} modes and that "
        "E_vib_check holds: fine cells of the tip ring by themselves, or the blow was too short for modes. "
        "To check it, double accuracy.across, or choose another accuracy.tip_size or accuracy.grid_shift."
    )


def _trapped(case: Case, energy: Energy) -> str:
    """Tell of waves that a block which lets none out keeps: an elastic barrier at rest holds no energy."""
    held, elastic = or_none(energy.locked_barrier) or 0.0, "barrier-elastic" in case.active
    if held <= TRAPPED or not elastic or "radiation" in case.active or case.scene.barrier.boundary == "fixed":
        return ""
    return (
        f"The elastic barrier keeps {held:.2g} of E_0: waves that its block lets not out, for the effect "
        "radiation is off. They may push the body anew, so that e is not sure. Give effects = "
        '["auto", "radiation"].'
    )


def _untimed(result: SolidResult) -> str:
    """Tell which effects' shares of the run time are not known, and why."""
    names = [name for name, share in result.shares.items() if share is None]
    if not names:
        return ""
    return (
        f"The share of the run time of {', '.join(names)} is not known: it was too short for the processor's "
        "clock beside the rest."
    )


def _energy(result: SolidResult, moved: RodMotion) -> Energy:
    a, E_0, barrier = result.accounts, result.E_0, result.case.scene.barrier
    V_n, V_t, Omega = after(moved)
    seen, k2 = (V_n - barrier.v_n, V_t - barrier.v_t), moved.k_squared
    kinetic = float(rigid.kinetic_energy(*seen, Omega, mass=moved.mass, k2=k2))
    given = 0.5 * (barrier.mass or 0.0) * (result.base[0] ** 2 + result.base[1] ** 2)
    given += 0.5 * (barrier.inertia or 0.0) * (result.turned.spin if result.turned else 0.0) ** 2
    stiff, vibration, floor = result.model.rod_stiffness is None, result.flight.energy, result.worst
    check = result.vibration_check
    locked = a["strain_rod"] - (check[1] if check else result.flight.strain)
    locked += a["kinetic_rod"] - result.motion.kinetic if stiff else 0.0  # the nose rings a little
    held = a["strain_barrier"] + a["kinetic_barrier"] - given
    sheared = {body: part * a[f"plastic_{body}"] for body, part in result.skin_shares.items()}
    bending = result.case.slots.bending is not None  # then what the plate holds are its waves

    unchecked = UNRELEASED if result.finished else CUT_OFF

    def share(energy: float) -> float:
        return float(energy / E_0)

    return Energy(
        E_0=E_0,
        rigid=share(kinetic),
        vibration=STIFF if stiff else share(vibration),
        vibration_check=share(sum(check)) if check else STIFF if stiff else unchecked,
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
        contact_dissipation=share(a["contact_dissipation"]),
        damping=_if_on(("material-damping", "contact-loss"), result, share(a["damping"])),
        contact=Unknown("what a contact holds is strain energy of the meshed bodies"),
        gravity=_if_on(("gravity",), result, share(kinetic - result.motion.kinetic - a["gravity"])),
        residual=share(a["residual"]),
        added_mass=share(result.added_energy),
    )


def _if_on(effects: tuple[str, ...], result: SolidResult, share: float) -> Num:
    """Return a share that one of the effects makes, the reason where all are off."""
    if set(effects) & set(result.case.active):
        return share
    are = "effect is" if len(effects) == 1 else "effects are"
    return Unknown(f"the {' and '.join(effects)} {are} off")


def _heat(result: SolidResult, E_lt: Num, vibration: Num) -> Heat:
    """Return flash temperature and bound, and rigid theory's friction loss less the vibration in it."""
    watch = result.heat
    if watch is None or not watch.power:
        return unknown(Heat, why_off(result.case.bodies))
    power, patch, speed = (np.array(values) for values in (watch.power, watch.patch, watch.speed))
    flux = np.divide(power, patch, out=np.zeros_like(power), where=patch > 0)
    rise = flash(np.array(watch.t), flux, np.sqrt(patch / np.pi), speed, *halves(result.case.bodies))
    peaks = (float(power.max()), float(flux.max()), float(patch.max()))
    less = vibration if isinstance(vibration, Unknown) else known(E_lt) - vibration
    return heat(result.case, rise, *peaks, less, float(speed.max()))


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
