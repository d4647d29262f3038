"""The numbers that decide on effects: beside what they stand for, or by hand."""

from dataclasses import replace
from math import log, pi, sqrt

import numpy as np
import pytest

from fem_impact.case.choose import active, choices, everything, resolved
from fem_impact.case.effects.plasticity import DEEP
from fem_impact.case.effects.radiation import number as radiated
from fem_impact.case.effects.registry import BARRIERS, EFFECTS, NAMES
from fem_impact.case.effects.slots import bodies_of, quick_impact
from fem_impact.case.measured import expected_shares
from fem_impact.physics.beam import bending_period
from fem_impact.physics.contact import (
    FLATTEST,
    arms,
    contact_estimate,
    normal_share,
    principal_radii,
    start_energy,
)
from fem_impact.physics.flash import expected_rise, flash_bound
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.shipped import replace as changed


def bodies(stated):
    return bodies_of(resolved(stated))


def number(stated, name):
    return next(choice.number for choice in choices(stated) if choice.name == name)


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
    peak = 1.5 * contact_estimate(bodies(elastic)).pressure
    assert number(stated, "barrier-elastoplastic") == pytest.approx(peak * sqrt(3) * 0.5 / 320e6)
    slippery = replace(stated, effects=("auto", "-friction"))
    assert number(slippery, "barrier-elastoplastic") < number(stated, "barrier-elastoplastic")


def test_radiated_share_is_that_of_hunter():
    """Held to Lamb's integral in the tests of the references."""
    stated = load("t5b")
    c0 = sqrt(206e9 / 7850)
    assert radiated(stated) == pytest.approx(1.127 * (-stated.impact.v_n / c0) ** 0.6)


def test_gain_by_the_rate_by_hand():
    """Strain 0.2 a/R of the indentation in half the contact; C of the plate, nothing below its tests."""
    stated = load("t5b")
    whole = replace(stated, effects=tuple(n for n in NAMES if n not in BARRIERS[:2]))
    size, R = contact_estimate(bodies(whole)), sqrt(3e-3 * 12.2e-3)
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
    tau, T1 = contact_estimate(bodies(whole)).duration, bending_period(whole)
    assert number(stated, "material-damping") == pytest.approx(2 * pi * 6e-4 * (tau + T1) / T1)
    speed = np.hypot(stated.impact.v_n, stated.impact.v_t)
    assert number(stated, "gravity") == pytest.approx(9.80665 * (tau + T1) / speed)


def test_angle_turned_by_hand():
    """The spin grows evenly while the rod touches and stays for a bending period."""
    stated = changed(load("elastic-frictionless"), "impact.omega", "-20 rad/s")
    whole = everything(stated)
    after, tau, T1 = (
        quick_impact(whole).Omega,
        contact_estimate(bodies(whole)).duration,
        bending_period(whole),
    )
    assert after > 10
    assert number(stated, "large-rotation") == pytest.approx(abs(after - 20) / 2 * tau + after * T1)


# ---------------------------------------------------------------- what leaving an effect out changes


def harm(stated, name):
    return next(choice.harm for choice in choices(stated) if choice.name == name)


def struck(*effects):
    return quick_impact(replace(load("t5b"), effects=effects))


def test_two_strikes_tell_what_an_effect_changes():
    elastic = struck("vibration", "friction", "barrier-elastic")
    plane = struck("vibration", "friction", "barrier-rigid")
    stated = replace(load("t5b"), effects=("vibration", "friction", "barrier-elastic"))
    lost = harm(stated, "barrier-elastic")
    assert lost.e == pytest.approx(abs(elastic.e - plane.e)) and lost.e > 0
    assert lost.E_vib == pytest.approx(abs(elastic.E_vib - plane.E_vib)) and lost.E_vib > 0
    yielding = struck("vibration", "friction", "barrier-elastoplastic")
    stated = replace(stated, effects=("vibration", "friction", "barrier-elastoplastic"))
    assert harm(stated, "barrier-elastoplastic").e == pytest.approx(elastic.e - yielding.e)
    assert struck("friction", "barrier-elastic").E_vib == 0.0
    assert harm(stated, "vibration").E_vib == pytest.approx(yielding.E_vib)


