"""Flash temperatures: closed-form limits, sharing of heat, and the watch over a run."""

from dataclasses import replace
from math import erfc, exp, pi, sqrt

import numpy as np
import pytest
import solid_scenes

from fem_impact.case.case import Case
from fem_impact.case.effects.heating import halves
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown, known
from fem_impact.physics.flash import (
    Half,
    expected_rise,
    flash,
    flash_bound,
    moving_rise,
    short_rise,
)
from fem_impact.physics.hardening import rate_law, strain_rate
from fem_impact.run.heated import beyond_melting
from fem_impact.run.simulate import simulate
from fem_impact.run.solid import reduce
from fem_impact.scene.inputs import inputs, melting
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.shipped import replace as changed
from fem_impact.solid.heatwatch import loaded_area

STEEL = Half(53.0, 7850 * 440.0)
Q, A = 1e8, 1e-3


def bound_of(scene):
    bodies = Case(scene, "rigid").bodies
    return flash_bound(bodies.contact, scene.surface.friction, halves(bodies))


def rise_of(scene):
    bodies = Case(scene, "rigid").bodies
    return expected_rise(bodies.contact, scene.surface.friction, halves(bodies))


def test_resting_source():
    """A round even source: q a / k at its centre (Carslaw & Jaeger 10.5)."""
    assert moving_rise(Q, A, 0.0, STEEL) == pytest.approx(Q * A / 53.0, rel=1e-3)


def test_fast_source():
    """One-dimensional heating while the source passes, 2 a / V long."""
    V = 1e4 * STEEL.diffusivity / A
    passing = 2 * Q / 53.0 * sqrt(STEEL.diffusivity * (2 * A / V) / pi)
    assert moving_rise(Q, A, V, STEEL) == pytest.approx(passing, rel=1e-3)


def under_a_moving_disc(V, x):
    """Steady rise at x on the axis of an even disc moving along x, by adding up moving points.

    Each point leaves Q / (2 pi k r) exp(-V (r + x) / (2 kappa)) (Carslaw & Jaeger 10.7, eq 2); over the
    distance r the sum is closed, over the direction it is a mean.
    """
    theta = (np.arange(2000) + 0.5) * 2 * pi / 2000
    edge = x * np.cos(theta) + np.sqrt(A**2 - (x * np.sin(theta)) ** 2)
    decay = V / (2 * STEEL.diffusivity) * edge * (1 + np.cos(theta))
    return Q / 53.0 * np.mean(edge * -np.expm1(-decay) / decay)


@pytest.mark.parametrize("peclet", [0.01, 0.1, 1.0, 10.0, 100.0, 1000.0])
def test_moving_source_beside_the_exact_one(peclet):
    """The closed form fits the hottest point under the disc within 2.5 % at any speed."""
    V = peclet * 2 * STEEL.diffusivity / A
    hottest = max(under_a_moving_disc(V, x) for x in np.linspace(-0.999 * A, 0.0, 201))
    assert moving_rise(Q, A, V, STEEL) == pytest.approx(hottest, rel=0.025)


def middle_of_a_resting_disc(t):
    """Rise at the centre after a time of even flux (Carslaw & Jaeger 10.5, 7)."""
    reach = sqrt(STEEL.diffusivity * t)
    x = A / (2 * reach)
    spread = exp(-x * x) / sqrt(pi) - x * erfc(x)
    return 2 * Q * reach / 53.0 * (1 / sqrt(pi) - spread)


@pytest.mark.parametrize("seconds", [1e-4, 1e-2, 3e-2, 0.1, 1.0, 100.0])
def test_the_flash_is_never_below_the_exact_one(seconds):
    """The lower of two limits is above the true course; at worst, between them, by a third."""
    t = np.linspace(0.0, seconds, 2001)
    one = np.ones(2000)
    found = 2 * flash(t, Q * one, A * one, 0 * one, STEEL, STEEL).rise[-1]
    assert 1.0 - 1e-9 <= found / middle_of_a_resting_disc(seconds) < 1.34


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
    assert made.time_above(made.peak) == 0.0


