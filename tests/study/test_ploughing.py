"""The impulse ratio of a yielding tip exceeds its friction by what it ploughs, on every mesh by the same."""

import numpy as np
import pytest

from fem_impact.cost.settings import FAMILY, on_mesh
from fem_impact.scene import load, replace_all
from fem_impact.simulate import simulate

F = 0.2


@pytest.mark.validation
def test_ploughing_converges():
    scene = replace_all(
        load("t5b"),
        {"surface.friction": F, "surface.friction_low": F, "surface.friction_high": F},
    )
    ploughed = np.array([simulate(on_mesh(scene, mesh))["mu"] - F for mesh in FAMILY[:3]])
    assert (ploughed > 0.01).all()
    assert (ploughed < 0.03).all()
    steps = np.abs(np.diff(ploughed))
    assert steps[1] < steps[0] < 0.005
