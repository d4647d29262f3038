"""Levels of a run that end early: what they leave, when no other follows, and how they go on."""

import re
from dataclasses import replace

import numpy as np
import pytest

from fem_impact.answers.refine import forecast
from fem_impact.answers.refine import level as level_module
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.forecast import SHORTER, OverBudgetError, Turns
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.simulate import simulate
from fem_impact.case.case import Case
from fem_impact.errors import ResultError, RunError, SceneError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import Outcome
from fem_impact.progress import Notice
from fem_impact.run.resolution import without_end
from fem_impact.scene.read import read_toml
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.rodview import RodState
from fem_impact.solid.stepguard import SMALLEST, THIN_CRUSHED
from fem_impact.solid.watchers import Watchers

QUICK = replace_all(load("quick"), {"save.frames": 0})
SHORT = replace_all(QUICK, {"projectile.length": "40 mm", "accuracy.levels": 2})
FREE = replace(QUICK, accuracy=replace(QUICK.accuracy, tip_size=None, barrier_size=None))


@pytest.fixture(scope="module")
def level():
    """Return the first level of a scene, which does not resolve its contact."""
    levels = LevelChain(Case(QUICK))
    levels._run_level(levels.meshes.first, Turns())
    return levels.done[0]


def lasting(level, seconds):
    """Return the level as if its run had taken so long."""
    cost = replace(level.outcome.cost, wall=seconds, setup_wall=0.0, cpu=seconds, setup_cpu=0.0)
    return replace(level, wall_s=seconds, outcomes=(replace(level.outcome, cost=cost),))


def test_two_levels_are_two(level):
    scene = replace(FREE, accuracy=replace(FREE.accuracy, levels=2))
    levels = LevelChain(Case(scene), done=[level])
    assert levels.finest > level.splits


def test_more_levels_run_where_the_last_resolved_nothing(level):
    level = lasting(level, 0.1)
    levels = LevelChain(Case(FREE), done=[level])
    finest = levels.finest
    levels.done = [replace(level, splits=splits) for splits in range(finest - 2, finest + 1)]
    assert levels._next == finest + 1
    levels.done.append(replace(level, splits=finest + 1))
    assert levels._next == finest + 2
    resolved = replace(levels.done[-1], record=replace(level.record, resolved=True))
    assert LevelChain(Case(FREE), done=[*levels.done[:2], resolved])._next is None
    levels.done.extend(replace(level, splits=finest + more) for more in (2, 3))
    assert levels._next is None


def test_a_smaller_step_follows_where_the_budget_does_not_hold_the_larger_for_sure(level):
    """Of four levels two are done and two left for three splits; of three one is, for two.

    A stepped rod had a minute: its second level, forecast to fit, was given up, and none was left.
    """
    for levels in (3, 4):
        scene = replace(QUICK, accuracy=replace(QUICK.accuracy, levels=levels))
        chain = LevelChain(Case(scene), done=[lasting(level, 10.0)] * (levels - 2))
        one_s, two_s = (chain.forecast_s(level.splits + more) for more in (1, 2))
        for budget_s in (0.5 * (one_s + two_s), 1.2 * two_s):
            chain.budget_s = chain.spent_s + budget_s
            assert chain._next == level.splits + 1
        chain.budget_s = chain.spent_s + 2.0 * two_s
        assert chain._next == level.splits + (1 if levels == 3 else 2)


def test_a_pilot_alone_keeps_its_numbers_and_tells_the_budget_of_a_second_level(level):
    told = []
    scene = replace(FREE, accuracy=replace(FREE.accuracy, unresolved="report"))
    resolved = replace(lasting(level, 10.0), record=replace(level.record, resolved=True))
    levels = LevelChain(Case(scene), RunOptions(progress=told.append), budget_s=12.0, done=[resolved])
    outcome = levels.run()
    assert known(outcome.restitution.edge.e) == known(level.outcome.restitution.edge.e)
    reason = "one level alone tells no error; a larger budget adds a finer level"
    assert outcome.validity.mesh_band == Unknown(reason)
    (said,) = [one.text for one in outcome.validity.limitations if "give a budget of" in one.text]
    assert "10 s of the budget of 12 s are used up. Level 2, finer, takes about" in said
    assert said in told[-1].text


