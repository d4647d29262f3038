"""Meshed projectiles of own shapes: masses, inertia and free modes beside the theory of beams and bars."""

from __future__ import annotations

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.fem.body import MeshedBodies
from fem_impact.physics.stepped_beam import beam_modes
from fem_impact.scene.read import read_dict

WAY = [["0 mm", "6 mm"], ["200 mm", "6 mm"]]
ROD = {"tip": "B", "length": "200 mm", "diameter": "19 mm", "tip_radius": "2 mm"}
OGIVE = {
    "shape": "ogive",
    "length": "200 mm",
    "diameter": "19 mm",
    "calibre_radius": 2.0,
    "nose_radius": "3 mm",
}
METALS = ("rod-steel", "aluminium-6061-t6")
SHAPES = {
    "taper": {"profile": [["0 mm", "3 mm"], ["200 mm", "9 mm"]]},
    "tube": {**ROD, "bore": WAY},
    "shell": {**OGIVE, "bore": [["40 mm", "6 mm"], ["200 mm", "6 mm"]]},
    "two metals": {
        **ROD,
        "segments": [
            {"to": f"{to} mm", "material": name} for to, name in zip((80, 200), METALS, strict=True)
        ],
    },
}
SLOW = pytest.mark.slow


def meshed(name):
    material = {} if "segments" in SHAPES[name] else {"material": "rod-steel"}
    data = {
        "id": "own",
        "effects": ["vibration", "barrier-rigid"],
        "projectile": {**SHAPES[name], **material},
        "barrier": {"material": "plate-steel"},
        "impact": {"angle": "30 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
        "accuracy": {"tip_size": "1.2 mm", "mass_scaling": 1.0},
    }
    return MeshedBodies(Case.of(read_dict(data)))


@pytest.mark.parametrize(
    "name",
    [
        "tube",
        pytest.param("two metals", marks=SLOW),
        pytest.param("taper", marks=SLOW),
        pytest.param("shell", marks=SLOW),
    ],
)
def test_mass_inertia_and_free_modes_are_those_of_the_shape(name):
    made = meshed(name)
    body, theory, places = (
        made.scene.projectile.rigid_body,
        beam_modes(made.scene.projectile),
        made.free_nodes,
    )
    mass, x = made.mass[places[:, 0]], made.x[places]
    centre = mass @ x / mass.sum()
    arm = x - centre
    assert 2 * mass.sum() == pytest.approx(body.mass, rel=1e-9)
    away = centre - projectile_centre(made)
    assert np.linalg.norm(away[[0, 2]]) < 1e-3 * body.length
    # masses at the corners of cells: (1 + h^2/l^2) or so
    assert mass @ (arm[:, 0] ** 2 + arm[:, 2] ** 2) / mass.sum() == pytest.approx(body.k2, rel=1e-3)
    found = made.rod_modes().frequency
    for wanted in (*theory.bent[:2], theory.stretched[0]):
        assert np.abs(found / (wanted / (2 * np.pi)) - 1).min() < 0.01
    assert found[0] == pytest.approx(theory.bent[0] / (2 * np.pi), rel=4e-3)


def projectile_centre(made):
    """Return the place of the theory's mass centre over the barrier, m."""
    d_c, d_d = made.scene.projectile.rigid_body.arms(made.scene.impact.angle)
    return np.array([float(d_c), 0.0, float(d_d)])


def test_a_bore_leaves_the_slices_hollow_and_equal():
    made = meshed("tube")
    rod = made.geometry.rod
    layers = rod.mesh.points[rod.body_nodes]
    radius = np.hypot(layers[..., 0], layers[..., 1])
    assert radius.min() > 5.9e-3
    assert rod.body_cells.shape[1] > 40
    assert made.drawn.inward == pytest.approx([1.0] * 3, abs=0.1)
