"""Mass points inside the section: exact moments, and one operator in all its forms."""

import numpy as np
import pytest
from solid_scenes import model, scene

import meshes
from fem_impact.fem.elements import lumped_mass
from fem_impact.fem.flight import rigid_motion
from fem_impact.fem.layout import TWISTING, MassPoints

RADIUS, DENSITY = 9.5e-3, 7850.0


@pytest.fixture(params=[6, 8, 12])
def drawn(request):
    bar = meshes.rod(np.array([[0.0, 0.0], [RADIUS, 0.0]]), 0.03, request.param, nose=False)
    mass = lumped_mass(bar.mesh.points, bar.mesh.cells, DENSITY)
    return bar, mass, MassPoints.of_rod(bar, mass, DENSITY)


def rows_of(bar, values):
    """Return nodal values (n, 3) of a bar as rows (3 sections, layers)."""
    return values[bar.body_nodes].transpose(2, 0, 1).reshape(-1, bar.body_nodes.shape[1]).copy()


def test_the_polar_moment_of_a_section_is_that_of_the_circle(drawn):
    bar, mass, points = drawn
    rows = rows_of(bar, bar.mesh.points)
    points.condense(rows)
    n = len(bar.body_nodes)
    nodal = np.bincount(bar.mesh.cells.ravel(), mass.ravel())[bar.body_nodes[:, 2]]
    x, y = rows[:n, 2], rows[n : 2 * n, 2]
    assert nodal @ (x**2 + y**2) == pytest.approx(nodal.sum() * RADIUS**2 / 2, rel=1e-12)
    assert nodal @ x**2 == pytest.approx(nodal @ y**2, rel=1e-12)
    assert (points.inward < 1).all() and (points.inward > 0.9).all()


def test_nodes_and_masses_are_each_others_inverse_and_the_first_layer_stays(drawn):
    bar, _, points = drawn
    rows = np.random.default_rng(0).normal(size=(len(points.lever), bar.body_nodes.shape[1]))
    moved = rows.copy()
    points.expand(moved)
    assert abs(moved - rows)[:, 1:].max() > 1e-3
    assert (moved[:, 0] == rows[:, 0]).all()
    points.condense(moved)
    assert moved == pytest.approx(rows, abs=1e-13)


def test_forces_do_the_same_work_on_nodes_and_masses(drawn):
    bar, _, points = drawn
    rng = np.random.default_rng(1)
    force, velocity = rng.normal(size=(2, len(points.lever), bar.body_nodes.shape[1]))
    spread, gathered = velocity.copy(), force.copy()
    points.expand(spread)
    points.gather(gathered)
    assert (force * spread).sum() == pytest.approx((gathered * velocity).sum(), rel=1e-12)


def test_the_matrix_is_the_operator(drawn):
    bar, _, points = drawn
    layers = bar.body_nodes.shape[1]
    vector = np.random.default_rng(2).normal(size=len(points.lever) * layers + 7)
    rows = vector[:-7].reshape(-1, layers).copy()
    points.expand(rows)
    expected = np.concatenate([rows.ravel(), vector[-7:]])
    assert points.matrix(layers, len(vector)) @ vector == pytest.approx(expected, abs=1e-13)


def test_a_motion_of_the_whole_section_is_left_alone(drawn):
    bar, mass, points = drawn
    rows = np.ones((len(points.lever), bar.body_nodes.shape[1]))
    n = len(bar.body_nodes)
    points.expand(rows)
    assert rows[:n] == pytest.approx(np.ones_like(rows[:n]), abs=1e-12)
    assert rows[2 * n :] == pytest.approx(np.ones_like(rows[:n]), abs=1e-12)
    sideways = rows_of(bar, np.tile([[0.0, 1.0, 0.0]], (len(bar.mesh.points), 1)))
    MassPoints.of_rod(bar, mass, DENSITY, TWISTING).expand(sideways)
    assert sideways[n : 2 * n] == pytest.approx(np.ones_like(rows[:n]), abs=1e-12)


def test_mass_and_inertia_of_a_scenes_rod():
    """Layers of lumped mass along the axis leave up to h^2 / (6 k^2) of the inertia too much."""
    short = {"length": 0.08, "across": 8}
    made = model("vibration", "barrier-rigid", **short)
    places = made.layout.rod[~made.geometry.rod.mesh.is_hanging]
    found = rigid_motion(made.start[0][places], made.start[1][places], made.mass[places[:, 0]])
    rod = scene("vibration", "barrier-rigid", **short).projectile.rigid_body
    assert found.mass == pytest.approx(rod.mass, rel=1e-12)
    assert 0.0 < found.inertia / found.mass - rod.k2 < made.geometry.rod.slice_length**2 / 6.0


def test_a_turned_rod_has_no_force():
    made = model("vibration", "barrier-rigid", length=0.08)
    x, turn = made.start[0], np.zeros(made.layout.rod_size)
    places = made.layout.rod[~made.geometry.rod.mesh.is_hanging]
    turn[places[:, 0]], turn[places[:, 2]] = x[places[:, 2]], -x[places[:, 0]]
    force = made.rod_stiffness @ turn
    assert abs(force).max() < 1e-9 * abs(made.rod_stiffness.parts[0]).max() * abs(turn).max()
