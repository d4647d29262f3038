"""Faces and sides that land flat, and bodies on two equal places, in the reduced model."""

from dataclasses import replace
from math import atan2, exp, pi, sqrt

import pytest

from fem_impact.case.case import Case
from fem_impact.modal.impact import solve
from fem_impact.outcome.groups import texts
from fem_impact.physics.contact_law import flow_law
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

STIFF = ("friction", "barrier-elastic")
ELASTIC = ("vibration", "friction", "barrier-elastic")
PLAIN = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}
LENGTH, RADIUS = 0.08, 9.5e-3


def scene_of(angle, *changes, v_n=-1.5, effects=None):
    fall = {"impact.angle": f"{angle} deg", "impact.v_n": f"{v_n} m/s", "impact.v_t": "0 m/s"}
    whole = {key: value for change in changes for key, value in change.items()}
    scene = replace_all(load("t5b"), fall | whole)
    return replace(scene, effects=effects) if effects else scene


def land(*args, **kwargs):
    case = Case.of(scene_of(*args, **kwargs), "modal")
    return case, solve(case)


@pytest.mark.parametrize("effects", [STIFF, ELASTIC, None], ids=["stiff", "elastic", "yielding"])
@pytest.mark.parametrize("shape", [{}, PLAIN], ids=["round edge", "sharp edge"])
def test_a_symmetric_body_that_lands_on_its_face_does_not_turn(shape, effects):
    _, found = land(0, shape, effects=effects)
    (site,) = found.sites
    assert abs(found.Omega) < 1e-6 and abs(found.V_t) < 1e-8
    assert found.finished and abs(found.residual) < 1e-5 * found.E_0
    assert site.low_t + site.high_t == pytest.approx(-2 * (RADIUS - (0 if shape else 3e-3)), abs=1e-9)
    if effects == STIFF:  # what does not come back left as waves
        assert found.waves == pytest.approx(found.E_0 - 0.5 * found.rod.mass * found.V_n**2, rel=1e-5)


@pytest.mark.parametrize(
    ("angle", "stiffness"), [(0, 2 * RADIUS), (90, pi / 4 * LENGTH), (-90, pi / 4 * LENGTH)]
)
def test_a_flat_part_is_a_linear_spring_of_the_printed_stiffness(angle, stiffness):
    """Half a period of the rod's mass on 2 a E* (flat punch) or pi/4 E* L (lying cylinder: Popov 2010)."""
    heavy = {"barrier.mass": "1e6 kg"}  # a barrier with a mass of its own is no half-space: no waves leave
    case, found = land(angle, PLAIN, heavy, effects=("barrier-elastic",))
    duration = pi * sqrt(found.rod.mass / (stiffness * case.contact.modulus))
    assert found.contacts[0, 1] - found.contacts[0, 0] == pytest.approx(duration, rel=0.01)
    assert (found.V_n, found.Omega) == (pytest.approx(1.5, rel=1e-5), pytest.approx(0.0, abs=1e-6))


def test_a_stiff_face_on_a_half_space_bounces_off_a_spring_and_a_dashpot():
    """A mass on spring and dashpot leaves where its acceleration ends, at exp(-zeta w t) of its speed.

    Spring and dashpot of a rigid disc on a half-space: 2 a E / (1 - nu^2) and 3.4 a^2 sqrt(rho G) / (1 - nu)
    (Lysmer and Richart 1966).
    """
    stiff = {"projectile.material.E": "10000 GPa", "barrier.material.E": "20 GPa"}
    case, found = land(0, PLAIN, stiff, effects=("barrier-elastic",))
    plate, m = case.contact.barrier, found.rod.mass
    spring = 2 * RADIUS * plate.E / (1 - plate.nu**2)
    shear = plate.E / (2 * (1 + plate.nu))
    dashpot = 3.4 * RADIUS**2 * sqrt(plate.rho * shear) / (1 - plate.nu)
    zeta = dashpot / (2 * sqrt(spring * m))
    turned = atan2(2 * zeta * sqrt(1 - zeta**2), 2 * zeta**2 - 1)
    assert found.V_n == pytest.approx(1.5 * exp(-zeta / sqrt(1 - zeta**2) * turned), rel=1e-2)
    assert abs(found.residual) < 1e-5 * found.E_0


