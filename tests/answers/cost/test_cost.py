"""What accuracy costs: errors against a known limit, Pareto front, choice, resuming, documents."""

import csv
import json
import re
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
from cost_fakes import LIMIT, SLOPE, TIP, WIGGLE, Here, run
from outcome_maker import altered

import fem_impact.run.simulate
from fem_impact.answers.cost.document import text_table, write_cost
from fem_impact.answers.cost.judge import (
    advice,
    best_group,
    best_within,
    cheapest,
    front,
    group_sentence,
    judge,
    verdict,
    worst,
)
from fem_impact.answers.cost.measure import judge_stored, measure
from fem_impact.answers.cost.settings import ONE_OFFSET, settings_of
from fem_impact.answers.refine.extrapolate import (
    EVEN,
    LOWEST,
    MeshRuns,
    mesh_limits,
    pair_limit,
    target_limits,
)
from fem_impact.answers.refine.levels import FAMILY, MeshLevel, at_offsets, on_mesh
from fem_impact.answers.refine.quantities import TARGETED, chosen
from fem_impact.case.measured import yardsticks
from fem_impact.errors import RunError, UsageError
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load

SCENE = load("t5b")


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", run)
    monkeypatch.setattr(import_module("fem_impact.answers.cost.measure"), "compiled_before", lambda: True)


@pytest.fixture
def cost(fake, tmp_path):
    return measure(SCENE, tmp_path, NullMeter(), executor=Here())


def runs_on(mesh):
    return [run(scene) for scene in at_offsets(SCENE, mesh)]


def limits_of(meshes):
    return target_limits([MeshRuns.of(runs) for runs in meshes])


def by_name(cost, words):
    found = [one for one in cost.settings if words in one.name]
    assert len(found) == 1
    return found[0]


def test_the_ladder_has_every_kind_of_setting():
    names = [setting.name for setting in settings_of(SCENE)]
    assert len(set(names)) == len(names)
    assert names[:3] == ["rigid", "modal", "solid 0.594 mm"]
    assert [setting.name for setting in settings_of(SCENE) if setting.kind == "extrapolated"] == [
        f"solid {sizes} mm extrapolated, {places} places"
        for sizes in ("0.594 and 0.297", "0.594 and 0.148", "0.297 and 0.148", "0.594, 0.297 and 0.148")
        for places in (2, 4)
    ]
    for effect in ("vibration", "friction", "rod-plasticity", "rate-hardening"):
        assert f"solid 0.594 mm without {effect}" in names
    assert "solid 0.594 mm with an elastic barrier" in names
    for setting in settings_of(SCENE):
        assert len(setting.runs) == (len(setting.meshes) or 1)
        for mesh, jobs in zip(setting.meshes, setting.runs, strict=False):
            size = 0.019 / 8 / 2 ** (3 + mesh.finer)
            places = [job.scene.accuracy.grid_shift for job in jobs]
            most = [0.0] if setting.kind in ONE_OFFSET else [0.0, 0.5, 0.25, 0.75][: setting.places]
            assert places == ([0.0, 0.5] if mesh == FAMILY[-1] else most)
            for key in ("tip_size", "barrier_size"):
                sizes = [getattr(job.scene.accuracy, key) for job in jobs]
                assert sizes == pytest.approx([size] * len(jobs), rel=1e-8)
            assert {job.scene.save.frames for job in jobs} == {0}


def test_a_rigid_barrier_has_no_grid_to_place():
    stiff = replace(SCENE, effects=("vibration", "friction", "barrier-rigid"))
    assert [scene.accuracy.grid_shift for scene in at_offsets(stiff, FAMILY[0])] == [0.0]
    assert [len(setting.runs[0]) for setting in settings_of(stiff) if setting.kind == "mesh"] == [1] * len(
        FAMILY
    )


def test_elements_and_steps_are_settings_of_their_own():
    numerics = [setting for setting in settings_of(SCENE) if setting.kind == "numerics"]
    (full,) = (setting.runs[0][0].scene for setting in settings_of(SCENE) if setting.kind == "full")
    assert replace(SCENE.accuracy, mass_scaling=1.0, fine_zone="even") == full.accuracy
    stated = {setting.name: setting.runs[0][0].scene.accuracy for setting in numerics}
    plain = on_mesh(SCENE, FAMILY[0]).accuracy
    assert stated == {
        "solid 0.594 mm fully integrated": replace(plain, element="full"),
        "solid 0.594 mm mean dilatation": replace(plain, element="bbar"),
        "solid 0.594 mm with half the default step": replace(plain, step=0.5 * plain.step),
    }


