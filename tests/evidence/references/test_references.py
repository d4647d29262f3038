"""Every reference against a number that is printed elsewhere, before it judges the solver."""

import ast
import doctest
import importlib
import pkgutil
from math import cos, pi, sin, sqrt
from pathlib import Path

import pytest

from fem_impact.evidence import references as reference
from fem_impact.evidence.references.bricks import Bar, rebound, wall_stress
from fem_impact.evidence.references.finite_sphere import INERTIA, oblique_sphere
from fem_impact.evidence.references.free_modes import bending_modes, cylinder_frequencies
from fem_impact.evidence.references.hertz import (
    SpringRow,
    contact_modulus,
    hertz,
    tangential_ratio,
    thornton_restitution,
    yield_speed,
)
from fem_impact.evidence.references.oblique import oblique_drop, oblique_rod
from fem_impact.evidence.references.rod_end import chain_restitution, sears
from fem_impact.evidence.references.waves import flexural_speed, longitudinal_speed
from rigid import Projectile

STEEL = (219e9, 0.29, 7850.0)
RADIUS = 9.5e-3
FREE = (
    "__future__",
    "collections",
    "dataclasses",
    "functools",
    "itertools",
    "math",
    "numpy",
    "scipy",
    "skfem",
)
NAMES = [name for _, name, _ in pkgutil.iter_modules(reference.__path__)]


@pytest.mark.parametrize("name", NAMES)
def test_the_examples_of_the_references_hold(name):
    module = importlib.import_module(f"{reference.__name__}.{name}")
    assert doctest.testmod(module).failed == 0


