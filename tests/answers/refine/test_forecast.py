"""The time that levels will take: a range from the mesh that stands, told with every report of progress."""

import pickle
from dataclasses import replace
from itertools import count
from math import sqrt
from types import SimpleNamespace

import pytest

from fem_impact.answers import simulate as simulate_module
from fem_impact.answers.refine import forecast
from fem_impact.answers.refine import level as level_module
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.forecast import LEFT, MIDDLE, LevelProgress, OverBudgetError, growth, planned_s
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.simulate import simulate
from fem_impact.case import size
from fem_impact.case.case import Case
from fem_impact.errors import RunError
from fem_impact.fem import body, eigen
from fem_impact.options import RunOptions
from fem_impact.progress import Notice, Progress, describe
from fem_impact.scene.shipped import load, replace_all


def shown(**of):
    seen = []
    level = LevelProgress(seen.append, "level 2", (6.0, 12.0), duration_s=2e-4, **of)
    return seen, level


def at(step, eta):
    return Progress(0.0, 1e-4, step, 0.0, "", eta, "x", setup_s=1.0)


def test_a_mesh_that_stands_is_forecast_by_the_impact_of_the_level_before():
    seen, level = shown(turns=2)
    level(at(0, 3.0))  # planned for half the duration that the level before showed, at one of two places
    assert level.own_s == pytest.approx(1 + 2 * sqrt(2))
    few, many = (2 * (level.own_s + later) for later in (6.0, 12.0))
    least, about, most = LEFT
    assert seen[0].eta_s == pytest.approx(about * many)
    assert seen[0].eta_range_s == pytest.approx((least * few, most * many))
    level(at(200, 1.0))
    assert seen[1].text == "level 2: about 25 s left (8 s to 2 min 03 s)."
    told, dear = shown(turns=2, used_s=5.0, limit_s=20.0)
    dear(at(0, 3.0))
    assert told[1].text.endswith("2 min 03 s). For all of it give a budget of 61 s.")
    assert seen[2].eta_s == pytest.approx(1 + level.own_s + about * 2 * 12, abs=0.5)  # time goes by
    assert describe(seen[0]).startswith("level 2  t 0/100 us  about 25 s left (8 s to 2 min 03 s)")


def test_a_contact_that_a_pilot_does_not_resolve_is_forecast_as_wide_as_estimated():
    meshes = LevelMeshes.of(Case(replace_all(load("t5b"), {"impact.v_n": "-0.3 m/s"})))
    expected = meshes.expected(0)
    wide = replace(expected, rod=replace(expected.rod, touched=5 * expected.rod.touched))
    assert meshes.likely(wide) == meshes.likely(None) == meshes.usual > meshes.last(wide)
    assert meshes.likely(replace(wide, resolved=True)) == meshes.last(wide)


def test_levels_that_do_not_stand_are_planned_by_their_meshes():
    meshes = LevelMeshes.of(Case(load("quick")))
    pilot, splits = meshes.pilot, meshes.first
    shown = pilot.size.steps * pilot.size.step  # as long as planned
    cost = SimpleNamespace(steps=1, min_step=shown, whole_cpu=1.0)
    last = SimpleNamespace(outcome=SimpleNamespace(cost=cost), splits=splits, found=meshes.expected(splits))
    each = [Case.of(meshes.at(splits + n), "solid", last.found).size.time for n in (1, 2)]
    assert planned_s(last, meshes, [splits + 1, splits + 2]) == pytest.approx(sum(each), rel=1e-3)
    cost.min_step = 4 * shown
    assert sum(each) < planned_s(last, meshes, [splits + 1, splits + 2]) < 2 * sum(each)


def test_a_pilot_tells_no_time_and_notices_pass():
    seen = []
    level = LevelProgress(seen.append, "pilot")
    level(at(0, 3.0))
    level(Notice("told"))
    assert (seen[0].eta_s, seen[1].text) == (None, "told")


def test_a_level_is_given_up_at_its_limit(monkeypatch):
    clock = [0.0]
    monkeypatch.setattr(forecast, "now", lambda: clock[0])
    level = LevelProgress(None, "level 2", (0.0, 0.0), limit_s=10.0)
    level(at(0, 3.0))
    clock[0] = 10.5
    with pytest.raises(RunError, match="given up after 10 s"):
        level(at(200, 3.0))


