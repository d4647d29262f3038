"""Laws of scaling: the same impact at another length, density and stiffness, or stiffness and speed.

Coefficients and shares of the energy stay as they are when all lengths grow together; when density, stiffness
and strength do; and when stiffness and strength grow as the square of the speed. Rate dependence, gravity and
heat have scales of their own and are left out.
"""

from dataclasses import fields
from math import cos, radians, sin

import pytest
from random_scenes import METALS

from fem_impact.outcome.keys import or_none
from fem_impact.run.simulate import simulate
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import Impact
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.types import Accuracy, Save, Scene

BOUND = {"solid": 2e-3, "modal": 2e-5}  # of e, mu and each share of E_0
TITANIUM, COPPER = METALS[1], METALS[2]


def scene(length=1.0, stiff=1.0, dense=1.0, fast=1.0):
    """Return a yielding, sliding, bending impact, its lengths, moduli, densities and speeds multiplied."""
    angle, speed = radians(35), 3.0 * fast
    return Scene(
        id="scaled",
        title="a scaled impact",
        projectile=ProjectileSpec(
            0.05 * length, 0.012 * length, "B", 3e-3 * length, multiplied(TITANIUM, stiff, dense)
        ),
        barrier=Barrier(multiplied(COPPER, stiff, dense)),
        surface=Surface("custom", 0.3, 0.3, 0.3, "chosen"),
        impact=Impact(angle, -speed * cos(angle), -speed * sin(angle), -20.0 * fast / length),
        effects=("vibration", "friction", "rod-plasticity", "barrier-elastoplastic"),
        accuracy=Accuracy(
            tip_size=0.4e-3 * length, across=6, block_margin=4e-3 * length, unresolved="report"
        ),
        save=Save(frames=0),
    )


def multiplied(metal, stiff, dense):
    """Return a metal with other moduli and strengths, and another density."""
    return Material(
        metal.name,
        metal.E * stiff,
        metal.nu,
        metal.rho * dense,
        metal.yield_stress * stiff,
        metal.ultimate_stress * stiff,
    )


def numbers(outcome):
    """Return e, mu and the known shares of E_0, but for the work above a depth that does not scale."""
    names = {one.name for one in fields(outcome.energy)} - {"E_0", "skin", "skin_rod", "skin_barrier"}
    shares = {name: or_none(getattr(outcome.energy, name)) for name in names}
    known = {name: value for name, value in shares.items() if isinstance(value, float)}
    return known | {"e": outcome.restitution.edge.e, "mu": outcome.restitution.mu}


@pytest.fixture(scope="module", params=BOUND)
def plain(request):
    """The impact as it is, in a fidelity."""
    return request.param, simulate(scene(), request.param)


@pytest.mark.long
@pytest.mark.parametrize(
    ("changes", "time", "force"),
    [
        ({"length": 3.0}, 3.0, 9.0),
        ({"stiff": 2.5, "dense": 2.5}, 1.0, 2.5),
        ({"stiff": 4.0, "fast": 2.0}, 0.5, 4.0),
    ],
    ids=["length", "density and stiffness", "stiffness and speed"],
)
def test_a_scaled_impact_is_the_same(plain, changes, time, force):
    fidelity, before = plain
    after = simulate(scene(**changes), fidelity)
    bound = BOUND[fidelity]
    assert before.validity.finished and after.validity.finished
    assert before.restitution.edge.e < 0.9 and before.energy.plastic > 0.1
    assert numbers(after) == pytest.approx(numbers(before), abs=bound)
    assert after.motion.Omega * time == pytest.approx(before.motion.Omega, rel=bound)
    assert after.contact.peak_force == pytest.approx(force * before.contact.peak_force, rel=5 * bound)
    first, then = before.contact.intervals[0], after.contact.intervals[0]
    assert len(after.contact.intervals) == len(before.contact.intervals)
    assert then.duration == pytest.approx(time * first.duration, rel=5 * bound)
