"""The page to sign: what it states, of which run, and what it refuses."""

import json

import pytest
import result_maker

from fem_impact.answers.verdict.assess import assess
from fem_impact.answers.verdict.criteria import LIMITED
from fem_impact.answers.verdict.limit import judge
from fem_impact.answers.verdict.limit_verdict import limit_document
from fem_impact.answers.verdict.sentences import document
from fem_impact.errors import ResultError
from fem_impact.files.atomic import signed
from fem_impact.pages.sheet import write_sheet
from fem_impact.pages.write import write_report
from fem_impact.scene.read import read_toml
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest, to_toml

OWN = {"name": "bronze", "E": "110 GPa", "nu": 0.34, "rho": "8800 kg/m3", "sources": {"E": "sheet 12"}}


@pytest.fixture
def run(tmp_path):
    """A run of a plate of an own material, one value of which has a source."""
    scene = replace_all(load("t5b"), {"barrier.material": OWN})
    limited = [{"kind": "model", "text": "No waves."}, {"kind": "resolution", "text": "Too coarse."}]
    bands = {"mesh_limit": {"mu": 0.61}, "mesh_band": {"mu": 0.0123}}
    result_maker.write_result(tmp_path, scene_digest=digest(scene), limitations=limited, **bands)
    (tmp_path / "scene.toml").write_text(to_toml(scene), encoding="utf-8")
    return tmp_path


def test_it_states_numbers_with_errors_sources_what_is_left_out_and_where_to_sign(run):
    text = write_sheet(run, "SC-17", "B").read_text(encoding="utf-8")
    order = ["SC-17", "revision B", "data:image/svg+xml", "Criterion", "Too coarse.", "0.610 ± 0.013"]
    order += ["Inputs and their sources", "sheet 12", "no source stated", "Not covered", "No waves."]
    places = [text.index(words) for words in [*order, "approved by", "Digest of the scene"]]
    assert places == sorted(places)
    assert "No verdict computed" in text
    assert "____" in write_sheet(run).read_text(encoding="utf-8")


def test_it_says_why_no_error_is_known_and_what_lies_below_the_floor(run):
    assert "impact, with their errors<" in write_sheet(run).read_text(encoding="utf-8")
    scene = read_toml(run / "scene.toml")
    alone = {"accuracy_target": None, "E_vib_below_floor": True}
    result_maker.write_result(run, scene_digest=digest(scene), **alone)
    text = write_sheet(run).read_text(encoding="utf-8")
    assert "error of these numbers not known: one mesh only" in text and "with their errors<" not in text
    assert "vibration is below its numerical floor (fraction 2e-05)" in text


def test_sheet_and_report_say_between_what_a_heat_without_an_error_lies(run):
    bands = {"mesh_limit": {"W_friction_over_E_0": 0.29}, "mesh_band": {"W_friction_over_E_0": 0.02}}
    result_maker.write_result(run, scene_digest=digest(read_toml(run / "scene.toml")), **bands)
    said = "top 0.1 mm of both: no error of it is known: it lies between 27 % (friction)"
    assert said in write_sheet(run).read_text(encoding="utf-8")
    assert said in write_report(run).read_text(encoding="utf-8")


@pytest.mark.long
def test_it_states_the_verdict_that_lies_in_the_folder_and_the_criterion(run):
    scene = read_toml(run / "scene.toml")
    told = document(assess(scene, "modal", 0.04, of="friction"))
    limited = limit_document(judge(scene, LIMITED["force"], 8e3, None, "modal"), "")
    for one, asked in (
        (told, "vibration changes friction by at most 0.04."),
        (limited, limited["box"][0][0]),
    ):
        (run / "verdict.json").write_text(json.dumps(signed(one)), encoding="utf-8")
        text = write_sheet(run).read_text(encoding="utf-8")
        assert f"Criterion: {asked} Answer: {one['answer'].upper()}." in text
        assert one["box"][1][1] in text
    (run / "verdict.json").write_text(json.dumps(signed(told | {"scene_digest": "0"})), encoding="utf-8")
    with pytest.raises(ResultError, match="verdict on another scene"):
        write_sheet(run)


def test_a_scene_that_was_changed_after_the_run_is_not_signed(run):
    (run / "scene.toml").write_text(to_toml(load("t5b")), encoding="utf-8")
    with pytest.raises(ResultError, match="changed after the run"):
        write_sheet(run)


def test_the_command_writes_it(cli, run):
    code, out, _ = cli("report", run, "--sign", "--document", "SC-17")
    assert code == 0 and "page to sign" in out and "SC-17" in (run / "sheet.html").read_text(encoding="utf-8")
    code, _, err = cli("report", run, "--revision", "B")
    assert code == 2 and "--revision" in err and "Add --sign" in err
