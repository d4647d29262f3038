"""The command ``cost``, and the run of a scene with a target."""

import json
from importlib import import_module
from pathlib import Path

import pytest
from cost_fakes import Here, fake_levels, run
from outcome_maker import altered

import fem_impact.run.simulate
from fem_impact.answers.refine import level as level_module

pytestmark = pytest.mark.usefixtures("unrendered")


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", run)
    monkeypatch.setattr(level_module, "simulate_recorded", fake_levels)
    measure = import_module("fem_impact.answers.cost.measure")
    monkeypatch.setattr(measure, "LocalProcesses", lambda *_, **__: Here())


def test_cost_prints_table_and_advice(cli, fake):
    code, out, err = cli("cost", "t5b", "--target", "25 %", "--budget", "400 s", "--of", "e", "--quiet")
    assert (code, err) == (0, "")
    assert "Cheapest within 25 % of e: rigid" in out
    assert "Best within 400 s on one core: 3 levels to 0.297 mm, two places" in out
    assert "an energy at least of 0.5 % of E_0" in out
    assert "results: results/cost/t5b" in out
    assert "page: results/cost/t5b/report.html" in out
    page = Path("results/cost/t5b/report.html").read_text()
    assert page.index("Cheapest within 25 %") < page.index('<figure class="live">') < page.index("<details>")
    code, out, _ = cli("cost", "t5b", "--json", "--target", "35 %", "--budget", "400 s")
    cheapest, _, of_e, default = json.loads(out)["advice"]
    assert cheapest.startswith("Cheapest within 35 % of e and E_vib: modal, error ")
    assert of_e.startswith("Cheapest within 35 % of e: rigid, error ")
    assert default.startswith("The default run takes ")


def test_a_scene_without_vibration_is_judged_by_what_its_runs_know(cli, fake):
    rigid_rod = ("t5b", "--set", 'effects=["auto", "-vibration"]', "--quiet", "--budget", "400 s")
    code, _out, err = cli("cost", *rigid_rod)
    assert (code, err) == (0, "")
    assert "E_vib" not in json.loads(Path("results/cost/t5b/cost.json").read_text())["quantities"]
    code, _, err = cli("cost", *rigid_rod, "--of", "E_vib")
    assert code == 3
    assert '--of "E_vib": is not known here: the vibration effect is off' in err


def test_all_scenes_of_the_paper_make_a_summary(cli, fake, monkeypatch):
    monkeypatch.setattr("fem_impact.cli.cost.MEASURED_SETS", ("t5b",))
    code, out, _ = cli("cost", "paper", "--finer", "0", "--out", "all", "--quiet")
    assert code == 0
    held = json.loads(Path("all/summary.json").read_text())
    assert list(held["scenes"]) == ["t5b"]
    assert "Levels give e to 2 %" in Path("all/summary.md").read_text()
    assert {"all/report.html", "all/t5b/report.html"} <= set(map(str, Path("all").rglob("*.html")))
    assert "summary: all/summary.json" in out
    levels = [one["name"] for one in held["scenes"]["t5b"]["settings"] if one["kind"] == "levels"]
    assert [name[:8] for name in levels] == ["2 levels", "3 levels"]
    monkeypatch.setattr(level_module, "simulate_recorded", None)
    line = ("cost", "paper", "--stored", "--finer", "0", "--out", "all", "--quiet", "--page", "cost.md")
    assert cli(*line)[0] == 0
    told = Path("cost.md").read_text()
    assert told.startswith("# What accuracy costs\n\n- ")
    assert "\nMade by `fem-impact cost paper" in told
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
        (["--finer", "9"], "--finer"),
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