def test_limit_and_order_are_found(cost):
    for name, key in (("e", "e_edge"), ("mu", "mu"), ("E_vib", "E_vib_over_E_0")):
        assert cost.limits[name].value == pytest.approx(LIMIT[key], rel=1e-4)
        assert cost.limits[name].order == pytest.approx(1, abs=0.02)
        finest = SLOPE[key] * (0.019 / 128 / TIP)
        rest = cost.limits[name].uncertainty - cost.limits[name].scatter
        assert rest == pytest.approx(0.25 * abs(finest), rel=0.01)
    assert cost.limits["mu"].scatter == 0
    assert EVEN[2] * WIGGLE * 0.019 / 128 / TIP < cost.limits["e"].scatter < 15 * EVEN[2] * WIGGLE


def test_errors_hold_distance_and_the_limits_own_uncertainty(cost):
    beyond = cost.limits["e"].uncertainty
    coarse = next(s for s in cost.settings if s.name == "solid 0.594 mm")
    away = SLOPE["e_edge"] * (0.019 / 32 / TIP)
    finest = 0.3 + SLOPE["e_edge"] * (0.019 / 128 / TIP)
    assert coarse.error["e"] == pytest.approx((away + beyond) / finest, rel=1e-3)
    modal = by_name(cost, "modal")
    assert modal.error["mu"] == pytest.approx((0.05 + cost.limits["mu"].uncertainty) / 0.5, rel=1e-3)
    assert by_name(cost, "rigid").error["E_vib"] is None


def test_a_mesh_is_the_mean_of_its_places_and_their_spread_its_scatter(cost):
    h = 0.019 / 128 / TIP
    two, four = (next(s for s in cost.settings if s.name == f"solid {mm} mm") for mm in (0.148, 0.297))
    scale = cost.limits["e"].scale
    assert two.value["e"] == pytest.approx(LIMIT["e_edge"] + SLOPE["e_edge"] * h, rel=1e-9)
    assert two.scatter["e"] * scale == pytest.approx(EVEN[2] * WIGGLE * h, rel=1e-9)
    assert two.scatter["mu"] == 0
    assert four.value["e"] == pytest.approx(LIMIT["e_edge"] + SLOPE["e_edge"] * 2 * h, rel=1e-9)
    assert four.scatter["e"] * scale == pytest.approx(EVEN[4] * WIGGLE * 2 * h / 6**0.5, rel=1e-9)
    assert two.cpu_s == pytest.approx(2 * two.two_cores_s)
    assert four.cpu_s == pytest.approx(2 * four.two_cores_s)
    assert by_name(cost, "modal").scatter == {}


def test_two_meshes_cost_both_and_are_extrapolated(cost):
    pair = by_name(cost, "solid 0.594 and 0.297 mm extrapolated, 4 places")
    single = {s.name: s for s in cost.settings}
    fine, coarse = single["solid 0.297 mm"], single["solid 0.594 mm"]
    assert pair.wall_s == pytest.approx(fine.wall_s + coarse.wall_s)
    assert pair.element_steps == fine.element_steps + coarse.element_steps
    assert pair.value["e"] == pytest.approx(pair_limit(fine.value["e"], coarse.value["e"], 2)[0])
    assert pair.value["e"] != fine.value["e"]
    assert pair.two_cores_s == pytest.approx(fine.two_cores_s + coarse.two_cores_s)


def test_two_places_of_each_mesh_take_half_the_time_and_scatter_more(cost):
    few, all_of_them = (by_name(cost, f"solid 0.594 and 0.297 mm extrapolated, {n} places") for n in (2, 4))
    assert few.cpu_s == pytest.approx(0.5 * all_of_them.cpu_s)
    assert few.scatter["e"] > 2 * all_of_them.scatter["e"] > 0
    assert few.band["mu"] == pytest.approx(all_of_them.band["mu"])  # which does not scatter


@pytest.mark.parametrize("ratio", [1.5, 2.0, 3.0])
@pytest.mark.parametrize("order", [LOWEST, 1.0, 2.0, 40.0])
def test_the_band_of_a_pair_holds_the_limit_whatever_the_order_from_three_quarters_up(ratio, order):
    fine, coarse = (1 + 0.2 * size**order for size in (1, ratio))
    value, half = pair_limit(fine, coarse, ratio, offsets=4)
    assert abs(value - 1) <= half * (1 + 1e-12)
    assert (order == LOWEST) == (value - 1 == pytest.approx(half, rel=1e-9))


