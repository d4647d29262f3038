"""``check`` and ``scenes``: a scene's statement, readable and as JSON."""

import json
import re

import pytest

from fem_impact.case.case import Case
from fem_impact.case.effects.registry import EFFECTS, NAMES
from fem_impact.scene.library import materials, shipped
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest, to_toml
from fem_impact.solid.watchers import _schedule


def test_scenes_lists_every_shipped_scene(cli):
    code, out, _ = cli("scenes")
    assert code == 0
    assert [line.split()[0] for line in out.splitlines()[1:]] == list(shipped())
    listed = json.loads(cli("scenes", "--json")[1])["scenes"]
    assert [row["digest"] for row in listed] == [digest(load(name)) for name in shipped()]


def test_an_ambient_far_from_room_temperature_changes_no_strength_and_is_told(cli):
    def said(*changes):
        words = [word for change in changes for word in ("--set", f"heating.{change}")]
        code, out, err = cli("check", "t5b", *words)
        return code, " ".join((out + err).split())

    told = "input: heating.ambient = 393.15 K adds to the heat alone: strengths and moduli are used as stated"
    assert told in said("ambient=120 degC")[1]
    for near in ("60 degC", "-20 degC"):
        assert "adds to the heat alone" not in said(f"ambient={near}")[1]
    code, refused = said("ambient=1500 degC", "ignition=2000 degC")
    assert code == 3 and "is not below the temperature at which plate-steel begins to melt" in refused
    code, refused = said("ambient=350 degC", "rod_melting=600 K")
    assert code == 3 and "begins to melt, 600 K" in refused


def test_check_prints_what_a_verdict_needs_on_one_screen(cli):
    code, out, _ = cli("check", "t5b", "--set", "effects=['auto', '-gravity', 'large-rotation']")
    said = " ".join(out.split())
    assert code == 0 and len(out.splitlines()) < 75
    for words in (
        "80 mm x 19 mm of rod-steel",
        "Barrier and contact plate-steel angle 45 deg, v_n -1.5024 m/s",
        "friction f 0.57 (0.45 to 0.7), machined surfaces",
        "0.1 mm deep, for 141 us",
        "T1/tau = 0.58",
        "on friction: f: 0.57, threshold 0.005",
        "on large-rotation (forced): theta",
        "gravity (forced)",
        "MB of memory",
        "inside the measured",
        "--long prints every value with its source",
    ):
        assert words in said
    assert "on gravity" not in said and "footnote 2" not in said
    assert max(map(len, out.splitlines())) < 80


def test_a_scene_without_a_title_is_named_once(cli, tmp_path):
    scene = tmp_path / "plain.toml"
    stated = to_toml(load("t5b")).splitlines()
    scene.write_text("\n".join(line for line in stated if not line.startswith("title")))
    assert cli("check", str(scene))[1].splitlines()[0] == "t5b"
    assert cli("check", "t5b")[1].splitlines()[0] == f"t5b: {load('t5b').title}"


def test_own_files_are_printed_as_seen_from_the_scene(cli, tmp_path):
    """The path from the root of the machine is no statement of the scene."""
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "tests.csv").write_text("quantity,mean,sd,n\ne,0.5,0.02,5\n")
    scene = tmp_path / "own.toml"
    scene.write_text(to_toml(load("t5b")).replace('measured = "t5b"', 'measured = "data/tests.csv"'))
    long = cli("check", str(scene), "--long")[1]
    assert 'measured = "data/tests.csv"\n' in long and str(tmp_path) not in long
    shown = tmp_path / "shown.toml"
    shown.write_text(long[: long.index("\n\nSources")])
    assert load(shown) == load(scene)


def test_check_names_segments_layers_plates_and_a_friction_that_counts_as_exact(cli):
    for scene, words in (
        ("heavy-tail", "of rod-steel up to"),
        ("layered", "2 mm of steel-4340 on aluminium-6061-t6"),
        ("plate-10mm", "thickness 10 mm"),
        ("moving-barrier", "v_n 2"),
        ("moving-barrier", "E_0 = 0.3544 J, as seen from the barrier"),
    ):
        assert words in " ".join(cli("check", scene)[1].split())
    custom = "surface={state='custom', friction=0.3, source='mine'}"
    assert (
        "friction f 0.3 (no interval stated: it counts as exact)" in cli("check", "t5b", "--set", custom)[1]
    )