@pytest.mark.parametrize("part", [0.5, 0.2, 0.1])
def test_the_time_above_a_temperature_holds_that_of_cooling(part):
    """Reported: it ended with the contact, where a patch ten times as hot takes 25 times as long to cool.

    Under an even flux until 1 the rise is sqrt(t), then sqrt(t) - sqrt(t - 1), part at (part + 1/part)^2 / 4.
    """
    t, q, a, V = np.linspace(0, 1e-5, 101), np.full(100, Q), np.full(100, A), np.zeros(100)
    made = flash(t, q, a, V, STEEL, STEEL)
    expected = 1e-5 * (0.25 * (part + 1 / part) ** 2 - part**2)
    assert made.time_above(part * made.peak) == pytest.approx(expected, rel=0.01)
    assert made.time_above(0.0) == pytest.approx(1e-5 * (1 + 1e6))


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
    result = solid_scenes.run(*effects, **changes)
    stated = result.case.scene
    watch = result.heat
    heat = float(np.array(watch.power) @ np.diff(watch.t))
    assert heat == pytest.approx(result.accounts["friction"], rel=0.01)  # the last window is still open
    found, size = reduce(result), result.case.bodies.estimate
    assert found.heat.patch == pytest.approx(pi * size.a_t * size.a_b, rel=0.35)
    # the blow turns the rod and the tip slides faster and faster
    last = abs(result.motion.V_t - result.motion.Omega * Case(stated).contact.arms[1])
    pushed = 2 * 0.2 * result.model.book.impulse[1]
    assert heat == pytest.approx(pushed * 0.5 * (6.0 + last), rel=0.1)
    assert np.average(watch.speed, weights=watch.power) == pytest.approx(heat / pushed, rel=0.15)
    assert "begins to melt" in found.heat.temperature.reason  # an elastic steel tip is pressed hard
    assert "did not finish" in found.heat.less_vibration.reason


def test_round_off_is_no_sliding_speed():
    """Without friction the heat is round-off of either sign."""
    effects = ("vibration", "friction", "barrier-elastic", "contact-heating")
    watch = solid_scenes.run(*effects, length=0.08, f=0.0, tip=1.6e-3, max_time=1.5e-4).heat
    assert min(watch.power) < 0 <= min(watch.speed)


def test_heat_does_not_act_on_the_motion():
    effects = ("vibration", "friction", "barrier-rigid")
    changes = {"length": 0.08, "tip": 1.6e-3, "max_time": 5e-5}
    plain = solid_scenes.run(*effects, **changes)
    watched = solid_scenes.run(*effects, "contact-heating", **changes)
    assert plain.heat is None
    assert watched.accounts == plain.accounts
    outcome = reduce(plain)
    assert outcome.heat.rise.reason.startswith("the contact-heating effect is off: effects = [")
    # a list without auto forces off what it does not name, and the outcome says so
    missed = {
        words.split()[0]
        for words in texts(outcome.validity.limitations)
        if "is left out by the scene" in words
    }
    assert missed == {"rod-plasticity", "barrier-elastoplastic", "rate-hardening"}
    # every effect that is on has its share of the run time, and only those
    shares = {choice.name: choice.share for choice in outcome.provenance.effect_choices}
    assert {name for name in shares if shares[name] is not None} == set(effects)
    assert 0.05 < shares["vibration"] < 1.0
    heated = reduce(watched).provenance
    assert next(0.0 < c.share < 0.5 for c in heated.effect_choices if c.name == "contact-heating")


def test_closed_form_of_the_rigid_fidelity():
    stated = replace(load("t5b"), effects=("auto", "contact-heating"))
    found = simulate(stated, "rigid")
    power = found.energy.friction * found.energy.E_0 / found.heat.power
    assert found.heat.flux * found.heat.patch == found.heat.power
    assert 5e-5 < power < 2e-4  # the contact time, s
    assert 100 < found.heat.rise < bound_of(stated)
    assert found.heat.temperature == found.heat.rise + 293.15
    assert any("Heat by closed form" in words for words in texts(found.validity.limitations, "model"))
    off = simulate(changed(load("t5b"), "effects", ["auto", "-contact-heating"]), "rigid")
    assert not any("Heat by closed form" in words for words in texts(off.validity.limitations, "model"))
    assert "above 1700 K, where plate-steel begins to melt" in found.heat.bound.reason
    assert 0.2 < rise_of(stated) / found.heat.rise < 5


def test_the_bound_by_hand():
    """Hardness of the plate, largest speed of sliding, all heat in the less effusive body.

    A leaning rod slides faster as the impact turns it than it came down, along and across.
    """
    stated = changed(load("t5b"), "heating.rod_conductivity", "20 W/(m K)")
    f, v = stated.surface.friction, Case.of(stated).bodies.contact.most_sliding
    assert v > abs(stated.impact.v_t) + abs(stated.impact.v_n)
    estimate = Case.of(stated).bodies.estimate
    pressure = 163 * 9.80665e6 / 0.927  # of the print of HV 163, above three times the ultimate stress
    assert pressure > 3 * 446e6
    pressure *= rate_law(stated.barrier.material).factor(strain_rate(estimate))
    alone = 2 * f * pressure * v * sqrt(3 * estimate.duration / (pi * 20.0 * 7850 * 440.0))
    assert bound_of(stated) == pytest.approx(alone)
    skinned = changed(stated, "barrier.material.skin", {"factor": 2.0, "depth": "0.05 mm"})
    skinned = changed(skinned, "projectile.material.skin", {"factor": 2.0, "depth": "0.05 mm"})
    assert bound_of(skinned) > 1.5 * bound_of(stated)