@pytest.mark.parametrize("ratio", [1.5, 2.0, 3.0])
def test_a_lower_order_falls_out_of_the_band_of_a_pair(ratio):
    value, half = pair_limit(1.2, 1 + 0.2 * ratio**0.6, ratio, offsets=4)
    assert abs(value - 1) > half


def test_the_scatter_of_both_meshes_is_carried_into_the_band(cost):
    two, four = EVEN[2], EVEN[4] / 6**0.5
    h, weight = 0.019 / 128 / TIP, 0.5 / (2**LOWEST - 1)
    scatter = WIGGLE * h * (((1 + weight) * two) ** 2 + (weight * 2 * four) ** 2) ** 0.5
    pair, scale = by_name(cost, "solid 0.297 and 0.148 mm extrapolated, 4"), cost.limits["e"].scale
    assert pair.scatter["e"] * scale == pytest.approx(scatter, rel=1e-6)
    assert pair.band["e"] * scale == pytest.approx(weight * SLOPE["e_edge"] * h + scatter, rel=1e-6)
    beyond = abs(pair.value["e"] - cost.limits["e"].value) + cost.limits["e"].uncertainty
    assert pair.error["e"] == pytest.approx(min(pair.band["e"], beyond / scale))
    assert all(bool(one.band) == (one.kind == "extrapolated") for one in cost.settings)
    assert any(one.error[name] == one.band[name] for one in cost.settings for name in one.band)
    assert any(one.error[name] < one.band[name] for one in cost.settings for name in one.band)


def test_the_best_group_is_the_quickest_that_meets_the_target_or_else_the_finest_two(cost):
    loose, strict, never = (best_group(cost.settings, TARGETED, target) for target in (0.2, 0.02, 1e-6))
    assert loose.name == "solid 0.594 and 0.297 mm extrapolated, 2 places"
    assert strict.name == "solid 0.594, 0.297 and 0.148 mm extrapolated, 2 places"
    assert never.name == "solid 0.297 and 0.148 mm extrapolated, 4 places"
    words = "0.3059 ± 0.0173 (0.0010 of it scatter), reached: 5.6 %"
    assert verdict(loose, cost.quantities, "e", 0.2) == words
    told = group_sentence(cost.settings, cost.quantities, TARGETED, 1e-6)
    assert told.startswith(
        "Several meshes against 0.0001 %, solid 0.297 and 0.148 mm extrapolated, 4 places: e 0.3030"
    )
    assert ", not reached: 2.8 %; " in told
    assert best_group([], TARGETED, 0.02) is None
    assert group_sentence([], {}, TARGETED, 0.02) == "No two meshes gave a result."


def test_the_band_of_coarse_meshes_that_agree_by_chance_reaches_to_the_limit_of_the_finest_two():
    values = dict(zip(FAMILY, (0.010, 0.010, 0.013), strict=True))
    on = {
        mesh: [altered(run, E_vib_over_E_0=E, E_vib_check_over_E_0=E) for run in runs_on(mesh)]
        for mesh, E in values.items()
    }
    limits, finest = (limits_of([on[mesh] for mesh in meshes]) for meshes in (FAMILY, FAMILY[1:]))
    groups = {one.name: one for one in settings_of(SCENE) if one.kind == "extrapolated"}
    coarse, fine = (
        judge(one, [MeshRuns.of(on[mesh]) for mesh in one.meshes], limits, finest)
        for one in (
            groups[f"solid {sizes} mm extrapolated, 4 places"]
            for sizes in ("0.594 and 0.297", "0.297 and 0.148")
        )
    )
    scale, limit = limits["E_vib"].scale, finest["E_vib"]
    assert coarse.value["E_vib"] == pytest.approx(0.010)
    assert coarse.band["E_vib"] * scale == pytest.approx(limit.value - 0.010)
    assert fine.band["E_vib"] * scale == pytest.approx(limit.uncertainty)


