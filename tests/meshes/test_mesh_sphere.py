import numpy as np
import pytest
from mesh_shapes import area_vectors

import meshes

RADIUS = 10e-3


def test_volume_converges_to_half_a_ball():
    exact = 2.0 / 3.0 * np.pi * RADIUS**3
    error = [1.0 - meshes.volume(meshes.sphere(RADIUS, across)) / exact for across in (8, 16, 32)]
    assert 0.0 < error[2] < 0.3 * error[1] < 0.3 * 0.3 * error[0]
    assert error[2] < 5e-3


def test_ball_touches_the_plane_at_the_origin_with_regular_fine_cells():
    zone = meshes.Zone(np.zeros(3), np.eye(3), np.full(3, -1e-3), np.full(3, 1e-3))
    mesh = meshes.sphere(RADIUS, 8, [zone] * 3)
    skin = np.unique(mesh.faces_with(meshes.SKIN))
    skin = skin[~mesh.is_hanging[skin]]
    arms = mesh.points[skin] - np.array([0.0, 0.0, RADIUS])
    assert np.linalg.norm(arms, axis=1) == pytest.approx(RADIUS, rel=1e-13)
    assert np.linalg.norm(mesh.points, axis=1).min() < 1e-15
    assert (mesh.points[np.unique(mesh.faces_with(meshes.SYMMETRY)), 1] == 0.0).all()
    assert np.abs(area_vectors(mesh).sum(axis=0)).max() < 1e-17
    quality = meshes.quality(mesh)
    assert quality.min_scaled_jacobian > 0.6
    assert quality.min_edge > 0.55 * 2.5e-3 / 8


@pytest.mark.parametrize("across", [6, 10, 14])
def test_every_even_count_gives_good_cells(across):
    assert meshes.quality(meshes.sphere(1.0, across)).min_scaled_jacobian > 0.5


def test_impossible_balls_are_refused():
    with pytest.raises(meshes.MeshError, match="radius must be positive"):
        meshes.sphere(0.0)
    with pytest.raises(meshes.MeshError, match="even number"):
        meshes.sphere(1.0, 7)