def test_a_long_rod_that_lands_on_its_side_bends_and_does_not_turn():
    _, found = land(90, PLAIN, effects=ELASTIC)
    assert abs(found.Omega) < 0.5 and found.vibration > 0.1 * found.E_0
    assert abs(found.residual) < 1e-5 * found.E_0


def test_a_side_that_yields_lands_flat_too():
    """It pressed into the groove of one end, which threw that up: e was -.5 and the spin 202 rad/s."""
    copper = {"barrier.material": "copper", "impact.v_n": "-3 m/s"}
    _, found = land(90, PLAIN, copper)
    assert abs(found.Omega) < 0.5 and found.V_n > 0.0
    assert abs(found.residual) < 1e-5 * found.E_0


def test_a_dumb_bell_lands_on_two_places_at_once():
    """Two round bulges of one height: nothing lies between them, and each takes half of the impulse."""
    bulges = [["0 mm", "6 mm"], ["10 mm", "10 mm"], ["20 mm", "6 mm"], ["60 mm", "6 mm"], ["70 mm", "10 mm"]]
    points = [*bulges, ["80 mm", "6 mm"]]
    bell = {"projectile": {"material": "rod-steel", "profile": points}}
    _, found = land(90, bell, effects=STIFF)
    one, other = found.sites
    assert one.impulse_n == pytest.approx(other.impulse_n, rel=1e-6)
    assert other.low_t - one.low_t == pytest.approx(60e-3, abs=1e-6)
    assert (found.V_n, found.Omega) == (pytest.approx(1.5, rel=1e-5), pytest.approx(0.0, abs=1e-5))


@pytest.mark.parametrize("angle", [0.05, 89.97])
@pytest.mark.parametrize("effects", [ELASTIC, None], ids=["elastic", "yielding"])
def test_what_lands_nearly_flat_closes_its_books_and_is_its_mirror_image(angle, effects):
    _, found = land(angle, PLAIN, effects=effects)
    _, mirrored = land(-angle, PLAIN, effects=effects)
    impulse = sum(site.impulse_n for site in found.sites)
    assert impulse == pytest.approx(found.rod.mass * (found.V_n + 1.5), rel=1e-9)
    assert abs(found.residual) < 2e-5 * found.E_0
    assert (mirrored.V_n, mirrored.V_t, mirrored.Omega) == pytest.approx(
        (found.V_n, -found.V_t, -found.Omega), rel=1e-6, abs=1e-9
    )


def test_the_cells_under_a_round_edge_of_a_leaning_face_begin_free_of_force():
    """On a line through both ends of the face those beyond would begin pressed in: 1.1e-5 of E_0."""
    _, found = land(0.1, v_n=-3.0)
    assert found.laid and abs(found.residual) < 1e-6 * found.E_0


def test_a_fast_face_yields_as_a_column():
    """At 40 m/s on a plate that bears three times its flow stress, Tabor's: the rod yields all over first."""
    case, found = land(0, PLAIN, v_n=-40.0)
    assert found.plastic > 0.2 * found.E_0 and abs(found.residual) < 1e-4 * found.E_0
    law = flow_law(case.contact, case.slots.rod_law, case.slots.barrier_law)
    assert law.other_yield_stress < 3 * law.yield_stress
    assert found.force == pytest.approx(law.other_yield_stress * pi * RADIUS**2, rel=0.01)
    strong = {"projectile.material.yield_stress": "2 GPa", "projectile.material.ultimate_stress": "2.1 GPa"}
    case, found = land(0, PLAIN, strong, v_n=-40.0)
    law = flow_law(case.contact, case.slots.rod_law, case.slots.barrier_law)
    assert found.force == pytest.approx(3 * law.yield_stress * pi * RADIUS**2, rel=0.01)


