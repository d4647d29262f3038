"""What a scene states and calls for, as the document of which the command ``check`` makes its texts."""

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from fem_impact.answers.simulate import refused_by
from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.metals import RATES, flow_stresses, laws
from fem_impact.case.size import RunSize
from fem_impact.cli.paths import shown_path
from fem_impact.outcome.groups import EffectChoice
from fem_impact.outcome.keys import keys_of
from fem_impact.scene import fields
from fem_impact.scene.inputs import STATED, inputs, materials_of
from fem_impact.scene.library import CHANGED, intervals_of, materials
from fem_impact.scene.material import JohnsonCookRate, Material, tested_at
from fem_impact.scene.types import Scene, digest, to_dict


def statement_of(case: Case) -> dict[str, Any]:
    """Return the document of ``--json``, from which the texts are made; SI units."""
    scene, mesh = case.scene, list[str]()
    if own := scene.projectile.own_mesh:  # how its file was taken, a sentence each
        body = own.body()
        cells = f"{len(body.half.cells)} hexahedra in the half y >= 0"
        mesh = [f"mesh {shown_path(own.path)}: {cells}", *body.told]
    # why a fidelity refuses the scene, None where it answers it; finite elements do
    refusals: dict[str, str | None] = {"solid": None}
    refusals |= {fidelity: refused_by(scene, fidelity) or None for fidelity in ("modal", "rigid")}
    return {
        "scene": to_dict(scene),
        "digest": digest(scene),
        "mesh": mesh,
        "body": _body_entry(case.bodies),
        "sources": {row[0]: row[2] for row in inputs(scene).rows if row[2] != STATED},
        "intervals": {
            f"{place}.{key}": interval
            for place, metal in materials_of(scene).items()
            for key, interval in intervals_of(metal.name).items()
        },
        "laws": laws(case.bodies),
        # of each body that yields, at rest and at strain rates, 1/s
        "flow_stress_Pa": {
            body: dict(zip(("0", *(f"{rate:g}" for rate in RATES)), stresses, strict=True))
            for body, stresses in flow_stresses(case.bodies).items()
        },
        "defaults": _defaults(scene),
        "effects": [{key.name: key.of(choice) for key in keys_of(EffectChoice)} for choice in case.choices],
        "limitations": [asdict(one) for one in case.limitations],
        "fidelities": refusals,
        "size": None if scene.accuracy.target else _size_entry(case.size),
    }


def _defaults(scene: Scene) -> list[dict[str, str]]:
    """Return the values that are used where a scene states none, without those of which it states another."""
    tables, unstated = to_dict(scene), []
    for default in fields.DEFAULTS:
        section, _, name = default.key.partition(".")
        stated = tables.get(section, {}).get(name, default.value)
        if str(stated) == str(default.value):
            unstated.append({"key": default.key, "value": default.value, "source": default.source})
    return unstated + [
        line for place, metal in materials_of(scene).items() for line in _of_rate(place, metal)
    ]


def _of_rate(place: str, metal: Material) -> Iterator[dict[str, str]]:
    """Yield the numbers of a scene's own law of the rate that are those of one which states none."""
    rate = metal.rate
    if not isinstance(rate, JohnsonCookRate) or metal.name.removesuffix(CHANGED) in materials():
        return
    unstated = {"tested": tested_at(metal.flow, rate.reference)}
    for number in fields.RATES[rate.law]:
        value = getattr(rate, number.key)
        if value == unstated.get(number.key, number.default):
            key = f"{place}.rate.{number.key}"
            yield {"key": key, "value": str(number.write(value)), "source": number.source}


def _body_entry(bodies: Bodies) -> dict[str, float]:
    """Return what the theories need of the projectile, SI."""
    body, (d_c, d_d), (rho, z) = bodies.body, bodies.contact.arms, bodies.contact.touch_point
    R1, R2 = bodies.contact.principal_radii
    return {
        "mass_kg": body.mass,
        "centre_m": body.z_c,
        "inertia_kg_m2": body.mass * body.k2,
        "k2_m2": body.k2,
        "length_m": body.length,
        "diameter_m": body.diameter,
        "gamma": body.gamma,
        "touch_z_m": z,
        "touch_rho_m": rho,
        "touch_length_m": bodies.contact.touch.length,
        "R1_m": R1,
        "R2_m": R2,
        "d_c_m": d_c,
        "d_d_m": d_d,
        "bending_period_s": bodies.bending_period,
        "stretching_period_s": bodies.stretching_period,
        "ovalling_period_s": bodies.ovalling_period,
    }


def _size_entry(size: RunSize) -> dict[str, float]:
    return {
        "elements_rod": size.rod,
        "elements_barrier": size.barrier,
        "elements_yielding": size.yielding,
        "step_s": size.step,
        "steps": size.steps,
        "most_steps": size.most_steps,
        "memory_MB": round(size.memory / 1e6),
        "cpu_s": size.time,
        "most_cpu_s": size.most_time,
    }
