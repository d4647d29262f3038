"""The stable step: the true limit of an assembled body, and that of one whose cells have deformed."""

import numpy as np
import pytest
import solid_scenes as scenes
import solid_shapes as shapes
from scipy.sparse import csr_matrix

from fem_impact.fem.elements import element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.hexmodes import LANES
from fem_impact.fem.sparse import assemble, tie_operator
from fem_impact.fem.stable import SAFETY, gradient_squares, stable_step
from fem_impact.solid.stepguard import StepGuard, zone_step
from fem_impact.solid.yielding import gauss_volumes

LAME = lame_constants(shapes.E, shapes.NU)
RHO = 7850.0


def test_step_is_that_of_the_largest_frequency():
    points, cells = shapes.distorted((3, 2, 3), 0.2, seed=3)
    K = shapes.dense(element_stiffness(points, cells, LAME, "bbar"), cells)
    inverse = np.repeat(1 / np.bincount(cells.ravel(), lumped_mass(points, cells, RHO).ravel()), 3)
    exact = np.linalg.eigvals(inverse[:, None] * K).real.max()
    found = stable_step(csr_matrix(K), inverse)
    assert found == pytest.approx(SAFETY * 2 / np.sqrt(exact), rel=1e-3)
    assert stable_step(csr_matrix(K), inverse) == found


# ---------------------------------------------------------------- cells that have deformed


def plate():
    """A rod's tip over a plate whose thin rows have the mass of higher ones."""
    effects = "vibration", "friction", "rod-plasticity", "barrier-elastoplastic"
    return scenes.model(*effects, length=0.08, v_n=-4.0, v_t=-4.0)


def deformed(model, shear, left):
    """Places (n, 3), m, of the plate's nodes: under the tip its first cell is dragged along t and pressed.

    The drag at the surface is given over the cell's width, and how much of the height is left.
    """
    x, h = model.geometry.barrier.points.copy(), model.geometry.tip_size
    near = np.exp(-((x[:, 0] / (6 * h)) ** 2) - (x[:, 1] / (3 * h)) ** 2)
    top = h * near * np.clip(1 + x[:, 2] / h, 0, 1)
    return x + np.outer(top, [shear, 0.0, left - 1])


def unstressed(model, zone, x):
    """Let a zone be as if made at the places x of its body's nodes, (n, 3); return a state at rest there."""
    state = model.initial_state()
    state.x[getattr(model.layout, zone.body)] = x
    corners = state.x[zone.blocks.dof.transpose(0, 3, 2, 1).reshape(-1, 8, 3)]
    weight = gauss_volumes(corners).reshape(-1, LANES, 8)
    zone.blocks.weight[:], zone.blocks.volume[:] = weight.transpose(0, 2, 1), weight.sum(axis=2)
    return state


def whole_step(model, zone, x):
    """The stable step, s, of the assembled body: yielding cells as they are at x, the others as they were."""
    nodes, part = getattr(model.layout, zone.body), getattr(model.geometry, zone.body)
    mesh, start = (part.mesh, model.geometry.rod_points) if zone.body == "rod" else (part, part.points)
    lame = zone.K - 2 * zone.G / 3, zone.G
    T = tie_operator(mesh.tie, nodes, len(model.mass))
    yields = model.geometry.may_yield[zone.body]
    K = assemble(start, mesh.cells[~yields], lame, "incompatible", T)
    K = K + assemble(x, mesh.cells[yields], lame, "bbar", T)
    return stable_step(csr_matrix(K), model.inverse_mass)


@pytest.mark.parametrize(("shear", "left"), [(4.0, 1.0), (0.0, 0.7), (0.0, 0.15), (2.0, 0.6)])
def test_step_of_a_deformed_plate_is_that_of_its_assembly(shear, left):
    """Its first rows are thin and have the mass of higher ones; single elements ask for far less."""
    model = plate()
    assert model.geometry.skin_rows >= 2
    guard, zone, x = StepGuard(model), model.zones[1], deformed(model, shear, left)
    state = unstressed(model, zone, x)
    guard.observe(state)
    true = whole_step(model, zone, x)
    assert true < 0.9 * model.step
    assert guard.allowed == pytest.approx(true, rel=6e-3)
    first, now = (gradient_squares(at, zone.places()) for at in (model.start[0], state.x))
    assert np.sqrt(first / now).min() * model.step < 0.85 * true


@pytest.mark.parametrize("squeeze", [0.5, 0.3])
def test_step_of_a_squeezed_tip_is_that_of_its_assembly(squeeze):
    model = scenes.model("vibration", "rod-plasticity", "barrier-rigid", length=0.08)
    guard, zone, x = StepGuard(model), model.zones[0], model.geometry.rod_points.copy()
    x[x[:, 2] < 2.4e-3, 2] *= squeeze
    state = unstressed(model, zone, x)
    guard.observe(state)
    assert guard.allowed < 0.9 * model.step
    assert guard.allowed == pytest.approx(whole_step(model, zone, x), rel=0.025)


@pytest.mark.long
def test_step_is_found_anew_only_where_single_elements_might_ask_for_less():
    model = plate()
    guard, zone = StepGuard(model), model.zones[1]
    found = []
    for shear in np.linspace(0.0, 3.0, 31):
        x = deformed(model, shear, 1.0)
        guard.observe(unstressed(model, zone, x))
        found.append((guard.allowed / whole_step(model, zone, x), *guard.steps))
    share, rod, anew = np.array(found).T
    assert 0.95 < share.min() < 0.98
    assert share.max() < 1 + 1e-4
    assert 5 <= len(np.unique(anew)) <= 12
    assert len(np.unique(rod)) == 1


def test_step_falls_on_as_it_fell():
    """Between two looks the cells go on deforming."""
    model = plate()
    guard, zone = StepGuard(model), model.zones[1]
    taken = []
    for left in (0.4, 0.2, 0.2):
        state = unstressed(model, zone, deformed(model, 0.0, left))
        guard.observe(state)
        taken.append((guard.allowed, state.dt_next))
    (first, _), (second, next_second), (third, next_third) = taken
    assert second < 0.9 * first
    assert next_second == pytest.approx(second**2 / first)
    assert next_third == third == second
    assert guard.smallest == next_second


def test_flow_is_not_counted_on_and_the_zone_stays_as_it_is():
    model = plate()
    zone, x = model.zones[1], model.start[0]
    first = zone_step(zone, model, x)
    zone.blocks.flow[:] = 0.0
    kept = [part.copy() for part in zone.blocks]
    assert zone_step(zone, model, x) == first
    assert all(np.array_equal(one, other) for one, other in zip(kept, zone.blocks, strict=True))


def test_stress_of_now_counts():
    """Pressed along its surface, the plate is softer there by about stress over stiffness."""
    model = plate()
    zone, x = model.zones[1], model.start[0]
    first = zone_step(zone, model, x)
    for component, share in enumerate((-0.05, -0.05, 0.1)):
        zone.blocks.stress[:, :, component * LANES : (component + 1) * LANES] = share * zone.G
    assert 1.01 < zone_step(zone, model, x) / first < 1.03
