"""Bending of a plate: its impedance, Zener's number and equation, and the widths that are refused."""

import re
from math import pi, sqrt

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.case.effects.barrier import compliance_share
from fem_impact.errors import SceneError
from fem_impact.evidence.references.hertz import zener_impact
from fem_impact.modal.impact import drop_round
from fem_impact.modal.motion import SUM, Bounds, Start
from fem_impact.outcome.groups import texts
from fem_impact.physics.contact_law import contact_law, flow_law
from fem_impact.physics.plate import contact_time, least_span, plate_impedance, zener_number
from fem_impact.scene.shipped import load, replace_all

ZENER = {0.05: (0.9178, 3.247, 1.087), 0.3: (0.6059, 3.429, 0.871), 1.0: (0.1841, 4.388, 0.556)}
PLATE = {"barrier.thickness": "10 mm", "barrier.support": "infinite"}


def stated(**changes):
    return replace_all(load("quick"), PLATE | changes)


def test_the_impedance_is_that_of_the_driven_infinite_plate():
    """The response to a harmonic point force, an integral over wave numbers, is 1 / (8 sqrt(D rho h))."""
    E, nu, rho, h, w = 70e9, 0.3, 2700.0, 5e-3, 2e4 * (1 - 1e-3j)
    D = E * h**3 / (12 * (1 - nu**2))
    k = np.linspace(0.0, 3000.0, 300_001)
    response = 1j * w * np.trapezoid(k / (D * k**4 - rho * h * w**2), k) / (2 * pi)
    assert abs(response) * plate_impedance(E, nu, rho, h) == pytest.approx(1.0, abs=3e-3)


@pytest.mark.parametrize("number", ZENER)
def test_zeners_equation_gives_the_published_kind_of_curve(number):
    found = zener_impact(number)
    assert (found.restitution, found.duration, found.peak) == pytest.approx(ZENER[number], abs=6e-4)


@pytest.mark.parametrize("number", ZENER)
def test_the_reduced_model_obeys_zeners_equation(number):
    bodies = Case(load("elastic-frictionless")).bodies
    law, flow = contact_law(bodies.contact), flow_law(bodies.contact, None, None)
    m, v, exact = 0.1, 1.0, zener_impact(number)
    T = (m / (law.stiffness * sqrt(v))) ** 0.4
    start = Start(m, 1.0, plate_mobility=number * T / m)
    end = drop_round(start, law, flow, (-v, 0.0, 0.0), Bounds(T / 300, T, 1.0), 0.0)
    assert end.now.rigid[0] == pytest.approx(exact.restitution * v, abs=1e-3)
    assert end.tally[SUM.force] == pytest.approx(exact.peak * law.stiffness * (v * T) ** 1.5, rel=2e-3)
    kept = 0.5 * m * end.now.rigid[0] ** 2 + end.tally[SUM.plate]
    assert kept == pytest.approx(0.5 * m * v**2, rel=1e-5)


def test_a_plate_that_is_not_thick_beside_the_contact_is_told():
    """What a half-space gives deeper than h: its strain under a point force, integrated from there."""

    def told(thickness):
        planned = Case.of(replace_all(load("plate-10mm"), {"barrier.thickness": thickness}), "modal")
        found = [
            sentence for sentence in texts(planned.limitations, "range", "model") if "half-space" in sentence
        ]
        return planned, found[0] if found else ""

    assert told("20 mm")[1] == ""
    planned, sentence = told("5 mm")
    size, steel, h = planned.estimate, planned.scene.barrier.material, 5e-3
    a, nu = sqrt(size.a_t * size.a_b), steel.nu
    z = np.geomspace(h, 1e4 * h, 20_001)
    strain = (3 - 2 * nu * (2 * nu - 1) / 2) / (2 * pi * steel.E * z**2)  # of 1 N, on the axis
    whole = 3 * (1 - nu**2) / (4 * steel.E * a)
    share = 100 * np.trapezoid(strain, z) / whole
    words = f"{2e3 * a:.2g} mm wide, {2 * a / h:.2g} of the plate's thickness.* gives {share:.2g} % of its"
    assert re.search(words, sentence)
    assert f"e may be off by some {0.5 * share * compliance_share(planned.bodies):.2g} %" in sentence


def test_zeners_number_falls_as_the_square_of_the_thickness():
    thin, thick = (zener_number(Case(stated(**{"barrier.thickness": h})).contact) for h in ("5 mm", "10 mm"))
    assert thin == pytest.approx(4 * thick, rel=1e-12)


def test_a_plate_bends_where_that_matters_and_radiates_no_more():
    active = Case.of(stated(), "modal").active
    assert "plate-bending" in active and "radiation" not in active
    assert "plate-bending" not in Case.of(stated(**{"barrier.thickness": "150 mm"}), "modal").active
    assert "plate-bending" not in Case.of(load("quick"), "modal").active


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"barrier.thickness": "1 mm"}, r"barrier.thickness = .*less than the width of the contact"),
        ({"barrier.span": "100 mm"}, r"barrier.span = .*waves are back.*at least 3\d\d mm"),
        ({"effects": ["auto", "radiation"]}, r"barrier.support = .*plate-bending, not radiation"),
        ({"barrier.mass": "5 kg"}, r"barrier.mass: is that of a free body"),
    ],
)
def test_a_plate_that_the_model_does_not_hold_is_refused(changes, said):
    with pytest.raises(SceneError, match=said):
        Case.of(stated(**changes), "modal")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"barrier.support": "infinite"}, r"barrier.thickness: is missing"),
        ({"barrier.support": "loose"}, r'Use "backed" or "infinite"'),
        ({"barrier.span": "1 m"}, r"barrier.span: means nothing"),
        ({"barrier.mass": "5 kg", "barrier.boundary": "fixed"}, r"barrier.boundary: holds the barrier"),
        ({"barrier.v_n": "-2 m/s"}, r"impact.v_n = .* is 0.4976 m/s as seen from the barrier"),
        ({"effects": ["auto", "plate-bending"]}, r'names "plate-bending", but the barrier does not bend'),
    ],
)
def test_a_barrier_that_is_stated_badly_is_refused(changes, said):
    with pytest.raises(SceneError, match=said):
        Case.of(replace_all(load("quick"), changes), "modal")


def test_the_least_span_is_that_of_the_group_speed_at_the_end_of_the_main_lobe():
    bodies = Case(stated()).bodies
    steel, h, tau = bodies.scene.barrier.material, 10e-3, contact_time(bodies.contact)
    k = np.linspace(1.0, 500.0, 200_001)
    omega = np.sqrt(steel.E * h**2 / (12 * (1 - steel.nu**2) * steel.rho)) * k**2
    speed = np.interp(3 * pi / tau, omega, np.gradient(omega, k))
    assert least_span(bodies.contact) == pytest.approx(speed * tau, rel=1e-4)