def test_an_effect_that_is_forced_off_is_told_as_if_it_came():
    stated = load("t5b")
    left = replace(stated, effects=("auto", "-friction"))
    assert harm(left, "friction") == harm(stated, "friction")
    assert harm(stated, "friction").e > 0.05


def test_damping_and_turning_change_their_share_of_the_vibration():
    stated = load("t3-machined")
    whole = everything(stated)
    damped, turned = harm(stated, "material-damping"), harm(stated, "large-rotation")
    assert damped.E_vib == pytest.approx(number(stated, "material-damping") * quick_impact(whole).E_vib)
    assert turned.E_vib == pytest.approx(2 * number(stated, "large-rotation") * quick_impact(whole).E_vib)
    assert turned.e == pytest.approx(turned.E_vib / normal_share(bodies(whole)))


def test_heating_is_weighed_by_the_rise_to_ignition():
    stated = load("t5b")
    assert number(stated, "contact-heating") == pytest.approx(
        expected_rise(bodies(everything(stated))) / 410.0
    )


def test_the_contact_is_that_of_its_own_approach():
    """A spin that brings the tip down as fast as a fall without it makes the same contact."""
    stated = load("t5b")
    d_c, d_d = arms(stated)
    spun = replace_all(stated, {"impact.omega": "-30 rad/s"})
    down, along = stated.impact.v_n - 30 * d_c, stated.impact.v_t + 30 * d_d
    fallen = replace_all(stated, {"impact.v_n": f"{down} m/s", "impact.v_t": f"{along} m/s"})
    assert contact_estimate(bodies(spun)) == pytest.approx(contact_estimate(bodies(fallen)))
    assert flash_bound(bodies(spun)) == pytest.approx(flash_bound(bodies(fallen)))
    assert contact_estimate(bodies(spun)).depth > 1.3 * contact_estimate(bodies(stated)).depth
    energy = start_energy(fallen) / start_energy(spun)
    assert normal_share(bodies(spun)) == pytest.approx(normal_share(bodies(fallen)) * energy)


def test_tip_radii_where_the_shape_ends():
    """A ball is round at its pole, a face is not; tip A's shoulder, beyond 60 degrees, is sharp."""
    ball = replace_all(load("t5b"), {"projectile.tip_radius": "9.5 mm", "impact.v_t": "0 m/s"})
    at = {angle: principal_radii(changed(ball, "impact.angle", angle)) for angle in ("0 deg", "1 deg")}
    assert at["0 deg"] == pytest.approx((9.5e-3, 9.5e-3))
    assert at["1 deg"] == pytest.approx(at["0 deg"])
    assert principal_radii(replace_all(load("t5b"), {"impact.angle": "0 deg"}))[1] == FLATTEST
    round_tip = replace_all(load("t5b"), {"projectile.tip": "A", "projectile.tip_radius": "7 mm"})
    assert principal_radii(changed(round_tip, "impact.angle", "59 deg"))[0] == 7e-3
    assert principal_radii(changed(round_tip, "impact.angle", "61 deg"))[0] == pytest.approx(0.019 / 200)


def test_expected_shares_of_the_run_time():
    """Every effect of the model has one; with the nose of the rigid rod they are the whole."""
    lean, full = (
        expected_shares(("friction", "barrier-rigid")),
        expected_shares(set(NAMES) - set(BARRIERS[:2])),
    )
    assert lean["barrier-rigid"] == 0.0 and lean["friction"] < 0.1
    assert 0.5 < sum(full.values()) < 1.0
    assert full["barrier-elastoplastic"] > full["radiation"]
    told = {choice.name: choice.share for choice in choices(load("t5b"))}
    assert {name for name in told if told[name] is None} == set(NAMES) - set(active(load("t5b")))


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
    }
