"""Selective mass scaling: the step grows, the rigid motion of the rod stays, results hardly move."""

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.fem.body import MeshedBodies
from fem_impact.fem.mass_scaling import MOST_REMOVED, crossing_times, scaled_rod
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.yielding import gauss_volumes

QUICK = replace_all(load("quick"), {"save.frames": 0, "accuracy.unresolved": "report"})


def scaled(factor, scene=QUICK, **changes):
    changes = {f"accuracy.{key}": value for key, value in changes.items()}
    return replace_all(scene, {"accuracy.mass_scaling": factor, **changes})


def volumes(mesh):
    return gauss_volumes(mesh.points[mesh.cells]).sum(axis=1)


def moments(body):
    """Mass, first moments along t and n, and moment of inertia about the b axis of a rod's nodes."""
    t, _, n = np.moveaxis(body.points[body.mesh.cells], 2, 0)
    return [float((body.mass * weight).sum()) for weight in (1.0, t, n, t**2 + n**2)]


@pytest.mark.parametrize("name", ["quick", "t6-17", "elastic-frictionless"])
def test_a_scaled_rod_keeps_mass_centre_and_inertia(name):
    true, heavy = (MeshedBodies(Case.of(scaled(factor, load(name)))) for factor in (1.0, 4.0))
    assert moments(heavy.rod) == pytest.approx(moments(true.rod), rel=1e-10, abs=1e-15)
    factors = heavy.rod.mass / true.rod.mass
    assert factors.max() > 2.0
    assert 1 - MOST_REMOVED <= factors.min() < 1.0
    slices = heavy.geometry.rod.body_cells.ravel()
    assert (factors[slices] == 1.0).all()


@pytest.mark.long
def test_the_step_grows_with_the_root_of_the_scaling():
    steps = {factor: build(Case.of(scaled(factor, load("t5b")))).step for factor in (1.0, 2.0, 4.0)}
    assert steps[2.0] / steps[1.0] == pytest.approx(np.sqrt(2.0), rel=0.05)
    assert steps[4.0] / steps[1.0] == pytest.approx(2.0, rel=0.05)


def test_a_rod_takes_no_more_than_it_can_make_up_for():
    wanted = build(Case.of(scaled(25.0, load("t6-17"))))
    assert 1.0 < wanted.scaling < 25.0
    assert wanted.added_mass.max() > 0.0 > wanted.added_mass.min()


def test_a_rod_without_larger_cells_keeps_its_masses():
    place = np.random.default_rng(0).random((6, 8, 3))
    mass, crossing = np.ones((6, 8)), np.full(6, 1e-9)
    same, factor = scaled_rod(mass, place, np.ones(6, bool), crossing, 1e-9, 4.0)
    assert factor == 1.0
    assert (same == mass).all()


def test_a_wave_crosses_a_box_through_its_thinnest_side():
    bodies = MeshedBodies(Case.of(QUICK))
    barrier = bodies.geometry.barrier
    times = crossing_times(barrier, barrier.points, bodies.materials["barrier"])
    edges = np.ptp(barrier.points[barrier.cells], axis=1)
    box = np.isclose(volumes(barrier), edges.prod(axis=1), rtol=1e-9, atol=0.0)
    speed = np.sqrt(206e9 * 0.71 / (1.29 * 0.42) / 7850.0)
    assert (edges[box, 2] < 0.2 * edges[box, 0]).sum() >= 50  # the lowest of the thin rows
    assert times[box] == pytest.approx(edges[box].min(axis=1) / speed, rel=1e-6)


@pytest.mark.long
def test_scaled_masses_hardly_move_the_result_and_are_told():
    true, heavy = (simulate(scaled(factor)) for factor in (1.0, 4.0))
    assert heavy.cost.steps < 0.7 * true.cost.steps
    assert heavy.restitution.edge.e == pytest.approx(true.restitution.edge.e, rel=0.02)
    assert heavy.restitution.mu == pytest.approx(true.restitution.mu, rel=0.005)
    assert heavy.energy.vibration == pytest.approx(true.energy.vibration, abs=2e-4)
    assert abs(heavy.energy.residual) < 1e-4
    assert (true.cost.mass_scaling, true.energy.added_mass > 0) == (1.0, True)  # thin rows of the barrier
    assert 2.0 < heavy.cost.mass_scaling < 4.0  # what the short nose can make up for
    assert true.energy.added_mass < heavy.energy.added_mass < 5e-3


def test_thin_rows_gain_mass_where_the_rod_can_make_up_for_no_more():
    """Asked for: a scaling of 4, or 0.15 at least; the cells that are large enough give the mass."""
    place = np.random.default_rng(0).random((60, 8, 3))
    mass, crossing = np.ones((60, 8)), np.where(np.arange(60) < 6, 0.3e-9, 1.2e-9)
    asked = mass, place, np.ones(60, bool), crossing, 1e-9, 4.0
    assert (scaled_rod(*asked)[0] == mass).all()
    heavy, factor = scaled_rod(*asked, least=0.15)
    assert factor == 1.0 and heavy.sum() == pytest.approx(mass.sum(), rel=1e-12)
    slowed = crossing * np.sqrt(heavy.mean(axis=1))
    assert slowed[:6].min() > 0.5e-9 and heavy[6:].min() >= 1 - MOST_REMOVED