def test_check_prints_values_units_sources_and_effects_on_demand(cli):
    code, out, _ = cli("check", "t5b", "--long")
    assert code == 0
    for words in (
        'length = "80 mm"',
        "footnote 2",
        "barrier.material.E = 206 GPa: measured on the test plates",
        "tested 0.002 /s: C of steel 1006",
        "rate_factor: interval 1.1 to 1.6",
        "Flow stress at 8 % plastic strain",
        "barrier 482 615 643 671",
        "accuracy.tip_size = 5 elements over the estimated radius",
        "on  friction",
        "inside the measured",
    ):
        assert words in out or words in " ".join(out.split())


def test_check_lists_no_default_of_which_the_scene_states_another(cli):
    out = cli("check", "quick", "--long", "--set", "heating.ignition=200 degC")[1]
    assert "heating.ignition = 703" not in out and "accuracy.tip_size = 5" not in out
    assert 'ignition = "473.15 K"' in out and "heating.ambient = 293.15 K: room" in out


def test_check_tells_number_threshold_and_time_of_each_effect(cli):
    text = cli("check", "t5b", "--long", "--set", "effects=['auto', 'barrier-elastic']")[1]
    parts = [part.partition("\n\n")[0] for part in re.split(r"\n  (?:on  |off )", text)[1:]]
    about = {part.split()[0].rstrip(":"): " ".join(part.split()) for part in parts}
    assert about["friction"].endswith("f: 0.57, threshold 0.005; it takes under 1 % of the run time")
    assert ", threshold " in about["gravity"] and "run time" not in about["gravity"]
    assert "run time" in about["barrier-elastic"] and "run time" not in about["barrier-rigid"]


def test_an_effect_that_is_nearly_called_for_is_told_with_its_number(cli):
    _, out, _ = cli("check", "t5b")
    told = " ".join(out.split())
    assert "radiation (0.0086, threshold 0.01)" in told and "gravity (0" not in told


def test_check_as_json_gives_a_scene_that_reads_back(cli):
    _, out, _ = cli("check", "t5b", "--set", "impact.angle=80 deg", "--json")
    statement = json.loads(out)
    scene = read_dict(statement["scene"])
    assert statement["digest"] == digest(scene)
    sentences = [one["text"] for one in statement["limitations"] if one["kind"] == "range"]
    assert any("angle 80 deg" in sentence for sentence in sentences)
    assert {effect["name"] for effect in statement["effects"] if effect["on"]} == set(Case(scene).active)


def test_check_tells_which_fidelities_answer(cli):
    assert "The scene is valid for --fidelity solid, modal, rigid; its digest:" in cli("check", "t5b")[1]
    said = " ".join(cli("check", "t5b", "--set", "accuracy=5 %")[1].split())
    assert 'not by --fidelity modal: accuracy = "5 %": is asked of the modal model' in said
    assert "valid for --fidelity solid; its digest:" in said


def test_a_scene_that_has_no_mesh_is_refused_with_the_fidelities_that_take_it(cli):
    code, _, err = cli("check", "t5b", "--set", "accuracy.tip_size=0.0005 mm")
    assert code == 3
    assert err.rstrip().endswith("--fidelity modal and --fidelity rigid take the scene as it is.")


def test_check_refuses_a_bad_file_by_name(cli, tmp_path):
    (tmp_path / "mine.toml").write_text("id = 3")
    code, out, err = cli("check", "mine.toml")
    assert (code, out) == (3, "")
    assert err.startswith("fem-impact: error: mine.toml: ")


def test_every_effect_that_a_scene_can_name_is_described():
    assert tuple(EFFECTS) == NAMES


def test_check_answers_at_both_ends_of_the_angle(cli):
    for angle in ("0 deg", "89.9 deg"):
        code, out, _ = cli("check", "t5b", "--set", f"impact.angle={angle}", "--json")
        assert code == 0
        assert json.loads(out)["scene"]["impact"]["angle"] == angle


def test_scenes_lists_every_shipped_material(cli):
    code, out, _ = cli("scenes", "--materials")
    assert code == 0
    table, sources = out.split("\n\n", 1)
    assert [line.split()[0] for line in table.splitlines()[1:]] == list(materials())
    assert "stainless-316l (316L, AISI 316L, 1.4404" in sources
    assert "yield_stress 190 MPa (190 MPa to 235 MPa): makeitfrom.com" in " ".join(sources.split())
    rows = json.loads(cli("scenes", "--materials", "--json")[1])["materials"]
    assert {row["material"]: row["E_Pa"] for row in rows} == {name: m.E for name, m in materials().items()}
    assert all(row["sources"]["E"] for row in rows)


