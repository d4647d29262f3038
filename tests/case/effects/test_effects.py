"""Effects: what a scene does not name is not built; what it names is described; numbers by hand."""

import subprocess
import sys
from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.case.choose import neglected
from fem_impact.case.effects.registry import EFFECTS, NAMES
from fem_impact.case.zones import zones_of
from fem_impact.physics.beam import bending_period
from fem_impact.physics.contact_law import thornton
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.shipped import replace as changed
from fem_impact.scene.types import to_dict
from fem_impact.solid.build import build
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.elastic import Dashpots, ElasticBlock, ElasticRod, Weight
from fem_impact.solid.frame import FixedFrame, TurningFrame
from fem_impact.solid.yielding import YieldingZone


def scene(*effects, **accuracy):
    base = load("t5b")
    size = {"tip_size": 0.8e-3, "across": 6} | accuracy
    return replace(base, measured=None, effects=effects, accuracy=replace(base.accuracy, **size))


def model(*effects):
    stated = scene(*effects)
    return build(Case.of(stated))


def bodies(stated):
    return Case(stated).bodies


def kinds(items):
    return [type(item) for item in items]


def test_bare_model_has_nothing_to_spare():
    made = model("vibration", "barrier-rigid")
    assert kinds(made.forces) == [ElasticRod]
    assert kinds(made.impulses) == [PlaneContact]
    assert made.zones == []
    assert made.geometry.barrier is None
    assert len(made.layout.barrier) == 0
    assert isinstance(made.rod.frame, FixedFrame)
    assert not made.contact.f.any()
    assert made.layout.size == made.layout.free_size + 3 * made.geometry.rod.mesh.is_hanging.sum() + 24


@pytest.mark.parametrize(
    ("name", "item"), [("rod-plasticity", YieldingZone), ("gravity", Weight)], ids=["plasticity", "gravity"]
)
def test_an_effect_adds_its_item_alone(name, item):
    made = model("vibration", name, "barrier-rigid")
    assert kinds(made.forces) == [ElasticRod, item]
    assert kinds(made.impulses) == [PlaneContact]


def test_friction_reaches_the_contact():
    made = model("vibration", "friction", "barrier-rigid")
    assert (made.contact.f == load("t5b").surface.friction).all() and len(made.contact.f)


def test_large_rotation_changes_the_frame_alone():
    made = model("vibration", "barrier-rigid", "large-rotation")
    assert isinstance(made.rod.frame, TurningFrame)
    assert kinds(made.forces) == [ElasticRod]