def test_the_band_of_the_vibration_is_no_less_than_its_two_counts_allow():
    """However well two meshes agree; the other quantities do not know of it."""
    meshes = [runs_on(mesh) for mesh in FAMILY[1:]]
    apart = [[altered(run, E_vib_check_over_E_0=0.03) for run in runs] for runs in meshes]
    plain, doubtful = limits_of(meshes), limits_of(apart)
    finest = apart[1][0].energy.vibration
    assert plain["E_vib"].uncertainty < 0.002
    assert doubtful["E_vib"].uncertainty == pytest.approx(0.03 - finest)
    assert doubtful["e"] == plain["e"]
    (_, narrow), (_, floored) = (mesh_limits(list(map(MeshRuns.of, runs))) for runs in (meshes, apart))
    assert floored["E_vib_over_E_0"] == pytest.approx(0.03 - finest)
    assert floored["e_edge"] == narrow["e_edge"]


def test_an_effect_is_judged_on_its_own_mesh_and_never_chosen(cost):
    without = by_name(cost, "without friction")
    assert without.error["mu"] == pytest.approx(1.0, rel=1e-3)
    assert by_name(cost, "without rate-hardening").error["mu"] == 0.0
    assert all(one.kind != "effect" for one in front(cost.settings, ["mu"]))
    assert without.front == []


def test_front_and_choice(cost):
    best = front(cost.settings, TARGETED)
    assert [s.cpu_s for s in best] == sorted(s.cpu_s for s in best)
    errors = [worst(s, TARGETED) for s in best]
    assert errors == sorted(errors, reverse=True)
    for one in cost.settings:
        beaten = [b for b in best if b.cpu_s <= one.cpu_s and worst(b, TARGETED) <= worst(one, TARGETED)]
        assert beaten or one.kind in ONE_OFFSET or one.error["E_vib"] is None
    assert cheapest(cost.settings, ["e"], 0.2).name == "rigid"
    assert cheapest(cost.settings, TARGETED, 0.2).name == "modal"
    assert cheapest(cost.settings, TARGETED, 1e-6) is None
    assert best_within(cost.settings, TARGETED, 1.0).name == "modal"
    assert best_within(cost.settings, TARGETED, 1e-9) is None
    finer = cheapest(cost.settings, TARGETED, 0.09)
    assert finer.kind in ("mesh", "extrapolated")
    assert worst(finer, TARGETED) <= 0.09
    assert all(s.cpu_s >= finer.cpu_s for s in best if worst(s, TARGETED) <= 0.09)


def test_advice_in_words(cost):
    good, quick = advice(cost.settings, TARGETED, 0.2, 1.0)
    assert good.startswith("Cheapest within 20 % of e and E_vib: modal, error ")
    assert quick.startswith("Best within 1 s on one core: modal")
    never, slow = advice(cost.settings, TARGETED, 1e-6, 1e-9)
    assert never.startswith("No setting brings e and E_vib within 0.0001 %; best: solid")
    assert slow == "No setting takes only 1e-09 s on one core."


def test_what_is_stored_is_not_computed_again(fake, tmp_path):
    first, second = Here(), Here()
    measure(SCENE, tmp_path, NullMeter(), FAMILY[:2], first)
    assert len(set(first.names)) == len(first.names) > 5
    held = judge_stored(SCENE, tmp_path, NullMeter())
    assert [one.name for one in held.settings if one.kind == "mesh"][-1] == "solid 0.297 mm"
    assert [one.name for one in held.settings if one.kind == "extrapolated"] == [
        f"solid 0.594 and 0.297 mm extrapolated, {places} places" for places in (2, 4)
    ]
    found = measure(SCENE, tmp_path, NullMeter(), FAMILY, second)
    assert second.names == [f"t5b: solid 0.148 mm, grid at {place}" for place in ("0", "0.5")]
    assert found.limits["e"].order is not None


def test_what_never_ran_cannot_be_judged(tmp_path):
    with pytest.raises(RunError, match=r"holds no run of t5b .* Leave out --stored"):
        judge_stored(SCENE, tmp_path, NullMeter())


def test_two_meshes_assume_an_order_and_say_none():
    found = limits_of([runs_on(MeshLevel(finer)) for finer in (0, 1)])["E_vib"]
    assert found.order is None
    assert abs(found.value - LIMIT["E_vib_over_E_0"]) <= found.uncertainty
    finest = SLOPE["E_vib_over_E_0"] * (0.019 / 128 / TIP)
    assert found.uncertainty == pytest.approx(0.5 / (2**LOWEST - 1) * finest)


