"""What accuracy costs: errors against a known limit, Pareto front, choice, resuming, documents."""

import csv
import json
from dataclasses import replace
from importlib import import_module

import pytest
from cost_fakes import LIMIT, SLOPE, TIP, Here, run

import fem_impact.simulate
from fem_impact.cost import (
    FAMILY,
    TARGETED,
    Mesh,
    advice,
    best_pair,
    best_within,
    cheapest,
    chosen,
    front,
    ladder,
    measure,
    on_mesh,
    pair_sentence,
    text_table,
    verdict,
    worst,
    write_cost,
)
from fem_impact.cost.judge import extrapolated, truths
from fem_impact.cost.yardsticks import yardsticks
from fem_impact.errors import RunError, SceneError
from fem_impact.progress import NullMeter
from fem_impact.scene import load

SCENE = load("t5b")


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(fem_impact.simulate, "simulate", run)
    monkeypatch.setattr(import_module("fem_impact.cost.measure"), "compiled_before", lambda: True)


@pytest.fixture
def cost(fake, tmp_path):
    return measure(SCENE, tmp_path, NullMeter(), executor=Here())


def by_name(cost, words):
    found = [one for one in cost.settings if words in one.name]
    assert len(found) == 1
    return found[0]


def test_the_ladder_has_every_kind_of_setting():
    names = [setting.name for setting in ladder(SCENE)]
    assert len(set(names)) == len(names)
    assert names[:3] == ["rigid", "modal", "solid 0.792 mm"]
    assert "solid 0.396 and 0.237 mm extrapolated" in names
    for effect in ("vibration", "friction", "rod-plasticity", "rate-hardening"):
        assert f"solid 0.594 mm without {effect}" in names
    assert "solid 0.594 mm with an elastic barrier" in names
    assert "solid 0.594 and 0.297 mm extrapolated" in names
    for setting in ladder(SCENE):
        assert (setting.scene is None) == (setting.kind == "pair")
        if setting.kind == "mesh":
            size = 0.019 / setting.mesh.across / 2**setting.mesh.levels
            assert setting.scene.accuracy.tip_size == pytest.approx(size, rel=1e-8)
            assert setting.scene.save.frames == 0


def test_elements_and_steps_are_rungs_of_their_own():
    rungs = {setting.name: setting.scene.accuracy for setting in ladder(SCENE) if setting.kind == "numerics"}
    plain = on_mesh(SCENE, Mesh(8, 2)).accuracy
    assert rungs == {
        "solid 0.594 mm fully integrated": replace(plain, element="full"),
        "solid 0.594 mm mean dilatation": replace(plain, element="bbar"),
        "solid 0.594 mm with half the default step": replace(plain, step=0.5 * plain.step),
    }


def test_limit_and_order_are_found(cost):
    for name, key in (("e", "e_edge"), ("mu", "mu"), ("E_vib", "E_vib_over_E_0")):
        assert cost.truth[name].value == pytest.approx(LIMIT[key], rel=1e-4)
        assert cost.truth[name].order == pytest.approx(1, abs=0.02)
        finest = SLOPE[key] * (0.019 / 80 / TIP)
        assert cost.truth[name].uncertainty == pytest.approx(0.25 * abs(finest), rel=0.01)


def test_errors_hold_distance_and_the_limits_own_uncertainty(cost):
    beyond = cost.truth["e"].uncertainty
    coarse = next(s for s in cost.settings if s.name == "solid 0.594 mm")
    away = SLOPE["e_edge"] * (0.019 / 32 / TIP)
    finest = 0.3 + SLOPE["e_edge"] * (0.019 / 80 / TIP)
    assert coarse.error["e"] == pytest.approx((away + beyond) / finest, rel=1e-3)
    modal = by_name(cost, "modal")
    assert modal.error["mu"] == pytest.approx((0.05 + cost.truth["mu"].uncertainty) / 0.5, rel=1e-3)
    assert by_name(cost, "rigid").error["E_vib"] is None


def test_a_pair_costs_both_meshes_and_assumes_first_order(cost):
    pair = by_name(cost, "0.396 and 0.297 mm")
    single = {s.name: s for s in cost.settings}
    fine, coarse = single["solid 0.297 mm"], single["solid 0.396 mm"]
    assert pair.wall_s == pytest.approx(fine.wall_s + coarse.wall_s)
    assert pair.element_steps == fine.element_steps + coarse.element_steps
    assert pair.value["e"] == pytest.approx(extrapolated(fine.value["e"], coarse.value["e"], 4 / 3))
    assert pair.value["e"] != fine.value["e"]
    assert pair.two_cores_s == max(fine.cpu_s, coarse.cpu_s)


def test_the_band_of_a_pair_is_twice_its_extrapolation_or_the_range_of_all_meshes(cost):
    tips = [0.019 / across / 2**levels for across, levels in ((6, 2), (10, 3))]
    spread = SLOPE["e_edge"] * (tips[0] - tips[1]) / TIP / 4
    for words, mesh in (("0.396 and 0.297", Mesh(8, 3)), ("0.396 and 0.237", Mesh(10, 3))):
        away = SLOPE["e_edge"] * mesh.tip_size(0.019) / TIP
        band = by_name(cost, words).band["e"] * cost.truth["e"].scale
        assert band == pytest.approx(max(2 * away, spread), rel=1e-6)
    assert all(bool(one.band) == (one.kind == "pair") for one in cost.settings)