def test_a_level_whose_mesh_forecasts_that_it_takes_too_long_is_given_up_at_once():
    """A pilot's contact may be a third of the estimate; a later level is forecast by what was found."""
    for duration_s, kept, dear in ((1e-4, 9.0, 11.0), (0.0, 28.0, 33.0)):
        level = LevelProgress(None, "level", (0.0, 0.0), duration_s=duration_s, limit_s=10.0)
        level(at(0, kept))
        with pytest.raises(OverBudgetError, match=f"it takes about {dear:.0f} s"):
            level(at(0, dear))


def test_a_long_level_is_forecast_by_what_its_mesh_holds():
    meshes = LevelMeshes.of(Case(load("quick")))
    splits, pilot = meshes.first + 3, meshes.pilot
    found, finer = meshes.expected(splits), meshes.at(splits)
    held = Case.of(finer, "solid", found).size.time / pilot.size.time
    assert growth(0.1, 3, pilot, finer, found) == pytest.approx(MIDDLE**3)
    assert growth(100.0, 3, pilot, finer, found) == pytest.approx(held) != pytest.approx(MIDDLE**3, rel=0.1)
    vast = replace_all(finer, {"accuracy.tip_size": "2 um", "accuracy.barrier_size": "2 um"})
    assert growth(100.0, 9, pilot, vast, found) == pytest.approx(MIDDLE**9)


def test_a_level_given_up_in_contact_tells_its_budget_by_the_impact_of_the_level_before(monkeypatch):
    clock = [0.0]
    monkeypatch.setattr(forecast, "now", lambda: clock[0])
    level = LevelProgress(None, "level 2", (0.0, 0.0), duration_s=1e-4, used_s=10.0, limit_s=20.0)
    clock[0] = 25.0
    with pytest.raises(OverBudgetError, match=r"takes about 50 s\. For it give a budget of 88 s\."):
        level(Progress(5e-5, 1e-4, 200, 0.0, "4 nodes touch", None))


def test_a_level_whose_steps_show_that_it_takes_too_long_is_given_up_before_its_limit(monkeypatch):
    """Of an impact of 100 us 20 have taken 4 s; its modes had taken 5 s, and a run before it another 10 s."""
    clock = [10.0]
    monkeypatch.setattr(forecast, "now", lambda: clock[0])
    level = LevelProgress(None, "level 2", (0.0, 0.0), duration_s=1e-4, limit_s=40.0, begun=0.0)
    slow = LevelProgress(None, "level 2", (0.0, 0.0), duration_s=1e-4, limit_s=28.0, begun=0.0)
    clock[0] = 15.0
    for one in (level, slow):
        one(at(0, 5.0))
    clock[0] = 18.0
    slow(Progress(1.5e-5, 1e-4, 100, 0.0, "4 nodes touch", 90.0))  # too early to say
    clock[0] = 19.0
    level(Progress(2e-5, 1e-4, 200, 0.0, "4 nodes touch", 90.0))  # by the impulse, which is rough
    with pytest.raises(OverBudgetError, match=r"given up after 19 s.* takes about 35 s"):
        slow(Progress(2e-5, 1e-4, 200, 0.0, "4 nodes touch", None))


def test_the_clock_of_another_process_counts_from_the_levels_beginning(monkeypatch):
    """Its own clock stands elsewhere, as it has compiled something else."""
    monkeypatch.setattr(forecast, "now", lambda: 100.0)
    sent = pickle.dumps(LevelProgress(None, "level 2", (0.0, 0.0), begun=93.0))
    monkeypatch.setattr(forecast, "now", lambda: 40.0)
    assert pickle.loads(sent).begun == 33.0


def test_forecasts_follow_the_load_of_the_machine(monkeypatch):
    """Three seconds of wall time have passed for each of processor time."""
    clocks = {"now": 0.0, "worked": 0.0}
    for name in clocks:
        monkeypatch.setattr(forecast, name, lambda name=name: clocks[name])
    level = LevelProgress(None, "level 2", (0.0, 0.0), duration_s=1e-4, limit_s=20.0)
    level(at(0, None))
    clocks.update(now=8.0, worked=2.0)
    with pytest.raises(OverBudgetError, match="it takes about 38 s"):
        level(at(0, 10.0))