@pytest.mark.parametrize("name", NAMES)
def test_a_reference_knows_nothing_of_the_solver(name):
    tree = ast.parse((Path(reference.__path__[0]) / f"{name}.py").read_text())
    used = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    used |= {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    for module in used:
        own = module.startswith(reference.__name__) or module == "fem_impact.arrays"  # names of array types
        assert module.split(".")[0] in FREE or own


def test_a_chain_rings_on_less_the_finer_it_is():
    """As links^(-2/3), what an Airy front leaves behind."""
    lost = [1 - chain_restitution(links, 0.3) for links in (50, 400)]
    assert lost[0] / lost[1] == pytest.approx(8 ** (2 / 3), rel=0.1)
    assert lost[0] < 0.03


SQUARE, METAL = (0.019, 0.24), (206e9, 0.29, 7850.0)


@pytest.mark.validation
@pytest.mark.parametrize(
    ("kind", "printed", "digits"),
    [("full", 120.576703e6, 1e-8), ("bbar", 120.5744e6, 5e-7), ("incompatible", 120.5780e6, 5e-7)],
)
def test_bricks_have_the_wall_stress_of_public_codes(kind, printed, digits):
    crossing = 2 * 0.24 / sqrt(206e9 / 7850)
    found = wall_stress(Bar(*SQUARE, (12, 144), *METAL, kind), 3.0, 7e-8, 0.15 * crossing, 0.85 * crossing)
    assert found == pytest.approx(printed, rel=digits)


@pytest.mark.parametrize(("f", "printed"), [(0.0, 1.403), (0.2, 1.91)])
def test_bricks_on_springs_have_the_rebound_of_public_codes(f, printed):
    found = rebound(Bar(*SQUARE, (4, 48), *METAL), 20 * pi / 180, 3.0, f, (2.6e13, 0.1), 4e-4)
    assert found == pytest.approx(printed, rel=0.015)


def test_hertz():
    E_star = contact_modulus(210e9, 0.29, 210e9, 0.29)
    mass = 4 / 3 * pi * RADIUS**3 * 7850
    fast = hertz(E_star, RADIUS, mass, 4.0)
    assert fast.force == pytest.approx(8317, abs=0.5)
    assert fast.duration == pytest.approx(49.89e-6, abs=5e-9)
    assert fast.radius == pytest.approx(0.803e-3, abs=5e-7)
    ball = hertz(contact_modulus(70e9, 0.30), 0.1, 4 / 3 * pi * 1e-3 * 2699, 0.2)
    assert ball.force == pytest.approx(11370, abs=5)


def test_sears():
    E_star = contact_modulus(219e9, 0.29, 206e9, 0.29)
    long = sears(219e9, 7850.0, 0.24, RADIUS, E_star, 7e-3, 2.0)
    assert long.force == pytest.approx(17777, rel=3e-4)
    assert long.duration == pytest.approx(219e-6, abs=1e-6)
    assert long.vibration == pytest.approx(0.0024, abs=1e-4)
    short = sears(219e9, 7850.0, 0.08, RADIUS, E_star, 7e-3, 4.0)
    assert short.force == pytest.approx(22502, rel=3e-4)
    assert short.duration == pytest.approx(115e-6, abs=1e-6)
    assert short.vibration < 4e-4


def test_guided_waves():
    found = [flexural_speed(r, 0.29) for r in (0.10, 0.20, 0.50)]
    assert found == pytest.approx([0.27000, 0.41381, 0.54478], abs=1.1e-5)
    # waves that are short beside the bar run along its skin, as Rayleigh's do
    assert longitudinal_speed(8.0, 0.29) == pytest.approx(0.5764, rel=3e-3)


def test_free_cylinder():
    long, short = (cylinder_frequencies(*STEEL, length, RADIUS) for length in (0.24, 0.08))
    assert long.torsion[0] == pytest.approx(6850.7, abs=0.06)
    assert short.bending[:2] == pytest.approx([12340, 28916], abs=0.6)
    assert short.longitudinal[0] == pytest.approx(32913, abs=0.6)
    assert short.torsion[0] == pytest.approx(20552, abs=0.6)


def test_beam_is_near_the_cylinder():
    """The rotary inertia and shear of Timoshenko's theory: within .04 % (Euler-Bernoulli: 1.6 %)."""
    found = bending_modes(*STEEL, 0.24, RADIUS).frequency[:3]
    assert found == pytest.approx([1526.3, 4092.1, 7728.6], rel=4e-4)


def test_oblique_sphere_turns_back():
    """Maw's annuli and the springs differ by the coarseness of the former.

    psi = 2 (1 - nu) V_t / (f (2 - nu) V_n) before and after.
    """
    nu, f = 0.29, 0.1
    scale, mass = 2 * (1 - nu) / (f * (2 - nu)), 4 / 3 * pi * RADIUS**3 * 7850.0
    impacts = [(115e9, nu, RADIUS, mass, f, 1.0, psi / scale) for psi in (0.5, 1.0, 2.0, 3.5)]
    after = [oblique_sphere(*impact) for impact in impacts]
    found = [scale * (one.centre_t - one.spin) for one in after]  # of the contact point
    assert found == pytest.approx([0.052, -0.050, -0.820, -1.477], abs=6.5e-3)


def test_alumina_sphere():
    """Kharaz, Gorham & Salman (2001): tangential restitution of the centre at 5, 20, 40 degrees."""
    mass, E_star = 4 / 3 * pi * 2.5e-3**3 * 4000, contact_modulus(380e9, 0.23, 380e9, 0.23)
    found = []
    for degrees in (5, 20, 40):
        angle = degrees * pi / 180
        after = oblique_sphere(E_star, 0.23, 2.5e-3, mass, 0.092, 3.9 * cos(angle), 3.9 * sin(angle))
        found.append(after.centre_t / (3.9 * sin(angle)))
    assert found == pytest.approx([0.740, 0.594, 0.781], abs=3e-3)


def test_a_sphere_that_slides_throughout_has_the_ratio_of_its_friction():
    mass, E_star = 4 / 3 * pi * RADIUS**3 * 7850, 115e9
    after = oblique_sphere(E_star, 0.29, RADIUS, mass, 0.1, 1.0, 3.0)
    assert after.ratio == pytest.approx(0.1, rel=1e-3)
    exact = 3.0 - 0.1 * 2.0 * (1 + 1 / INERTIA)
    assert after.centre_t - after.spin == pytest.approx(exact, rel=1e-3)


def drop(length, speed, f):
    """The printed drops: a plain cylinder with the fixed arms of its corner (Eq 6-7), tip radius 6.05 mm."""
    angle, mass = pi / 4, pi * RADIUS**2 * length * STEEL[2]
    d_c = length / 2 * sin(angle) - RADIUS * cos(angle)
    d_d = length / 2 * cos(angle) + RADIUS * sin(angle)
    body, arms, touch = (mass, length**2 / 12 + RADIUS**2 / 4), (d_c, d_d), (RADIUS, 0.0)
    rod = oblique_rod(*STEEL, length, RADIUS, angle, body, arms, touch)
    E_star = contact_modulus(219e9, 0.29, 206e9, 0.29)
    row = SpringRow(E_star, tangential_ratio(0.29) * E_star, 6.05e-3, f, 1.5e-3)
    return rod, oblique_drop(rod, row, -speed / sqrt(2), -speed / sqrt(2), turning=False)


@pytest.mark.parametrize(
    ("length", "speed", "f", "e", "contacts", "bending"),
    [
        (0.24, 2.1, 0.0, 0.853, 2, 0.058),
        (0.24, 2.1, 0.34, 0.396, 1, 0.114),
        pytest.param(0.24, 2.1, 0.55, 0.733, 1, 0.036, marks=pytest.mark.long),
        pytest.param(0.08, 4.2, 0.0, 0.975, 1, 0.014, marks=pytest.mark.long),
        pytest.param(0.08, 4.2, 0.34, 1.001, 1, 0.0001, marks=pytest.mark.long),
        (0.08, 4.2, 0.55, 1.009, 1, 0.0065),
    ],
)
def test_oblique_rod(length, speed, f, e, contacts, bending):
    rod, found = drop(length, speed, f)
    assert found.restitution == pytest.approx(e, abs=2e-3)
    assert len(found.contacts) == contacts
    assert found.bending / found.E_0 == pytest.approx(bending, rel=0.02, abs=4e-4)
    rigid = 0.5 * rod.mass * (found.V_n**2 + found.V_t**2 + rod.k2 * found.Omega**2)
    kept = (rigid + found.bending + found.stretching) / found.E_0
    assert kept == pytest.approx(1.0, abs=1e-3) if f == 0 else kept < 1.0


@pytest.mark.parametrize(("length", "ratio"), [(0.24, 0.71), (0.12, 0.49), (0.08, 0.31)])
def test_a_force_that_does_not_bend_the_rod(length, ratio):
    """The printed ratios are those of slender beams (theta = 4.65 w / L at the end) and the rounded edge."""
    rho, z = map(float, Projectile(length, 2 * RADIUS, "B", 3e-3, 7850.0).contact_point(pi / 4))
    w, turn = 1 - 4.65 * z / length, 4.65 * rho / length
    assert (w - turn) / (w + turn) == pytest.approx(ratio, abs=5e-3)


def test_thornton():
    """The 0.08 m rod at 45 degrees, yield 320 MPa, effective mass with f = 0.6."""
    rod = Projectile(0.08, 2 * RADIUS, "B", 3e-3, 7850.0)
    d_c, d_d = map(float, rod.arms(pi / 4))
    mass = rod.mass / (1 + d_c * (d_c - 0.6 * d_d) / rod.k2)
    start = yield_speed(2.8 * 320e6, 115.9e9, 6.05e-3, mass)
    found = [thornton_restitution(v / sqrt(2), start) for v in (1.31, 2.11, 4.23, 6.09)]
    assert found == pytest.approx([0.345, 0.306, 0.257, 0.235], rel=0.01)
