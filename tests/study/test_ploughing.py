"""The impulse ratio of a tip that yields while it slides exceeds its friction by what it ploughs."""

import numpy as np
import pytest

from fem_impact.cost.settings import FAMILY, on_mesh
from fem_impact.scene import load, replace_all
from fem_impact.simulate import simulate

F = 0.2


@pytest.mark.validation
def test_finer_meshes_plough_more():
    """.017, .026, .035, .041 at one place of the barrier's grid: it grows ever less, as README says."""
    scene = replace_all(
        load("t5b"),
        {"surface.friction": F, "surface.friction_low": F, "surface.friction_high": F},
    )
    runs = [simulate(on_mesh(scene, mesh)) for mesh in FAMILY]
    ploughed = np.array([run["mu"] - F for run in runs])
    assert (ploughed > 0.005).all()
    assert (ploughed < 0.05).all()
    grown = np.diff(ploughed)
    assert (grown > 0.0).all()
    assert grown[2] < 0.8 * grown[1]  # both finer by 0.099 mm
    e = np.array([run["e_paper"] for run in runs[1:]])
    assert np.ptp(e) < 0.03
