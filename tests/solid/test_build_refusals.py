"""What the model builder refuses before any work."""

import pytest

from fem_impact.effects import specify
from fem_impact.errors import SceneError
from fem_impact.scene import load
from fem_impact.solid.build import build


@pytest.mark.parametrize("name", ["t5b", "t3-machined"])
def test_a_tip_too_coarse_to_yield_is_refused(name):
    scene = load(name).replace("accuracy.tip_size", "2.4 mm")
    with pytest.raises(SceneError, match=r"accuracy\.tip_size.*Give at most 1\.7 mm"):
        build(scene, specify(scene))


def test_the_proposed_tip_is_taken():
    scene = load("t5b").replace("accuracy.tip_size", "1.6 mm")
    assert [zone.count > 0 for zone in build(scene, specify(scene)).zones] == [True, True]
