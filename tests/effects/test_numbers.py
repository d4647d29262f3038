"""The numbers that decide on effects: beside what they stand for, or by hand."""

from dataclasses import replace
from math import log, pi, sqrt

import numpy as np
import pytest

from fem_impact.effects import EFFECTS, choices, everything
from fem_impact.effects.plasticity import DEEP, thornton
from fem_impact.effects.radiation import number as radiated
from fem_impact.effects.rotation import angle_turned
from fem_impact.effects.share import expected_shares
from fem_impact.effects.vibration import bending_period, left_by_pulse, stretching_period, vibration_share
from fem_impact.estimates import arms, contact_estimate, effective_mass, projectile, start_energy
from fem_impact.heating import expected_rise
from fem_impact.scene import BARRIERS, NAMES, load
from fem_impact.solid.march import evaluate
from fem_impact.verify.reference.hertz import radiated_share


def number(stated, name):
    return next(choice.number for choice in choices(stated) if choice.name == name)


@pytest.mark.parametrize("x", [0.1, 0.6, 0.999999, 1.3])
def test_amplitude_left_by_a_half_sine_pulse(x):
    """Of an oscillator of circular frequency 1 after a push of unit area over the time pi x."""
    t = (np.arange(20_000) + 0.5) * pi * x / 20_000
    push = np.sin(t / x) / (2 * x)
    left = abs(np.sum(push * np.exp(1j * t))) * pi * x / 20_000
    assert left_by_pulse(x) == pytest.approx(left, rel=1e-5)


@pytest.mark.parametrize("x", np.linspace(1.5, 12, 40))
def test_no_longer_pulse_leaves_more_than_the_envelope(x):
    t = (np.arange(20_000) + 0.5) * pi * x / 20_000
    left = abs(np.sum(np.sin(t / x) * np.exp(1j * t))) * pi / 2 / 20_000
    assert left <= left_by_pulse(x) * (1 + 1e-6)


def test_vibration_share_by_hand():
    """A blow of 1.5 m* v_n on the mass-normalised ends, 2 of the bending, sqrt 2 of the stretching mode."""
    stated = replace(load("elastic-frictionless"), effects=("vibration", "barrier-elastic"))
    tau, m = contact_estimate(stated).duration, projectile(stated).mass
    impulse = 1.5 * effective_mass(stated) * 1.5 * sqrt(0.5)
    bent = 2 * impulse * left_by_pulse(2 * tau / bending_period(stated))
    stretched = sqrt(2) * impulse * left_by_pulse(2 * tau / stretching_period(stated))
    assert stretching_period(stated) == pytest.approx(2 * 0.24 / sqrt(219e9 / 7850))
    assert vibration_share(stated) == pytest.approx((bent**2 + stretched**2) / (2 * m) / start_energy(stated))


def test_false_energy_of_a_turned_rod():
    """The finite elements in a frame that stays, turned as a rigid body by as much as the number assumes."""
    import solid_scenes

    effects = ("vibration", "barrier-rigid")
    stated, model = solid_scenes.scene(*effects, length=0.06), solid_scenes.model(*effects, length=0.06)
    theta, state = angle_turned(stated), model.initial_state()
    rod = np.unique(model.layout.rod.reshape(-1, 3), axis=0)
    t, n = state.x[rod[:, 0]], state.x[rod[:, 2]]
    state.x[rod[:, 0]] = np.cos(theta) * t + np.sin(theta) * n
    state.x[rod[:, 2]] = np.cos(theta) * n - np.sin(theta) * t
    evaluate(model, state)
    false = 2 * model.forces[0].accounts(state)["strain_rod"]
    assert number(stated, "large-rotation") == pytest.approx(false / start_energy(stated), rel=0.02)


def test_angle_turned_by_hand():
    stated = load("elastic-frictionless").replace("impact.omega", "-20 rad/s")
    rod, (d_c, _) = projectile(stated), arms(stated)
    Omega = 2 * 1.5 * d_c / (rod.k2 + d_c**2)
    lasting = contact_estimate(stated).duration + bending_period(stated)
    assert angle_turned(stated) == pytest.approx((Omega + 20) * lasting)


def test_first_yield_under_a_sphere():
    """Largest shear on the axis of Hertz' contact at nu = 0.3, for a peak pressure of one."""
    z = np.linspace(0.01, 3, 3000)
    along = -1 / (1 + z**2)
    around = -1.3 * (1 - z * np.arctan(1 / z)) + 0.5 / (1 + z**2)
    assert 1 / np.max(np.abs(along - around)) == pytest.approx(DEEP, rel=0.01)


def test_first_yield_with_friction_and_its_cap():
    """A gentle touch is Hertz'; the other body holds no more than 2.8 of its ultimate stress."""
    stated = load("t5b").replace("impact.v_n", "-0.001 m/s").replace("surface.friction", 0.5)
    elastic = replace(stated, effects=("vibration", "friction", "barrier-elastic"))
    peak = 1.5 * contact_estimate(elastic).pressure
    assert number(stated, "barrier-elastoplastic") == pytest.approx(peak * sqrt(3) * 0.5 / 320e6)
    slippery = replace(stated, effects=("auto", "-friction"))
    assert number(slippery, "barrier-elastoplastic") < number(stated, "barrier-elastoplastic")


def test_radiated_share_is_that_of_hunter():
    """Held to Lamb's integral in the tests of the references."""
    stated = load("t5b")
    c0 = sqrt(206e9 / 7850)
    assert radiated(stated) == pytest.approx(radiated_share(abs(stated.impact.v_n), c0))


