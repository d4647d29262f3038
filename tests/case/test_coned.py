"""A shoulder that is a cone in meshes is told, and where its edge touches first."""

import pytest

from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.shaft import coned
from fem_impact.scene.read import read_dict

SMALL_STEP = [["0 mm", "6 mm"], ["50 mm", "6 mm"], ["50 mm", "7 mm"], ["120 mm", "7 mm"]]


def bodies(angle: str, profile: list[list[str]] = SMALL_STEP) -> Bodies:
    scene = {
        "id": "stepped",
        "projectile": {"profile": profile, "material": "rod-steel"},
        "barrier": {"material": "plate-steel"},
        "surface": {"state": "custom", "friction": 0.3, "source": "assumed"},
        "impact": {"angle": angle, "v_n": "-0.3 m/s", "v_t": "0 m/s"},
    }
    return Case.of(read_dict(scene), "modal").bodies


def test_a_body_without_shoulders_is_told_nothing():
    assert coned(bodies("30 deg", SMALL_STEP[:2])) == ""


@pytest.mark.parametrize(("angle", "beside"), [("30 deg", False), ("88.95 deg", True)])
def test_a_shoulder_is_told_and_whether_its_edge_touches_first(angle, beside):
    told = coned(bodies(angle))
    assert told.startswith("in a mesh the shoulder 50 mm from the tip is a cone")
    assert told.endswith("finite elements land beside it") == beside
