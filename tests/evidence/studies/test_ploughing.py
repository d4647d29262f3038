"""The impulse ratio of a tip that yields while it slides exceeds its friction by what it ploughs."""

import numpy as np
import pytest

from fem_impact.answers.refine.chain import LevelChain
from fem_impact.case.case import Case
from fem_impact.scene.shipped import load, replace_all

pytestmark = pytest.mark.usefixtures("unrendered")

F = 0.2


@pytest.mark.validation
def test_ploughing_does_not_hang_on_the_mesh():
    scene = replace_all(
        load("t5b"), {"surface.friction": F, "surface.friction_low": F, "surface.friction_high": F}
    )
    chain = LevelChain(Case(scene))
    chain.refine()
    runs = [level.outcome for level in chain.done[-2:]]
    ploughed = np.array([run.restitution.mu - F for run in runs])
    assert (ploughed > 0.03).all()
    assert np.ptp(ploughed) < 0.01
    e = np.array([run.restitution.paper.e for run in runs])
    assert np.ptp(e) < 0.03
