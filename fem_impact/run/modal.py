"""From a modal impact to the outcome."""

from collections.abc import Callable
from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np

from fem_impact.case.case import Case
from fem_impact.case.effects import radiation
from fem_impact.case.effects.damping import loss_factor
from fem_impact.case.effects.plasticity import struck
from fem_impact.case.layers import require_heavier
from fem_impact.case.shaft import bends_beyond
from fem_impact.errors import SceneError
from fem_impact.modal.impact import Arrival, ModalResult, solve
from fem_impact.outcome.groups import Energy, Heat, Markers, RunCost, limitations
from fem_impact.outcome.keys import Num, Unknown, or_none, unknown
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.physics.contact_law import begins_to_yield
from fem_impact.progress import Progress
from fem_impact.run import common
from fem_impact.run.assemble import ImpactEnd, Reduction
from fem_impact.run.modal_error import digs_in, half_widths, place_of, sentence, with_barrier, with_waves
from fem_impact.run.modal_history import plastic_works
from fem_impact.run.resolution import without_coefficients
from fem_impact.tables.text import plain
from rigid import Turned

HALVINGS = 2  # of the time step
CHOICES = Unknown("effects are weighed for the finite elements; `fem-impact check` lists them")
NOT_MESHED = Unknown("the reduced model has no elements")
NO_STRESS = Unknown("the reduced model does not compute residual stress")
SOFT_ROD = Unknown(
    "the work in the surface of a projectile that is softer than the barrier is known by finite elements "
    "alone: this model was .14 and .17 of E_0 too high in two scenes"
)
OPEN = (
    "an edge digs in as in no stored scene, and the reduced model's half-width is {:.2g} of a number between "
    "0 and 1; finite elements (--fidelity solid) tell more"
)
UNDAMPED = Unknown("the reduced model has no material damping")
UNSENT = Unknown("a local contact law sends no waves into the barrier")
KEPT = Unknown("the modes of a body are computed once and kept")
HEAT = (
    "finite elements alone follow it (--fidelity solid); `fem-impact assess --for heat` estimates the "
    "temperature by the reduced model, with its error"
)


def closed(
    case: Case,
    progress: Callable[[Progress], None] | None = None,
    recorded: bool = False,
    arrival: Arrival | None = None,
    alone: bool = True,
) -> ModalResult:
    """Compute an impact as `solve` does, with half the time step, and half of that, while the ledger is open.

    Of 57 random scenes one missed 1.1e-4 of E_0, and half of it with half the step.
    """
    for halved in range(HALVINGS + 1):
        result = solve(case, progress, recorded, 0.5**halved, arrival, alone)
        if abs(result.residual / result.E_0) <= common.RESIDUAL_LIMIT:
            break
    return result


def reduce(case: Case, result: ModalResult) -> Outcome:
    """Return the Outcome of a modal impact."""
    barrier, flows = case.scene.barrier, case.contact.rod_yields or case.contact.barrier_yields
    turns = barrier.inertia is not None
    omitted, strange = common.flow_omitted(case), [_too_light(case), _unlike_layer(case), _lossy(case)]
    strange.append(bends_beyond(case.bodies, float(result.energies.max(initial=0.0))))
    strange.append(_round_edge(case) if result.laid else _level_flank(case))
    end = ImpactEnd(
        V_n=result.V_n,
        V_t=result.V_t,
        Omega=result.Omega,
        mass=result.rod.mass,
        k2=result.rod.k2,
        base=(result.V_bn, result.V_bt),
        leaving=result.V_n - result.V_bn,
        contacts=result.contacts,
        missing=result.residual / result.E_0,
        finished=result.finished,
        reason=result.reason,
        other_end=result.other_end,
        turn=(result.Omega_b, common.apart(case), result.away) if turns else None,
    )
    turned = abs(result.Omega_b) * float(result.contacts[-1, 1])
    tilted = f"The barrier turns by up to {turned:.2g} rad in contact, but its surface is taken as level."
    outcome = Reduction.of(case, end).outcome(
        _energy(case, result),
        unknown(Markers, "the camera's markers are followed on the finite elements only"),
        unknown(Heat, HEAT),
        _cost(result),
        peak_force=result.force,
        choices=CHOICES,
        sites=result.sites,
        unmeshed="the reduced model has no second mesh",
        limited=limitations(
            "model",
            *ASSUMPTIONS,
            DENTED.format("tip" if common.rod_flows(case) else "barrier") if flows else "",
            LAYERED if barrier.layers else "",
            omitted,
            *strange,
            LAID if result.laid else "",
            LEVEL if turns else "",
            tilted if turned > TILT_TOLD else "",
        ),
    )
    said = outcome.validity
    if why := next(filter(None, (omitted, *strange)), ""):
        return replace(outcome, validity=replace(said, model_band=Unknown(why)))
    place, speed = place_of(case, outcome), case.contact.approach
    halves, waves = half_widths(place, outcome, speed, common.part_of_last(case)), _waves(case, result)
    halves = with_waves(waves, outcome, with_barrier(barrier, outcome, halves), speed)
    if digs_in(outcome) and (half := halves.get("e_edge", 0.0)) >= 1.0:
        outcome = without_coefficients(outcome, Unknown(OPEN.format(half)))
    said = replace(
        said,
        model_band={key: halves[key] for key in halves if or_none(KEY_TABLE[key].of(outcome)) is not None},
        limitations=(
            *said.limitations,
            *limitations("model", sentence(place, outcome), WAVES.format(100 * waves) if waves else ""),
        ),
    )
    return replace(outcome, validity=said)