def test_a_level_whose_mesh_shows_that_it_takes_too_long_is_given_up_at_once():
    """A pilot only where even a third of its forecast is too much; it tells what budget holds two levels."""
    level = LevelProgress(None, "level 2", (0.0, 0.0), duration_s=1e-4, limit_s=10.0)
    with pytest.raises(OverBudgetError, match=r"it takes about 18 s\. For it give a budget of 2\d s\.$"):
        level(at(0, 18.0))
    pilot = LevelProgress(None, "pilot", limit_s=10.0)
    pilot(at(0, 18.0))
    pilot(at(0, None))
    with pytest.raises(OverBudgetError, match=r"gave no number\. .* give a budget of 260 s"):
        pilot(at(0, 40.0))


def test_modes_that_take_longer_than_the_budget_are_broken_off(monkeypatch):
    """Every look at the clock takes a second here; no step of the impact is computed."""
    clock, told = count(), []
    monkeypatch.setattr(forecast, "now", lambda: next(clock))
    monkeypatch.setattr(eigen, "_LAST", {})
    chain = LevelChain(Case(load("quick")), RunOptions(progress=told.append), budget_s=20.0)
    with pytest.raises(
        OverBudgetError, match=r"^The coarsest level was given up after 2\d s, .* It gave no number"
    ):
        chain.run()
    assert len(told) > 5 and not any(one.step for one in told)


def test_a_set_up_that_no_budget_holds_is_given_up_before_its_matrices(monkeypatch):
    chain = LevelChain(Case(load("quick")), budget_s=20.0)
    _ = chain.meshes.pilot.size  # planned as small: the mesh shows more
    monkeypatch.setattr(size, "SETUP", 0.1)
    monkeypatch.setattr(forecast, "require_pilot", lambda *_: None)
    monkeypatch.setattr(body, "stiffness_of", None)
    with pytest.raises(OverBudgetError, match=r"given up after \d s, .*takes about \d\d+ s"):
        chain.run()


def test_what_reading_took_is_used_up():
    with pytest.raises(OverBudgetError, match="it is not begun"):
        LevelChain(Case(load("quick")), budget_s=20.0, read_s=26.0).run()


def test_a_pilot_that_no_budget_holds_is_not_begun(monkeypatch):
    """Rigid theory answers in its place, or the reduced model where the budget spares its time."""
    begun = []
    monkeypatch.setattr(level_module, "simulate_recorded", lambda *_: begun.append(1))
    slow = replace_all(load("t5b"), {"accuracy.tip_size": "0.015 mm"})
    reduced = r"reduced model says: e = .* \+- .*fidelity modal"
    for spare, says in ((0.1, "rigid theory says, of unknown error: e = "), (1e6, reduced)):
        monkeypatch.setattr(simulate_module, "SPARE", spare)
        with pytest.raises(OverBudgetError, match=rf"would take about \d+ s: it is not begun\. .*{says}"):
            simulate(slow, budget_s=1.0)
    assert not begun


@pytest.mark.long
def test_a_run_tells_its_range_when_the_second_mesh_stands():
    told = []
    scene = replace_all(load("quick"), {"save.frames": 0})
    LevelChain(Case(scene), RunOptions(progress=told.append)).run()
    told = [one for one in told if isinstance(one, Progress)]
    assert all(one.eta_s is None for one in told if "level 1" in one.note)
    second = [one for one in told if "level 2 of 3" in one.note]
    stands = next(one for one in second if "are made" in one.contact)
    least, most = stands.eta_range_s
    assert 0 < least < stands.eta_s < most


def test_the_budget_of_levels_grows_with_their_number_and_with_the_places():
    budgets = [forecast.for_levels_s(100.0, levels, places) for places in (1, 2) for levels in (2, 3)]
    two, three, two_twice, three_twice = budgets
    assert forecast.for_levels_s(100.0) == two < two_twice < three < three_twice
    for levels, budget in ((2, two), (3, three)):
        assert budget > 100.0 * sum(MIDDLE**level for level in range(levels))
