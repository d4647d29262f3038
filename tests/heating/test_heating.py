"""Flash temperatures: closed-form limits, sharing of heat, and the watch over a run."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
import solid_scenes

from fem_impact.estimates import arms, contact_estimate
from fem_impact.heating import Half, expected_rise, flash, flash_bound, moving_rise, short_rise
from fem_impact.reduce import reduce
from fem_impact.scene import load
from fem_impact.simulate import simulate
from fem_impact.solid.heatwatch import loaded_area

STEEL = Half(53.0, 7850 * 440.0)
Q, A = 1e8, 1e-3


def test_resting_source():
    """A round even source: q a / k at its centre (Carslaw & Jaeger 10.5)."""
    assert moving_rise(Q, A, 0.0, STEEL) == pytest.approx(Q * A / 53.0, rel=1e-3)


def test_fast_source():
    """One-dimensional heating while the source passes, 2 a / V long."""
    V = 1e4 * STEEL.diffusivity / A
    passing = 2 * Q / 53.0 * sqrt(STEEL.diffusivity * (2 * A / V) / pi)
    assert moving_rise(Q, A, V, STEEL) == pytest.approx(passing, rel=1e-3)


def test_short_rise_of_a_steady_flux_and_after_it():
    t = np.array([0.0, 1e-5, 4e-5, 1e-4])
    found = short_rise(t, np.array([Q, Q, 0.0]), STEEL)
    one = 2 * Q / sqrt(pi * 53.0 * 7850 * 440.0)
    assert found == pytest.approx(one * np.array([0, sqrt(1e-5), sqrt(4e-5), sqrt(1e-4) - sqrt(6e-5)]))


def test_a_short_flash_is_shared_by_effusivity():
    soft = Half(53.0 / 4, STEEL.capacity)
    t, q, a, V = np.linspace(0, 1e-5, 11), np.full(10, Q), np.full(10, A), np.zeros(10)
    alone = 2 * Q * sqrt(1e-5 / pi)
    made = flash(t, q, a, V, STEEL, soft)
    assert made.peak == pytest.approx(alone / (STEEL.effusivity + soft.effusivity))
    assert made.time_above(0.5 * made.peak) == pytest.approx(7.5e-6, abs=1.1e-6)
    assert made.time_above(made.peak) == 0.0


def test_a_long_flash_is_steady_and_less_on_the_moving_body():
    t, q, a = np.linspace(0, 10.0, 11), np.full(10, Q), np.full(10, A)
    resting = flash(t, q, a, np.zeros(10), STEEL, STEEL)
    assert resting.peak == pytest.approx(0.5 * Q * A / 53.0, rel=1e-3)
    assert flash(t, q, a, np.ones(10), STEEL, STEEL).peak < 0.5 * resting.peak


def test_area_that_a_pressure_needs():
    """An even pressure has its own area, Hertz' ellipse 8/9 of it."""
    area = np.full(400, 1e-8)
    assert loaded_area(area * 3e8, area) == pytest.approx(area.sum())
    r = (np.arange(2000) + 0.5) / 2000
    ring = 2 * pi * r / 2000
    assert loaded_area(np.sqrt(1 - r**2) * ring, ring) == pytest.approx(8 / 9 * pi, rel=1e-3)


@pytest.mark.parametrize(("barrier", "tip"), [("barrier-rigid", 0.4e-3), ("barrier-elastic", 0.8e-3)])
def test_the_watch_finds_all_heat_and_the_patch(barrier, tip):
    """An elastic sliding tip: the patch is near that of Hertz, the heat f J V."""
    effects = ("vibration", "friction", barrier, "large-rotation", "contact-heating")
    changes = {"length": 0.08, "f": 0.2, "angle": 0.8, "v_n": -6.0, "v_t": -6.0, "tip": tip, "max_time": 5e-5}
    result, stated = solid_scenes.run(*effects, **changes), solid_scenes.scene(*effects, **changes)
    watch = result.heat
    heat = float(np.array(watch.power) @ np.diff(watch.t))
    assert heat == pytest.approx(result.accounts["friction"], rel=0.01)  # the last window is still open
    found, size = reduce(stated, result), contact_estimate(stated)
    assert found["contact_patch_m2"] == pytest.approx(pi * size.a_t * size.a_b, rel=0.35)
    # the blow turns the rod and the tip slides faster and faster
    last = abs(result.motion.V_t - result.motion.Omega * arms(stated)[1])
    pushed = 2 * 0.2 * result.model.book.impulse[1]
    assert heat == pytest.approx(pushed * 0.5 * (6.0 + last), rel=0.1)
    assert np.average(watch.speed, weights=watch.power) == pytest.approx(heat / pushed, rel=0.15)
    assert found["flash_temperature_K"] == found["flash_rise_K"] + 293.15
    less = found["E_lt_edge_over_E_0"] - found["E_vib_over_E_0"]
    assert found["E_lt_less_vibration_over_E_0"] == pytest.approx(less)


def test_heat_does_not_act_on_the_motion():
    effects = ("vibration", "friction", "barrier-rigid")
    changes = {"length": 0.08, "tip": 1.6e-3, "max_time": 5e-5}
    plain = solid_scenes.run(*effects, **changes)
    watched = solid_scenes.run(*effects, "contact-heating", **changes)
    assert plain.heat is None
    assert watched.accounts == plain.accounts
    assert reduce(solid_scenes.scene(*effects, **changes), plain).reason("flash_rise_K") == (
        "the contact-heating effect is off"
    )


def test_closed_form_of_the_rigid_fidelity():
    stated = replace(load("t5b"), effects=("auto", "contact-heating"))
    found = simulate(stated, "rigid")
    power = found["W_friction_over_E_0"] * found["E_0_J"] / found["friction_power_W"]
    assert found["friction_flux_W_per_m2"] * found["contact_patch_m2"] == found["friction_power_W"]
    assert 5e-5 < power < 2e-4  # the contact time, s
    assert 100 < found["flash_rise_K"] < found["flash_bound_K"]
    assert found["flash_bound_K"] == pytest.approx(293.15 + flash_bound(stated))
    assert 0.2 < expected_rise(stated) / found["flash_rise_K"] < 5


def test_ignition_is_the_users():
    stated = load("t5b").replace("heating.ignition", "60 degC")
    assert stated.heating.ignition == pytest.approx(333.15)
    assert (
        simulate(replace(stated, effects=("auto", "contact-heating")), "rigid")["time_above_ignition_s"] > 0
    )
