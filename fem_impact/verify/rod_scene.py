"""Scenes of dropped rods for problems that the project's own builder can state."""

from __future__ import annotations

from dataclasses import replace

from fem_impact.scene import Material, Scene, load
from fem_impact.verify.problem import Values

__all__ = ["rod_scene"]


def rod_scene(p: Values, effects: tuple[str, ...]) -> Scene:
    """Return a scene from parameters; absent ones take the values of a frictionless drop.

    Used are length, diameter, tip_radius, E, nu, rho, barrier_E, angle, v_n, v_t (approach speeds above 0),
    omega, f, tip_size, across, max_time.
    """
    base = load("t5b")
    rod = Material("steel", p["E"], p["nu"], p["rho"], 1e9, 1e9)
    plate = replace(rod, E=p.get("barrier_E", p["E"]))
    f = p.get("f", 0.0)
    return replace(
        base,
        id="verify",
        title="a rod of the verification",
        measured=None,
        projectile=replace(
            base.projectile,
            length=p["length"],
            diameter=p["diameter"],
            tip="B",
            tip_radius=p["tip_radius"],
            material=rod,
        ),
        barrier=replace(base.barrier, material=plate),
        surface=replace(base.surface, state="custom", friction=f, friction_low=f, friction_high=f),
        impact=replace(
            base.impact, angle=p["angle"], v_n=-p["v_n"], v_t=-p["v_t"], omega=p.get("omega", 0.0)
        ),
        effects=effects,
        accuracy=replace(
            base.accuracy, tip_size=p["tip_size"], across=int(p["across"]), max_time=p["max_time"]
        ),
        save=replace(base.save, frames=0),
    )
