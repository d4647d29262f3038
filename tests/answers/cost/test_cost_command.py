"""The command ``cost``, and the run of a scene with a target."""

import json
from importlib import import_module
from pathlib import Path

import pytest
from cost_fakes import Here, run
from outcome_maker import altered

import fem_impact.run.simulate


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", run)
    measure = import_module("fem_impact.answers.cost.measure")
    monkeypatch.setattr(measure, "compiled_before", lambda: True)
    monkeypatch.setattr(measure, "LocalProcesses", lambda *_, **__: Here())


def test_cost_prints_table_and_advice(cli, fake):
    code, out, err = cli("cost", "t5b", "--target", "20 %", "--budget", "400 s", "--of", "e", "--quiet")
    assert (code, err) == (0, "")
    assert "Cheapest within 20 % of e: rigid" in out
    assert "Best within 400 s on one core: solid 0.594 and 0.297 mm extrapolated" in out
    assert "results: results/cost/t5b" in out
    assert "page: results/cost/t5b/report.html" in out
    page = Path("results/cost/t5b/report.html").read_text()
    assert page.index("Cheapest within 20 %") < page.index('<figure class="live">') < page.index("<details>")
    code, out, _ = cli("cost", "t5b", "--json", "--target", "20 %")
    cheapest, of_e, default, pair = json.loads(out)["advice"]
    assert of_e == "Cheapest within 20 % of e: rigid, error 16 % in 0.001 s."
    assert default.startswith("The default run takes 10 s of processor time; its error is at most ")
    assert cheapest == "Cheapest within 20 % of e and E_vib: modal, error 11 % in 0.01 s."
    assert pair.startswith(
        "Several meshes against 20 %, solid 0.594 and 0.297 mm extrapolated, 2 places: e 0.3059 ± "
    )


def test_a_scene_without_vibration_is_judged_by_what_its_runs_know(cli, fake):
    rigid_rod = ("t5b", "--set", 'effects=["auto", "-vibration"]', "--quiet", "--target", "20 %")
    code, out, err = cli("cost", *rigid_rod)
    assert (code, err) == (0, "")
    assert "Cheapest within 20 % of e: rigid" in out
    assert "E_vib" not in json.loads(Path("results/cost/t5b/cost.json").read_text())["quantities"]
    code, _, err = cli("cost", *rigid_rod, "--of", "E_vib")
    assert code == 3
    assert '--of = "E_vib": is not known here: the vibration effect is off' in err


def test_all_scenes_of_the_paper_make_a_summary(cli, fake, monkeypatch):
    sets = ("t3-machined", "t5b")
    monkeypatch.setattr("fem_impact.scene.types.MEASURED_SETS", sets)
    code, out, _ = cli("cost", "paper", "--finest", "0.25 mm", "--out", "all", "--quiet")
    assert code == 0
    held = json.loads(Path("all/summary.json").read_text())
    assert list(held["scenes"]) == list(sets)
    assert "Two or three meshes together give e to 2 %" in Path("all/summary.md").read_text()
    assert {"all/report.html", "all/t5b/report.html"} <= set(map(str, Path("all").rglob("*.html")))
    assert "summary: all/summary.json" in out
    meshes = [one["name"] for one in held["scenes"]["t5b"]["settings"] if one["kind"] == "mesh"]
    assert meshes == ["solid 0.594 mm", "solid 0.297 mm"]
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", None)
    line = ("cost", "paper", "--stored", "--out", "all", "--quiet", "--page", "cost.md")
    assert cli(*line)[0] == 0
    told = Path("cost.md").read_text()
    assert told.startswith("# What accuracy costs\n\nMade by `fem-impact cost paper`")
    assert "](cost/error-against-time.svg)" in told
    assert Path("cost/error-against-time.svg").exists()
    again = json.loads(Path("all/summary.json").read_text())
    assert again["scenes"] == held["scenes"]


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["--target", "2"], "--target"),
        (["--budget", "30"], 'has no unit. Write it with its unit, such as --budget "30 s".'),
        (["--of", "speed"], "is not a quantity of interest"),
        (["--finest", "0.25"], 'has no unit. Write it with its unit, such as --finest "0.25 mm".'),
        (["--finest", "0.5 mm"], "Give at most 0.297 mm."),
        (["--page", "cost.md"], "run `cost paper`"),
    ],
)
def test_wrong_words_are_refused_before_any_work(cli, words, complaint):
    code, _, err = cli("cost", "t5b", *words)
    assert code == 2
    assert complaint in err
    assert not Path("results").exists()


def test_a_scene_with_a_target_says_what_it_reached(cli, monkeypatch):
    stated = {"accuracy_target": 0.2, "achieved_error": 0.15, "achieved_wall_s": 0.02}
    stated |= {"mesh_limit": {"e_edge": 0.31, "E_vib_over_E_0": 0.02}}
    monkeypatch.setattr(
        "fem_impact.answers.simulate.simulate", lambda scene, *_: altered(run(scene), **stated)
    )
    code, out, _ = cli("run", "t5b", "--set", "accuracy=20 %")
    assert code == 0
    assert "asked for 20 %; reached in e and E_vib 15 %, in 0.02 s" in out
    assert "limits of all levels: e (tip's arms) 0.31, E_vib/E_0 0.02" in out
