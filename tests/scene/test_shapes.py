"""Shapes as users state them: named ones, profiles, bores and segments, and what is refused."""

from __future__ import annotations

import re
import tomllib
from math import copysign, radians

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.errors import ResultError, SceneError
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.shapes import read_points
from fem_impact.scene.shipped import replace
from fem_impact.scene.types import digest, to_toml

OGIVE = {
    "shape": "ogive",
    "length": "100 mm",
    "diameter": "19 mm",
    "calibre_radius": 2.0,
    "nose_radius": "3 mm",
}
CONE = {"shape": "sphere-cone", "length": "100 mm", "diameter": "19 mm"}
CONE |= {"cone_angle": "20 deg", "nose_radius": "3 mm"}
BY_LENGTH = {key: value for key, value in OGIVE.items() if key != "calibre_radius"}
POINTS = [["0 mm", "0 mm"], ["1 mm", "4 mm"], ["5 mm", "7 mm"], ["60 mm", "9 mm"], ["80 mm", "6 mm"]]
TWO = [{"to": "40 mm", "material": "rod-steel"}, {"to": "100 mm", "material": "plate-steel"}]
LAST = {"material": "plate-steel"}


def scene(projectile, angle="45 deg"):
    if "segments" not in projectile:
        projectile = {"material": "rod-steel", **projectile}
    return {
        "id": "own",
        "projectile": projectile,
        "barrier": {"material": "plate-steel"},
        "surface": {"state": "machined"},
        "impact": {"angle": angle, "v_n": "-1.5 m/s", "v_t": "-1 m/s"},
    }


@pytest.mark.parametrize(
    "projectile",
    [
        OGIVE,
        CONE,
        {**{k: v for k, v in OGIVE.items() if k != "calibre_radius"}, "nose_length": "30 mm"},
        {**{k: v for k, v in CONE.items() if k != "cone_angle"}, "nose_length_m": 0.03},
        {"shape": "ball", "diameter": "19 mm"},
        {"shape": "cone", "length": "80 mm", "diameter": "19 mm", "cone_angle": "30 deg"}
        | {"face_diameter": "6 mm"},
        {"profile": POINTS},
        {"profile": POINTS, "profile_smooth": True},
        {**OGIVE, "bore": [["40 mm", "5 mm"], ["100 mm", "6 mm"]]},
        {**OGIVE, "segments": TWO},
        {"tip": "A", "length": "100 mm", "diameter": "19 mm", "tip_radius": "7 mm", "segments": TWO},
    ],
)
def test_a_shape_reads_back_as_it_was_written(projectile):
    made = read_dict(scene(projectile))
    again = read_dict(tomllib.loads(to_toml(made)))
    assert again == made
    assert digest(again) == digest(made)
    assert not made.projectile.is_rod


@pytest.mark.parametrize(
    ("shape", "tip", "radius"),
    [
        ({"shape": "flat"}, "plain", 0.0),
        ({"shape": "hemisphere"}, "B", 9.5e-3),
        ({"shape": "rounded-edge", "edge_radius": "3 mm"}, "B", 3e-3),
    ],
)
def test_shapes_that_are_rods_are_the_rods_with_a_tip(shape, tip, radius):
    rod = read_dict(scene({"length": "100 mm", "diameter": "19 mm", **shape})).projectile
    assert rod.is_rod
    assert (rod.tip, rod.tip_radius) == (tip, radius)


def test_one_size_of_a_shape_can_be_changed():
    made = replace(read_dict(scene(OGIVE)), "projectile.calibre_radius", 3.0)
    assert made.projectile.shape.sizes[2] == 3.0