def test_the_face_of_the_measured_rod_rebounds_as_by_finite_elements():
    """e .886 +- .030 by finite elements with the effect radiation; by the law of its round edge .67."""
    outcome = simulate(scene_of(0), "modal")
    assert outcome.restitution.edge.e == pytest.approx(0.886, abs=0.03)
    assert "what lands flat" in " ".join(texts(outcome.validity.limitations, "model"))
    assert "a dashpot for the waves that it sends" in " ".join(texts(outcome.validity.limitations, "model"))
    inclined = texts(simulate(scene_of(45), "modal").validity.limitations, "model")
    assert "lands flat" not in " ".join(inclined)


@pytest.mark.parametrize("angle", [5, 15, 30, 40])
def test_a_round_nose_that_sinks_deep_into_rubber_stays_one(angle):
    """Its arc and the short cone beside it lay within the dent, and landed flat: e fell from .83 to .03."""
    nose = {"projectile.tip": "A", "projectile.tip_radius": "10 mm", "projectile.diameter": "20 mm"}
    soft = {"barrier.material": "natural-rubber", "surface.state": "custom", "surface.friction": 0.5}
    _, found = land(angle, nose, soft | {"surface.source": "assumed"}, v_n=-1.93)
    assert found.finished and not found.laid
    scene = scene_of(angle, nose, soft | {"surface.source": "assumed"}, v_n=-1.93)
    assert 0.65 < simulate(scene, "modal").restitution.edge.e < 0.85


CONE = {
    "id": "cone",
    "projectile": {
        "shape": "cone",
        "length": "90 mm",
        "diameter": "16 mm",
        "cone_angle": "35 deg",
        "face_diameter": "5 mm",
        "material": "s235",
    },
    "barrier": {"material": "aluminium-6061-t6"},
    "surface": {"state": "custom", "friction": 0.25, "source": "assumed"},
}


@pytest.mark.long
@pytest.mark.parametrize(
    "angle, e, force",
    [(0.6, 0.798, 8676.0), (1.0, 0.726, 7484.0), (2.0, 0.604, 5868.0), (5.0, 0.456, 4080.0)],
)
def test_a_face_on_a_cone_bears_more_than_a_column_and_lands_flat_at_any_small_angle(angle, e, force):
    """By finite elements. As a column it had e 0.44, and from 0.7 degrees on it was no face."""
    impact = {"angle": f"{angle} deg", "v_n": "-2 m/s", "v_t": "-0.3 m/s"}
    outcome = simulate(load({**CONE, "impact": impact}), "modal")
    assert outcome.restitution.edge.e == pytest.approx(e, abs=0.05)
    assert outcome.contact.peak_force == pytest.approx(force, rel=0.2)


@pytest.mark.parametrize(
    ("speed", "friction", "e", "force", "vibration"),
    [(1, 0.1, 0.78, 2590, 0.021), (2, 0.3, 0.637, 6650, 0.109)],
)
def test_a_square_edge_that_hardly_leans_rebounds_as_by_finite_elements(speed, friction, e, force, vibration):
    """A pin of brass, 60 x 16 mm, at 1 degree: e was 0.67 and 0.58, and the force 0.87 and 0.81 of theirs."""
    pin = {"projectile.length": "60 mm", "projectile.diameter": "16 mm", "projectile.material": "brass"}
    found = simulate(scene_of(1, PLAIN | pin, {"surface.friction": friction}, v_n=-speed), "modal")
    assert found.estimate("e_edge")[0] == pytest.approx(e, abs=0.045)
    assert found.estimate("peak_force_N")[0] == pytest.approx(force, rel=0.12)
    assert found.estimate("E_vib_over_E_0")[0] == pytest.approx(vibration, abs=0.013)