def test_expected_rise_of_a_hertzian_patch_by_hand():
    """Short beside the time that heat takes across the patch: a mean flux all the time, shared evenly."""
    stated = load("elastic-frictionless")
    stated = replace(
        stated,
        surface=replace(stated.surface, state="custom", friction=0.1, friction_low=0.0, friction_high=0.2),
        effects=("vibration", "friction", "barrier-rigid"),
        impact=replace(stated.impact, v_t=-1.0, omega=-2.0),
    )
    size = Case.of(stated).bodies.estimate
    pair, (d_c, d_d) = Case(stated).contact, Case(stated).contact.arms
    speed = abs(-1.0 + 2.0 * d_d - 2 * pair.approach * d_c * d_d / (pair.body.k2 + d_c**2))
    assert speed > abs(pair.sliding) == pytest.approx(abs(-1.0 + 2.0 * d_d))
    flux = 0.1 * size.pressure * 0.5 * speed
    shared = 2 * flux * sqrt(size.duration / pi) / (2 * sqrt(53.0 * 7850 * 440.0))
    assert rise_of(stated) == pytest.approx(shared, rel=0.02)


def test_heat_stays_for_a_while_when_the_source_is_gone():
    t, q = np.linspace(0, 1e-5, 11), np.concatenate([np.full(5, Q), np.zeros(5)])
    made = flash(t, q, np.full(10, A), np.zeros(10), STEEL, STEEL)
    assert made.rise[-1] == pytest.approx((sqrt(2.0) - 1) * made.peak, rel=1e-6)


@pytest.mark.parametrize(("melting", "resolved"), [("5200 K", True), ("700 K", False)])
def test_a_temperature_above_the_melting_point_is_not_resolved(melting, resolved):
    """Of the two bodies the one that melts first counts; conduction without latent heat is no bound there."""
    limits = {"heating.rod_melting": melting, "heating.barrier_melting": "5500 K", "surface.friction": 0.2}
    other = replace_all(load("t5b"), limits | {"effects": ["auto", "contact-heating"]})
    heat, bound = simulate(other, "rigid").heat, 293.15 + bound_of(other)
    assert 300.0 < heat.temperature < 700.0 < bound
    if resolved:
        assert heat.bound == pytest.approx(bound)
    else:
        assert f"gives {bound:.0f} K, above 700 K, where rod-steel begins to melt" in heat.bound.reason
    hot = simulate(changed(other, "heating.barrier_melting", "310 K"), "rigid").heat
    assert hot.rise == hot.temperature and "above 310 K, where plate-steel begins" in hot.rise.reason


def test_without_both_melting_points_no_bound_is_told():
    scene = replace_all(
        load("t5b"), {"projectile.material": "tungsten-heavy-alloy", "effects": ["auto", "contact-heating"]}
    )
    outcome = simulate(scene, "rigid")
    assert any("melting point of tungsten-heavy-alloy" in one.text for one in outcome.validity.limitations)
    told = outcome.heat
    assert told.temperature > 293.0 and told.bound.reason.endswith("state heating.rod_melting")


def test_melting_points_stand_beside_shipped_materials_with_their_sources():
    """A changed strength leaves them as they are; of an own material none is known."""
    other = {"projectile.material": "brass", "barrier.material.yield_stress": "300 MPa"}
    scene = replace_all(load("t5b"), other)
    assert melting(scene) == {"rod": ("brass", pytest.approx(1188.75)), "barrier": ("plate-steel", 1700.15)}
    table = inputs(scene)
    told = dict(zip(table.texts("input"), table.texts("source"), strict=True))
    assert "C26000 cartridge brass: solidus" in told["heating.rod_melting"]
    own = {"name": "mine", "E": "70 GPa", "nu": 0.33, "rho": "2700 kg/m3"}
    assert melting(changed(load("t5b"), "projectile.material", own)) == {"barrier": ("plate-steel", 1700.15)}


def test_a_stated_restitution_that_a_model_does_not_use_is_told():
    stated = changed(load("t5b"), "restitution", 0.5)
    for fidelity, told in (("modal", True), ("solid", True), ("rigid", False)):
        assert any("stated restitution 0.5" in one.text for one in Case(stated, fidelity).limitations) is told


