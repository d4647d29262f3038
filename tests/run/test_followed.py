"""A scene that is followed beyond its first impact: keys, records, totals, refusals."""

import math
from dataclasses import replace as replace_record
from types import SimpleNamespace

import pytest

from fem_impact.answers.refine.extrapolate import level_limit
from fem_impact.answers.refine.needed import ROWS
from fem_impact.answers.refine.strikes import open_by_levels
from fem_impact.case.case import Case
from fem_impact.errors import SceneError, UsageError
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.strikes import told as in_words
from fem_impact.run import certain
from fem_impact.run.common import gravity_of
from fem_impact.run.modal import closed, reduce
from fem_impact.run.modal_error import HELD
from fem_impact.run.simulate import simulate
from fem_impact.run.strikes import RATTLE
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import to_dict, to_toml
from rigid import GRAVITY


def rattling(**changes):
    stated = {"impact.until": "rest", "impact.slope": "0 deg", **changes}
    return replace_all(load("quick"), {key.replace("__", "."): value for key, value in stated.items()})


@pytest.fixture(scope="module")
def floor():
    return simulate(rattling(), "rigid")


# the scene


def test_a_scene_without_the_keys_is_written_as_before():
    impact = to_dict(load("quick"))["impact"]
    assert not {"until", "slope"} & set(impact)
    assert to_dict(replace(load("quick"), "impact.until", "first"))["impact"] == impact


