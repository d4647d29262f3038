"""Effects: what a scene does not name is not built; what it names is described; numbers by hand."""

from dataclasses import replace
from math import pi, sqrt, tan

import numpy as np
import pytest

from fem_impact.effects import EFFECTS, describe, specify
from fem_impact.estimates import contact_estimate, contact_modulus, effective_mass, principal_radii
from fem_impact.scene import load
from fem_impact.scene.effect_names import NAMES
from fem_impact.solid.build import build
from fem_impact.solid.contact import PlaneContact, SurfaceContact
from fem_impact.solid.elastic import Dashpots, ElasticBlock, ElasticRod, Weight
from fem_impact.solid.frame import FixedFrame, TurningFrame
from fem_impact.solid.yielding import YieldingZone


def scene(*effects, **accuracy):
    base = load("t5b")
    size = {"tip_size": 0.8e-3, "across": 6} | accuracy
    return replace(base, measured=None, effects=effects, accuracy=replace(base.accuracy, **size))


def model(*effects):
    stated = scene(*effects)
    return build(stated, specify(stated))


def kinds(items):
    return [type(item) for item in items]


def test_bare_model_has_nothing_to_spare():
    made = model("vibration", "barrier-rigid")
    assert kinds(made.forces) == [ElasticRod]
    assert kinds(made.impulses) == [PlaneContact]
    assert made.zones == []
    assert made.geometry.barrier is None
    assert len(made.layout.barrier) == 0
    assert isinstance(made.forces[0].frame, FixedFrame)
    assert made.impulses[0].f == 0.0
    assert made.layout.size == made.layout.free_size + 3 * made.geometry.rod.mesh.is_hanging.sum() + 24


@pytest.mark.parametrize(
    ("name", "item"), [("rod-plasticity", YieldingZone), ("gravity", Weight)], ids=["plasticity", "gravity"]
)
def test_an_effect_adds_its_item_alone(name, item):
    made = model("vibration", name, "barrier-rigid")
    assert kinds(made.forces) == [ElasticRod, item]
    assert kinds(made.impulses) == [PlaneContact]


def test_friction_reaches_the_contact():
    assert model("vibration", "friction", "barrier-rigid").impulses[0].f == load("t5b").surface.friction


def test_large_rotation_changes_the_frame_alone():
    made = model("vibration", "barrier-rigid", "large-rotation")
    assert isinstance(made.forces[0].frame, TurningFrame)
    assert kinds(made.forces) == [ElasticRod]


def test_elastic_block_brings_its_boundary_and_no_yielding():
    made = model("vibration", "barrier-elastic")
    assert kinds(made.forces) == [ElasticRod, ElasticBlock]
    assert kinds(made.impulses) == [Dashpots, SurfaceContact]
    assert made.zones == []


def test_elastoplastic_block_yields_alone():
    made = model("vibration", "barrier-elastoplastic")
    assert [zone.body for zone in made.zones] == ["barrier"]
    barrier = made.geometry.barrier
    assert made.zones[0].count == (barrier.level == barrier.level.max()).sum()


def test_both_bodies_yield_with_their_own_laws():
    made = model("vibration", "rod-plasticity", "barrier-elastoplastic")
    assert [zone.body for zone in made.zones] == ["rod", "barrier"]
    assert [zone.law[0] for zone in made.zones] == [546e6, 320e6]