def test_a_profile_is_read_from_a_table_beside_the_scene(tmp_path):
    (tmp_path / "mine.csv").write_text("z [mm],r [mm]\n0,0\n1,4\n5,7\n60,9\n80,6\n")
    text = to_toml(read_dict(scene({"profile": POINTS})))
    head, tail = text.split("profile = ")
    tail = tail.split("\n]\n", 1)[1]
    (tmp_path / "own.toml").write_text(f'{head}profile = "mine.csv"\n{tail}')
    assert read_toml(tmp_path / "own.toml") == read_dict(scene({"profile": POINTS}))
    (tmp_path / "mine.csv").write_text("z_m,r_m\n# tip\n0,0\n\n0.02,x\n")
    told = r"own\.toml: projectile\.profile: .*mine\.csv: line 5, column r_m: 'x' is not a finite number"
    with pytest.raises(SceneError, match=told):
        read_toml(tmp_path / "own.toml")
    (tmp_path / "mine.csv").unlink()
    with pytest.raises(SceneError, match="cannot be read"):
        read_toml(tmp_path / "own.toml")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a,b\n0,0\n", "has no columns z and r. The first line names them, such as z_mm,r_mm"),
        ("z_mm,r_yd\n0,0\n", "'yd' is not a unit of length"),
        ("z_mm,r_mm,z_m\n0,0,0\n", "z has two columns, the second is 'z_m'"),
        ("z_mm,r_mm\n0,0\n\n9\n", "line 4 has 1 cells, the header 2"),
        ("", "is empty. Begin it with the header z_mm,r_mm"),
    ],
)
def test_a_table_of_points_that_cannot_be_read_is_refused(tmp_path, text, told):
    (tmp_path / "mine.csv").write_text(text)
    with pytest.raises(ResultError, match=told):
        read_points(tmp_path / "mine.csv")


def test_points_carry_the_unit_of_their_column(tmp_path):
    (tmp_path / "mine.csv").write_text("\ufeffnote, r (cm) ,z\ntip,-0,0\ntail,1.5,0.25\n", encoding="utf-8")
    points = read_points(tmp_path / "mine.csv")
    assert points == ((0.0, 0.0), (0.25, 0.015))
    assert copysign(1.0, points[0][1]) == 1.0


@pytest.mark.parametrize(
    ("projectile", "told"),
    [
        ({"shape": "egg", "length": "1 m"}, 'shape = "egg": is not a choice'),
        ({**OGIVE, "nose_radius": "30 mm"}, "nose_radius must lie between 0 and 9.5 mm"),
        ({**OGIVE, "calibre_radius": 0.5}, "calibre_radius = 0.5"),
        ({**OGIVE, "length": "15 mm"}, r"the nose is .* long, the body only 15 mm"),
        ({**CONE, "nose_radius": "11 mm"}, "leaves no cone"),
        ({**OGIVE, "nose_length": "30 mm"}, "nose_length: is given beside calibre_radius.*one of them"),
        ({**CONE, "nose_length_m": 0.03}, "nose_length: is given beside cone_angle.*one of them"),
        (
            {k: v for k, v in OGIVE.items() if k != "calibre_radius"},
            "calibre_radius: is missing.*nose_length",
        ),
        ({**BY_LENGTH, "nose_length": "9 mm"}, "nose_length of 9 mm is blunter.*more than half.*9.5 mm"),
        ({**BY_LENGTH, "nose_length": "120 mm"}, "the nose is 120 mm long, the body only 100 mm"),
        ({**BY_LENGTH, "nose_length": "30 mm", "nose_radius": "10 mm"}, "nose_radius must lie below 9.5 mm"),
        ({**BY_LENGTH, "nose_length": 30}, 'nose_length = 30: a bare number.*such as "'),
        (
            {"shape": "flat", "length": "1 m", "diameter": "9 mm", "nose_length": "3 mm"},
            "nose_length.*not a known",
        ),
        ({**CONE, "edge_radius": "11 mm"}, r"edge_radius.*not a known key"),
        ({"profile": "x"}, "must be a list of 2 to 2000 points"),
        ({"profile": [["0 mm", "0 mm"]]}, "must be a list of 2 to 2000 points"),
        ({"profile": [["0 mm", "0 mm"], [20, 6]]}, r"profile\[2\]"),
        ({"profile": [["0 mm", "1 mm"], ["20 mm"]]}, r"profile\[2\].*pair"),
        ({"profile": [["0 mm", "1 mm"], ["20 mm", "2 mm"], ["10 mm", "2 mm"]]}, r"profile\[3\].*behind"),
        ({"profile": [["5 mm", "1 mm"], ["20 mm", "2 mm"]]}, "must start at z = 0"),
        ({"profile": POINTS, "profile_smooth": 1}, "must be true or false"),
        (
            {"profile": [["0 mm", "0 mm"], ["4 mm", "0 mm"], ["4 mm", "80 mm"]]},
            r"profile\[2\] = .z = 4 mm, radius 0.*both lie on the axis",
        ),
        ({**OGIVE, "bore": [["0 mm", "9.6 mm"], ["100 mm", "9.6 mm"]]}, "leaves no wall"),
        (
            {**OGIVE, "bore": "8 mm"},
            r'Write bore = \[\["0 mm", "4 mm"\], \["100 mm", "4 mm"\]\].*radius there',
        ),
        ({**OGIVE, "bore": [["50 mm", "5 mm"], ["120 mm", "5 mm"]]}, "beyond the tail"),
        ({**OGIVE, "segments": TWO[:1]}, "must end at the tail"),
        ({**OGIVE, "segments": [TWO[0], TWO[0], TWO[1]]}, r"segments\[2\]\.to.*must end behind"),
        (
            {**OGIVE, "segments": [TWO[1], TWO[0]]},
            r"segments\[1\]\.to.*leaves no room for the next.* is 100 mm long.*longer projectile",
        ),
        (
            {**OGIVE, "segments": [{**TWO[0], "to": "120 mm"}, LAST]},
            r'segments\[1\]\.to = "120 mm".*leaves no room',
        ),
        ({**OGIVE, "tip": "B"}, r'projectile\.tip = "B": stands beside a shape.*Leave out tip, or shape'),
        ({**OGIVE, "segments": TWO, "material": "rod-steel"}, "stands beside segments"),
        ({**OGIVE, "segments": "steel"}, "must be a list of segments"),
        (
            {**OGIVE, "segments": [{"material": "lead"}, TWO[1]]},
            r"segments\[1\]\.to: is missing.*only the last",
        ),
        ({**OGIVE, "segments": [{"to": "100 mm"}]}, r"segments\[1\]\.material.*missing"),
    ],
)
def test_a_bad_shape_is_refused_with_its_key(projectile, told):
    with pytest.raises(SceneError, match=told) as caught:
        read_dict(scene(projectile))
    assert "projectile" in str(caught.value)