def _waves(case: Case, result: ModalResult) -> float:
    """Return the share of the normal energy that waves take from an elastic contact, 0 if it is small."""
    elastic = case.contact.compliant and not (begins_to_yield(case.contact) or result.laid)
    share = radiation.number(case.bodies) if elastic else 0.0
    return share if share > LEAST_WAVES else 0.0


def _too_light(case: Case) -> str:
    """Say that a free barrier is lighter than the metal that deforms, empty where it is not, or is rigid."""
    if case.scene.barrier.mass is None or not case.contact.compliant:
        return ""
    try:
        require_heavier(case.bodies, case.zones)
    except SceneError as light:
        return f"The barrier's mass of {light.value} {light.problem}" if light.key == "barrier.mass" else ""
    return ""


BESIDE = 0.1
"""Length of a flank over the radius of gyration, up to which its force acts where it begins."""


def _level_flank(case: Case) -> str:
    """Say that a flank is pressed in along its length, of which the model has the force at one end.

    Of a sphere-cone with a level flank of .36 of its radius of gyration E_r was .92 and E_vib .04 of E_0, by
    finite elements .80 and .14; with .12 E_r was .84 and .78. A cone 1 degree from level had friction .25 and
    .10.
    """
    body, angle = case.bodies.body, abs(case.contact.angle)
    if not isinstance(body, Turned):
        return ""
    step, height = np.diff(body.outline, axis=0), body.outline @ (-sin(angle), cos(angle))
    pressed = np.maximum(height[1:], height[:-1]) - height.min() < case.contact.round_contact.depth
    longest = float(np.hypot(*step[pressed & (step[:, 1] > 0.0)].T).max(initial=0.0))
    if longest <= BESIDE * sqrt(body.k2):
        return ""
    return (
        f"A flank of {1e3 * longest:.3g} mm is nearly level and is pressed in along its length: at which of "
        "its ends it bears, and so the motion after the impact, is not followed."
    )


BEYOND = 0.25
"""Length of the round contact beside a face over the face's diameter, up to which the face bears most."""


def _round_edge(case: Case) -> str:
    """Say that a face lands flat whose round edge bears much, empty where none does.

    The springs of a face end where its edge begins. A rod of 13 mm whose edge has a radius of 4.6 mm, .40 to
    .50 by this number, had 4.9, 3.8 and 2.6 kN on copper at 0, 7 and 14 degrees, by finite elements 12.5, 8.7
    and 7.6 kN, beyond the half-widths; with .18 and .28 these hold.
    """
    pair, face = case.contact, case.bodies.body.face
    if face <= 0.0 or abs(pair.angle) > pi / 4:  # a side lands
        return ""
    share = pair.round_contact.a_t / (2.0 * face)
    if share <= BEYOND:
        return ""
    return (
        f"The face lands flat, and the contact of its round edge is {share:.2g} of its diameter long: what "
        "bears beside the face is left out, so that forces are too low and dents too deep."
    )


LOSSY = 0.1
"""What a half wave may lose of its amplitude by the loss factor, pi eta / 2, while the body is in contact."""


def _lossy(case: Case) -> str:
    """Say that the body loses much of its vibration while it touches, empty where it does not."""
    eta = loss_factor(case.bodies)
    if 0.5 * pi * eta <= LOSSY:
        return ""
    return (
        f"Left out: the body's loss factor of {eta:g} takes much of its vibration while it still touches; "
        "here it does so after the impact alone, so that e is too high."
    )


def _unlike_layer(case: Case) -> str:
    """Say that a thin first layer is far softer or stiffer than what lies under it, empty where it is not.

    Layers of the stored scenes are metals on metals, and the model takes them as one material. Under a rod on
    4 mm of rubber over steel it had no friction; finite elements have 30 % of E_0. A rod on 0.6 mm of
    aluminium over steel eight times as strong had e .50 and 18 kN; finite elements .29 and 10 kN.
    """
    first, *below = struck(case.bodies)
    if not below:
        return ""
    times, under = max((max(first.E / metal.E, metal.E / first.E), metal.E) for metal in below)
    if times >= UNLIKE:
        much = f"{plain(times, 2)} times as {'soft' if first.E < under else 'stiff'} as"
    elif first.yields and any(WEAKER * first.yield_stress <= metal.yield_stress for metal in below):
        much = f"weaker by a factor of {WEAKER:g} or more than"
    else:
        return ""
    return (
        f"The first layer, thin for its contact, is {much} what lies under it: layers are taken as one "
        "material, and no stored scene has such a layer."
    )