def test_two_meshes_that_agree_by_chance_prove_nothing():
    two = zip(runs_on(FAMILY[-1]), (0.01, -0.01), strict=True)
    fine = [altered(run, e_edge=0.3 + off) for run, off in two]
    same = [fine, [altered(run, tip_size_m=2 * run.cost.tip_size) for run in fine]]
    weight = 0.5 / (2**LOWEST - 1)
    both = ((1 + weight) ** 2 + weight**2) ** 0.5
    assert limits_of(same)["e"].uncertainty == pytest.approx(EVEN[2] * 0.01 * both)


def test_the_scatter_of_a_limit_is_that_of_its_means():
    """A fit through three meshes, moved at random by their scatter, ends about as far off as is stated."""
    generator, meshes = np.random.default_rng(3), [runs_on(mesh) for mesh in FAMILY]
    shares = [EVEN[4] / 6**0.5] * 2 + [EVEN[2]]
    errors = [share * WIGGLE * mesh.sizes(SCENE)[0] / TIP for share, mesh in zip(shares, FAMILY, strict=True)]
    ends = []
    for _ in range(60):
        moved = [
            [altered(run, e_edge=run.restitution.edge.e + error * by) for run in runs]
            for runs, error, by in zip(meshes, errors, generator.normal(size=3), strict=True)
        ]
        ends.append(limits_of(moved)["e"].value - LIMIT["e_edge"])
    off = float(np.sqrt(np.mean(np.square(ends))))
    assert 0.5 * off < limits_of(meshes)["e"].scatter < 2 * off


def test_a_failed_run_is_told_and_too_few_meshes_refused(monkeypatch, tmp_path):
    def failing(scene, fidelity="solid", options=None):
        if fidelity == "solid" and (scene.accuracy.tip_size or TIP) < least:
            raise RunError("out of patience.")
        return run(scene, fidelity)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", failing)
    least = 0.2e-3
    found = measure(SCENE, tmp_path, NullMeter(), executor=Here())
    names = {f"t5b: solid 0.148 mm, grid at {at}" for at in ("0", "0.5")}
    assert {failure["setting"] for failure in found.failures} == names
    assert {failure["reason"] for failure in found.failures} == {"out of patience."}
    least = 1.0
    other = replace(SCENE, id="other")
    with pytest.raises(RunError, match=r"other: no two meshes gave a result. out of patience"):
        measure(other, tmp_path, NullMeter(), executor=Here())


def test_documents(cost, tmp_path):
    write_cost(cost, tmp_path)
    held = json.loads((tmp_path / "cost.json").read_text())
    assert held["quantities"]["e"]["limit"] == cost.limits["e"].value
    assert len(held["settings"]) == len(cost.settings)
    assert held["machine"]["csr_ns_per_element_step"] > 0
    rows = list(csv.DictReader((tmp_path / "cost.csv").read_text().splitlines()))
    assert float(rows[0]["wall_s"]) == cost.settings[0].wall_s
    assert "e" in rows[0]["front"].split()
    text = text_table(cost)
    assert (tmp_path / "cost.txt").read_text() == text + "\n"
    assert "1.00" in text.splitlines()[5]
    assert "modal" in text and "Changes by leaving an effect out" in text
    assert float(rows[-1]["scatter_e"]) == cost.settings[-1].scatter["e"]
    line = text.split("Scatter between places of the barrier's grid")[1].splitlines()[2]
    known = by_name(cost, "solid 0.594 mm fully").scatter["e"]
    assert line.startswith("solid 0.594 mm ") and f" {100 * known:.3g} " in line


def test_yardsticks_are_of_a_machine_of_this_world():
    found = yardsticks()
    assert 0.5 < found["triad_GB_per_s"] < 2000
    assert 5 < found["csr_ns_per_element_step"] < 20000


def test_unknown_quantities_are_refused():
    assert chosen(()) == TARGETED
    assert chosen(["mu"]) == ("mu",)
    with pytest.raises(UsageError, match="muu"):
        chosen(["muu"])


def test_the_table_holds_the_quantities_asked_for_in_columns(cost):
    head, unit, *rows = text_table(cost, ("e", "Omega")).split("\n\n")[0].splitlines()[1:]
    assert head.split()[-2:] == ["e", "Omega"] and unit.split() == ["unit", "-", "rad/s"]
    ends = [{match.end() for match in re.finditer(r"\S+", row.replace("*", " "))} for row in (unit, *rows)]
    assert all({head.index(" e ") + 2, len(head)} <= found for found in ends)