def test_the_pairs_of_known_friction_are_listed_with_sources(cli):
    code, out, _ = cli("scenes", "--friction")
    assert code == 0
    assert "steel on brass" in out
    pairs = json.loads(cli("scenes", "--friction", "--json")[1])["pairs"]
    assert {"families", "low", "high", "source"} == set(pairs[0])


def test_check_tells_the_laws_in_force(cli):
    assert "rod-steel: yields at 546 MPa, power law through" in " ".join(cli("check", "t5b")[1].split())
    assert "barrier.material plate-steel: yields" in " ".join(cli("check", "t5b", "--long")[1].split())
    assert json.loads(cli("check", "t5b", "--json")[1])["laws"]["barrier.material"].startswith("plate-steel")


def test_a_thickness_without_support_is_said_to_change_nothing(cli):
    words = "its thickness changes nothing"
    plate = ("check", "t5b", "--set", "barrier.thickness=20 mm")
    assert words in " ".join(cli(*plate)[1].split())
    assert words not in " ".join(cli(*plate, "--set", "barrier.support=infinite")[1].split())
    assert words not in " ".join(cli("check", "t5b")[1].split())


def test_a_plate_too_thick_to_bend_is_said_to_be_massive(cli):
    words, plate = "too thick to bend in this impact", ("check", "t5b", "--set", "barrier.support=infinite")
    assert words in " ".join(cli(*plate, "--set", "barrier.thickness=1.5 m")[1].split())
    for thin in (
        ["barrier.thickness=20 mm"],
        ["barrier.thickness=1.5 m", 'effects=["auto", "plate-bending"]'],
    ):
        changes = (word for change in thin for word in ("--set", change))
        assert words not in " ".join(cli(*plate, *changes)[1].split())


def test_a_fall_is_told_as_speed_and_energy_and_a_coin_as_a_plate(cli):
    """Half a metre of fall gives sqrt(2 g h) and m g h; a coin has no part that could be rigid."""
    said = " ".join(cli("check", "t5b", "--set", "impact.height='0.5 m'")[1].split())
    mass = load("t5b").projectile.body().mass
    motion = "height 0.5 m: 3.132 m/s (v_n -2.214, v_t -2.214)"
    assert f"{motion}, E_0 = {mass * 9.80665 * 0.5:.4g} J" in said
    assert "us (beam and bar)" in said
    coin = "projectile={profile=[['0 mm', '12 mm'], ['2 mm', '12 mm']], material='brass'}"
    said = " ".join(cli("check", "t5b", "--set", coin, "--set", "measured=")[1].split())
    assert "us (plate and bar)" in said and "contact time: has no upper limit, so the effect is on" in said


def test_a_value_whose_unit_is_rounded_is_told_in_few_digits(cli):
    turning = ("--set", "impact.omega=60 rpm", "--set", "impact.angle=33.333 deg")
    said = " ".join(cli("check", "t5b", *turning)[1].split())
    assert "omega 6.283 rad/s" in said and "angle 33.333 deg" in said


def test_frames_are_told_over_the_time_that_they_are_spread_over(cli):
    """A run that lasted longer stored 160 where 120 at most were promised."""
    said = " ".join(cli("check", "t5b")[1].split())
    assert "120 (save.frames) in 3 times the estimated contact, more in a longer run" in said
    case = Case.of(load("t5b"))
    early, later, parted = _schedule(case)
    first = round(parted / early)
    assert first + (3 * case.estimate.duration - parted) / later == pytest.approx(120, abs=1)


def test_an_effect_that_is_off_though_its_number_calls_for_it_says_why(cli, tmp_path):
    """Waves through nylon are worth following, and a barrier taken as rigid has none."""
    nylon = {"projectile.material": "pa66", "barrier.material": "s235", "impact.angle": "10 deg"}
    nylon["impact.speed"] = "3 m/s"
    pair = {"surface": {"state": "pair"}}
    scene = replace_all(load("quick"), nylon | pair)
    needs = "needs barrier-elastic or barrier-elastoplastic, which are off"
    for changes, said in (
        ({}, f"off radiation (0.013, threshold 0.01): {needs}"),
        ({"effects": ["auto", "barrier-elastic", "-radiation"]}, "threshold 0.01): left out by the scene"),
    ):
        path = tmp_path / "nylon.toml"
        path.write_text(to_toml(replace_all(scene, changes)))
        code, out, _ = cli("check", str(path))
        assert code == 0 and said in " ".join(out.split())
