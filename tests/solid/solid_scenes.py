"""Scenes and coarse models that the solver's tests share; a run is made once a session."""

from dataclasses import replace
from functools import cache
from math import pi

from fem_impact.case.case import Case
from fem_impact.scene.shipped import load
from fem_impact.solid.build import build
from fem_impact.solid.run import solve

MACHINED = 0.57
SHARP = {"tip": "plain", "tip_radius": 0.0}
# keys of an outcome that differ from run to run of the same scene
OF_THE_CLOCK = {
    *("created_utc", "wall_s", "cpu_s", "setup_wall_s", "setup_cpu_s"),
    *("peak_memory_MB", "effect_choices"),
}


def scene(
    *effects,
    length=0.24,
    v_n=-1.5,
    v_t=-1.5,
    f=MACHINED,
    tip=0.8e-3,
    across=6,
    angle=pi / 4,
    omega=0.0,
    max_time=2.5e-3,
    sharp=False,
):
    """A rod with a 3 mm edge on a mesh fit for tests."""
    base = load("t5b")
    return replace(
        base,
        id="test",
        measured=None,
        projectile=replace(base.projectile, length=length, **(SHARP if sharp else {})),
        surface=replace(base.surface, state="custom", friction=f, friction_low=f, friction_high=f),
        impact=replace(base.impact, angle=angle, v_n=v_n, v_t=v_t, omega=omega),
        effects=effects,
        accuracy=replace(base.accuracy, tip_size=tip, across=across, max_time=max_time, unresolved="report"),
        save=replace(base.save, frames=0),
    )


def model(*effects, **changes):
    """A fresh model: its items hold what moves."""
    return build(Case.of(scene(*effects, **changes)))


@cache
def run(*effects, **changes):
    """The end of a run; read only."""
    return solve(Case.of(scene(*effects, **changes)))