def _energy(case: Case, result: ModalResult) -> Energy:
    E_0, vibration = result.E_0, result.vibration / result.E_0
    floor = abs(result.residual) / E_0
    plastic_rod, plastic_barrier = (work / E_0 for work in plastic_works(case, result))
    sheared: Num = result.skin / E_0
    skin_rod: Num = common.UNSHEARED if case.contact.rod_yields else 0.0
    skin_barrier: Num = result.skin / E_0 - result.friction / E_0
    if common.rod_flows(case):
        sheared = skin_rod = SOFT_ROD
        skin_barrier = common.UNSHEARED if case.contact.barrier_yields else 0.0
    return Energy(
        E_0=E_0,
        rigid=result.kinetic / E_0,
        vibration=vibration,
        vibration_check=Unknown("the free flight is exact in modes, so there is nothing to check it against"),
        vibration_floor=floor,
        below_floor=bool(vibration < floor),
        friction=result.friction / E_0,
        skin=sheared,
        skin_rod=skin_rod,
        skin_barrier=skin_barrier,
        plastic_rod=plastic_rod,
        plastic_barrier=plastic_barrier,
        locked_rod=NO_STRESS,
        locked_barrier=NO_STRESS,
        radiated=result.waves / E_0 if result.laid else UNSENT,
        plate=result.plate / E_0 if case.slots.plate else common.UNBENT,
        barrier=result.barrier / E_0 if case.scene.barrier.mass else common.MASSIVE,
        contact_dissipation=Unknown("the reduced model has no contact nodes"),
        damping=result.viscous / E_0 if case.slots.contact_loss else UNDAMPED,
        contact=result.stored / E_0 if result.stored else Unknown("nothing touches at the end"),
        gravity=result.fallen / E_0 if case.slots.gravity else Unknown("the gravity effect is off"),
        residual=result.residual / E_0,
        added_mass=NOT_MESHED,
    )


def _cost(result: ModalResult) -> RunCost:
    return replace(
        unknown(RunCost, NOT_MESHED.reason),
        steps=result.steps,
        wall=result.wall,
        cpu=result.cpu,
        setup_wall=KEPT,
        setup_cpu=KEPT,
        peak_memory=Unknown("the reduced model needs hardly any memory beside that of the program"),
        min_step=result.step,
    )


TILT_TOLD = 0.01  # rad, as for the rod's own rotation
LEVEL = "A barrier that turns moves the struck point with it, but the surface there keeps its direction."
LAID = (
    "A face or side that lands flat is a row of springs between its ends, with the stiffness of a flat punch "
    "or of a lying cylinder, and a dashpot for the waves that it sends into the barrier. Finite elements "
    "let them out where the effect radiation is on: the measured rod of 80 mm that lands flat at 1.5 m/s has "
    "e .91, by finite elements .89 +- .03 with that effect and .94 without it."
)
UNLIKE = 10.0
"""Ratio of the moduli of a thin first layer and of what lies under it, which no stored scene comes near."""
WEAKER = 3.0
"""The same of their yield stresses, where the first layer is the weaker one."""
LEAST_WAVES = 0.02
"""Share of the normal energy that waves in the barrier take, above which half-widths hold it besides."""
WAVES = (
    "Waves in the barrier take about {:.2g} % of the normal energy (Hunter 1957), which the reduced model "
    "leaves out: the half-widths of e, V_n and the rigid motion hold that, too."
)
LAYERED = (
    "The barrier's layers count as one material, with the stiffness and strength that they have under the "
    "estimated contact; waves in layers are left out."
)
DENTED = "A later contact of the same strike meets the dent that the first one left in the {}."
ASSUMPTIONS = (
    "Contact force by Hertz' law; where a body yields, by Tabor's hardness of the softer body over the "
    "groove that the tip presses into it. The elliptic contact is replaced by a circular one of the radius "
    "sqrt(R1 R2).",
    "The forces of a sliding tip that ploughs and of a contact that yields in shear hold two constants, "
    "found from six other impacts.",
    "Left out: residual stress, and waves in the barrier. Of two bodies that yield the one that does so "
    "first is pressed in alone; their strengths share the plastic work. W_skin lacks that in the surface of "
    "the other one, .01 and .03 of E_0 in two scenes of steel by finite elements.",
)
