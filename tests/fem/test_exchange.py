"""Meshes for scikit-fem, meshio and PyVista: volumes and fields are kept, whoever counts them."""

import numpy as np
import pytest
from own_bodies import box, write
from skfem import Basis, ElementHex1, MeshHex

import fem_impact
from fem_impact.physics.stepped_beam import beam_modes
from meshes import block

MESH = block((0.0, 0.0, -3.0), (2.0, 1.0, 0.0), 0.5)


def volume(mesh):
    return Basis(mesh, ElementHex1()).dx.sum()


def test_a_block_keeps_its_volume_in_each_library():
    assert volume(fem_impact.to_skfem(MESH)) == pytest.approx(6.0)
    assert fem_impact.to_pyvista(MESH).compute_cell_sizes()["Volume"].sum() == pytest.approx(6.0)
    (cells,) = fem_impact.to_meshio(MESH).cells
    assert cells.type == "hexahedron" and np.array_equal(cells.data, MESH.cells)


def test_corners_handed_over_as_they_are_give_another_volume():
    assert volume(MeshHex(MESH.points.T.copy(), MESH.cells.T.copy())) != pytest.approx(6.0, rel=0.1)


def test_a_field_of_a_node_is_that_of_the_same_node():
    mesh = fem_impact.to_skfem(MESH)
    basis = Basis(mesh, ElementHex1())
    assert np.array_equal(basis.nodal_dofs[0], np.arange(len(MESH.points)))
    field = 2.0 * MESH.points[:, 0] - MESH.points[:, 2]
    gradient = basis.interpolate(field).grad
    for along, slope in enumerate((2.0, 0.0, -1.0)):
        assert gradient[along] == pytest.approx(slope, abs=1e-12)


def test_stored_fields_go_with_the_mesh(result):
    fields = fem_impact.read_fields(result / "fields.vtkhdf")
    last, grid = fem_impact.to_meshio(fields, 2), fem_impact.to_pyvista(fields, 2)
    assert last.points == pytest.approx(grid.points)
    assert set(last.point_data) == set(fields.point_names)
    for name in fields.cell_names:
        assert last.cell_data[name][0] == pytest.approx(grid.cell_data[name])
    assert fem_impact.to_meshio(fields).points == pytest.approx(fields.points)


def test_modes_of_a_scene_are_those_of_its_beam():
    """A rod of the tests: its first bending by finite elements beside Timoshenko's beam."""
    scene = fem_impact.load("t4")
    free = fem_impact.modes(scene)
    assert free.shape.shape == (len(free.points), 2, len(free.omega))
    bent = beam_modes(scene.projectile).bent[0]
    assert free.omega[0] == pytest.approx(bent, rel=0.01)
    assert free.frequency[0] == pytest.approx(free.omega[0] / 6.283185, rel=1e-6)


def test_modes_of_a_mesh_of_the_users_own_are_those_of_its_beam_straight_or_bent(tmp_path):
    """Bent by a hundredth of its length: as a straight bar; no run at 0 deg could stand on its tip."""
    steel = {"mesh_unit": "m", "material": "rod-steel"}
    for bend in (0.0, 1.5e-3):
        points, cells = box(4, 2, 40, (-4e-3, 0.0, 0.0), (4e-3, 4e-3, 0.15))
        points[:, 0] += bend * (points[:, 2] / 0.15) ** 2
        write(tmp_path / "bar.vtu", points, cells)
        rod = steel | {"mesh": tmp_path / "bar.vtu"}
        scene = fem_impact.replace(fem_impact.load("t5b"), "projectile", rod)
        free = fem_impact.modes(scene)
        assert free.omega[:2] == pytest.approx(beam_modes(scene.projectile).bent[:2], rel=0.02)