def test_a_level_begins_where_the_budget_may_hold_it(level):
    """Its own mesh tells within seconds whether it does: the forecast may be far too long."""
    ten = lasting(level, 10.0)
    forecast_s = LevelChain(Case(FREE), done=[ten]).forecast_s(ten.splits + 1)
    for share, begins in ((SHORTER - 0.05, False), (SHORTER + 0.05, True)):
        levels = LevelChain(Case(FREE), budget_s=10.0 + share * forecast_s, done=[ten])
        assert (levels._next == ten.splits + 1) is begins


@pytest.mark.parametrize("mends", [True, False])
def test_a_level_whose_ledger_does_not_close_is_repeated_once_with_half_the_step(level, monkeypatch, mends):
    steps, bad = [], "The energy ledger misses 1.4e-04 of E_0, more than 0.0001."

    def run(scene, fidelity, options, case):
        steps.append(scene.accuracy.step)
        said = level.outcome.validity
        lost = replace(said, finished=False, stopped_because=bad)
        validity = said if mends and scene.accuracy.step < QUICK.accuracy.step else lost
        return replace(level.outcome, validity=validity), level.record

    monkeypatch.setattr(level_module, "simulate_recorded", run)
    levels = LevelChain(Case(QUICK), done=[level])
    levels._run_level(2, Turns())
    assert steps == [QUICK.accuracy.step, 0.5 * QUICK.accuracy.step]
    assert levels.done[-1].loses is not mends and levels.done[-1].repeats == 1
    told = [one.text for one in levels._stated().validity.limitations]
    assert any("accuracy.step is 0.45: with 0.9" in one for one in told)
    assert not levels.done[0].shorter_steps(QUICK)


def test_a_level_that_the_budget_does_not_let_run_with_half_the_step_stands_and_says_why(level, monkeypatch):
    bad = "The energy ledger misses 1.4e-04 of E_0, more than 0.0001."

    def run(scene, fidelity, options, case):
        if scene.accuracy.step < QUICK.accuracy.step:
            raise RunError("It was given up.")
        return replace(
            level.outcome, validity=replace(level.outcome.validity, finished=False, stopped_because=bad)
        ), level.record

    monkeypatch.setattr(level_module, "simulate_recorded", run)
    levels = LevelChain(Case(QUICK), done=[level])
    levels._run_level(2, Turns())
    assert levels.done[-1].loses and levels.done[-1].repeats == 0 and not levels.done[-1].left
    told = [one.text for one in levels._stated().validity.limitations if one.kind == "run"]
    assert "Another repeat of the level has no outcome. It was given up." in told


def test_smaller_cells_do_not_follow_crushed_ones(level):
    levels = LevelChain(Case(FREE), done=[level])
    assert levels._next is not None
    levels.done[0] = replace(level, record=replace(level.record, crushed=True))
    assert levels._next is None
    assert "fidelity rigid or modal has none" in levels.run().validity.mesh_band.reason


def test_where_levels_end_unresolved_the_remedy_is_one_that_adds_a_finer_one(level):
    """Three levels more than asked for have run already: one more has to be asked for."""
    for scene, remedy in (
        (FREE, r"accuracy.levels = 4 in place of 3 adds a finer level \(about \d+ s more\)"),
        (QUICK, r"a smaller accuracy.tip_size adds a finer level \(half of it: about \d+ s more\)"),
    ):
        levels = LevelChain(Case(scene), done=[level])
        levels.done = [
            replace(lasting(level, 0.1), splits=splits)
            for splits in range(levels.finest - 2, levels.finest + 4)
        ]
        validity = levels.run().validity
        assert re.search(f"; {remedy}$", validity.mesh_band.reason)
    more = replace(FREE, accuracy=replace(FREE.accuracy, levels=4))
    assert LevelChain(Case(more), done=levels.done)._next == levels.done[-1].splits + 1