def test_ignition_is_the_users():
    stated = changed(load("t5b"), "heating.ignition", "60 degC")
    assert stated.heating.ignition == pytest.approx(333.15)
    assert (
        simulate(replace(stated, effects=("auto", "contact-heating")), "rigid").heat.time_above_ignition > 0
    )


def test_rigid_theory_tells_no_temperature_of_an_edge_that_is_crushed():
    """A brass drift on granite: it told 335 K where finite elements melt the brass."""
    steel = replace_all(load("t5b"), {"surface.friction_high": 0.9})
    assert known(simulate(steel, "rigid").heat.temperature) > 300.0
    sharp = replace_all(steel, {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"})
    heat = simulate(sharp, "rigid").heat
    for value in (heat.temperature, heat.rise, heat.time_above_ignition):
        assert isinstance(value, Unknown) and "crushed" in value.reason
    assert known(heat.power) > 0.0


def of_hardness(name, number):
    """A material whose flow stress is that of its hardness test; it has no ultimate stress."""
    elastic = {"name": name, "E": "210 GPa", "nu": 0.3, "rho": "7850 kg/m3"}
    return elastic | {"yield_stress": "150 MPa", "hardness": number, "law": "hardness"}


def bound_of_hard_bodies(rod, barrier):
    own = {f"heating.{body}_{key}": value for body in ("rod", "barrier") for key, value in OWN_HEAT.items()}
    metals = {"projectile.material": of_hardness("a", rod), "barrier.material": of_hardness("b", barrier)}
    scene = replace_all(load("t5b"), own | metals)
    bodies = Case(scene, "rigid").bodies
    return bound_of(scene), bodies.contact, scene.surface.friction


OWN_HEAT = {"conductivity": "53 W/(m K)", "heat_capacity": "440 J/(kg K)"}


@pytest.mark.parametrize(("rod", "barrier"), [(300, 160), (160, 300), (160, 160)])
def test_without_an_ultimate_stress_the_hardness_of_the_softer_body_bounds_the_heat(rod, barrier):
    found, pair, f = bound_of_hard_bodies(rod, barrier)
    flux = f * 160 * 9.80665e6 / 0.927 * max(abs(pair.sliding) + pair.approach, pair.most_sliding)
    assert found == pytest.approx(2 * flux * sqrt(3 * pair.estimate.duration / pi) / STEEL.effusivity)


def test_a_hardness_below_three_times_the_ultimate_stress_does_not_lower_the_bound():
    low, lower, stated = (changed(load("t5b"), "barrier.material.hardness", n) for n in (100, 60, 163))
    assert bound_of(low) == bound_of(lower)
    assert (
        bound_of(stated)
        == bound_of(load("t5b"))
        == pytest.approx(bound_of(low) * 163 * 9.80665e6 / 0.927 / (3 * 446e6))
    )


def test_rigid_theory_says_that_the_heat_is_off_not_that_it_never_knows_it():
    scene = replace(load("t5b"), effects=("auto", "-contact-heating"))
    assert "contact-heating effect is off" in simulate(scene, "rigid").heat.temperature.reason


def test_a_closed_form_does_not_know_that_a_body_melts():
    """Reported: "at least 1673 K" by rigid theory, whose rise is 0.3 to 1.3 times that of finite elements."""
    hot = replace_all(load("t5b"), {"heating.rod_melting": "50 degC", "effects": ["auto", "contact-heating"]})
    told = simulate(hot, "rigid").heat.temperature
    assert beyond_melting(told) and told.reason.startswith("not resolved: conduction of heat alone gives")


def test_without_friction_no_effect_is_proposed_that_is_forced_already():
    """Reported: effects = ["auto", "contact-heating"] "turns it on", of a scene that states just that."""
    smooth = {"surface.state": "custom", "surface.source": "none", "surface.friction": 0.0}
    scene = replace_all(load("t5b"), {**smooth, "effects": ["auto", "contact-heating"]})
    assert simulate(scene, "rigid").heat.rise == Unknown("the friction effect is off, so that nothing rubs")


def test_heat_of_a_tip_that_sticks_by_rigid_theory_is_told_as_too_low():
    """Reported: 293 K of a bronze nose that sticks; finite elements have 13 % of E_0 of friction."""
    forced = replace_all(load("quick"), {"effects": ["auto", "contact-heating"], "surface.friction": 1.0})
    told = " ".join(one.text for one in simulate(forced, "rigid").validity.limitations)
    assert "or the give of a contact that sticks here, lets the tip slide" in told
