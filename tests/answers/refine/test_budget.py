"""How long runs will take, by what others took."""

import pytest
from outcome_maker import outcome

from fem_impact.answers.refine.budget import calibration_factor, planned_s
from fem_impact.answers.refine.levels import FAMILY, on_mesh
from fem_impact.scene.shipped import load, replace

COARSE, FINE = (on_mesh(load("t5b"), mesh) for mesh in FAMILY[:2])


def ran(wall_s, scaling=4.0):
    return outcome(wall_s=wall_s, setup_wall_s=0.0, mass_scaling=scaling)


def test_the_next_mesh_takes_as_much_longer_than_planned_as_the_last():
    for workers in (1, 2):
        planned = planned_s([COARSE] * 3, workers)
        runs = [ran(2.5 * planned_s([COARSE], 1))] * 3
        assert calibration_factor([COARSE] * 3, runs, workers) == pytest.approx(2.5)
        assert planned == pytest.approx((3 if workers == 1 else 2) * planned_s([COARSE], 1))


def test_a_coarse_rod_that_makes_up_for_less_added_mass_does_not_slow_the_next_mesh():
    """Its step is smaller than planned, that of the finer mesh is not."""
    slow = planned_s([replace(COARSE, "accuracy.mass_scaling", 1.5)], 1)
    assert slow > 1.1 * planned_s([COARSE], 1)
    assert calibration_factor([COARSE], [ran(slow, scaling=1.5)], 1) == pytest.approx(1.0)
    assert calibration_factor([COARSE], [ran(slow)], 1) > 1.1
