"""The two examples of docs/tutorials/extend.md: a hemispherical tip and an aluminium rod."""

import json
import math
from pathlib import Path

import pytest

from fem_impact.case.case import Case
from fem_impact.fem.geometry import build_geometry
from fem_impact.scene.shipped import load, replace, replace_all
from rigid import SHAPES, Nose


@pytest.fixture
def ball(monkeypatch):
    monkeypatch.setitem(SHAPES, "ball", lambda radius, r: Nose(radius, 0.0, r, math.pi / 2))


def test_an_added_tip_is_turned_meshed_and_touches_where_it_should(ball):
    scene = replace_all(
        load("t5b"),
        {"projectile.tip": "ball", "projectile.tip_radius": "9.5 mm", "accuracy.tip_size": "1.2 mm"},
    )
    rod = scene.projectile.rigid_body
    cylinder, half_ball = math.pi * 0.0095**2 * (0.08 - 0.0095), 2 / 3 * math.pi * 0.0095**3
    assert rod.mass == pytest.approx(7850 * (cylinder + half_ball), rel=1e-12)
    rho, z = rod.contact_point(math.pi / 4)
    assert (rho, 0.0095 - z) == pytest.approx((0.0095 * math.sqrt(0.5),) * 2)
    scene = replace(scene, "effects", ["vibration", "barrier-rigid"])
    built = build_geometry(Case.of(scene).bodies, Case.of(scene).zones, 1e-5, meshed_barrier=False)
    assert built.rod_points[:, 2].min() == pytest.approx(1e-5)


ROD = ("--length", "80 mm", "--diameter", "19 mm", "--angle", "45 deg")
DROP = ("--height", "0.82 m", "--surface", "machined")
HEAT = ("--heat", "--fidelity", "modal", "--json")


@pytest.mark.long
def test_an_added_tip_is_assessed_as_the_shape_it_has(ball, cli):
    code, out, err = cli("assess", *ROD, *DROP, "--tip", "ball", "--tip-radius", "9.5 mm", *HEAT)
    assert (code, err) == (0, "")
    document = json.loads(out)["transfer"]
    assert document["case"]["tip"] == "ball"
    nose = cli("assess", *ROD, *DROP, "--tip", "A", "--tip-radius", "7 mm", *HEAT)[1]
    round_nose = json.loads(nose)["transfer"]
    assert document["basis"]["weights"] == round_nose["basis"]["weights"]  # as far from the rounded edges


def test_an_added_tip_has_coefficients(ball, cli):
    Path("mine.csv").write_text(
        "test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s\n"
        "1,-1.572,-1.602,0.381,-0.371,3.607\n2,-1.516,-1.507,0.271,-0.369,1.019\n"
    )
    line = ("coefficients", "mine.csv", *ROD, "--tip", "ball", "--tip-radius", "9.5 mm", "--json")
    code, out, err = cli(*line)
    assert (code, err) == (0, "")
    assert json.loads(out)["rod"]["tip"] == "ball"


def test_an_added_tip_has_no_usual_radius(ball, cli):
    code, _, err = cli("assess", *ROD, *DROP, "--tip", "ball")
    assert code == 2
    assert "--tip-radius" in err


def test_a_tip_nobody_added_is_refused(cli):
    with pytest.raises(ValueError, match='"A", "B" or "plain"'):
        replace(load("t5b"), "projectile.tip", "dome")
    code, _, err = cli("assess", *ROD, *DROP, "--tip", "plane")
    assert code == 2
    assert "Did you mean plain?" in err


def test_an_own_material_is_a_table_of_the_scene():
    aluminium = {
        "name": "Al 6082-T6",
        "E": "70 GPa",
        "nu": 0.33,
        "rho": "2700 kg/m3",
        "yield_stress": "260 MPa",
        "ultimate_stress": "310 MPa",
    }
    scene = replace(load("t5b"), "projectile.material", aluminium)
    assert scene.projectile.rigid_body.mass == pytest.approx(
        2700 / 7850 * load("t5b").projectile.rigid_body.mass
    )
    assert scene.measured is None  # the tests are of steel