def test_each_repeat_has_twice_the_room_of_the_one_before(level, monkeypatch):
    rooms, called = [], []

    def left(scene, fidelity, options, case):
        rooms.append((case.record.rod.reach, case.record.barrier.spread))
        called.append(options.progress.name.endswith(", again"))
        return lasting(level, float(len(rooms))).outcome, replace(level.record, left=True)

    monkeypatch.setattr(level_module, "simulate_recorded", left)
    levels = LevelChain(Case(QUICK), done=[level])
    levels._run_level(2, Turns())
    assert levels.done[-1].repeats == 2 and called == [False, True, True]
    assert levels.done[-1].wall_s == levels.done[-1].runs.cpu_s == 1.0 + 2.0 + 3.0
    assert rooms == [(k * level.record.rod.reach, k * level.record.barrier.spread) for k in (1.0, 2.0, 4.0)]


@pytest.mark.parametrize(("ends", "error"), [(True, OverBudgetError), (True, SceneError), (False, RunError)])
def test_what_left_its_zones_counts_where_no_repeat_comes_to_its_end(level, ends, error, monkeypatch):
    ran = []

    def left(scene, fidelity, options, case):
        ran.append(scene)
        if len(ran) > 1:
            raise error("It was given up.")
        validity = replace(level.outcome.validity, finished=ends)
        return replace(level.outcome, validity=validity), replace(level.record, left=True)

    monkeypatch.setattr(level_module, "simulate_recorded", left)
    levels = LevelChain(Case(QUICK), done=[level])
    if not ends:
        with pytest.raises(error):
            levels._run_level(2, Turns())
        return
    levels._run_level(2, Turns())
    assert levels.done[-1].repeats == 0 and levels.done[-1].outcome == level.outcome
    assert levels.done[-1].left.endswith("left the finely meshed zones of the level.")
    assert levels.done[-1].lost == "Another repeat of the level has no outcome. It was given up."


def test_a_level_that_stopped_where_skin_came_down_runs_again_with_room_there(level, monkeypatch):
    """What a run that ended knew before stays known: what touched until a stop is not all that will."""
    far, ran = np.array([[0.0, 0.0, 0.02]]), []

    def stops(scene, fidelity, options, case):
        ran.append(case)
        validity = replace(level.outcome.validity, finished=len(ran) > 1)
        record = replace(level.record, rod=replace(level.record.rod, touched=far), left=len(ran) == 1)
        return replace(level.outcome, validity=validity), record

    monkeypatch.setattr(level_module, "simulate_recorded", stops)
    LevelChain(Case(QUICK), done=[level])._run_level(2, Turns())
    first, again = (case.record.rod.touched for case in ran)
    assert (again == np.concatenate([first, far])).all()


def test_a_level_whose_thin_rows_are_crushed_runs_again_without_them(level, monkeypatch):
    rows = []

    def squeezed(scene, fidelity, options, case):
        rows.append(case.zones.skin_rows)
        return level.outcome, replace(level.record, crushed=rows[-1] > 0)

    monkeypatch.setattr(level_module, "simulate_recorded", squeezed)
    levels = LevelChain(Case(QUICK), done=[level])
    levels._run_level(2, Turns())
    assert rows[0] > 0 and rows[1:] == [0] and not levels.done[-1].record.crushed
    assert "no thin rows and columns" in levels.done[-1].without_thin and not level.without_thin
    levels._run_level(3, Turns())  # as smaller cells are crushed sooner
    assert len(rows) == 3 and rows[-1] == 0


def test_a_step_falls_less_far_where_a_mesh_has_thin_rows_to_lose(level):
    (case,), guards = level.cases, []
    model = build(case)
    for record in (case.record, replace(case.record, crushed=True)):
        one = Case(case.scene, "solid", record)
        guards.append(Watchers.of(one, model, RodState.of(model), None, False).guard.crushed)
    assert guards == [THIN_CRUSHED, SMALLEST]


@pytest.fixture
def failing(monkeypatch):
    """Let the second level end as a function of its outcome and record says."""
    run, ran = level_module.simulate_recorded, []

    def set_up(end):
        def ended(scene, fidelity, options, case):
            ran.append(scene)
            outcome, record = run(scene, fidelity, options, case)
            return end(outcome, record) if len(ran) > 1 else (outcome, record)

        monkeypatch.setattr(level_module, "simulate_recorded", ended)
        return ran

    return set_up