def test_gain_by_the_rate_by_hand():
    """Strain 0.2 a/R of the indentation in half the contact, C ln(rate); nothing below 1 per second."""
    stated = load("t5b")
    whole = replace(stated, effects=tuple(n for n in NAMES if n not in BARRIERS[:2]))
    size, R = contact_estimate(whole), sqrt(3e-3 * 12.2e-3)
    rate = 0.2 * sqrt(size.a_t * size.a_b) / R / (size.duration / 2)
    assert number(stated, "rate-hardening") == pytest.approx(0.022 * log(rate), rel=1e-3)
    assert number(stated.replace("impact.v_n", "-1e-7 m/s"), "rate-hardening") == 0.0


def test_damped_share_and_fall_by_hand():
    stated = load("t5b")
    whole = replace(stated, effects=tuple(n for n in NAMES if n not in BARRIERS[:2]))
    tau, T1 = contact_estimate(whole).duration, bending_period(whole)
    assert number(stated, "material-damping") == pytest.approx(2 * pi * 6e-4 * (tau + T1) / T1)
    speed = np.hypot(stated.impact.v_n, stated.impact.v_t)
    assert number(stated, "gravity") == pytest.approx(9.80665 * (tau + T1) / speed)


# ---------------------------------------------------------------- what leaving an effect out changes


def harm(stated, name):
    return next(choice.harm for choice in choices(stated) if choice.name == name)


@pytest.mark.parametrize(("f", "sideways"), [(0.4, 0.6), (0.9, 0.2)])
def test_friction_takes_the_side_push_but_for_a_fifth(f, sideways):
    """At 45 degrees the bending force is 1 - f of the frictionless one, at least a fifth."""
    plain = replace(load("elastic-frictionless"), effects=("vibration", "barrier-elastic"))
    surface = replace(plain.surface, state="custom", friction=f, friction_low=0.0, friction_high=1.0)
    rough = replace(plain, surface=surface, effects=("vibration", "friction", "barrier-elastic"))

    def bending(stated):
        tau, m = contact_estimate(stated).duration, effective_mass(stated)
        blow = 1.5 * m * 1.5 * sqrt(0.5)
        stretched = sqrt(2) * blow * left_by_pulse(2 * tau / stretching_period(stated))
        bent = sqrt(
            2 * projectile(stated).mass * start_energy(stated) * vibration_share(stated) - stretched**2
        )
        return bent / (2 * blow * left_by_pulse(2 * tau / bending_period(stated)))

    assert bending(plain) == pytest.approx(1.0)
    assert bending(rough) == pytest.approx(sideways)


def test_vibration_costs_its_share_of_the_normal_energy():
    stated = load("t5b")
    lost, whole = harm(stated, "vibration"), everything(stated)
    normal = 0.5 * effective_mass(whole) * stated.impact.v_n**2 / start_energy(whole)
    assert lost.E_vib == vibration_share(whole)
    assert lost.e == pytest.approx(lost.E_vib / normal)
    assert harm(stated, "barrier-elastic").e == pytest.approx(
        lost.e * 1.6 * number(stated, "barrier-elastic")
    )


def test_plasticity_costs_what_thornton_says():
    stated = load("t5b")
    lost = harm(stated, "barrier-elastoplastic")
    assert lost.e == pytest.approx(1 - thornton(number(stated, "barrier-elastoplastic") ** 2.5))
    assert 0.2 < lost.e < 1.0
    assert lost.E_vib == pytest.approx(lost.e * vibration_share(everything(stated)))


def test_friction_changes_the_effective_mass():
    stated = load("t5b")
    (d_c, d_d), k2 = arms(stated), projectile(stated).k2
    assert harm(stated, "friction").e == pytest.approx(0.57 * d_c * d_d / (k2 + d_c**2))


def test_rates_change_e_by_five_eighths_of_their_gain():
    stated = load("t5b")
    most = max(number(stated, "rod-plasticity"), number(stated, "barrier-elastoplastic"))
    expected = 0.625 * number(stated, "rate-hardening") * thornton(most**2.5)
    assert harm(stated, "rate-hardening").e == pytest.approx(expected)


def test_large_rotation_changes_little_where_friction_keeps_the_rod_from_turning():
    """Measured on t5b by `study effects`: 2e-5 of e and 4e-6 of E_0."""
    lost = harm(load("t5b"), "large-rotation")
    assert 2e-6 < lost.e < 2e-4 and 4e-7 < lost.E_vib < 4e-5
    assert harm(load("t5b").replace("surface.friction", 0.0), "large-rotation").E_vib > 100 * lost.E_vib


def test_heating_is_weighed_by_the_rise_to_ignition():
    stated = load("t5b")
    assert number(stated, "contact-heating") == pytest.approx(expected_rise(everything(stated)) / 410.0)


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
    assert {name for name in told if told[name] is None} == set(NAMES) - set(load("t5b").active)


def test_thresholds_are_those_that_the_page_names():
    assert {name: effect.threshold for name, effect in EFFECTS.items()} == {
        "vibration": 0.1,
        "friction": 0.005,
        "rod-plasticity": 1.0,
        "barrier-rigid": 0.02,
        "barrier-elastic": 0.02,
        "barrier-elastoplastic": 1.0,
        "rate-hardening": 0.03,
        "radiation": 0.01,
        "gravity": 0.005,
        "large-rotation": 1e-5,
        "material-damping": 0.05,
        "contact-heating": 0.1,
    }