YIELDING = ("yielding", "yielding_kernel", "plastic_return")
OF_ONE_EFFECT = ("heatwatch", "boundary", "rigid_rest", *YIELDING)
RUN = """
import sys
from dataclasses import replace
from fem_impact.case.case import Case
from fem_impact.case.zones import zones_of
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.run import solve

base = load("t5b")
size = replace(base.accuracy, tip_size=1.6e-3, across=6, max_time=2e-6)
solve(Case.of(replace(base, measured=None, effects=tuple(sys.argv[1:]), accuracy=size)))
print(*sys.modules)
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("effects", "imported"),
    [
        (("vibration", "barrier-rigid"), ()),
        pytest.param(
            ("friction", "barrier-elastoplastic", "contact-heating"),
            ("heatwatch", "boundary", "rigid_rest", *YIELDING),
            marks=pytest.mark.long,
        ),
    ],
)
def test_what_is_off_is_not_even_imported(effects, imported):
    done = subprocess.run([sys.executable, "-c", RUN, *effects], capture_output=True, text=True, check=True)
    loaded = {name.rpartition(".")[2] for name in done.stdout.split() if name.startswith("fem_impact.")}
    assert tuple(name for name in OF_ONE_EFFECT if name in loaded) == imported


def test_elastic_block_brings_no_yielding():
    made = model("vibration", "barrier-elastic")
    assert kinds(made.forces) == [ElasticRod, ElasticBlock]
    assert kinds(made.impulses) == [SurfaceContact]
    assert made.zones == []


def test_elastoplastic_block_yields_alone():
    made = model("vibration", "barrier-elastoplastic")
    assert [zone.body for zone in made.zones] == ["barrier"]
    yields = made.geometry.may_yield["barrier"]
    assert made.zones[0].count == yields.sum()
    assert made.geometry.barrier.finest[yields].all()


def test_both_bodies_yield_with_their_own_laws():
    made = model("vibration", "rod-plasticity", "barrier-elastoplastic")
    assert [zone.body for zone in made.zones] == ["rod", "barrier"]
    assert [zone.law.yield_stress for zone in made.zones] == [546e6, 320e6]


def test_coasting_leaves_the_rod_alone():
    made = model("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "gravity").coasting()
    assert [item.body for item in made.forces] == ["rod"] * 3
    assert list(made.impulses) == []


def test_waves_leave_only_where_radiation_is_on():
    made = model("vibration", "barrier-elastic", "radiation")
    assert kinds(made.impulses) == [Dashpots, SurfaceContact]


def test_rate_hardening_reaches_both_bodies():
    made = model("vibration", "rod-plasticity", "barrier-elastoplastic", "rate-hardening")
    # each by its own C, over its curve at the 0.002 per second of the tensile test
    factors = [[zone.rate.factor(rate) for rate in (1e-3, 2e-3, 1e3)] for zone in made.zones]
    assert factors[0] == pytest.approx([1, 1, (1 + 0.0134 * 6.9078) / (1 - 0.0134 * 6.2146)], rel=1e-4)
    assert factors[1] == pytest.approx([1, 1, (1 + 0.022 * 6.9078) / (1 - 0.022 * 6.2146)], rel=1e-4)
    assert [zone.rate for zone in model("vibration", "rod-plasticity", "barrier-rigid").zones] == [None]


def numbers(stated):
    return {choice.name: choice.number for choice in Case(stated).choices}


def test_every_effect_of_the_scenes_is_told():
    assert tuple(EFFECTS) == NAMES
    for set_id in ("t5b", "elastic-frictionless"):
        stated = load(set_id)
        for told in Case(stated).choices:
            assert told.on == (told.name in Case(stated).active)
            assert told.forced == ("auto" not in stated.effects)
            effect = EFFECTS[told.name]
            assert told.sentence == (effect.sentence if told.on else effect.absence)


def test_numbers_of_a_scene():
    stated = load("t5b")
    number = numbers(stated)
    assert number["friction"] == pytest.approx(0.57)
    soft = [(1 - 0.29**2) / E for E in (219e9, 206e9)]
    assert number["barrier-elastic"] == pytest.approx(soft[1] / sum(soft))
    # friction brings first yield to the surface, at 1/(sqrt(3) f); 450 MPa is what the plate can hold
    limit = 2.8 * stated.barrier.material.ultimate_stress
    assert number["rod-plasticity"] == pytest.approx(limit / (546e6 / (sqrt(3) * 0.57)))
    assert number["barrier-elastoplastic"] > 3
    # the short rod's first bending frequency is 12 340 Hz (Rayleigh-Ritz)
    assert bending_period(stated.projectile) == pytest.approx(1 / 12340, rel=0.01)
    assert bending_period(load("t3-machined").projectile) == pytest.approx(1 / 1526.3, rel=0.01)
    assert number["vibration"] == pytest.approx(
        bending_period(stated.projectile) / bodies(stated).estimate.duration
    )
    assert number["gravity"] == pytest.approx(9.8 * 190e-6 / 2.11, rel=0.3)


def test_e_of_thornton():
    """Continuous at the yield speed; slope -1/4 far above it; .306 at 2.11 m/s of 5.9 mm/s (see Thornton)."""
    assert thornton(1.0) == 1.0
    assert thornton(1.0001) == pytest.approx(1.0, abs=1e-3)
    assert thornton(2e6) / thornton(1e6) == pytest.approx(2**-0.25, rel=1e-3)


# ---------------------------------------------------------------- choice


def chosen(scene, **impact):
    stated = replace(scene, effects=("auto",), impact=replace(scene.impact, **impact), measured=None)
    return set(Case(stated).active)


def test_a_scene_without_effects_is_auto():
    data = to_dict(load("t5b"))
    del data["effects"]
    stated = read_dict(data)
    assert stated.effects == ("auto",)
    assert {"vibration", "friction", "rod-plasticity", "barrier-elastoplastic"} <= set(Case(stated).active)
    assert changed(stated, "impact.v_n", "-3 m/s").effects == ("auto",)


def test_each_effect_goes_off_where_its_number_is_small():
    base = load("t5b")
    slow = chosen(base, v_n=-1e-4, v_t=-1e-4)
    assert not {"rod-plasticity", "barrier-elastoplastic", "rate-hardening"} & slow
    assert {"barrier-elastic", "gravity"} <= slow
    assert "radiation" not in slow
    assert {"radiation", "rate-hardening"} <= chosen(base, v_n=-20.0, v_t=-1.0)
    assert "gravity" not in chosen(base)
    upright = chosen(base, angle=0.0, v_t=0.0)
    assert "large-rotation" not in upright
    assert "friction" in upright
    slippery = replace(base.surface, state="custom", friction=0.001, friction_low=0.0)
    assert "friction" not in chosen(replace(base, surface=slippery))


def test_a_hard_stiff_barrier_is_rigid():
    base = load("t5b")
    hard = replace(
        base.barrier.material, name="hard", E=1e13, yield_stress=9e10, ultimate_stress=9e10, rho=3000
    )
    barrier = replace(base.barrier, material=hard)
    light = replace(base.projectile, material=replace(base.projectile.material, E=70e9))
    made = chosen(replace(base, projectile=light, barrier=barrier))
    assert "barrier-rigid" in made
    assert "radiation" not in made
    # 2.1 % of the compliance
    assert "barrier-elastic" in chosen(replace(base, barrier=barrier))


def test_forced_effects_are_kept_and_missed_ones_named():
    stated = replace(load("t5b"), effects=("auto", "gravity", "barrier-elastic", "-friction"))
    assert {"gravity", "barrier-elastic"} <= set(Case(stated).active)
    assert "friction" not in Case(stated).active
    assert "rate-hardening" in Case(stated).active  # the rod still yields
    forced = {choice.name for choice in Case(stated).choices if choice.forced}
    assert forced == {"gravity", "friction", "barrier-rigid", "barrier-elastic", "barrier-elastoplastic"}
    said = neglected(Case(stated).choices)
    assert len(said) == 2
    assert said[0].startswith("friction is left out by the scene although")
    assert said[1].startswith("barrier-elastoplastic is left out")
    assert said[0].endswith("f is 0.57, above 0.005.")


def test_a_stronger_barrier_than_needed_is_no_neglect():
    quiet = replace(load("t5b").impact, v_n=-1e-4, v_t=-1e-4)
    stated = replace(load("t5b"), effects=("auto", "barrier-elastoplastic"), impact=quiet, measured=None)
    assert "barrier-elastoplastic" in Case(stated).active
    assert neglected(Case(stated).choices) == ()


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
    R1, R2 = Case(stated).contact.principal_radii
    assert (R1, R2) == pytest.approx((9.5e-3, 9.5e-3), rel=2e-3)
    E_star = bodies(stated).contact.modulus
    assert E_star == pytest.approx(210e9 / (2 * (1 - 0.29**2)))
    found, sphere = bodies(stated).estimate, 4 / 3 * pi * 9.5e-3**3 * 7850
    share = bodies(stated).contact.effective_mass / sphere
    # depth and time of the sphere, scaled by the mass that this rod has at its contact
    depth = (1575.7 / (4 / 3 * E_star * sqrt(9.5e-3))) ** (2 / 3)
    assert found.depth == pytest.approx(depth * share**0.4, rel=2e-3)
    assert found.duration == pytest.approx(65.82e-6 * share**0.4, rel=2e-3)
    assert found.a_t == pytest.approx(0.461e-3 * share**0.2, rel=3e-3)
    force = 1575.7 * share**0.6
    assert found.pressure == pytest.approx(force / (pi * found.a_t * found.a_b), rel=3e-3)


def test_rigid_barrier_has_no_compliance():
    stated = scene("vibration", "barrier-rigid")
    assert bodies(stated).contact.modulus == pytest.approx(219e9 / (1 - 0.29**2))


def test_effective_mass_of_a_push_beside_the_centre():
    stated = scene("vibration", "barrier-rigid")
    m, k2, d_c = 0.178, 5.6e-4, 0.0217
    assert bodies(stated).contact.effective_mass == pytest.approx(m / (1 + d_c**2 / k2), rel=0.03)
    upright = replace(stated, impact=replace(stated.impact, angle=0.0))
    assert bodies(upright).contact.effective_mass < 0.18


def test_a_soft_plate_limits_the_pressure():
    stated = load("t5b")
    found = bodies(stated).estimate
    assert found.pressure == pytest.approx(2.8 * 320e6)
    work = pi * found.pressure * sqrt(np.prod(Case(stated).contact.principal_radii)) * found.depth**2
    assert work == pytest.approx(0.5 * bodies(stated).contact.effective_mass * stated.impact.v_n**2)
    slow = replace(stated, impact=replace(stated.impact, v_n=-1e-3))
    assert bodies(slow).estimate.pressure < 2.8 * 320e6


def test_edge_radii_of_profile_b():
    """The 3 mm edge at 45 degrees has principal radii 3 and 12.2 mm."""
    assert Case(load("t5b")).contact.principal_radii == pytest.approx((3e-3, 12.2e-3), rel=5e-3)


SHARP = {
    "projectile.tip": "plain",
    "projectile.tip_radius": "0 mm",
    "projectile.length": "200 mm",
    "impact.height": "1 m",
}


@pytest.mark.parametrize("angle", [8, 20, 45])
def test_a_sharp_edge_is_pressed_in_as_the_parabola_that_is_as_wide(angle):
    stated = replace_all(load("t5b"), SHARP | {"impact.angle": f"{angle} deg"})
    found, tangent = bodies(stated).estimate, np.tan(np.radians(angle))
    assert 2 * found.a_t == pytest.approx(found.depth * (1 / tangent + tangent), rel=1e-5)
    assert found.a_t == pytest.approx(sqrt(2 * found.R1 * found.depth))
    assert found.shift == pytest.approx(0.5 * found.depth * (1 / tangent - tangent), abs=1e-9, rel=1e-5)
    work = pi * found.pressure * sqrt(found.R1 * found.R2) * found.depth**2
    assert work == pytest.approx(0.5 * bodies(stated).contact.effective_mass * stated.impact.v_n**2)
    zones = zones_of(bodies(stated))
    low, high = zones.whole
    assert zones.half[0] >= 2.2 * 2.0 * found.a_t  # steel flows along the flanks of an edge
    assert low[0] < -found.depth / tangent and high[0] > found.depth * tangent


@pytest.mark.parametrize("angle", [-1, 1, 2, 5])
def test_what_is_pressed_in_of_a_face_that_leans_is_as_wide_as_its_chord(angle):
    """Its rim was taken to be no flatter than 10.5 diameters: 0.6 of the chord at 1 degree."""
    slow = {"impact.height": "10 mm", "impact.angle": f"{angle} deg"}
    case = bodies(replace_all(load("t5b"), SHARP | slow))
    found, lean = case.estimate, abs(np.radians(angle))
    assert not case.contact.all_may_touch
    assert 2 * found.R2 * found.depth == pytest.approx(2 * 9.5e-3 * found.depth / np.sin(lean))


@pytest.mark.parametrize("name", ["t2", "t4", "t5d", "t6-17", "t6-60", "t3-machined-tip-a"])
def test_the_measured_tips_are_pressed_in_as_round_as_they_are(name):
    found = bodies(load(name)).estimate
    assert (found.R1, found.R2, found.shift) == (*Case(load(name)).contact.principal_radii, 0.0)


def test_a_face_that_nearly_lies_flat_keeps_the_estimate_of_its_edge():
    flat = replace_all(load("t5b"), {"impact.angle": "0.5 deg"})
    found = bodies(flat).estimate
    assert (found.R1, found.shift) == (3e-3, 0.0)
    assert zones_of(bodies(flat)).reach[0] > 0.012
