"""Plastic work of rod and barrier right under their surfaces."""

from types import SimpleNamespace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.run.simulate import simulate
from fem_impact.run.solid import reduce
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid import fine_zone
from fem_impact.solid.fine_zone import DEPTH, depths, skin_shares
from fem_impact.solid.skin import below_outline

CUBE = np.array([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
STACK = np.stack([CUBE - [0, 0, 1], CUBE - [0, 0, 2]])  # two cells of unit height under n = 0
LEANING = np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])  # turns n by 37 degrees towards t
TOP = np.array([[4, 5, 6, 7]])  # face of the upper cell
WORK = np.array([3.0, 2.0])  # upper and lower cell
EVEN = np.ones((2, 8))
HIGH = np.tile(np.repeat([0.0, 1.0], 4), (2, 1))  # strain at the upper four points of each cell alone


def _model(height, strain):
    """What `skin_shares` reads of a model: both bodies are the two cells, ``height`` in units of the depth.

    The rod's are turned upside down and lean, so that its surface is no level one.
    """
    places = np.arange(96).reshape(2, 2, 8, 3)
    zones = [
        SimpleNamespace(body=body, places=lambda at=at: at, spent=lambda: (strain, WORK))
        for body, at in zip(("barrier", "rod"), places, strict=True)
    ]
    rod = -STACK @ LEANING.T
    mesh = SimpleNamespace(faces_with=lambda tag: TOP)
    return SimpleNamespace(
        zones=zones,
        start=(height * DEPTH * np.concatenate([STACK.ravel(), rod.ravel()]), None),
        layout=SimpleNamespace(rod=places[1].reshape(-1, 3)),
        geometry=SimpleNamespace(rod=SimpleNamespace(mesh=mesh)),
    )


@pytest.mark.parametrize(
    ("height", "strain", "share"),
    [
        (0.5, EVEN, 1.0),
        (1.0, EVEN, 0.6),
        (2.0, EVEN, 0.3),
        (4.0, EVEN, 0.15),
        (2.0, HIGH, 0.6),
        (4.0, HIGH, 0.3),
        (1.0, 0 * EVEN, 0.0),
    ],
)
def test_work_above_the_depth_counts(height, strain, share):
    """Reference: the heights of cells and half cells over the depth, by hand."""
    found = skin_shares(_model(height, strain))
    assert (found["rod"], found["barrier"]) == (pytest.approx(share), pytest.approx(share))


@pytest.mark.parametrize(("depth", "share"), [(0.0, 1.0), (2.0, 0.0)])
def test_a_cell_from_face_to_face_lies_above_as_a_whole_or_below(depth, share, monkeypatch):
    """All its nodes are alike deep, as those between the faces of a disc."""
    monkeypatch.setattr(fine_zone, "depths", lambda model: np.full(96, depth * DEPTH))
    assert skin_shares(_model(1.0, EVEN)) == {"rod": share, "barrier": share}


def test_the_depth_in_a_round_nose_is_that_under_its_outline():
    """Reference: distances from the meridian; the nearest facet of a mesh is off by less than its bulge."""
    model = scenes.model("vibration", "rod-plasticity", "barrier-rigid", length=0.08, tip=0.4e-3)
    rod = load("t5b").projectile.rigid_body
    outline = np.vstack([rod.meridian(), [rod.diameter / 2, rod.length]])
    exact = below_outline(model.geometry.rod.mesh.points, outline)
    found = depths(model)[model.layout.rod[:, 2]]
    (zone,) = model.zones
    near = np.unique(model.geometry.rod.mesh.cells[zone.cells])
    assert exact[near].max() > 5 * DEPTH
    assert np.quantile(np.abs(found - exact)[near], 0.9) < 0.1 * DEPTH


@pytest.mark.long
def test_a_run_tells_friction_and_skin_together():
    result = scenes.run(
        "vibration", "friction", "rod-plasticity", "barrier-elastoplastic", length=0.08, v_n=-2.1, v_t=-2.1
    )
    found = reduce(result)
    energy = found.energy
    assert 0.05 * energy.plastic_barrier < energy.skin_barrier < 0.5 * energy.plastic_barrier
    assert 0.0 < energy.skin_rod < energy.plastic_rod
    assert energy.skin == pytest.approx(energy.friction + energy.skin_rod + energy.skin_barrier)


@pytest.mark.long
def test_the_work_of_a_projectile_that_is_softer_than_the_barrier_counts():
    scene = replace_all(load("quick"), {"projectile.material": "brass", "save.frames": 0})
    energy = simulate(scene, "solid").energy
    assert energy.plastic_rod > 10 * energy.plastic_barrier
    assert energy.skin_rod > 10 * energy.skin_barrier
    assert energy.skin == pytest.approx(energy.friction + energy.skin_rod + energy.skin_barrier)


def test_an_elastic_barrier_has_no_sheared_skin():
    result = scenes.run("vibration", "friction", "barrier-elastic", length=0.08, v_n=-1.0, v_t=-1.0)
    found = reduce(result)
    assert found.energy.skin == found.energy.friction > 0.0
    assert found.energy.skin_rod == found.energy.skin_barrier == 0.0
