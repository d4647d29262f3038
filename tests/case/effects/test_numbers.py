"""The numbers that decide on effects: beside what they stand for, or by hand."""

from dataclasses import replace
from math import log, pi, sqrt

import numpy as np
import pytest

from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.choose import all_effects
from fem_impact.case.effects.heating import halves
from fem_impact.case.effects.plasticity import DEEP
from fem_impact.case.effects.radiation import number as radiated
from fem_impact.case.effects.registry import BARRIERS, EFFECTS, NAMES
from fem_impact.case.measured import expected_shares
from fem_impact.physics.beam import bending_period
from fem_impact.physics.contact import FLATTEST
from fem_impact.physics.flash import expected_rise, flash_bound
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.shipped import replace as changed


def bodies(stated):
    return Case(stated).bodies


def whole_of(stated):
    """The bodies with all effects in force that the scene does not force off."""
    return Bodies(stated, all_effects(stated.effects))


def radii(stated):
    return Case(stated).contact.principal_radii


def number(stated, name):
    return next(choice.number for choice in Case(stated).choices if choice.name == name)


def test_first_yield_under_a_sphere():
    """Largest shear on the axis of Hertz' contact at nu = 0.3, for a peak pressure of one."""
    z = np.linspace(0.01, 3, 3000)
    along = -1 / (1 + z**2)
    around = -1.3 * (1 - z * np.arctan(1 / z)) + 0.5 / (1 + z**2)
    assert 1 / np.max(np.abs(along - around)) == pytest.approx(DEEP, rel=0.01)


def test_first_yield_with_friction_and_its_cap():
    """A gentle touch is Hertz'; the other body holds no more than 2.8 of its ultimate stress."""
    stated = changed(changed(load("t5b"), "impact.v_n", "-0.001 m/s"), "surface.friction", 0.5)
    elastic = replace(stated, effects=("vibration", "friction", "barrier-elastic"))
    peak = 1.5 * bodies(elastic).estimate.pressure
    assert number(stated, "barrier-elastoplastic") == pytest.approx(peak * sqrt(3) * 0.5 / 320e6)
    slippery = replace(stated, effects=("auto", "-friction"))
    assert number(slippery, "barrier-elastoplastic") < number(stated, "barrier-elastoplastic")


def test_radiated_share_is_that_of_hunter():
    """Held to Lamb's integral in the tests of the references."""
    stated = load("t5b")
    c0 = sqrt(206e9 / 7850)
    assert radiated(bodies(stated)) == pytest.approx(1.127 * (-stated.impact.v_n / c0) ** 0.6)


def test_gain_by_the_rate_by_hand():
    """Strain 0.2 a/R of the indentation in half the contact; C of the plate, nothing below its tests."""
    stated = load("t5b")
    whole = replace(stated, effects=tuple(n for n in NAMES if n not in BARRIERS[:2]))
    size, R = bodies(whole).estimate, sqrt(3e-3 * 12.2e-3)
    rate = 0.2 * sqrt(size.a_t * size.a_b) / R / (size.duration / 2)
    assert number(stated, "rate-hardening") == pytest.approx(
        (1 + 0.022 * log(rate)) / (1 + 0.022 * log(0.002)) - 1, rel=1e-3
    )
    faster = replace(
        stated.barrier.material, name="fast", rate=replace(stated.barrier.material.rate, tested=2e3)
    )
    tested_fast = replace(stated, barrier=replace(stated.barrier, material=faster))
    rod_alone = (1 + 0.0134 * log(rate)) / (1 + 0.0134 * log(0.002)) - 1
    assert number(tested_fast, "rate-hardening") == pytest.approx(rod_alone, rel=1e-3)


def test_damped_share_and_fall_by_hand():
    stated = load("t5b")
    whole = replace(stated, effects=tuple(n for n in NAMES if n not in BARRIERS[:2]))
    tau, T1 = bodies(whole).estimate.duration, bending_period(whole.projectile)
    assert number(stated, "material-damping") == pytest.approx(2 * pi * 6e-4 * (tau + T1) / T1)
    speed = np.hypot(stated.impact.v_n, stated.impact.v_t)
    assert number(stated, "gravity") == pytest.approx(9.80665 * (tau + T1) / speed)