def test_a_shape_does_not_repeat_a_measured_set():
    rod = {"tip": "B", "length": "80 mm", "diameter": "19 mm", "tip_radius": "3 mm"}
    of_set = {"measured": "t5b", "impact": {"angle": "45 deg", "v_n": "-1.5 m/s", "v_t": "-1.5 m/s"}}
    assert read_dict(scene(rod) | of_set).measured == "t5b"
    with pytest.raises(SceneError, match=r"another projectile\.tip"):
        read_dict(scene({**rod, "bore": [["20 mm", "4 mm"], ["80 mm", "4 mm"]]}) | of_set)


TUBE = {"tip": "plain", "length": "80 mm", "diameter": "19 mm"}


def test_an_inner_diameter_states_a_bore_from_tip_to_tail():
    tube = read_dict(scene({**TUBE, "inner_diameter": "14 mm"}))
    assert tube.projectile.bore == ((0.0, 0.007), (0.08, 0.007))
    assert read_dict(scene({**TUBE, "bore": [["0 mm", "7 mm"], ["80 mm", "7 mm"]]})) == tube
    assert replace(tube, "projectile.inner_diameter_m", 0.012).projectile.bore[1] == (0.08, 0.006)
    assert replace(tube, "projectile.length", "90 mm").projectile.bore[1] == (0.09, 0.007)


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("wall_thickness", "2 mm", r"projectile\.wall_thickness = .*is not a known key.*inner_diameter = "),
        ("inner_diameter", "19 mm", r"bounds no body"),
        ("bore", [["0 mm", "6 mm"], ["80 mm", "6 mm"]], r"inner_diameter: stands beside a bore"),
    ],
)
def test_a_tube_is_stated_once_and_has_a_wall(key, value, told):
    tube = {**TUBE, "inner_diameter": "14 mm", key: value}
    with pytest.raises(SceneError, match=told):
        read_dict(scene(tube))


