"""A wanted error: levels go on until it is reached, at two places of the grid, within a budget."""

import re
from dataclasses import replace as with_

import cost_fakes
import pytest
from cost_fakes import pressed, run

from fem_impact.answers.refine import chain, forecast
from fem_impact.answers.refine import level as level_module
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.simulate import simulate
from fem_impact.case.case import Case
from fem_impact.cli.run import print_outcome
from fem_impact.errors import RunError, SceneError
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import Outcome
from fem_impact.progress import Notice, Progress
from fem_impact.run.resolution import without_end
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import to_dict

ASKED = replace(load("t5b"), "accuracy", "5 %")
FINEST = "0.001 %"
"""An error that no level reaches."""


@pytest.fixture
def ran(monkeypatch):
    """Let levels run as `cost_fakes` says, and note size and place of each run; a clock tells their time."""
    seen, clock = [], [0.0]

    def fake(scene, fidelity, options, case):
        outcome = run(scene)
        seen.append((scene.accuracy.tip_size, scene.accuracy.grid_shift))
        clock[0] += outcome.cost.whole_wall
        return outcome, pressed(case.record) if len(seen) > 1 else case.record

    monkeypatch.setattr(level_module, "simulate_recorded", fake)
    monkeypatch.setattr(forecast, "now", lambda: clock[0])
    return seen


def told(outcome):
    return [text for text in texts(outcome.validity.limitations) if "not reached" in text]


def test_levels_go_on_until_the_bands_are_as_narrow(ran):
    wide = simulate(replace(ASKED, "accuracy", "30 %"), budget_s=1e9)
    assert 0 < wide.validity.achieved_error <= 0.3 and not told(wide)
    assert len({size for size, _ in ran}) == 3  # two may agree by chance
    few, _ = len(ran), ran.clear()
    narrow = simulate(ASKED, budget_s=1e9)
    assert narrow.validity.achieved_error <= 0.05 and not told(narrow)
    assert len(ran) > few
    assert known(narrow.validity.mesh_limit)["e_edge"] == pytest.approx(cost_fakes.LIMIT["e_edge"], rel=0.05)