def test_angle_turned_by_hand():
    """The spin grows evenly while the rod touches and stays for a bending period.

    Without friction an impulse at the arm d_c turns the rigid rod by (1 + e) v d_c / (k^2 + d_c^2), e = 1.
    """
    stated = changed(load("elastic-frictionless"), "impact.omega", "-20 rad/s")
    whole = whole_of(stated)
    d_c, k2 = whole.contact.arms[0], whole.body.k2
    after = -20 + 2 * whole.contact.approach * d_c / (k2 + d_c**2)
    tau, T1 = whole.estimate.duration, bending_period(stated.projectile)
    assert after > 10
    assert number(stated, "large-rotation") == pytest.approx(abs(after - 20) / 2 * tau + after * T1)


def test_heating_is_weighed_by_the_rise_to_ignition():
    stated = load("t5b")
    assert number(stated, "contact-heating") == pytest.approx(
        expected_rise(whole_of(stated).contact, stated.surface.friction, halves(whole_of(stated))) / 410.0
    )


def test_a_leaning_rod_heats_its_contact_that_does_not_slide_at_first_touch():
    """Without friction and loss its contact point leaves at 2 v d_c d_d / (k^2 + d_c^2); f = 0.57 holds it.

    Upright it does not slide: where the scene states what its heat is judged by, that is said.
    """
    still = {"impact.v_t": "0 m/s", "heating.ignition": "200 degC"}
    leaning, upright = (replace_all(load("t5b"), still | {"impact.angle": a}) for a in ("45 deg", "0 deg"))
    (d_c, d_d), k2 = Case(leaning).contact.arms, Case(leaning).bodies.body.k2
    slides = 2 * Case(leaning).contact.approach * d_c * d_d / (k2 + d_c**2)
    assert Case(leaning).contact.most_sliding == pytest.approx(slides)
    assert "contact-heating" in Case(leaning).active and "contact-heating" not in Case(upright).active
    said = [one.text for one in Case(upright).limitations if "heating.ignition, 473.15 K" in one.text]
    assert len(said) == 1 and 'effects = ["auto", "contact-heating"]' in said[0]
    assert not [one for one in Case(leaning).limitations if "heat of the contact is not" in one.text]


def test_the_contact_is_that_of_its_own_approach():
    """A spin that brings the tip down as fast as a fall without it makes the same contact."""
    stated = load("t5b")
    d_c, d_d = Case(stated).contact.arms
    spun = replace_all(stated, {"impact.omega": "-30 rad/s"})
    down, along = stated.impact.v_n - 30 * d_c, stated.impact.v_t + 30 * d_d
    fallen = replace_all(stated, {"impact.v_n": f"{down} m/s", "impact.v_t": f"{along} m/s"})
    assert bodies(spun).estimate == pytest.approx(bodies(fallen).estimate)
    bounds = [flash_bound(one.contact, 0.57, halves(one)) for one in (bodies(spun), bodies(fallen))]
    assert bounds[0] == pytest.approx(bounds[1])
    assert bodies(spun).estimate.depth > 1.3 * bodies(stated).estimate.depth


def test_tip_radii_where_the_shape_ends():
    """A ball is round at its pole, a face is not; tip A's shoulder, beyond 60 degrees, is sharp."""
    ball = replace_all(load("t5b"), {"projectile.tip_radius": "9.5 mm", "impact.v_t": "0 m/s"})
    at = {
        angle: Case(changed(ball, "impact.angle", angle)).contact.principal_radii
        for angle in ("0 deg", "1 deg")
    }
    assert at["0 deg"] == pytest.approx((9.5e-3, 9.5e-3))
    assert at["1 deg"] == pytest.approx(at["0 deg"])
    flat = replace_all(load("t5b"), {"impact.angle": "0.1 deg"})
    twice = {"length": "160 mm", "diameter": "38 mm", "tip_radius": "6 mm"}
    larger = replace_all(flat, {f"projectile.{name}": size for name, size in twice.items()})
    assert radii(flat)[1] == pytest.approx(FLATTEST * 0.019)
    assert radii(larger) == pytest.approx(tuple(2 * radius for radius in radii(flat)))
    round_tip = replace_all(load("t5b"), {"projectile.tip": "A", "projectile.tip_radius": "7 mm"})
    assert Case(changed(round_tip, "impact.angle", "59 deg")).contact.principal_radii[0] == 7e-3
    assert Case(changed(round_tip, "impact.angle", "61 deg")).contact.principal_radii[0] == pytest.approx(
        0.019 / 200
    )