def test_the_best_pair_is_the_quickest_that_meets_the_target_or_the_one_widest_apart(cost):
    loose, strict = (best_pair(cost.settings, TARGETED, target) for target in (0.2, 0.02))
    assert (loose.name, strict.name) == (
        "solid 0.792 and 0.396 mm extrapolated",
        "solid 0.594 and 0.297 mm extrapolated",
    )
    assert verdict(loose, cost.quantities, "e", 0.2) == "0.3000 ± 0.0594, reached: 19 %"
    told = pair_sentence(cost.settings, cost.quantities, TARGETED, 0.02)
    assert told.startswith("Two meshes against 2 %, solid 0.594 and 0.297 mm extrapolated: e 0.3000 ± ")
    assert ", not reached: 14 %; " in told
    assert best_pair([], TARGETED, 0.02) is None
    assert pair_sentence([], {}, TARGETED, 0.02) == "No two meshes gave a result."


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
        assert beaten or one.kind == "effect" or one.error["E_vib"] is None
    assert cheapest(cost.settings, ["e"], 0.2).name == "rigid"
    assert cheapest(cost.settings, TARGETED, 0.2).name == "modal"
    assert cheapest(cost.settings, TARGETED, 1e-6) is None
    assert best_within(cost.settings, TARGETED, 1.0).name == "modal"
    assert best_within(cost.settings, TARGETED, 1e-9) is None
    finer = cheapest(cost.settings, TARGETED, 0.09)
    assert finer.kind in ("mesh", "pair")
    assert worst(finer, TARGETED) <= 0.09
    assert all(s.cpu_s >= finer.cpu_s for s in best if worst(s, TARGETED) <= 0.09)


def test_advice_in_words(cost):
    good, quick = advice(cost.settings, TARGETED, 0.2, 1.0)
    assert good.startswith("Cheapest within 20 % of e and E_vib: modal, error ")
    assert quick.startswith("Best within 1 s: modal")
    never, slow = advice(cost.settings, TARGETED, 1e-6, 1e-9)
    assert never.startswith("No setting brings e and E_vib within 0.0001 %; best: solid")
    assert slow == "No setting takes only 1e-09 s."


def test_what_is_stored_is_not_computed_again(fake, tmp_path):
    first, second = Here(), Here()
    measure(SCENE, tmp_path, NullMeter(), FAMILY[:2], first)
    found = measure(SCENE, tmp_path, NullMeter(), FAMILY, second)
    assert len(first.names) > 5
    assert second.names == ["t5b: solid 0.237 mm"]
    assert found.truth["e"].order is not None


def test_two_meshes_assume_an_order_and_say_none():
    found = truths([run(on_mesh(SCENE, Mesh(across, 3))) for across in (8, 16)])["e"]
    assert found.order is None
    assert abs(found.value - LIMIT["e_edge"]) <= found.uncertainty
    finest = SLOPE["e_edge"] * (0.019 / 128 / TIP)
    assert found.uncertainty == pytest.approx(2 * finest)


def test_the_limit_rests_on_every_mesh_that_ran(fake, tmp_path):
    """One mesh of the family and the two coarse ones tell an order."""
    found = measure(SCENE, tmp_path, NullMeter(), FAMILY[:1], Here()).truth["e"]
    assert found.order == pytest.approx(1.0, abs=1e-3)
    assert found.value == pytest.approx(LIMIT["e_edge"], abs=1e-4)


def test_two_meshes_that_agree_by_chance_prove_nothing():
    apart = [replace_e(mesh, e) for mesh, e in ((Mesh(8, 3), 0.3), (Mesh(6, 3), 0.3), (Mesh(8, 2), 0.36))]
    alone, beside = truths(apart[:2]), truths(apart[:2], apart[2:])
    assert alone["e"].uncertainty == pytest.approx(0, abs=1e-12)
    assert beside["e"].uncertainty == pytest.approx(0.03)


def replace_e(mesh, e):
    return run(on_mesh(SCENE, mesh)).replace(e_edge=e)


def test_a_failed_run_is_told_and_too_few_meshes_refused(monkeypatch, tmp_path):
    def failing(scene, fidelity="solid", **options):
        if fidelity == "solid" and scene.accuracy.across > most:
            raise RunError("out of patience.")
        return run(scene, fidelity)

    monkeypatch.setattr(fem_impact.simulate, "simulate", failing)
    most = 8
    found = measure(SCENE, tmp_path, NullMeter(), executor=Here())
    assert found.failures == [{"setting": "t5b: solid 0.237 mm", "reason": "out of patience."}]
    most = 5
    other = replace(SCENE, id="other")
    with pytest.raises(RunError, match=r"other: no two meshes gave a result. out of patience"):
        measure(other, tmp_path, NullMeter(), executor=Here())


def test_documents(cost, tmp_path):
    write_cost(cost, tmp_path, TARGETED)
    held = json.loads((tmp_path / "cost.json").read_text())
    assert held["quantities"]["e"]["limit"] == cost.truth["e"].value
    assert len(held["settings"]) == len(cost.settings)
    assert held["machine"]["csr_ns_per_element_step"] > 0
    rows = list(csv.DictReader((tmp_path / "cost.csv").read_text().splitlines()))
    assert float(rows[0]["wall_s"]) == cost.settings[0].wall_s
    assert "e" in rows[0]["front"].split()
    assert (tmp_path / "cost.svg").read_text().count("<svg") == 1
    text = text_table(cost)
    assert (tmp_path / "cost.txt").read_text() == text + "\n"
    assert "1.00" in text.splitlines()[3]
    assert "modal" in text and "changes in % by leaving an effect out" in text


def test_yardsticks_are_of_a_machine_of_this_world():
    found = yardsticks()
    assert 0.5 < found["triad_GB_per_s"] < 2000
    assert 5 < found["csr_ns_per_element_step"] < 20000


def test_unknown_quantities_are_refused():
    assert chosen(()) == TARGETED
    assert chosen(["mu"]) == ("mu",)
    with pytest.raises(SceneError, match="muu"):
        chosen(["muu"])
