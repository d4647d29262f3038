"""Free bending of thin discs and rings: the mesh against the theory of plates."""

import pytest

from fem_impact.case.case import Case
from fem_impact.fem.eigen import rod_modes
from fem_impact.physics.beam import disc_period, free_plate_root
from fem_impact.physics.plate import bending_stiffness
from fem_impact.scene.read import read_dict
from fem_impact.solid.build import build

RADIUS = 12e-3  # m


def plate(thickness, hole=0.0, element="incompatible"):
    shape = {"profile": [["0 m", f"{RADIUS} m"], [f"{thickness} m", f"{RADIUS} m"]]}
    if hole:
        shape["bore"] = [[place, f"{hole * RADIUS} m"] for place in ("0 m", f"{thickness} m")]
    return read_dict(
        {
            "id": "plate",
            "projectile": {**shape, "material": "rod-steel"},
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": "45 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
            "effects": ["vibration", "barrier-rigid"],
            "accuracy": {"tip_size": "1.2 mm", "mass_scaling": 1.0, "element": element},
        }
    )


def frequencies(scene):
    model = build(Case.of(scene))
    n = model.layout.rod_size
    return rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0, 6).frequency


def by_theory(scene, waves, hole=0.0):
    """Frequency, Hz, of the lowest mode with so many nodal diameters."""
    rod, root = scene.projectile, free_plate_root(waves, scene.projectile.material.nu, hole)
    stiffness = bending_stiffness(rod.material.E, rod.material.nu, rod.length)
    return (root / RADIUS) ** 2 * (stiffness / (rod.material.rho * rod.length)) ** 0.5 / 6.283185307


@pytest.mark.parametrize(("nu", "squares"), [(0.33, {2: 5.25, 0: 9.08, 3: 12.2})])
def test_roots_of_a_free_disc_are_the_published_ones(nu, squares):
    """A. W. Leissa, Vibration of Plates, NASA SP-160, 1969, completely free circular plate."""
    for waves, square in squares.items():
        assert free_plate_root(waves, nu) ** 2 == pytest.approx(square, rel=4e-3)


def test_a_ring_bends_lower_than_a_disc_and_a_pinhole_is_not_felt():
    disc = free_plate_root(2, 0.3)
    assert free_plate_root(2, 0.3, 0.01) == pytest.approx(disc, rel=1e-3)
    assert free_plate_root(2, 0.3, 0.9) < free_plate_root(2, 0.3, 0.5) < disc


def test_a_thin_disc_bends_like_a_plate():
    """Shear lowers the frequencies of one that is a tenth of its radius thick by 1 to 1.5 %."""
    scene = plate(1.2e-3)
    found = frequencies(scene)
    for mode, waves in enumerate((2, 0)):
        assert found[mode] == pytest.approx(by_theory(scene, waves), rel=0.025)
        assert found[mode] < by_theory(scene, waves)
    assert 1 / found[0] == pytest.approx(disc_period(scene.projectile), rel=0.025)
    assert frequencies(plate(1.2e-3, element="full"))[0] > 1.03 * found[0]  # they lock in shear


def test_a_thin_ring_bends_like_a_plate_with_a_hole():
    scene = plate(1.2e-3, hole=0.5)
    assert frequencies(scene)[0] == pytest.approx(by_theory(scene, 2, 0.5), rel=0.025)
