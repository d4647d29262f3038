"""The stable step: the true limit of an assembled body, and a safe one while elements are squeezed."""

import numpy as np
import pytest
import solid_scenes as scenes
import solid_shapes as shapes
from scipy.sparse import csr_matrix

from fem_impact.solid.elements import element_stiffness, isotropic_stiffness, lumped_mass
from fem_impact.solid.sparse import assemble, tie_operator
from fem_impact.solid.stable import SAFETY, stable_step
from fem_impact.solid.stepguard import StepGuard

C = isotropic_stiffness(shapes.E, shapes.NU)
RHO = 7850.0


def test_step_is_that_of_the_largest_frequency():
    points, cells = shapes.distorted((3, 2, 3), 0.2, seed=3)
    K = shapes.dense(element_stiffness(points, cells, C, "bbar"), cells)
    inverse = np.repeat(1 / np.bincount(cells.ravel(), lumped_mass(points, cells, RHO).ravel()), 3)
    exact = np.linalg.eigvals(inverse[:, None] * K).real.max()
    found = stable_step(csr_matrix(K), inverse)
    assert found == pytest.approx(SAFETY * 2 / np.sqrt(exact), rel=1e-3)
    assert stable_step(csr_matrix(K), inverse) == found


@pytest.mark.parametrize("squeeze", [0.5, 0.3])
def test_guard_stays_below_the_limit_of_a_squeezed_tip(squeeze):
    """Part of the zone is flattened: the guard must shorten the step at least as much as the truth."""
    model = scenes.model("vibration", "rod-plasticity", "barrier-rigid", length=0.08)
    state, guard = model.initial_state(), StepGuard(model)
    mesh, layout = model.geometry.rod.mesh, model.layout
    x = state.x[layout.rod]
    low = x[:, 2] < 2.4e-3
    x[low, 2] *= squeeze
    state.x[layout.rod] = x
    guard.observe(state)
    T = tie_operator(mesh.tie, layout.rod, layout.rod_size)
    K = assemble(x, mesh.cells, C, "bbar", T)
    true = stable_step(K, model.inverse_mass[: layout.rod_size])
    assert true < 0.9 * model.step
    assert squeeze * 0.5 * model.step < state.dt_next < true * 1.002