def test_slope_and_until_are_written_and_read_back(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(to_toml(rattling(impact__until="3 strikes")))
    scene = read_toml(path)
    assert (scene.impact.until, scene.impact.most_strikes, scene.impact.slope) == ("3 strikes", 3, 0.0)
    assert scene == rattling(impact__until="3 strikes")


@pytest.mark.parametrize("until, most", [("first", 1), ("1 strike", 1), ("12 strikes", 12), ("rest", None)])
def test_words_that_say_how_far(until, most):
    assert rattling(impact__until=until).impact.most_strikes == most


@pytest.mark.parametrize("until", ["0 strikes", "three strikes", "", 3, "Rest", "1000 strikes"])
def test_other_words_are_refused_with_those_that_hold(until):
    with pytest.raises(SceneError, match=r'impact.until.*"first", "rest", or a number of strikes'):
        rattling(impact__until=until)


def test_a_height_falls_down_the_vertical():
    data = to_dict(load("quick"))
    data.pop("measured", None)
    data["impact"] = {"angle": "30 deg", "height": "0.5 m", "slope": "0 deg"}
    impact = read_dict(data).impact
    assert (impact.v_n, impact.v_t) == pytest.approx((-math.sqrt(2 * GRAVITY * 0.5), 0.0))
    assert read_dict(to_dict(read_dict(data))).impact == impact
    assert replace(read_dict(data), "impact.angle", "60 deg").impact.v_t == pytest.approx(0.0)


def test_without_a_slope_the_axis_is_vertical():
    impact = load("quick").impact
    assert impact.vertical == impact.angle
    assert rattling().impact.vertical == 0.0


@pytest.mark.parametrize(
    "stated, fidelity, stages",
    [
        ("", "solid", (("solid", 1), ("rigid", None))),
        ("", "modal", (("modal", None),)),
        ("solid for the first 3, then modal", "solid", (("solid", 3), ("modal", None))),
        ("solid for the first 3, then modal", "modal", (("modal", None),)),
        ("solid for the first 3, then modal", "rigid", (("rigid", None),)),
        ("modal for the first 5, then rigid", "solid", (("solid", 1), ("modal", 5), ("rigid", None))),
        (
            "solid for the first 1, then modal for the next 4, then rigid",
            "solid",
            (("solid", 1), ("modal", 4), ("rigid", None)),
        ),
    ],
)
def test_the_models_of_the_strikes_follow_the_statement(stated, fidelity, stages):
    scene = rattling(strikes__fidelity=stated) if stated else rattling()
    assert scene.strikes.stages(fidelity) == stages
    assert scene.strikes.first == ("modal" if stated.startswith("modal") else "solid")
    assert read_dict(to_dict(scene)) == scene


@pytest.mark.parametrize(
    "stated", ["rigid, then modal", "modal for the first 0, then rigid", "modal, then rigid", 3]
)
def test_other_statements_of_models_are_refused_with_examples(stated):
    with pytest.raises(SceneError, match=r"strikes.fidelity.*solid for the first 3, then modal"):
        rattling(strikes__fidelity=stated)


def test_how_to_follow_a_body_is_refused_where_it_is_not_followed():
    with pytest.raises(SceneError, match=r'strikes.*until = "rest"'):
        simulate(rattling(strikes__fidelity="modal", impact__until="first"), "modal")


def test_a_free_barrier_is_refused_with_the_remedy():
    with pytest.raises(SceneError, match=r"impact.until.*Leave out barrier.mass"):
        simulate(rattling(barrier__mass="1 kg"), "rigid")


@pytest.mark.parametrize("effects", [["auto", "-gravity"], ["friction", "barrier-rigid"]])
def test_gravity_acts_in_flight_unless_it_is_left_out(effects):
    assert gravity_of(rattling()) == GRAVITY
    assert gravity_of(rattling(effects=effects)) == 0.0


# the record


def test_a_scene_of_the_first_impact_has_no_strikes():
    strikes = simulate(load("quick"), "rigid").strikes
    assert strikes.until == "first"
    assert isinstance(strikes.each, Unknown)
    assert "impact.until" in strikes.each.reason


def test_the_first_strike_is_the_first_impact(floor):
    first = floor.strikes.each[0]
    assert first.V_n == pytest.approx(floor.motion.V_n, rel=1e-12)
    assert first.Omega == pytest.approx(floor.motion.Omega, rel=1e-12)
    assert first.mu == pytest.approx(floor.restitution.mu, rel=1e-12)
    assert first.friction == pytest.approx(floor.energy.friction * floor.energy.E_0, rel=1e-12)


def test_the_energy_of_all_strikes_adds_up(floor):
    s = floor.strikes
    spent = s.friction + s.plastic + s.damping + s.other + s.settled + s.left
    assert floor.energy.E_0 + s.gravity == pytest.approx(spent, rel=1e-10)
    assert abs(s.residual) < 1e-10
    for one in s.each:
        parts = one.friction + one.plastic + one.damping + one.other + one.vibration
        assert one.lost == pytest.approx(parts, rel=1e-9, abs=1e-14)


def test_a_rod_on_a_floor_comes_to_rest_and_its_hardest_strikes_are_named(floor):
    s = floor.strikes
    assert (s.end, s.left) == ("rests", 0.0)
    assert s.time_factor == RATTLE and f"s (within a factor of {RATTLE:g})" in " ".join(in_words(s))
    assert s.each[s.hardest_energy - 1].lost == max(one.lost for one in s.each)
    assert s.each[s.hardest_heat - 1].friction == max(one.friction for one in s.each)
    assert isinstance(s.hardest_force, Unknown)
    tails = [one.approach for one in s.each if one.part == "tail"]
    assert s.other_end == pytest.approx(max(tails) / s.each[0].approach)
    assert "strikes again" not in floor.validity.stopped_because


def test_each_strike_takes_the_law_of_its_own_contact(floor):
    assert len({round(one.e, 6) for one in floor.strikes.each}) > 3
    stated = simulate(rattling(restitution=0.4), "rigid").strikes.each
    slipped = [one.e for one in stated if abs(one.mu) == pytest.approx(0.57)]
    assert slipped == pytest.approx([0.4] * len(slipped), abs=1e-9)


@pytest.mark.long
def test_a_rod_slides_on_down_a_slope_steeper_than_its_friction_holds():
    strikes = simulate(replace(load("quick"), "impact.until", "rest"), "rigid").strikes
    assert strikes.end == "slides on"
    assert strikes.gravity > 0.0
    held = simulate(rattling(impact__slope="20 deg"), "rigid").strikes
    assert held.end == "rests"


def test_a_slope_that_was_not_stated_is_told_where_the_rod_moves_beside_its_axis():
    straight_down = {"impact": {"angle": "30 deg", "v_n": "-2 m/s", "v_t": "0 m/s", "until": "2 strikes"}}
    guessed = replace_all(load("t5b"), straight_down)
    told = " ".join(texts(simulate(guessed, "rigid").validity.limitations, "model"))
    assert "the barrier slopes by 30 degrees" in told and 'impact.slope = "0 deg"' in told
    level = simulate(replace(guessed, "impact.slope", "0 deg"), "rigid")
    assert "No impact.slope" not in " ".join(texts(level.validity.limitations, "model"))


def test_a_wanted_number_of_strikes_is_done():
    strikes = simulate(rattling(impact__until="3 strikes"), "rigid").strikes
    assert (len(strikes.each), strikes.end) == (3, "goes on")
    assert strikes.left > 0.0


def test_without_gravity_the_rod_leaves():
    strikes = simulate(rattling(effects=["auto", "-gravity"]), "rigid").strikes
    assert strikes.end == "leaves"
    assert strikes.gravity == 0.0


def test_the_record_is_read_back_and_a_table_made_of_it(floor, tmp_path):
    floor.write(tmp_path / "outcome.json")
    again = Outcome.read(tmp_path / "outcome.json")
    assert again.strikes.each[1].approach == floor.strikes.each[1].approach
    assert again.strikes.each[0].force is None
    table = floor.strikes.to_dataframe()
    assert len(table) == len(floor.strikes.each)
    assert table["part"].iloc[1] == floor.strikes.each[1].part


def test_what_the_rules_are_and_what_the_law_leaves_out_is_told(floor):
    told = " ".join(texts(floor.validity.limitations, "model"))
    assert "does not rebound" in told
    assert "one after the other" in told
    assert "lose nothing along the normal" in told


@pytest.mark.long
def test_a_body_of_segments_takes_the_material_of_the_part_that_strikes():
    parts = [{"to": "40 mm", "material": "rod-steel"}, {"material": "plate-steel"}]
    scene = rattling()
    data = to_dict(scene)
    data["projectile"] = {
        **{key: value for key, value in data["projectile"].items() if key != "material"},
        "segments": parts,
    }
    data.pop("measured", None)
    tail = next(one for one in simulate(read_dict(data), "rigid").strikes.each if one.part == "tail")
    plain = next(one for one in simulate(scene, "rigid").strikes.each if one.part == "tail")
    assert tail.e != pytest.approx(plain.e, abs=1e-3)


@pytest.mark.long
def test_strikes_in_an_earlier_dent_are_counted():
    """All of a ball that falls straight down; none of one whose place on the barrier moves on."""
    told = {}
    for v_t in ("0 m/s", "-1 m/s"):
        changes = {"impact__v_t": v_t, "impact__v_n": "-2 m/s", "impact__angle": "0 deg"}
        data = to_dict(rattling(impact__until="3 strikes", **changes))
        data.pop("measured", None)
        data["projectile"] = {"shape": "ball", "diameter": "20 mm", "material": "rod-steel"}
        told[v_t] = " ".join(texts(simulate(read_dict(data), "rigid").validity.limitations, "model"))
    assert "2 of the strikes land in the dent" in told["0 m/s"]
    assert "land in the dent" not in told["-1 m/s"]


@pytest.mark.long
@pytest.mark.parametrize("material", ["rod-steel", "aluminium-6061-t6"])
def test_a_ball_on_its_dent_rebounds_nearly_elastically_by_modes_as_by_finite_elements(material):
    """In barrier and ball; finite elements of the steel ball have e = 0.96 and 0.95 of the first force."""
    changes = {"impact__v_t": "0 m/s", "impact__v_n": "-2 m/s", "impact__angle": "0 deg"}
    data = to_dict(rattling(impact__until="2 strikes", **changes))
    data.pop("measured", None)
    data["projectile"] = {"shape": "ball", "diameter": "20 mm", "material": material}
    outcome = simulate(read_dict(data), "modal")
    first, second = outcome.strikes.each
    assert first.e < 0.71
    assert 0.98 < second.e < 1.0002  # gravity acts over the depth of its dent
    assert second.force == pytest.approx(first.force, rel=0.02)
    assert second.plastic < 0.02 * first.plastic  # slower, steel yields at a lower stress
    told = " ".join(texts(outcome.validity.limitations, "model"))
    assert "of which 2 meet the dents of earlier ones" in told
    assert "land in the dent" not in told
    assert "loss factor 0.0006 of iron, as the material states none" in told


# what is certain of it


@pytest.fixture(scope="module")
def steep():
    return simulate(rattling(impact__angle="75 deg"), "modal").strikes


def test_the_path_lies_within_what_is_told_of_it_as_far_as_it_is_certain(steep):
    """Which rigid sequences alone, whose strikes lose less, would exclude."""
    assert 3 <= steep.certain < len(steep.each)
    for one, about in zip(steep.each[: steep.certain], steep.spread, strict=False):
        assert about.time_low <= one.time <= about.time_high
        assert about.approach_low <= one.approach <= about.approach_high
    assert steep.other_end_low < steep.other_end < steep.other_end_high


def test_half_widths_grow_from_the_models_own_as_the_sequence_goes_on(steep):
    case = Case.of(rattling(impact__angle="75 deg"), "modal")
    own = reduce(case, closed(case)).validity.model_band
    with pytest.raises(UsageError, match=r"is no number of a strike\. Did you mean E_before_J"):
        steep.half_width(1, "before_J")
    assert steep.half_width(1, "e") == pytest.approx(own["e_edge"], rel=0.1)
    times = [steep.half_width(number, "time_s") for number in range(1, 1 + steep.certain)]
    E_0 = steep.each[0].before
    assert steep.half_width(1, "E_vib_J") == pytest.approx(own["E_vib_over_E_0"] * E_0, rel=0.1)
    assert steep.half_width(1, "peak_force_N") > 0.02 * steep.each[0].force
    # what the rigid motion loses and friction does not take
    loss = max(steep.half_width(1, "E_after_J"), steep.half_width(1, "W_friction_J"))
    assert steep.half_width(1, "E_plastic_J") == pytest.approx(loss, rel=1.0)
    assert times[0] == 0.0
    assert times[-1] > 2.0 * times[1] > 0.0
    assert 0.0 < steep.friction_half < steep.friction


def test_a_number_of_a_strike_without_a_half_width_has_a_reason(steep, floor):
    assert "loss factor of vibration in flight" in steep.half_width(2, "W_damping_J").reason
    assert "strikes_spread" in steep.half_width(steep.certain + 1, "time_s").reason
    assert floor.strikes.spread[floor.strikes.certain].half_widths == {}
    parts = {(one.tip, one.tail, one.other, one.none) for one in steep.spread[: steep.certain]}
    assert parts == {(64, 0, 0, 0), (0, 64, 0, 0)}


def test_a_model_that_nothing_is_moved_of_repeats_its_own_path(steep):
    """Rigid strikes by e, mu and friction of the modes, flights between them: contacts take no time in it."""
    case = Case.of(rattling(impact__angle="75 deg"), "modal")
    plain = certain._run(case.scene, certain._each(case, steep.each))
    for one, other in zip(steep.each[:3], plain, strict=False):
        assert (one.approach, one.part) == (pytest.approx(other.approach, rel=0.02), other.part)
        assert one.friction == pytest.approx(other.friction, rel=0.05)
        assert one.lost == pytest.approx(other.lost, rel=0.05)


@pytest.mark.long
def test_what_meshes_leave_open_of_strikes_widens_what_is_told_of_them(steep):
    """By levels of 1 and 0.5 mm whose first strikes have an e 0.1 apart: by the rule of their limit."""
    solid = [replace_record(one, fidelity="solid") for one in steep.each[:2]]
    strikes = replace_record(steep, each=tuple(solid))
    coarser = replace_record(strikes, each=(replace_record(solid[0], e=solid[0].e + 0.1), solid[1]))
    levels = [
        SimpleNamespace(
            size=size,
            outcome=SimpleNamespace(strikes=of),
            runs=SimpleNamespace(size=size, wide=True, resolved=True, rows=ROWS),
        )
        for size, of in ((1e-3, coarser), (5e-4, strikes))
    ]
    limit, band = level_limit([1e-3, 5e-4], [[solid[0].e + 0.1], [solid[0].e]], [True, True])
    half = band + solid[0].e - limit
    case = Case.of(rattling(impact__angle="75 deg", surface__friction=0.5), "modal")
    assert "rigid theory tells no error" in certain.with_spread(case, strikes).certain.reason
    told = certain.with_spread(case, strikes, open_by_levels(levels))
    assert told.half_width(1, "e") == pytest.approx(half / HELD, rel=0.1)
    assert told.half_width(1, "mu") == pytest.approx(0.0, abs=1e-12)
    assert "levels of meshes" in told.holds
    levels[0].outcome.strikes = replace_record(strikes, each=tuple(solid[:1]))
    assert open_by_levels(levels)[1] is None


def test_the_first_strikes_are_counted_over_the_interval_of_friction(floor):
    s = floor.strikes
    assert 1 <= s.certain < len(s.each)
    assert s.other_end_low < s.other_end < s.other_end_high
    surface, frictions = rattling().surface, []
    for f in (surface.friction_low, surface.friction_high):
        frictions.append(simulate(rattling(surface__friction=f), "rigid").strikes.each)
    for number, one in enumerate(s.spread[: s.certain]):
        assert sorted((one.tip, one.tail, one.other, one.none)) == [0, 0, 0, 64]
        ends = sorted(each[number].approach for each in frictions)
        assert ends[0] <= one.approach_low <= one.approach_high <= ends[1] * (1 + 1e-12)
    after = s.spread[s.certain]
    assert max(after.tip, after.tail, after.other, after.none) < 64
    assert all(one.tip + one.tail + one.other + one.none == 64 for one in s.spread)
    assert "not the error of rigid theory" in s.holds


def test_the_curve_over_the_inclination_passes_through_the_scene():
    """Without friction and losses the other end of a slender rod comes 3/2 (1 + e) - e = 2 times as fast."""
    scene = rattling(restitution=1.0, surface__friction=0.0, impact__v_t="0 m/s", impact__until="2 strikes")
    angles, ratios = certain.other_end_curve(replace(scene, "projectile.length", "300 mm"))
    here = replace_all(
        scene, {"projectile.length": "300 mm", "impact.angle": f"{math.degrees(angles[-3])} deg"}
    )
    assert simulate(here, "rigid").strikes.other_end == pytest.approx(ratios[-3], rel=1e-9)
    assert ratios[-3] == pytest.approx(2.0, abs=0.15)


def test_stated_errors_of_angle_and_speed_widen_what_is_told():
    """An elastic ball that falls straight down: its time and speed are known from the speed alone."""
    errors = {"strikes__speed_error": 0.1, "surface__friction": 0.5}
    changes = {"restitution": 0.5, "impact__v_t": "0 m/s", "impact__until": "2 strikes"}
    table = {"shape": "ball", "diameter": "20 mm", "material": "rod-steel"}
    data = to_dict(rattling(**errors, **changes)) | {"projectile": table}
    data.pop("measured", None)
    s = simulate(read_dict(data), "rigid").strikes
    first, second = s.spread
    v = s.each[0].approach
    assert (first.approach_low / v, first.approach_high / v) == pytest.approx((0.91, 1.09), abs=0.01)
    assert second.time_high / s.each[1].time == pytest.approx(first.approach_high / v, rel=1e-9)
    assert s.certain == 2


def test_without_an_interval_nothing_is_compared():
    strikes = simulate(rattling(surface__friction=0.5), "rigid").strikes
    assert isinstance(strikes.certain, Unknown)
    assert "strikes.angle_error" in strikes.certain.reason
