"""A verdict in words: the three lines of its box, what it rests on, what it does not cover; and as JSON."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import copysign, degrees, isclose
from typing import Any

from fem_impact.answers.simulate import refused_by
from fem_impact.answers.verdict.assess import ANGLES, Verdict
from fem_impact.answers.verdict.levels import next_step
from fem_impact.answers.verdict.screening import Screening
from fem_impact.answers.verdict.vibration import (
    CALLED,
    CHANGED,
    MESHES,
    PROBABLY,
    GradedAnswer,
    VibrationEffect,
)
from fem_impact.case.case import Case
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome, installed_versions
from fem_impact.outcome.shares import SHARES, heat_ends, work_ends
from fem_impact.run.heated import below_melting
from fem_impact.run.simulate import simulate
from fem_impact.run.unusual import ROUND_OFF
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import FIRST
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.shapes import NamedShape
from fem_impact.scene.types import Scene, digest, to_dict
from fem_impact.tables.text import plain, with_band, wrapped

SCHEMA = "fem-impact/verdict/2"
LEAST_SHARE = 0.005
"""Shares of E_0 below it are not named among those of the rest."""
LEAST_HALF = 0.1
"""Per cent of E_0, to which shares are printed: no level knows them better."""

FIRST_ONLY = (
    "The first impact only: the rod keeps the rest of its energy and may strike again, which a run "
    "until rest follows.",
    "Fracture, chipping and wear of rod and barrier; chemical heat.",
    "Supports and other bodies that the rod or the barrier may touch.",
)

THERE: Mapping[GradedAnswer, str] = {
    "yes": "rigid theory may be used there",
    "no": "rigid theory may not be used there",
    "probably yes": "rigid theory may probably be used there",
    "probably no": "rigid theory may probably not be used there",
    "undecided": "whether rigid theory may be used there is undecided",
}
TOLD = 5e-4  # of e, beyond 1: three digits show it
ALL_OVER = "; rigid theory may be used at all of them"
FORMULA = "its restitution is a closed formula; give it a measured or computed one, the key restitution"
WHY: Mapping[str, str] = {
    "e": FORMULA,
    "energy": FORMULA,
    "friction": "its loss along the barrier counts plastic flow, too",
}
"""Why rigid theory has another number than a run whose vibration hardly matters."""
Line = tuple[str, str]


def box(v: Verdict) -> tuple[Line, Line, Line]:
    """Return title and sentence of the three lines that come first."""
    return (
        ("May rigid theory be used here?", _may(v)),
        ("Vibration takes", _vibration(v.here) if v.here else "a share that is not known."),
        ("The rest goes to", _rest(v.scene, v.here) if v.here else "parts that are not known."),
    )


def _may(v: Verdict) -> str:
    here, number = v.here, CALLED[v.of]
    told = f"no model tells by how much vibration changes {number}"
    if here:
        told = f"vibration changes {number} by {here.told}{doubt(here)}, by {here.model}"
    at = f"at this inclination, {degrees(v.scene.impact.angle):.4g} degrees"
    said = f"{at}, {told} (allowed: {v.tolerance:g}).{_beyond(v)} {_anywhere(v)}"
    answer = v.answer.upper()
    if v.answer in PROBABLY.values():
        answer += " (four of five such answers are right)"
    but = _but(v) if v.answer.endswith("yes") else ""
    return f"{answer} as to vibration: {said} {but}" if but else f"{answer}: {said}"


def _but(v: Verdict) -> str:
    """Return why --fidelity rigid does not give the number that a yes is about; nothing where it does."""
    if v.here is None:
        return ""
    if refused := refused_by(v.scene.untargeted, "rigid"):
        return f"But --fidelity rigid has no answer here: {refused}"
    key = CHANGED[v.of]
    theirs, ours = key.of(simulate(v.scene.untargeted, "rigid")), key.of(v.here.free)
    if v.scene.restitution is not None or isinstance(theirs, Unknown) or isinstance(ours, Unknown):
        return ""
    if abs(theirs - ours) <= v.tolerance:
        return ""
    numbers = f"{theirs:.3f} for {CALLED[v.of]} and {v.here.model} {ours:.3f}"
    return f"But --fidelity rigid has {numbers}: {WHY[v.of]}."


def _beyond(v: Verdict) -> str:
    """Say where an answer holds for the stated friction alone, not over its interval."""
    low, high = v.over_friction or (0.0, 0.0)
    changes = {"yes": max(low, high, key=abs), "no": 0.0 if low < 0.0 < high else min(low, high, key=abs)}
    side = v.answer.removeprefix("probably ")
    told, surface = changes.get(side, 0.0), v.scene.surface
    if v.over_friction is None or side not in changes or (abs(told) <= v.tolerance) == (side == "yes"):
        return ""
    ends = f"{surface.friction_low:g},{surface.friction_high:g}"
    return (
        f" That is for f = {surface.friction:g} alone: within its interval the change is {told:+.3f} by "
        f"the reduced model; --uncertain surface.friction={ends} answers for all of it."
    )


def doubt(change: VibrationEffect) -> str:
    """Return e of both twins where one of them is out of the range of a plain impact, else nothing."""
    free, stiff = (or_none(run.restitution.edge.e) for run in (change.free, change.stiff))
    if free is None or stiff is None or all(-ROUND_OFF <= e < 1 + TOLD for e in (free, stiff)):
        return ""
    return f" (doubtful: e is {free:.3f} with vibration and {stiff:.3f} without it, outside 0 to 1)"


def _anywhere(v: Verdict) -> str:
    """Say what holds for other inclinations of the same projectile at the same speed."""
    if v.worst is None:
        return "For other inclinations the answer is not known: change impact.angle and assess them, too."
    by = " by the reduced model" if v.fidelity == "solid" else ""
    least, most = (copysign(degrees(angle), v.scene.impact.angle) for angle in (ANGLES[0], ANGLES[-1]))
    over = f"from {least:.0f} to {most:.0f} degrees"
    holds = v.worst_answer == "yes"
    known = " of those where the change is known" * bool(v.not_known[0])
    if v.worst is v.here:
        return f"At no other inclination {over}{known} is the answer worse{by}{ALL_OVER * holds}."
    there = f"rigid theory may be used at every inclination {over}"
    there = there if holds else THERE[v.worst.graded(v.tolerance)]
    return (
        f"At the worst inclination{known}, {degrees(v.worst.angle):.0f} degrees (rod and velocity turned "
        f"together), it changes {v.of} by {v.worst.told}{doubt(v.worst)}{by}; {there}."
    )


def _vibration(effect: VibrationEffect) -> str:
    mean, band = 100 * max(effect.E_vib, 0.0), max(100 * effect.E_vib_band, LEAST_HALF / 100)
    share, half = with_band(mean, band).split(" +- ")
    share = f"{share} % of the energy"
    if or_none(effect.free.energy.below_floor):
        return f"{share}, which is below the numerical floor of the model"
    least, most = effect.E_vib - effect.E_vib_band, effect.E_vib + effect.E_vib_band
    range_ = f"0 to {plain(min(100 * most, 100.0), 2)} %" if least < 0 else f"± {half} %"
    return f"{share} ({range_}: error of {effect.model})"


def _rest(scene: Scene, effect: VibrationEffect) -> str:
    plate, named = scene.barrier.bends, scene.projectile.named
    energy = effect.free.energy
    parts = [(share, or_none(share.of(energy)) or 0.0) for share in SHARES if share.label != "vibration"]
    listed = [
        f"{named(share.label.replace('barrier', 'plate') if plate else share.label)} "
        f"{_percent(effect, share.key.path[-1], part)}"
        for share, part in parts
        if part > LEAST_SHARE
    ]
    kind = f"± error of {effect.model}" if effect.errors else f"by {effect.model}"
    thick = f"the plate is {1e3 * (scene.barrier.thickness or 0.0):g} mm thick; " if plate else ""
    return f"{', '.join(listed)} ({kind}); {thick}{_heating(effect)}"


def _percent(effect: VibrationEffect, name: str, part: float) -> str:
    """Return a share in per cent with its half-width, if known."""
    half = effect.errors.get(name)
    if half is None:
        return f"{plain(100 * part, 2)} %"
    return f"{with_band(100 * part, max(100 * half, LEAST_HALF), 0.0, 100.0)} %".replace("+-", "±")


def _heating(effect: VibrationEffect) -> str:
    """Return what can heat the contact."""
    energy = effect.free.energy
    skin, friction = energy.skin, or_none(energy.friction) or 0.0
    if not isinstance(skin, Unknown):
        alone = isinstance(energy.skin_rod, Unknown) or isinstance(energy.skin_barrier, Unknown)
        of = "the softer body" if alone else "both bodies"
        share = _percent(effect, "skin", skin)
        ends = "" if "skin" in effect.errors else heat_ends(effect.free)
        told = f"{share} can heat the contact (friction, and plastic work of {of} down to 0.1 mm)"
        return f"{told}; no error of it is known: {ends}" if ends else told
    if ends := work_ends(effect.free):
        return f"what can heat the contact is not known: {ends}"
    plastic = or_none(energy.plastic) or 0.0
    least, most = (plain(100 * part, 2) for part in (friction, friction + plastic))
    return f"{least} % (friction alone) to {most} % (with all plastic work) can heat the contact"


def basis(v: Verdict) -> tuple[Line, ...]:
    """Return what the verdict rests on: title and sentence."""
    here, twin = v.here, v.scene.projectile.named("the same scene with a rod that cannot vibrate")
    # the change is that of vanishing cells
    on = " (on the finest mesh)" if here and here.model == MESHES else ""
    return (
        ("case", case_sentence(v.scene)),
        ("T1/tau and gamma", f"{v.screening.sentence}."),
        *(((f"with vibration{on}", _motion(here.free)), (twin + on, _motion(here.stiff))) if here else ()),
        *((f"step {number}", f"{step}.") for number, step in enumerate(v.steps, 1)),
        *((("fidelity", f"{v.fidelity}. {here.source}"),) if here else ()),
        *((("heat of the contact", _heat(here, v.scene)),) if here else ()),
        *_other_angles(v),
        _friction(v),
        *(("note", note) for note in v.notes),
    )


def _heat(effect: VibrationEffect, scene: Scene) -> str:
    """Return how hot the contact becomes, or why that is not known."""
    heat = effect.free.heat
    if isinstance(heat.power, Unknown):
        return f"not known: {heat.power.reason}."
    mean = below_melting(scene, effect.heat[0]) if effect.heat else heat.temperature
    if isinstance(mean, Unknown):
        return f"the mean temperature of the patch is {mean.reason}."
    spot = (
        f"What single spots reach is {heat.bound.reason}"
        if isinstance(heat.bound, Unknown)
        else f"No spot exceeds {heat.bound:.0f} K, under the assumptions of the report"
    )
    told = f"{mean:.0f}"
    error = "The error of this mesh is not known: finer elements may give more. "
    if effect.heat is not None:
        ends = effect.free.ends_of(KEY_TABLE["flash_temperature_K"])
        told, error = with_band(*effect.heat, *ends).replace("+-", "±"), ""
    return (
        f"the patch reaches {told} K in the mean, by friction alone. {spot}. {error}Method: conduction of "
        "heat into both bodies (Jaeger 1942; Tian & Kennedy 1994, doi:10.1115/1.2927035)."
    )


def case_sentence(scene: Scene) -> str:
    """Return the scene in one sentence: body, material, barrier, impact."""
    rod, impact = scene.projectile, scene.impact
    parts = [f"{one.material.name} to {1e3 * one.to:g} mm" for one in rod.segments]
    materials = ", ".join(parts) or rod.material.name
    return (
        f"{scene.id}: {1e3 * rod.length:g} mm x {1e3 * rod.diameter:g} mm {rod.called} of {materials}, "
        f"{_form(rod)}{rod.bored}, {scene.projectile.rigid_body.mass:.3g} kg, on {struck(scene.barrier)}, "
        f"{degrees(impact.angle):.4g} degrees, v_n {impact.v_n:.4g} and v_t {impact.v_t:.4g} m/s, f "
        f"{scene.surface.friction:g} ({scene.surface.state})."
    )


def struck(barrier: Barrier) -> str:
    """Return what is struck: layers and material, of a plate its thickness and support."""
    layers = "".join(f"{1e3 * one.thickness:g} mm of {one.material.name} on " for one in barrier.layers)
    if barrier.thickness is None:
        return f"{layers}{barrier.material.name}"
    support = "free underneath" if barrier.bends else "bonded to a base"
    return f"{layers}a plate of {1e3 * barrier.thickness:g} mm of {barrier.material.name} ({support})"


def _form(rod: ProjectileSpec) -> str:
    if rod.shape is None:
        round_nose = rod.tip == "B" and isclose(2 * rod.tip_radius, rod.diameter)
        return "hemispherical nose" if round_nose else f"tip {rod.tip}"
    return rod.shape.name if isinstance(rod.shape, NamedShape) else "mesh" if rod.own_mesh else "profile"


def _motion(run: Outcome) -> str:
    return (
        f"e {run.told('e_edge')}, mu {run.told('mu')}, Omega {run.told('Omega_rad_per_s')} rad/s, "
        f"E_r {run.told('E_r_over_E_0', 100.0)} % of E_0."
    )


def _other_angles(v: Verdict) -> Iterator[Line]:
    if v.elsewhere is not None:
        alike = "Each has its own error, told like that here."
        error = alike if v.fidelity == "modal" else v.elsewhere.source
        yield "other inclinations", f"by the reduced model at every 5 degrees. {error}"
    angles, why = v.not_known
    if angles:
        at = ", ".join(f"{degrees(angle):.0f}" for angle in angles)
        yield "not known", f"at {at} degrees the reduced model gives no answer; at the first of them {why}"


def _friction(v: Verdict) -> Line:
    surface = v.scene.surface
    ends = f"f from {surface.friction_low:g} to {surface.friction_high:g}"
    if "friction" not in Case(v.scene).active:
        text = "none: the scene has no friction."
    elif surface.friction_low == surface.friction_high:
        text = (
            f"f = {surface.friction:g} is stated without an interval and counts as exact; give friction_low "
            "and friction_high to see what its uncertainty does."
        )
    elif v.over_friction is None:
        text = (
            f"what {ends} does is not known without the reduced model: assess both ends (surface.friction)."
        )
    else:
        low, high = v.over_friction
        text = f"over {ends} the reduced model's change of {v.of} runs from {low:+.3f} to {high:+.3f}."
    return "uncertain friction", text


def not_covered(v: Verdict) -> tuple[str, ...]:
    """Return what the verdict does not cover: what may make it wrong first, then what is never covered."""
    limitations = v.here.free.validity.limitations if v.here else Case(v.scene).limitations
    return (*texts(limitations), *never_covered(v.scene))


def never_covered(scene: Scene) -> tuple[str, ...]:
    """Return what no run of a scene covers; of one that is followed the later strikes are."""
    return tuple(map(scene.projectile.named, FIRST_ONLY[scene.impact.until != FIRST :]))


def lines_of(titled: Iterable[Sequence[str]], indent: str) -> list[str]:
    """Return titled sentences as lines of a terminal."""
    return [line for title, sentence in titled for line in wrapped(f"{title}: {sentence}", indent)]


def screening_lines(screening: Screening, scene: str) -> tuple[Line, ...]:
    """Return the closed-form screening of a scene and the command that gives the verdict on it."""
    return (
        ("rigid theory by the published limit (not a safe one)", f"{screening.sentence}."),
        ("the verdict", f"fem-impact assess {scene}"),
    )


def document(v: Verdict, command: str = "fem-impact assess") -> dict[str, Any]:
    """Return the verdict as plain JSON; ``command`` is that which gives it again."""
    return {
        "schema": SCHEMA,
        "scene": to_dict(v.scene),
        "scene_digest": digest(v.scene),
        "versions": installed_versions(),
        "within": {"of": v.of, "change": v.tolerance},
        "fidelity": v.fidelity,
        "answer": v.answer,
        "answer_any_angle": v.worst_answer,
        "refused_by_rigid": refused_by(v.scene.untargeted, "rigid") or None,
        "here": v.here and _change_entry(v.here),
        "worst": v.worst and _change_entry(v.worst),
        "not_known_rad": list(v.not_known[0]),
        "change_over_friction": list(v.over_friction) if v.over_friction else None,
        "screening": {
            "T1_s": v.screening.period,
            "tau_s": v.screening.duration,
            "T1_over_tau": v.screening.ratio,
            "gamma_per_m0_3815": v.screening.gamma,
            "published": v.screening.published,
        },
        "steps": list(v.steps),
        "box": [list(line) for line in box(v)],
        "missing": v.missing or None,
        "next_step": next_step(command, v.more),
        "basis": [list(line) for line in basis(v)],
        "not_covered": list(not_covered(v)),
        "with_vibration": v.here and v.here.free.to_dict(),
        "without_vibration": v.here and v.here.stiff.to_dict(),
    }


def _change_entry(change: VibrationEffect) -> dict[str, Any]:
    return {
        "angle_rad": change.angle,
        "change": change.value if change.is_known else None,
        "band": change.band,
        "rests_on": change.model,
        "E_vib_over_E_0": change.E_vib,
        "E_vib_band": change.E_vib_band,
        "errors_over_E_0": dict(change.errors),
        "source": change.source,
    }
