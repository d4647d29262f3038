"""Impacts to either side, on the side and up the slope: mirror images and closed forms."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from own_bodies import box, write

from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.simulate import simulate
from fem_impact.answers.verdict.vibration import inclined
from fem_impact.case.case import Case
from fem_impact.case.zones import zones_of
from fem_impact.errors import SceneError
from fem_impact.outcome.keys import Unknown
from fem_impact.scene.impact import Impact
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load
from fem_impact.scene.shipped import replace as changed

ROD = {"length": "60 mm", "diameter": "19 mm", "tip": "plain", "material": "rod-steel"}
ELASTIC = ["vibration", "barrier-rigid"]
TURNED = ("V_t", "Omega")
KEPT = ("V_n", "mass", "k_squared", "gamma")


def scene(projectile, angle, v_t=0.0, omega=0.0, effects=ELASTIC, **more):
    return read_dict(
        {
            "id": "any",
            "projectile": projectile,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "custom", "friction": 0.3, "source": "chosen for a test"},
            "impact": {
                "angle": f"{angle} deg",
                "v_n": "-1 m/s",
                "v_t": f"{v_t} m/s",
                "omega": f"{omega} rad/s",
            },
            "effects": effects,
            "save": {"frames": 0, "strain_samples": 0},
            **more,
        }
    )


def mirrored(stated):
    impact, barrier = stated.impact, stated.barrier
    return replace(
        stated,
        impact=replace(impact, angle=-impact.angle, v_t=-impact.v_t, omega=-impact.omega),
        barrier=replace(barrier, v_t=-barrier.v_t, centre_offset=-barrier.centre_offset),
    )


def check_mirrored(one, other, rel, share=1e-12):
    """Hold two outcomes to each other as mirror images: all numbers but those along t are equal.

    ``share`` is by how much shares of the energy may differ.
    """
    motion, image = one.motion, other.motion
    for name in KEPT:
        assert getattr(image, name) == pytest.approx(getattr(motion, name), rel=rel), name
    for name in TURNED:
        assert getattr(image, name) == pytest.approx(-getattr(motion, name), rel=rel), name
    edge, its = one.restitution.edge, other.restitution.edge
    assert other.restitution.mu == pytest.approx(-one.restitution.mu, rel=rel)
    assert (its.d_c, its.d_d, its.e) == pytest.approx((-edge.d_c, edge.d_d, edge.e), rel=rel)
    assert numbers(other.energy) == pytest.approx(numbers(one.energy), rel=rel, abs=share)


def numbers(group):
    """Return the known numbers of a group but its round-off."""
    held = {name: getattr(group, name) for name in type(group).__dataclass_fields__ if name != "residual"}
    return {name: value for name, value in held.items() if not isinstance(value, Unknown)}


SCENES = ("t5b", "t3-machined-tip-a", "ogive", "tube", "spinning-rod", "free-barrier-5kg", "moving-barrier")


@pytest.mark.long
@pytest.mark.parametrize("fidelity", ["rigid", "modal"])
@pytest.mark.parametrize("name", SCENES)
def test_the_mirror_image_of_a_scene_has_the_mirror_image_as_its_outcome(name, fidelity):
    stated = replace(load(name), measured=None)
    check_mirrored(simulate(stated, fidelity), simulate(mirrored(stated), fidelity), rel=1e-12)


def test_a_barrier_that_turns_is_mirrored_with_its_offset():
    turning = {"mass": "5 kg", "inertia": "0.02 kg m2", "centre_depth": "30 mm", "centre_offset": "12 mm"}
    stated = scene({**ROD, "tip": "B", "tip_radius": "3 mm"}, 40, -0.5, 8.0, ["auto"])
    stated = replace(stated, barrier=read_dict(_barrier(turning)).barrier)
    one, other = (simulate(either, "modal") for either in (stated, mirrored(stated)))
    check_mirrored(one, other, rel=1e-12)
    assert other.barrier.Omega_b == pytest.approx(-one.barrier.Omega_b, rel=1e-12)
    assert abs(one.barrier.Omega_b) > 0.1


def _barrier(turning):
    from fem_impact.scene.types import to_dict

    stated = to_dict(scene(ROD, 40))
    return {**stated, "barrier": {"material": "plate-steel", **turning}}


def test_zones_of_one_mesh_are_mirrored():
    stated = replace(load("t5b"), measured=None)
    pressed = changed(stated, "impact.angle", "2 deg")
    for one in (stated, pressed):
        zones, image = (zones_of(Case(s).bodies) for s in (one, mirrored(one)))
        assert (image.reach, image.along) == (zones.reach[::-1], zones.along[::-1])
        low, high = zones.barrier_boxes[-1]
        assert np.array(image.barrier_boxes[-1])[:, 0] == pytest.approx([-high[0], -low[0]])
        assert image.half == zones.half
    assert zones_of(Case(pressed).bodies).reach[0] > 0


def test_a_tip_that_slides_up_the_slope_has_the_closed_form():
    """Friction acts down the slope all the time: one impulse with mu = -f, energetic restitution e."""
    e, f, v_t = 0.6, 0.3, 4.0
    stated = scene(
        {**ROD, "tip": "B", "tip_radius": "3 mm"},
        30,
        v_t,
        restitution=e,
        effects=["friction", "barrier-rigid"],
    )
    body = stated.projectile.rigid_body
    d_c, d_d = map(float, body.arms(radians(30.0)))
    P = (1 + e) / (1 + d_c * (d_c + f * d_d) / body.k2)
    found = simulate(stated, "rigid")
    assert found.restitution.mu == pytest.approx(-f)
    assert found.motion.V_n == pytest.approx(-1 + P)
    assert found.motion.V_t == pytest.approx(v_t - f * P)
    assert found.motion.Omega == pytest.approx((d_c + f * d_d) * P / body.k2)


@pytest.mark.parametrize("angle", [90, -90])
def test_a_rod_that_lands_on_its_side_bounces_without_turning(angle):
    stated = scene(ROD, angle, restitution=0.7)
    found = simulate(stated, "rigid")
    assert found.restitution.edge.d_c == pytest.approx(0, abs=1e-15)
    assert found.restitution.edge.d_d == pytest.approx(9.5e-3)
    assert (found.motion.V_n, found.motion.V_t) == pytest.approx((0.7, 0.0), abs=1e-14)
    assert found.motion.Omega == pytest.approx(0, abs=1e-12)


def test_a_side_that_lands_asks_for_levels_or_a_restitution_or_the_reduced_model():
    stated = scene(ROD, 90)
    assert Case.of(stated, "modal")
    with pytest.raises(SceneError, match=r"straight side.*or state restitution"):
        Case.of(stated, "rigid")
    with pytest.raises(SceneError, match=r"on several meshes \(accuracy\.levels above 1\)"):
        Case.of(changed(stated, "accuracy.levels", 1), "solid")
    assert Case.of(replace(stated, restitution=0.5), "rigid")
    assert LevelChain(Case(stated)).meshes.pilot


@pytest.mark.parametrize("way", ["height", "speed"])
def test_a_rod_that_moves_along_the_barrier_is_refused(way):
    stated = {"angle": "-90 deg", way: {"height": "1 m", "speed": "1 m/s"}[way]}
    with pytest.raises(SceneError, match=f"moves along it never strikes.*Give v_n and v_t in place of {way}"):
        read_dict(_impact(stated))


def _impact(table):
    from fem_impact.scene.types import to_dict

    return {**to_dict(scene(ROD, 40)), "impact": table}


def test_another_inclination_may_turn_the_velocity_up_the_slope():
    stated = replace(load("t5b"), measured=None, impact=Impact(pi / 4, -1.0, -0.2))
    turned = inclined(stated, radians(5.0)).impact
    assert turned.v_t > 0
    assert np.hypot(turned.v_n, turned.v_t) == pytest.approx(np.hypot(1.0, 0.2))


# finite elements, on coarse meshes


COARSE = {"levels": 2, "tip_size": "1.2 mm", "unresolved": "report"}


@pytest.mark.long
def test_finite_elements_mirror_an_impact_to_round_off():
    rod = {**ROD, "tip": "B", "tip_radius": "3 mm"}
    stated = scene(rod, 45, -0.4, 20.0, ["friction", *ELASTIC], accuracy=COARSE)
    one, other = simulate(stated, "solid"), simulate(mirrored(stated), "solid")
    check_mirrored(one, other, rel=1e-7, share=1e-9)


def test_a_mesh_and_its_mirror_image_strike_as_mirror_images(tmp_path):
    points, cells = box(4, 2, 8, (-6e-3, 0, 0), (6e-3, 6e-3, 40e-3))
    points[:, 0] += 0.15 * points[:, 2]  # it leans, and has no plane of symmetry across x
    image = cells[:, [1, 0, 3, 2, 5, 4, 7, 6]]
    bodies = [
        {"mesh": str(write(tmp_path / f"{name}.vtu", points * [side, 1, 1], which)), "material": "rod-steel"}
        for name, side, which in (("one", 1, cells), ("other", -1, image))
    ]
    effects, coarse = ["friction", *ELASTIC], {**COARSE, "tip_size": "2 mm"}
    stated = [
        scene(body, side * 35, side * -0.4, side * 9, effects, accuracy=coarse, restitution=0.8)
        for body, side in zip(bodies, (1, -1), strict=True)
    ]
    check_mirrored(*(simulate(one, "rigid") for one in stated), rel=1e-12)
    # the highest modes that are kept are known to about 1e-5 of their energy
    check_mirrored(*(simulate(one, "solid") for one in stated), rel=1e-7, share=2e-6)


@pytest.mark.parametrize("effects", [ELASTIC, ["auto"]])
def test_a_rod_on_its_side_touches_all_along_and_does_not_turn(effects):
    chain = LevelChain(Case(scene(ROD, 90, effects=effects, accuracy=COARSE)))
    found = chain.run()
    touched = chain.done[-1].record.rod.touched
    assert (touched[:, 2].min(), touched[:, 2].max()) == pytest.approx((0, 60e-3), abs=1e-6)
    assert found.motion.V_n > 0.6
    assert abs(found.motion.Omega) < 0.05 * found.motion.V_n / 60e-3
