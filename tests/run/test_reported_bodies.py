"""Bodies that were reported as refused or as ending in a traceback: each has an outcome that is right."""

import pytest
from own_bodies import box, write

from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict


def scene(projectile, f, impact, tip_size):
    return read_dict(
        {
            "id": "reported",
            "projectile": projectile,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "custom", "friction": f, "source": "assumed"},
            "impact": impact,
            "accuracy": {"tip_size": tip_size, "levels": 1, "unresolved": "report"},
            "save": {"frames": 0},
        }
    )


def test_a_bar_on_two_feet_beside_its_plane_of_symmetry_strikes(tmp_path):
    """Three levels of meshes give e .297 +- .040 and mu .086 +- .023."""
    points, cells = box(6, 3, 30, (-6, 0, 0), (6, 6, 60))
    bottom = points[:, 2] == 0.0
    points[bottom, 2] = 0.2 * (1.0 - points[bottom, 1] / 6.0)
    path = write(tmp_path / "two-feet.vtk", points, cells)
    body = {"mesh": str(path), "mesh_unit": "mm", "material": "rod-steel"}
    outcome = simulate(scene(body, 0.57, {"angle": "10 deg", "speed": "1 m/s"}, "0.5 mm"))
    assert outcome.validity.finished
    assert abs(outcome.energy.residual) < 1e-4
    assert outcome.restitution.edge.e == pytest.approx(0.297, abs=0.08)
    assert outcome.restitution.mu == pytest.approx(0.086, abs=0.023)


def test_a_coin_lands_on_its_rim():
    """Three levels of meshes give e .415 +- .080 and mu -.165 +- .017."""
    coin = {"profile": [["0 mm", "12 mm"], ["2 mm", "12 mm"]], "material": "brass"}
    impact = {"angle": "45 deg", "v_n": "-1 m/s", "v_t": "0 m/s"}
    outcome = simulate(scene(coin, 0.2, impact, "0.1 mm"))
    assert outcome.validity.finished
    assert outcome.restitution.edge.e == pytest.approx(0.415, abs=0.08)
    assert outcome.restitution.mu == pytest.approx(-0.165, abs=0.017)
