"""The barrier's plastic work right under its surface."""

from types import SimpleNamespace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.run.solid import reduce
from fem_impact.solid.doubts import DEPTH, skin_share

CUBE = np.array([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
STACK = np.stack([CUBE - [0, 0, 1], CUBE - [0, 0, 2]])  # two cells of unit height under n = 0
WORK = np.array([3.0, 2.0])  # upper and lower cell
EVEN = np.ones((2, 8))
HIGH = np.tile(np.repeat([0.0, 1.0], 4), (2, 1))  # strain at the upper four points of each cell alone


def _model(height, strain):
    """What `skin_share` reads of a model: the two cells, ``height`` in units of the depth."""
    zone = SimpleNamespace(
        body="barrier", places=lambda: np.arange(48).reshape(2, 8, 3), spent=lambda: (strain, WORK)
    )
    return SimpleNamespace(zones=[zone], start=(height * DEPTH * STACK.ravel(), None))


@pytest.mark.parametrize(
    ("height", "strain", "share"),
    [
        (0.5, EVEN, 1.0),
        (1.0, EVEN, 0.6),
        (2.0, EVEN, 0.3),
        (4.0, EVEN, 0.15),
        (2.0, HIGH, 0.6),
        (4.0, HIGH, 0.3),
        (1.0, 0 * EVEN, 0.0),
    ],
)
def test_work_above_the_depth_counts(height, strain, share):
    """Reference: the heights of cells and half cells over the depth, by hand."""
    assert skin_share(_model(height, strain)) == pytest.approx(share, rel=1e-12)


def test_a_run_tells_friction_and_skin_together():
    result = scenes.run(
        "vibration", "friction", "rod-plasticity", "barrier-elastoplastic", length=0.08, v_n=-2.1, v_t=-2.1
    )
    found = reduce(result)
    friction, plate = found.energy.friction, found.energy.plastic_barrier
    assert 0.05 * plate < found.energy.skin - friction < 0.5 * plate


def test_an_elastic_barrier_has_no_sheared_skin():
    result = scenes.run("vibration", "friction", "barrier-elastic", length=0.08, v_n=-1.0, v_t=-1.0)
    found = reduce(result)
    assert found.energy.skin == found.energy.friction > 0.0
