"""The local contact: Hertz, Thornton's law, a sliding and sticking sphere."""

from dataclasses import replace
from math import inf, pi, sqrt

import numpy as np
import pytest

from fem_impact.modal.impact import plastic_work, reach
from fem_impact.modal.march import (
    ALONE,
    HARDEST,
    MOST_CONTACTS,
    PEAK,
    RIGID,
    WORK_N,
    WORK_T,
    Bounds,
    Start,
    drop,
)
from fem_impact.physics.contact import projectile
from fem_impact.physics.contact_law import ContactLaw, contact_law, restitution
from fem_impact.plan.plan import plan
from fem_impact.scene.shipped import load

NU, R = 0.29, 9.5e-3
MASS = 4 / 3 * pi * R**3 * 7850
E_STAR = 210e9 / 2 / (1 - NU**2)
HERTZ = 4 / 3 * E_STAR * sqrt(R)


def law_of(scene):
    return contact_law(plan(scene, "modal").bodies)


def law(f=0.0, limit=inf):
    shear = 4 * 210e9 / (2 * (1 + NU)) / (2 - NU)
    depth = (pi * limit / (2 * E_STAR)) ** 2 * R
    return ContactLaw(R, E_STAR, limit, HERTZ, depth, HERTZ * depth**1.5, pi * limit * R, shear, f)


def strike(contact, v_n, v_t=0.0, omega=0.0, steps=1000):
    """Let a sphere strike; return motion, works, largest depth and force, contacts."""
    start = Start(MASS, 0.4 * R**2, 0.0, 0.0, R, v_t, -v_n, omega, 0.0, 0.0)
    contacts = np.zeros((MOST_CONTACTS, 4))
    bounds = Bounds(60e-6 / v_n**0.2 / steps, 1e-4, 1e-3, reach(contact, 0.5 * MASS * v_n**2))
    end = drop(start, contact, RIGID, ALONE, bounds, contacts)
    assert end.over
    works, most = end.tally[[WORK_N, WORK_T]], end.tally[[PEAK, HARDEST]]
    return end.motion.rigid[:3], works, most, contacts[: end.touches]


@pytest.mark.parametrize(("v", "force", "duration"), [(1.0, 1575.7, 65.82e-6), (4.0, 8317.0, 49.89e-6)])
def test_hertz(v, force, duration):
    motion, _, (_, peak), contacts = strike(law(), v)
    assert motion[0] == pytest.approx(v, rel=1e-6)
    assert peak == pytest.approx(force, rel=1e-3)
    assert contacts[0, 1] - contacts[0, 0] == pytest.approx(duration, rel=5e-3)
    assert contacts[0, 2] == pytest.approx(2 * MASS * v, rel=1e-3)


@pytest.mark.parametrize(("psi", "after"), [(0.5, 0.052), (1.0, -0.050), (2.0, -0.820), (3.5, -1.477)])
def test_a_sphere_sticks_and_turns_back(psi, after):
    """Maw, Barber & Fawcett: the printed annuli are coarse, the springs are not."""
    f = 0.3
    unit = f * (2 - NU) / (2 * (1 - NU))
    (_, V_t, Omega), _, _, _ = strike(law(f), 1.0, -psi * unit)
    assert -(V_t - Omega * R) / unit == pytest.approx(after, abs=0.012)


def test_a_sphere_that_slides_throughout_has_the_ratio_of_its_friction():
    (V_n, V_t, _), works, _, contacts = strike(law(0.1), 1.0, -3.0)
    assert (V_t + 3.0) / (V_n + 1.0) == pytest.approx(0.1, rel=1e-4)
    assert contacts[0, 3] / contacts[0, 2] == pytest.approx(0.1, rel=1e-4)
    exact = 0.5 * MASS * (9.0 - V_t**2) - 0.5 * 0.4 * MASS * R**2 * (0.1 * 2 / (0.4 * R)) ** 2
    assert -works[1] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("v", [0.2, 1.0, 5.0])
def test_thornton_by_march_and_in_closed_form(v):
    contact = law(limit=1e9)
    motion, works, (peak, _), _ = strike(contact, v)
    assert motion[0] / v == pytest.approx(restitution(contact, MASS, v), rel=1e-4)
    assert -works[0] == pytest.approx(plastic_work(contact, peak), rel=1e-4)


def test_what_does_not_yield_loses_nothing():
    assert restitution(law(limit=1e9), MASS, 1e-3) == 1.0
    assert restitution(law(), MASS, 100.0) == 1.0
    assert plastic_work(law(), 1e-3) == 0.0


def test_thornton_of_the_short_rod():
    """The 0.08 m rod at 45 degrees, plate of 320 MPa, effective mass with f = 0.6."""
    scene = load("t5b")
    contact = law_of(scene)
    assert contact.R == pytest.approx(6.05e-3, rel=1e-3)
    assert contact.limit == pytest.approx(2.8 * 320e6)
    rod = projectile(scene)
    d_c, d_d = map(float, rod.arms(pi / 4))
    mass = rod.mass / (1 + d_c * (d_c - 0.6 * d_d) / rod.k2)
    found = [restitution(contact, mass, v / sqrt(2)) for v in (1.31, 2.11, 4.23, 6.09)]
    assert found == pytest.approx([0.345, 0.306, 0.257, 0.235], rel=0.01)


def test_effects_choose_the_law():
    scene = load("t5b")
    elastic = replace(scene, effects=("vibration", "barrier-elastic"))
    rigid = replace(scene, effects=("vibration", "friction", "rod-plasticity", "barrier-rigid"))
    assert (law_of(elastic).limit, law_of(elastic).friction) == (inf, 0.0)
    assert law_of(rigid).limit == pytest.approx(2.8 * 546e6)
    assert law_of(rigid).E_star == pytest.approx(219e9 / (1 - 0.29**2))
    assert law_of(rigid).shear / law_of(elastic).shear == pytest.approx(2, rel=0.05)
    mindlin = 2 * (1 - NU) / (2 - NU)  # tangential over normal stiffness
    assert law_of(rigid).shear == pytest.approx(mindlin * 2 * law_of(rigid).E_star)
    assert law_of(rigid).friction == 0.57
