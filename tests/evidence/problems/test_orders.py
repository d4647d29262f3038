"""Orders of convergence where theory gives one.

The patch test, exact, is in tests/solid/test_elements.py; the closing loss, first order, is in
test_verify_bar.py.
"""

import numpy as np
import pytest

import meshes
from fem_impact.evidence.problems.bodies import FreeBody, body_model
from fem_impact.evidence.problems.problem import verify
from fem_impact.evidence.problems.waves import frequencies, probe
from fem_impact.evidence.references.free_modes import cylinder_frequencies
from fem_impact.fem.eigen import rod_modes
from fem_impact.solid.march import march


def order(errors, sizes):
    """Return the slope of log |error| on log size."""
    return np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0]


@pytest.mark.long
def test_frequencies_are_of_second_order():
    across, errors = np.array([8, 12]), []
    exact = cylinder_frequencies(219e9, 0.29, 7850.0, 0.06, 9.5e-3)
    for n in across:
        bar = meshes.rod(np.array([[0.0, 0.0], [9.5e-3, 0.0]]), 0.06, n, slice_length=0.019 / n, nose=False)
        still = np.zeros_like(bar.mesh.points)
        found = frequencies(body_model(FreeBody(bar, bar.mesh.points, still, 219e9, 0.29, 7850.0)))
        bending, longitudinal = found["bending"][:3], found["longitudinal"][:2]
        errors.append([*(bending / exact.bending - 1), *(longitudinal / exact.longitudinal[:2] - 1)])
    for row in np.transpose(errors):
        assert order(row, 1 / across) == pytest.approx(2.0, abs=0.3)


def test_waves_are_of_second_order_in_the_slice():
    """The section's own error stays: differences between three heights fall by four."""
    errors = [[c.error for c in verify("waves", {"aspect": a}).checks] for a in (2.0, 1.0, 0.5)]
    coarse, middle, fine = (np.array(row)[[-2, -1]] for row in errors)
    assert (coarse - middle) / (middle - fine) == pytest.approx([4.0, 4.0], abs=0.5)


def test_time_steps_are_of_second_order():
    """Leapfrog rings a mode at (2 / dt) asin(omega dt / 2): high by (omega dt)^2 / 24."""
    bar = meshes.rod(np.array([[0.0, 0.0], [9.5e-3, 0.0]]), 0.03, 6, nose=False)
    still = body_model(FreeBody(bar, bar.mesh.points, np.zeros_like(bar.mesh.points), 219e9, 0.29, 7850.0))
    n = still.layout.rod_size
    modes = rod_modes(still.rod_stiffness, still.mass[:n], still.inverse_mass[:n] == 0, 30)
    omega, shape = modes.omega[-1], modes.shape[:, -1]
    errors, steps = [], np.array([0.8, 0.4, 0.2]) * still.step
    for step in steps:
        state = still.initial_state()
        state.v[:n] = 1e-3 * shape / abs(shape).max()
        state.dt_next = step
        ringing = probe(still, state.v[still.layout.rod], 60 * 2 * np.pi / omega, every=1)
        march(still, state, [ringing])
        errors.append(ringing.frequency() * 2 * np.pi / omega - 1)
    assert errors == pytest.approx((omega * steps) ** 2 / 24, rel=0.1)
    assert order(errors, steps) == pytest.approx(2.0, abs=0.05)