def test_each_level_but_the_pilot_runs_at_two_places(ran):
    simulate(ASKED, budget_s=1e9)
    (_, first), *others = ran
    assert first == 0.0
    assert [place for _, place in others] == [0.0, 0.5] * (len(others) // 2)
    sizes = [size for size, _ in others[::2]]
    assert sizes == sorted(sizes, reverse=True) and sizes == [size for size, _ in others[1::2]]


def test_an_error_of_one_number_alone_is_reached_by_that_number(ran):
    """Three levels give mu to 4 %, e and E_vib less well."""
    simulate(ASKED, budget_s=1e9)
    both, _ = len(ran), ran.clear()
    outcome = simulate(replace(ASKED, "accuracy", "mu 5 %"), budget_s=1e9)
    assert outcome.validity.achieved_error == pytest.approx(0.0376, rel=1e-2) and not told(outcome)
    assert len(ran) < both


def test_a_wanted_error_is_written_as_it_is_read():
    for text in ("e 2 %", "2 %"):
        assert to_dict(replace(ASKED, "accuracy", text))["accuracy"]["target"] == text
    with pytest.raises(SceneError, match=r"target.*Omega"):
        replace(ASKED, "accuracy", "speed 2 %")


def test_places_can_be_asked_for_without_an_error(ran):
    scene = replace(load("t5b"), "accuracy.offsets", 2)
    two = simulate(scene)
    ran.clear()
    one = simulate(load("t5b"))
    assert {place for _, place in ran} == {0.0}
    bands = [known(outcome.validity.mesh_band)["mu"] for outcome in (two, one)]
    assert bands[0] < 0.5 * bands[1]


def test_an_error_that_is_not_reached_tells_what_more_would_cost(ran):
    """The budget that is advised lets the next level run."""
    scene = replace(ASKED, "accuracy", FINEST)
    budget = 300.0
    short = simulate(scene, budget_s=budget)
    (sentence,) = told(short)
    assert re.search(r"e is known to [\d.]+ % and E_vib is known to [\d.]+ %", sentence)
    levels, _ = len({size for size, _ in ran}), ran.clear()
    enough = float(re.search(r"a budget of (\d+) s", sentence)[1])
    assert short.validity.achieved_wall <= budget < enough
    simulate(scene, budget_s=enough)
    assert len({size for size, _ in ran}) > levels


def test_levels_end_some_splits_beyond_those_that_resolve_the_contact(ran):
    levels = LevelChain(Case(replace(ASKED, "accuracy", FINEST)), budget_s=1e9)
    outcome = levels.run()
    assert levels.done[-1].splits == levels.finest + chain.MOST_FINER
    assert told(outcome)[0].endswith(end := "No finer level is tried: accuracy.levels is at most 6.")
    del levels.done[4:]
    levels.done[-1] = with_(levels.done[-1], splits=levels.finest + chain.MOST_FINER)
    remedy = "accuracy.levels = 5 in place of 3 adds a finer level"
    assert levels.following is None
    assert levels.advice()[0].startswith(f"{end.partition(':')[0]}: {remedy} (about ")
    stated = replace(replace(ASKED, "accuracy", FINEST), "accuracy.levels", 5)
    assert LevelChain(Case(stated), done=levels.done).following == levels.done[-1].splits + 1


def test_a_level_that_cannot_keep_the_budget_is_given_up(monkeypatch):
    """Its progress tells how long it takes; the levels before it count."""
    clock = [0.0]

    def slow(scene, fidelity, options, case):
        outcome = run(scene)
        clock[0] += outcome.cost.whole_wall * (50 if clock[0] else 1)
        options.progress(Notice("a step"))
        options.progress(Progress(0.0, 1e-4, 200, 0.0, ""))
        return outcome, pressed(case.record)

    monkeypatch.setattr(level_module, "simulate_recorded", slow)
    monkeypatch.setattr(forecast, "now", lambda: clock[0])
    levels = LevelChain(Case(replace(ASKED, "accuracy", FINEST)), budget_s=100.0)
    outcome = levels.run()
    assert len(levels.done) == 1
    assert "Level 2, finer, gave no result: It was given up after" in told(outcome)[0]


def test_a_finer_level_that_fails_leaves_what_the_coarser_ones_say(ran, monkeypatch):
    fake = level_module.simulate_recorded

    def cut(scene, *rest):
        outcome, record = fake(scene, *rest)
        validity = with_(outcome.validity, finished=False, stopped_because="the tail.")
        cut_off = without_end(with_(outcome, validity=validity), "the tail.")
        return (cut_off if len(ran) > 3 else outcome), record

    monkeypatch.setattr(level_module, "simulate_recorded", cut)
    outcome = simulate(replace(ASKED, "accuracy", FINEST), budget_s=1e9)
    assert any("cut off. the tail." in text for text in texts(outcome.validity.limitations))
    assert not isinstance(outcome.motion.V_n, Unknown)


def test_a_rod_that_cannot_vibrate_is_judged_by_e_alone(ran, capsys, tmp_path):
    for scene, words in ((replace(ASKED, "effects", ["auto", "-vibration"]), "e "), (ASKED, "e and E_vib")):
        print_outcome(simulate(scene, budget_s=1e9), tmp_path)
        assert f"asked for 5 %; reached in {words}" in capsys.readouterr().out


def test_runs_of_one_level_share_what_they_found(ran, monkeypatch):
    fake, spread = level_module.simulate_recorded, []

    def found(scene, fidelity, options, case):
        outcome, record = fake(scene, fidelity, options, case)
        spread.append(case.record.rod.spread)
        wide = 3.0 if scene.accuracy.grid_shift else 1.0
        return outcome, with_(record, rod=with_(record.rod, spread=wide * record.rod.spread))

    monkeypatch.setattr(level_module, "simulate_recorded", found)
    simulate(replace(load("t5b"), "accuracy.offsets", 2))
    pilot, second, _, third, _ = spread
    assert second == pilot and third == pytest.approx(3 * second)


@pytest.mark.long
def test_the_files_are_those_of_the_finest_level_at_its_first_place(tmp_path):
    short = {"projectile.length": "40 mm", "accuracy.levels": 2, "accuracy.offsets": 2, "save.frames": 0}
    scene = replace_all(load("quick"), short)
    outcome = simulate(scene, options=RunOptions(tmp_path), workers=2)
    assert sorted(path.name for path in tmp_path.glob("level-*")) == ["level-1", "level-2", "level-2-run-2"]
    assert (tmp_path / "contact.npz").is_file()
    edge, first = outcome.restitution.edge.e, Outcome.read(tmp_path / "outcome.json").restitution.edge.e
    second = Outcome.read(tmp_path / "level-2-run-2" / "outcome.json").restitution.edge.e
    assert edge == first != second


def test_a_model_without_a_mesh_refuses_a_wanted_error():
    with pytest.raises(SceneError, match="is asked of the modal model, which has no mesh to refine"):
        simulate(ASKED, "modal")


def test_a_pilot_that_fails_is_an_error(monkeypatch):
    def fails(*_):
        raise RunError("The motion is not finite.")

    monkeypatch.setattr(level_module, "simulate_recorded", fails)
    with pytest.raises(RunError, match="not finite"):
        simulate(ASKED)