def test_expected_shares_of_the_run_time():
    """Every effect of the model has one; with the nose of the rigid rod they are the whole."""
    lean, full = (
        expected_shares(("friction", "barrier-rigid")),
        expected_shares(set(NAMES) - set(BARRIERS[:2])),
    )
    assert lean["barrier-rigid"] == 0.0 and lean["friction"] < 0.1
    assert 0.5 < sum(full.values()) < 1.0
    assert full["barrier-elastoplastic"] > full["radiation"]
    told = {choice.name: choice.share for choice in Case(load("t5b")).choices}
    assert {name for name in told if told[name] is None} == set(NAMES) - set(Case(load("t5b")).active)


def test_thresholds_are_those_that_the_page_names():
    assert {name: effect.threshold for name, effect in EFFECTS.items()} == {
        "vibration": 0.1,
        "friction": 0.005,
        "rod-plasticity": 1.0,
        "barrier-rigid": 0.02,
        "barrier-elastic": 0.02,
        "barrier-elastoplastic": 1.0,
        "rate-hardening": 0.03,
        "machined-skin": 0.03,
        "radiation": 0.01,
        "plate-bending": 0.006,
        "gravity": 0.005,
        "large-rotation": 0.01,
        "material-damping": 0.05,
        "contact-heating": 0.1,
        "contact-loss": 0.02,
    }


def test_what_lands_flat_sends_waves_into_the_barrier_however_slow_it_comes():
    """Steel on steel: a bar has rho c = 40.6, the half-space 1.55 rho c_s = 39.0 MPa s/m: nearly matched."""
    flat = replace_all(
        load("t5b"),
        {
            "projectile.tip": "plain",
            "projectile.tip_radius": "0 mm",
            "impact.angle": "0 deg",
            "impact.v_n": "-0.1 m/s",
        },
    )
    assert number(flat, "radiation") == pytest.approx(1.0, abs=0.01)
    tilted = changed(flat, "impact.angle", "20 deg")
    assert number(tilted, "radiation") < 0.01
    assert ("radiation" in Case(flat).active, "radiation" in Case(tilted).active) == (True, False)


def test_a_side_that_lands_all_along_yields_as_a_line_does():
    """c45 on s275 at 1 m/s: finite elements of 200 mm x 20 mm have 42.9 kN, Hertz' line 890 MPa there.

    A rigid body on a bed presses harder than one through which waves run; the tip's contact said 0.92.
    """
    scene = replace_all(
        load("quick"),
        {
            "projectile.length": "200 mm",
            "projectile.diameter": "20 mm",
            "projectile.tip_radius": "1 mm",
            "projectile.material": "c45",
            "barrier.material": "s275",
            "impact.angle": "90 deg",
            "impact.v_n": "-1 m/s",
            "impact.v_t": "0 m/s",
        },
    )
    side = Case.of(scene, "modal")
    measured = sqrt(42.9e3 / 0.198 * side.contact.modulus / (pi * 0.01))
    assert measured == pytest.approx(890e6, rel=0.02)
    at_first = min(1.6, 1 / (sqrt(3) * side.contact.f)) * side.contact.barrier.yield_stress
    assert measured < number(scene, "barrier-elastoplastic") * at_first < 1.5 * measured
    assert {"rod-plasticity", "barrier-elastoplastic"} <= set(side.active)


@pytest.mark.parametrize(
    ("rod", "forced", "yields"),
    [
        ("steel-4340", "barrier-elastic", "rod-plasticity"),
        ("lead", "-rod-plasticity", "barrier-elastoplastic"),
    ],
)
def test_a_body_that_is_kept_elastic_caps_no_pressure(rod, forced, yields):
    """A ball at 10 m/s on a softer plate that may not yield: the stronger one does, e is not 1."""
    ball = {"shape": "ball", "diameter": "10 mm", "material": rod}
    stated = load(
        {
            "id": "ball",
            "projectile": ball,
            "barrier": {"material": "s355"},
            "surface": {"state": "custom", "friction": 0.2, "source": "test"},
            "impact": {"angle": "0 deg", "speed": "10 m/s"},
        }
    )
    assert yields not in Case(stated).active
    kept = changed(stated, "effects", ["auto", forced])
    assert yields in Case(kept).active
    assert simulate(kept, "rigid").restitution.edge.e < 0.75
