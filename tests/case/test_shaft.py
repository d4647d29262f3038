"""A shaft that the strike would make flow is told by the models that have none."""

from math import sqrt

import pytest

from fem_impact import load, replace_all, simulate
from fem_impact.case.case import Case
from fem_impact.case.limits import not_reduced
from fem_impact.case.shaft import part_flows, rings_through, shaft_flows, wall_is_flattened
from fem_impact.errors import SceneError
from fem_impact.outcome.keys import Unknown
from fem_impact.scene.read import read_dict

ROD = {"projectile.length": "0.12 m", "impact.angle": "0 deg", "impact.v_t": "0 m/s"}


def flows(**changed):
    return shaft_flows(Case(replace_all(load("t5b"), ROD | changed)).bodies)


def test_the_least_speed_is_that_of_a_plane_wave_at_the_yield_stress():
    steel = load("t5b").projectile.material
    limit = steel.yield_stress / sqrt(steel.E * steel.rho)
    # a rod so long and thin that the contact could press harder than a wave can
    thin = {"projectile.length": "0.6 m", "projectile.diameter": "6 mm", "projectile.tip_radius": "1 mm"}
    assert not flows(**thin | {"impact.v_n": f"{-0.99 * limit} m/s"})
    assert "would yield" in flows(**thin | {"impact.v_n": f"{-1.01 * limit} m/s"})


def test_a_short_rod_turns_back_before_the_wave_has_its_full_stress():
    told = flows(**{"impact.v_n": "-14 m/s"})
    assert not told, (
        "the force over the section is 14 m/s times the mass over the contact's time, below yield"
    )


@pytest.mark.long
@pytest.mark.parametrize("fidelity", ["rigid", "modal"])
def test_models_without_a_mesh_tell_it(fidelity):
    changed = {
        "projectile.diameter": "6 mm",
        "projectile.tip_radius": "1 mm",
        "impact.v_n": "-60 m/s",
        "impact.angle": "20 deg",
    }
    outcome = simulate(replace_all(load("t5b"), ROD | changed), fidelity)
    texts = [one.text for one in outcome.validity.limitations]
    assert any(text.startswith("Left out: a shaft that would yield") for text in texts), texts


@pytest.mark.long
def test_a_tube_on_its_side_is_flattened_where_its_rings_bear_less_than_comes_down():
    """48.3 mm by 3.2 mm, S235: 107 N/mm over .32 mm are 2.6 J for 150 mm, which come down at 3.1 m/s."""
    table = {
        "id": "ring",
        "projectile": {
            "length": "150 mm",
            "diameter": "48.3 mm",
            "inner_diameter": "41.9 mm",
            "tip": "plain",
            "material": "s235",
        },
        "barrier": {"material": "s235"},
        "impact": {"angle": "90 deg", "v_n": "-6.26 m/s", "v_t": "0 m/s"},
    }
    ring = load(table)
    assert "10.5 J come down, and it bears 2.5" in wall_is_flattened(Case(ring).bodies)
    for changes in (
        {"impact.v_n": "-3 m/s"},
        {"impact.angle": "45 deg"},
        {"projectile.inner_diameter": "20 mm"},
    ):
        assert wall_is_flattened(Case(replace_all(ring, changes)).bodies) == ""
    told = simulate(ring, "modal").validity.limitations
    assert any("a wall that would be flattened" in one.text for one in told)


def test_a_disc_on_its_face_is_told_without_an_error_and_is_not_decided_by_the_reduced_model():
    """By plane waves brass on steel keeps e .13 to .14, where a disc without a stretching mode has .82."""
    disc = load(
        {
            "id": "disc",
            "projectile": {"length": "15 mm", "diameter": "150 mm", "tip": "plain", "material": "brass"},
            "barrier": {"material": "s235"},
            "surface": {"state": "custom", "friction": 0.3, "source": "chosen"},
            "impact": {"angle": "0 deg", "v_n": "-4 m/s", "v_t": "0 m/s"},
        }
    )
    assert rings_through(Case(disc).bodies) == not_reduced(Case(disc).bodies) != ""
    outcome = simulate(disc, "modal")
    assert isinstance(outcome.half_widths, Unknown) and outcome.estimate("e_edge")[1] is None
    for changes in ({"impact.angle": "60 deg"}, {"projectile.length": "300 mm"}):
        assert rings_through(Case(replace_all(disc, changes)).bodies) == ""


CAP = {
    "id": "capped",
    "projectile": {
        "length": "80 mm",
        "diameter": "20 mm",
        "tip": "B",
        "tip_radius": "3 mm",
        "segments": [{"to": "5 mm", "material": "42crmo4"}, {"material": "lead"}],
    },
    "barrier": {"material": "s355"},
    "surface": {"state": "custom", "friction": 0.3, "source": "assumed"},
    "impact": {"angle": "30 deg", "speed": "6 m/s"},
}


@pytest.mark.parametrize("fidelity", ["modal", "solid"])
def test_a_later_segment_that_would_yield_is_refused_by_the_models_that_keep_it_elastic(fidelity):
    """The contact of a steel cap presses lead, which yields at 11 MPa, with several times that."""
    with pytest.raises(SceneError, match="over 11 MPa; only the first segment may yield") as refused:
        Case.of(read_dict(CAP), fidelity)
    assert refused.value.key == "projectile.segments[2].material"
    assert Case.of(read_dict(CAP), "rigid").fidelity == "rigid"
    gentle = CAP | {"impact": {"angle": "30 deg", "speed": "0.05 m/s"}}
    assert Case.of(read_dict(gentle), fidelity).fidelity == fidelity


def test_a_segment_behind_a_stiffer_one_gets_the_wave_that_this_one_passes_on():
    """Its own plane wave, 10.8 MPa at 0.8 m/s, lies below the yield stress of lead; what arrives does not."""
    parts = [{"to": "60 mm", "material": "42crmo4"}, {"material": "lead"}]
    rod = CAP["projectile"] | {"length": "120 mm", "segments": parts}
    scene = {
        "projectile": rod,
        "barrier": {"material": "100cr6"},
        "impact": {"angle": "1 deg", "speed": "0.8 m/s"},
    }
    number, stress = part_flows(Case(read_dict(CAP | scene)).bodies)
    assert number == 2 and 11e6 < stress < 20e6


def test_a_list_of_effects_without_plasticity_keeps_all_elastic():
    stated = CAP | {"effects": ["vibration", "friction", "barrier-rigid"]}
    assert Case.of(read_dict(stated), "modal").fidelity == "modal"


def test_a_later_segment_of_a_metal_without_a_yield_stress_stays_elastic_as_stated():
    lead = {"name": "soft", "E": "16 GPa", "nu": 0.44, "rho": "11340 kg/m3", "source": "assumed"}
    parts = [CAP["projectile"]["segments"][0], {"material": lead}]
    stated = CAP | {"projectile": CAP["projectile"] | {"segments": parts}}
    assert part_flows(Case(read_dict(stated)).bodies) == (0, 0.0)
    assert Case.of(read_dict(stated), "modal").fidelity == "modal"
