"""How many cells a contact is expected to have, what resolves it, and what is said before a run."""

import re
from dataclasses import replace

import pytest

from fem_impact.case.case import Case
from fem_impact.case.cells import (
    ADVISED,
    LEAST,
    RIM,
    advice,
    coarse_tip,
    contact_radius,
    expected_cells,
    size_for,
    widest_tip_size,
)
from fem_impact.scene.shipped import load, replace_all


def bodies(**changes):
    """Return the bodies of t5b, whose contact yields, with other values."""
    keys = {
        "tip": "accuracy.tip_size",
        "v_n": "impact.v_n",
        "diameter": "projectile.diameter",
        "length": "projectile.length",
        "radius": "projectile.tip_radius",
    }
    return Case.of(replace_all(load("t5b"), {keys[k]: value for k, value in changes.items()}), "modal").bodies


def test_cells_follow_from_the_mesh_as_it_is_split():
    """19 mm over 8 cells, halved: .297 mm for any size asked for between .21 and .42 mm."""
    half = bodies(tip="0.35 mm")
    assert expected_cells(half) == pytest.approx(contact_radius(half) / 0.296875e-3 + RIM)
    assert expected_cells(bodies(tip="0.4 mm")) == expected_cells(half)
    assert expected_cells(bodies(tip="0.15 mm")) - RIM == pytest.approx(2 * (expected_cells(half) - RIM))


@pytest.mark.parametrize("v_n", ["-0.05 m/s", "-0.3 m/s", "-2 m/s"])
def test_the_advised_size_is_resolved(v_n):
    asked = bodies(v_n=v_n)
    size = size_for(asked, ADVISED["yielding"])
    given = bodies(v_n=v_n, tip=f"{size} m")
    assert ADVISED["yielding"] / 1.5 < expected_cells(given) < 1.5 * ADVISED["yielding"]
    told = re.search("tip_size = (.* mm) or less", advice(asked))[1]
    assert ADVISED["yielding"] <= expected_cells(bodies(v_n=v_n, tip=told)) < 2 * ADVISED["yielding"]


def test_an_element_wider_than_the_contact_is_doubted_before_the_run():
    gentle = bodies(v_n="-0.05 m/s", tip="0.8 mm")
    assert advice(gentle) in coarse_tip(gentle)
    assert coarse_tip(bodies(v_n="-0.05 m/s", tip=f"{widest_tip_size(gentle)} m")) == ""
    assert coarse_tip(bodies(tip="0.7 mm")) == ""


def test_elastic_bodies_need_fewer_cells():
    scene = replace(load("t5b"), effects=("vibration", "friction", "barrier-elastic"))
    elastic = Case.of(scene, "modal").bodies
    assert size_for(elastic, ADVISED["elastic"]) > size_for(elastic, ADVISED["yielding"])
    assert 0.148e-3 < size_for(elastic, ADVISED["elastic"]) < 0.296e-3  # cells of .148 mm resolve it
    assert "accuracy.tip_size = 0.15 mm or less" in advice(elastic)


def test_advice_keeps_a_fine_zone_and_within_what_a_scene_may_state():
    wide = bodies(v_n="-20 m/s")
    assert size_for(wide, LEAST["yielding"]) == pytest.approx(0.7 * 19e-3 / 8)
    assert "modal fidelity" in advice(
        bodies(v_n="-1e-6 m/s", length="1 mm", diameter="0.2 mm", radius="0.03 mm")
    )


ONE = ("--set", "accuracy.levels=1")


def test_check_tells_the_cells_and_the_size_for_fewer_errors(cli):
    code, out, _ = cli("check", "quick", *ONE)
    said = " ".join(out.split())
    assert code == 0
    assert "about 2.3 cells over the radius of the contact, 1.1 mm: e and mu within some 11 %" in said
    assert "Give accuracy.tip_size = 0.15 mm or less for 5 %" in said
    assert "or less for" not in cli("check", "quick", *ONE, "--set", "accuracy.tip_size=0.15 mm")[1]


def test_check_tells_that_one_mesh_does_not_settle_which_of_two_steels_flows(cli):
    words = "60 to 85 % of what 10 cells gave"
    stiff = "effects=['auto', '-rod-plasticity']"
    assert words in " ".join(cli("check", "t5b", *ONE)[1].split())
    assert words not in " ".join(cli("check", "t5b", *ONE, "--set", stiff)[1].split())