def test_a_flank_that_lies_on_the_barrier_is_refused():
    chamfer = {"profile": [["0 mm", "5 mm"], ["2 mm", "7 mm"], ["80 mm", "8 mm"]]}
    with pytest.raises(SceneError, match=r"flank of 2\.83 mm along the barrier"):
        Case.of(read_dict(scene(chamfer)), "solid")
    assert Case.of(read_dict(scene(chamfer, "30 deg")), "solid")


@pytest.mark.parametrize(("angle", "fidelity"), [(45.0, "solid"), (41.0, "solid"), (42.5, "rigid")])
def test_an_angle_that_the_refusal_of_a_flank_names_is_accepted_and_the_nearest(angle, fidelity):
    chamfer = {"profile": [["0 mm", "5 mm"], ["2 mm", "7 mm"], ["80 mm", "8 mm"]]}
    with pytest.raises(SceneError) as refused:
        Case.of(read_dict(scene(chamfer, f"{angle} deg")), fidelity)
    told = [int(one) for one in re.findall(r"(-?\d+) deg", refused.value.remedy)]
    assert told
    for named in told:
        assert Case.of(read_dict(scene(chamfer, f"{named} deg")), fidelity)
        nearer = named + (1 if named < angle else -1)
        with pytest.raises(SceneError, match="flank"):
            Case.of(read_dict(scene(chamfer, f"{nearer} deg")), fidelity)


def test_no_angle_is_named_at_which_the_body_does_not_come_down_on_a_barrier_that_moves():
    """Along its axis it comes down at 0.97 m/s at 61 deg, while the barrier goes away at 0.99 m/s."""
    cone = {"shape": "cone", "length": "60 mm", "diameter": "20 mm", "cone_angle": "30 deg"}
    data = scene(cone | {"face_diameter": "2 mm"}) | {"impact": {"angle": "60 deg", "speed": "2 m/s"}}
    data["barrier"] = data["barrier"] | {"v_n": "-0.99 m/s"}
    with pytest.raises(SceneError, match="flank") as refused:
        Case.of(read_dict(data), "rigid")
    assert "Give an angle of 59 deg." in refused.value.remedy


def test_a_flank_that_is_pressed_in_whole_asks_for_a_lower_speed():
    """No angle helps: one of 170 deg was asked for."""
    cone = {"shape": "cone", "length": "700 mm", "diameter": "7.4 mm", "cone_angle": "67 deg"}
    fast = scene(cone | {"face_diameter": "1.3 mm"}, "5 deg")
    fast["impact"] = fast["impact"] | {"v_n": "-14 m/s", "v_t": "-1 m/s"}
    with pytest.raises(SceneError, match="flank") as refused:
        Case.of(read_dict(fast), "solid")
    assert "lower speed" in refused.value.remedy and "deg" not in refused.value.remedy


@pytest.mark.parametrize("angle", [5, 35])
def test_a_point_that_is_pressed_in_to_its_flanks_is_to_be_rounded(angle):
    """Not the angle: none helps."""
    spike = [["0 mm", "0 mm"], ["12 mm", "3 mm"], ["40 mm", "8 mm"], ["180 mm", "8 mm"]]
    fast = scene({"profile": spike, "material": "copper"}, f"{angle} deg")
    fast["impact"] |= {"v_n": "-3 m/s", "v_t": "-2 m/s"}
    with pytest.raises(SceneError, match="ends in a point") as refused:
        Case.of(read_dict(fast), "solid")
    assert "Round the point" in refused.value.remedy
    fast["projectile"]["profile"] = [["0 mm", "1 mm"], *spike[1:]]
    assert Case.of(read_dict(fast), "solid")


def test_the_radius_at_the_contact_is_that_of_the_point_that_touches():

    for angle in (10.0, 40.0, 60.0):
        assert Case(read_dict(scene(CONE, f"{angle} deg"))).contact.principal_radii == pytest.approx(
            (3e-3, 3e-3), rel=2e-3
        )
    # beyond the cone's slope its shoulder comes down: an edge
    R1, R2 = Case(read_dict(scene(CONE, "75 deg"))).contact.principal_radii
    assert R1 == pytest.approx(0.019 / 200)
    assert R2 == pytest.approx(9.5e-3 / np.sin(radians(75.0)))


