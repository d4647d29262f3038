import numpy as np
import pytest
from mesh_shapes import SHAPES, contact_zone

import meshes

# By hand: a lumped hex8 cube of edge h in pure dilatation has omega^2 = 4 (3 lambda + 2 mu) / (rho h^2).


@pytest.mark.parametrize("nu", [0.0, 0.29, 0.45])
def test_limit_of_a_cube_is_its_dilatation(nu):
    mesh = meshes.block((0.0, 0.0, -2e-3), (2e-3, 2e-3, 0.0), 2e-3)
    bulk = (1.0 + nu) / (1.0 - nu)
    exact = 2.0 / np.sqrt(4.0 * bulk) * 2e-3 / 5900.0
    shear = 2.0 / np.sqrt(8.0 * 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu)) * 2e-3 / 5900.0
    limit = meshes.step_limit(mesh, 5900.0, nu)[0]
    assert limit <= min(exact, shear) * (1.0 + 1e-12)
    if nu == 0.29:
        assert limit == pytest.approx(0.742 * 2e-3 / 5900.0, rel=1e-3)


def test_bound_of_a_cube_lies_between_half_the_limit_and_the_limit():
    mesh = meshes.block((0.0, 0.0, -1.0), (1.0, 1.0, 0.0), 1.0)
    assert 0.5 * 0.742 < meshes.step_bound(mesh, 1.0)[0] < 0.742


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_bound_is_safe_and_sharp_on_real_noses(name):
    zone = contact_zone(SHAPES[name])
    mesh = meshes.rod(SHAPES[name], 0.06, zone=zone, levels=2).mesh
    ratio = meshes.step_bound(mesh, 5900.0) / meshes.step_limit(mesh, 5900.0)
    assert ratio.max() < 1.0
    assert ratio.min() > 0.65


def test_assembled_mesh_is_not_faster_than_its_fastest_cell():
    zone = meshes.Zone([0.0, 0.0, 0.0], np.eye(3), np.full(3, -0.1), np.full(3, 0.1))
    mesh = meshes.block((-1.0, 0.0, -1.0), (1.0, 1.0, 0.0), 1.0, zone, 1)
    assert meshes.step_limit(mesh, 1.0).min() == pytest.approx(0.742 * 0.5, rel=1e-3)


def test_step_scales_with_size_over_speed():
    small = meshes.block((0.0, 0.0, -1.0), (1.0, 1.0, 0.0), 1.0)
    large = meshes.block((0.0, 0.0, -3.0), (3.0, 3.0, 0.0), 3.0)
    assert meshes.step_bound(large, 6.0)[0] == pytest.approx(
        0.5 * meshes.step_bound(small, 1.0)[0], rel=1e-12
    )


@pytest.mark.parametrize(("speed", "nu"), [(0.0, 0.3), (1.0, 0.5), (1.0, -0.1)])
def test_impossible_materials_are_refused(speed, nu):
    mesh = meshes.block((0.0, 0.0, -1.0), (1.0, 1.0, 0.0), 1.0)
    with pytest.raises(meshes.MeshError, match="step bound needs"):
        meshes.step_bound(mesh, speed, nu)