def not_finite(outcome, record):
    raise RunError("The motion is not finite.")


def crushed(outcome, record):
    return without_end(outcome, "An element was crushed."), replace(record, crushed=True, left=True)


@pytest.mark.long
@pytest.mark.parametrize(("end", "runs"), [(not_finite, 2), (crushed, 3)])
def test_what_coarser_levels_found_is_kept_where_a_finer_one_fails(failing, end, runs, tmp_path):
    """One that is crushed runs once more, without its thin rows."""
    ran = failing(end)
    accuracy = replace(QUICK.accuracy, unresolved="report")
    outcome = simulate(replace(QUICK, accuracy=accuracy), options=RunOptions(tmp_path))
    assert len(ran) == runs
    assert 0 < known(outcome.restitution.edge.e) < 1
    assert isinstance(outcome.validity.mesh_band, Unknown)
    (told,) = [one.text for one in outcome.validity.limitations if "cut off" in one.text]
    assert "level 1" in told
    assert Outcome.read(tmp_path / "outcome.json") == outcome
    assert (tmp_path / "contact.npz").is_file()


@pytest.mark.long
def test_numbers_of_a_coarser_level_that_did_not_resolve_the_contact_are_withheld(failing):
    failing(not_finite)
    outcome = simulate(QUICK)
    assert "fewer than" in outcome.restitution.edge.e.reason


def test_a_pilot_that_fails_is_an_error(monkeypatch):
    monkeypatch.setattr(level_module, "simulate_recorded", lambda *_: not_finite(*_[:2]))
    with pytest.raises(RunError, match="not finite"):
        simulate(QUICK)


@pytest.mark.long
def test_a_level_killed_in_the_middle_goes_on_from_its_checkpoint(tmp_path):
    whole = simulate(SHORT)

    def kill(progress):
        if "level 2" in progress.note and progress.step > 400:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(SHORT, options=RunOptions(tmp_path, kill, checkpoint_s=0.0))
    steps = []
    again = RunOptions(tmp_path, lambda p: steps.append((p.note, p.step)), resume=True)
    outcome = simulate(SHORT, options=again)
    of_second = [step for note, step in steps if "level 2" in note and step]
    assert not [note for note, _ in steps if "level 1" in note] and of_second[0] > 400
    assert outcome.restitution.edge.e == whole.restitution.edge.e
    assert outcome.energy.vibration == whole.energy.vibration


@pytest.mark.parametrize(("budget", "is_told"), [(3.0, True), (4.0, False)])
def test_a_budget_that_may_hold_the_pilot_alone_is_told_before_it_runs(monkeypatch, budget, is_told):
    """A budget of 60 s ended after 83 s without a number, and nothing had told so."""
    told = []

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(level_module, "simulate_recorded", stopped)
    pilot_s = LevelMeshes.of(Case(QUICK)).pilot.size.time
    levels = LevelChain(Case(QUICK), RunOptions(progress=told.append), budget * pilot_s)
    with pytest.raises(KeyboardInterrupt):
        levels.refine()
    notices = [one.text for one in told if isinstance(one, Notice)]
    advice = f"may hold it alone. {forecast.FOR_TWO.format(forecast.for_levels_s(pilot_s))}"
    assert len(notices) == is_told and all(advice in one for one in notices)


@pytest.mark.long
def test_to_resume_where_nothing_is_begins_and_another_scene_is_refused(failing, tmp_path):
    def interrupted(outcome, record):
        raise KeyboardInterrupt

    failing(interrupted)
    with pytest.raises(KeyboardInterrupt):
        simulate(QUICK, options=RunOptions(tmp_path, resume=True))
    assert read_toml(tmp_path / "scene.toml") == QUICK
    with pytest.raises(ResultError, match="another scene"):
        simulate(replace_all(QUICK, {"impact.speed": "2 m/s"}), options=RunOptions(tmp_path, resume=True))