def test_the_length_of_an_ogive_gives_its_circle():
    """C = ((L - r)^2 / (R - r) + R + r) / 2 = 55 mm, its centre beside the shoulder."""
    rod = {**BY_LENGTH, "diameter": "20 mm", "nose_radius": "2 mm", "nose_length": "30 mm"}
    made = read_dict(scene(rod)).projectile
    line = made.body().outline
    assert line[-2] == pytest.approx([10e-3, 30e-3], rel=1e-12)
    side = line[line[:, 1] > 3e-3][:-1]
    assert np.hypot(side[:, 0] + 45e-3, side[:, 1] - 30e-3) == pytest.approx(55e-3, rel=1e-12)
    by_radius = read_dict(
        scene({**OGIVE, "diameter": "20 mm", "nose_radius": "2 mm", "calibre_radius": 2.75})
    )
    assert line == pytest.approx(by_radius.projectile.body().outline, rel=1e-9)


def test_the_length_of_a_cone_gives_its_angle():
    flat = {"shape": "cone", "length": "80 mm", "diameter": "20 mm", "face_diameter": "6 mm"}
    line = read_dict(scene({**flat, "nose_length": "24 mm"})).projectile.body().outline
    by_angle = {**flat, "cone_angle": f"{np.degrees(np.arctan(7 / 24)):.12f} deg"}
    assert line == pytest.approx(read_dict(scene(by_angle)).projectile.body().outline, rel=1e-9)
    sharp = {k: v for k, v in CONE.items() if k != "cone_angle"} | {
        "diameter": "20 mm",
        "nose_radius": "2 mm",
    }
    line = read_dict(scene({**sharp, "nose_length": "30 mm"})).projectile.body().outline
    assert line[-2] == pytest.approx([10e-3, 30e-3], rel=1e-12)
    (rho, z), (R, end) = line[-3:-1]  # where the sphere about (0, 2 mm) ends, and the cylinder begins
    assert np.hypot(rho, z - 2e-3) == pytest.approx(2e-3, rel=1e-9)
    assert rho * (R - rho) + (z - 2e-3) * (end - z) == pytest.approx(0.0, abs=1e-15)  # tangent


def test_a_stated_length_of_the_nose_is_kept_and_replaced():
    made = read_dict(scene({**BY_LENGTH, "nose_length": "30 mm"}))
    wider = replace(made, "projectile.diameter", "24 mm")
    assert wider.projectile.body().outline[-2, 1] == pytest.approx(30e-3)
    assert 'nose_length = "30 mm"' in to_toml(wider)
    again = replace(made, "projectile.calibre_radius", 2.0)
    assert digest(replace(again, "projectile.nose_length", "30 mm")) == digest(made)
    assert replace(again, "title", "own").projectile == read_dict(scene(OGIVE)).projectile


def test_the_last_segment_ends_at_the_tail():
    left_out = [TWO[0], {"material": "plate-steel"}]
    made = read_dict(scene({**OGIVE, "segments": left_out}))
    assert made == read_dict(scene({**OGIVE, "segments": TWO}))
    longer = replace(made, "projectile.length", "160 mm")
    assert [part.to for part in longer.projectile.segments] == [0.04, 0.16]
    rho = [part.material.rho for part in longer.projectile.segments]
    added = 0.06 * np.pi * 9.5e-3**2 * rho[1]
    assert longer.projectile.body().mass == pytest.approx(made.projectile.body().mass + added, rel=1e-6)
    with pytest.raises(SceneError, match=r"segments\[1\]\.to.*the projectile is 40 mm long"):
        replace(made, "projectile.length", "40 mm")


@pytest.mark.long
def test_lengths_of_a_body_of_segments_are_swept_and_the_user_is_told(cli):
    line = ("sweep", "heavy-tail", "--vary", "projectile.length=0.1,0.16m", "--fidelity", "rigid")
    code, out, _ = cli(*line, "--workers", "1")
    assert code == 0 and "2 runs, 0 failed" in out
    code, _, err = cli("check", "heavy-tail", "--set", "projectile.length=160 mm")
    assert code == 0 and "the segments still end at 80 mm; the last one ends at the new tail" in err
