"""The command ``hardness``: numbers by the flow curve, and the layers that give the stated ones."""

import json

from fem_impact.cli.hardness import NONE
from fem_impact.cli.main import main
from fem_impact.physics.indentation import HardnessTest
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_toml


def test_it_tells_numbers_and_the_curve_of_each_material(capsys):
    assert main(["hardness", "t5b", "--loads", "10,30"]) == 0
    out = capsys.readouterr().out
    assert "projectile.material (rod-steel): HV 235 is stated; its flow curve alone has HV" in out
    assert "factor" in out and "depth at HV 30, mm" in out
    assert out.count("\n  2 ") == 2


def test_its_document_has_every_point_with_its_range(capsys):
    skin = "barrier.material.skin.factor=1.7", "barrier.material.skin.load=5"
    assert (
        main(["hardness", "t5b", "--json", "--scatter", "5", *(w for one in skin for w in ("--set", one))])
        == 0
    )
    rod, plate = json.loads(capsys.readouterr().out)
    at = {(p["load"], p["factor"]): p for p in plate["points"]}
    assert {load for load, _ in at} == {5} and {p["load"] for p in rod["points"]} == {5, 10, 30}
    assert plate["skin"] == at[5, 1.7]["depth"]
    low, depth, high = (at[5, 2.0][key] for key in ("low", "depth", "high"))
    assert 0 < low < depth < high < HardnessTest(163, 5).radius
    soft = {p["factor"]: p for p in rod["points"] if p["load"] == 10}
    assert soft[1.2]["depth"] is None and soft[1.5]["depth"] > soft[2.0]["depth"]


def test_a_load_that_is_no_number_is_refused(capsys):
    assert main(["hardness", "t5b", "--loads", "HV30"]) == 2
    assert '--loads "HV30": is no number above 0' in capsys.readouterr().err


def test_a_load_that_no_hardness_test_has_is_refused(cli):
    for kgf in ("1e9", "0.001", "10,0.5"):
        code, _, err = cli("hardness", "t5b", "--loads", kgf)
        assert code == 2 and "must be 1 to 120 kgf." in err


def test_a_curve_outside_the_indentations_computed_is_told_beside_the_other_body(cli):
    code, out, err = cli("hardness", "t5b", "--set", "projectile.material=copper")
    told = " ".join(out.split())
    assert (code, err) == (0, "")
    assert "projectile.material (copper): HV 51 is stated, but no layer that meets it is known." in told
    assert "barrier.material (plate-steel): HV 163 is stated; its flow curve alone has" in told
    documents = json.loads(cli("hardness", "t5b", "--set", "projectile.material=copper", "--json")[1])
    assert "lies outside the indentations computed" in documents[0]["reason"] and not documents[1]["reason"]


def test_a_hardness_below_yield_names_the_place_that_states_it(cli, tmp_path):
    soft = ("--set", "barrier.material.law=hardness", "--set", "barrier.material.hardness=60")
    assert "--set: hardness of plate-steel (changed)" in cli("check", "t5b", *soft)[2]
    own = to_toml(
        replace_all(load("t5b"), {"barrier.material.hardness": 60, "barrier.material.law": "hardness"})
    )
    (tmp_path / "own.toml").write_text(own)
    assert "own.toml: hardness of plate-steel (changed)" in cli("check", "own.toml")[2]


def test_a_curve_through_the_hardness_itself_has_no_layer(cli):
    """It was told that no material states a hardness."""
    own = {"name": "own steel", "E": "210 GPa", "nu": 0.3, "rho": "7850 kg/m3", "yield_stress": "300 MPa"}
    table = ", ".join(
        f"{key} = {value!r}" for key, value in (own | {"law": "hardness", "hardness": 150}).items()
    )
    stated = ("--set", f"projectile.material={{{table}}}", "--set", "barrier.material=s235")
    assert cli("hardness", "t5b", *stated)[1].split() == NONE.split()