def test_coasting_leaves_the_rod_alone():
    made = model("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "gravity").coasting()
    assert [item.body for item in made.forces] == ["rod"] * 3
    assert list(made.impulses) == []


def test_every_effect_of_the_scenes_is_described():
    assert tuple(EFFECTS) == NAMES or set(EFFECTS) == set(NAMES)
    for set_id in ("t5b", "elastic-frictionless"):
        stated = load(set_id)
        rows = describe(stated)
        assert {row[0] for row in rows} == set(NAMES)
        for name, on, measure, number, sentence in rows:
            assert on == (name in stated.effects)
            assert measure
            assert np.isfinite(number) or number == float("inf")
            assert sentence == (EFFECTS[name].sentence if on else EFFECTS[name].absence)


def test_numbers_of_a_scene():
    stated = load("t5b")
    number = {name: value for name, _, _, value, _ in describe(stated)}
    assert number["friction"] == pytest.approx(0.57 / tan(stated.impact.angle))
    soft = [(1 - 0.29**2) / E for E in (219e9, 206e9)]
    assert number["barrier-elastic"] == pytest.approx(soft[1] / sum(soft))
    assert number["rod-plasticity"] / number["barrier-elastoplastic"] == pytest.approx(320 / 546)
    assert number["rod-plasticity"] > 5
    # Euler-Bernoulli, 13 % above the exact 12 340 Hz of the short rod
    period = number["vibration"] * contact_estimate(stated).duration
    assert 1 / period == pytest.approx(1.13 * 12340, rel=0.06)
    assert 0 < number["gravity"] < 1e-2
    assert 1e-4 < number["large-rotation"] < 0.1


# ---------------------------------------------------------------- estimates


def test_hertz_sphere():
    """R = 9.5 mm, E = 210 GPa both, nu .29: at 1 m/s 1575.7 N, 65.82 us, a = 0.461 mm."""
    base = scene("vibration", "barrier-elastic")
    steel = replace(base.projectile.material, E=210e9, nu=0.29)
    rod = replace(base.projectile, tip="B", tip_radius=9.5e-3, material=steel, length=0.019)
    stated = replace(
        base,
        projectile=rod,
        barrier=replace(base.barrier, material=steel),
        impact=replace(base.impact, angle=pi / 4, v_n=-1.0, v_t=0.0),
    )
    R1, R2 = principal_radii(stated)
    assert (R1, R2) == pytest.approx((9.5e-3, 9.5e-3), rel=2e-3)
    E_star = contact_modulus(stated)
    assert E_star == pytest.approx(210e9 / (2 * (1 - 0.29**2)))
    found, sphere = contact_estimate(stated), 4 / 3 * pi * 9.5e-3**3 * 7850
    share = effective_mass(stated) / sphere
    # depth and time of the sphere, scaled by the mass that this rod has at its contact
    depth = (1575.7 / (4 / 3 * E_star * sqrt(9.5e-3))) ** (2 / 3)
    assert found.depth == pytest.approx(depth * share**0.4, rel=2e-3)
    assert found.duration == pytest.approx(65.82e-6 * share**0.4, rel=2e-3)
    assert found.a_t == pytest.approx(0.461e-3 * share**0.2, rel=3e-3)
    force = 1575.7 * share**0.6
    assert found.pressure == pytest.approx(force / (pi * found.a_t * found.a_b), rel=3e-3)


def test_rigid_barrier_has_no_compliance():
    assert contact_modulus(scene("vibration", "barrier-rigid")) == pytest.approx(219e9 / (1 - 0.29**2))


def test_effective_mass_of_a_push_beside_the_centre():
    stated = scene("vibration", "barrier-rigid")
    m, k2, d_c = 0.178, 5.6e-4, 0.0217
    assert effective_mass(stated) == pytest.approx(m / (1 + d_c**2 / k2), rel=0.03)
    upright = replace(stated, impact=replace(stated.impact, angle=0.0))
    assert effective_mass(upright) < 0.18


def test_a_soft_plate_limits_the_pressure():
    stated = load("t5b")
    found = contact_estimate(stated)
    assert found.pressure == pytest.approx(2.8 * 320e6)
    work = pi * found.pressure * sqrt(np.prod(principal_radii(stated))) * found.depth**2
    assert work == pytest.approx(0.5 * effective_mass(stated) * stated.impact.v_n**2)
    slow = replace(stated, impact=replace(stated.impact, v_n=-1e-3))
    assert contact_estimate(slow).pressure < 2.8 * 320e6


def test_edge_radii_of_profile_b():
    """The 3 mm edge at 45 degrees has principal radii 3 and 12.2 mm."""
    assert principal_radii(load("t5b")) == pytest.approx((3e-3, 12.2e-3), rel=5e-3)
