"""Element operators against scikit-fem's own assembly, exact fields, and beam theory."""

import numpy as np
import pytest
import solid_shapes as shapes
from skfem import Basis, ElementHex1, ElementVector
from skfem.models.elasticity import linear_elasticity

import meshes
from fem_impact.fem.elements import element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.forms import HEX_MAPPING, hex_mesh
from fem_impact.fem.sparse import assemble, tie_operator
from meshes import Zone

E, NU, RHO = shapes.E, shapes.NU, shapes.RHO
LAME = lame_constants(E, NU)
KINDS = ("full", "bbar", "incompatible")


def test_full_integration_is_what_scikit_fem_assembles():
    points, cells = shapes.distorted((2, 2, 2), 0.2, seed=1)
    vector = ElementVector(ElementHex1())
    basis = Basis(hex_mesh(points, cells), vector, intorder=2)
    theirs = linear_elasticity(*lame_constants(E, NU)).assemble(basis)
    order = basis.nodal_dofs.T.ravel()
    ours = shapes.dense(element_stiffness(points, cells, LAME, "full"), cells)
    assert abs(theirs[order][:, order].toarray() - ours).max() < 1e-11 * abs(ours).max()


@pytest.mark.parametrize("kind", KINDS)
def test_a_linear_field_has_the_energy_of_its_constant_strain(kind):
    points, cells = shapes.distorted((1, 1, 1), 0.25, seed=2)
    H = np.random.default_rng(3).normal(size=(3, 3))
    K = element_stiffness(points, cells, LAME, kind)[0]
    u = (points[cells[0]] @ H.T).ravel()
    strain, (lame, G) = (H + H.T) / 2, LAME
    density = lame * np.trace(strain) ** 2 + 2 * G * (strain**2).sum()
    assert u @ K @ u == pytest.approx(density * shapes.volume(points[cells[0]]), rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_only_the_six_rigid_motions_are_free(kind):
    points, cells = shapes.distorted((1, 1, 1), 0.25, seed=4)
    K = element_stiffness(points, cells, LAME, kind)[0]
    value = np.linalg.eigvalsh(K)
    assert abs(value[:6]).max() < 1e-12 * value[-1]
    assert value[6] > 1e-2 * value[-1]  # no hourglass mode
    x = points[cells[0]]
    spin = np.add(np.cross([0.3, -1.0, 2.0], x), [1e-3, 2e-3, -1e-3])
    assert abs(K @ spin.ravel()).max() < 1e-12 * value[-1] * abs(spin).max()


@pytest.mark.parametrize("kind", KINDS)
def test_distorted_patch(kind):
    points, cells = shapes.distorted((3, 3, 3), 0.25, seed=5)
    K = shapes.dense(element_stiffness(points, cells, LAME, kind), cells)
    u = (points @ np.random.default_rng(6).normal(size=(3, 3))).ravel()
    inner = np.repeat(shapes.inner(points), 3)
    assert inner.sum() == 24
    solved = np.linalg.solve(K[np.ix_(inner, inner)], -K[np.ix_(inner, ~inner)] @ u[~inner])
    assert abs(solved - u[inner]).max() < 1e-11 * abs(u).max()


@pytest.mark.parametrize("kind", ["bbar", "incompatible"])
def test_patch_across_a_hanging_node_tie(kind):
    mesh, points = shapes.refined_patch(seed=7)
    free, boundary = ~mesh.is_hanging, np.zeros(len(points), bool)
    boundary[mesh.faces] = True
    places = np.arange(3 * len(points)).reshape(-1, 3)
    T = tie_operator(mesh.tie, places, 3 * len(points))
    K = assemble(points, mesh.cells, LAME, kind, T).toarray()
    u = points @ np.random.default_rng(8).normal(size=(3, 3))
    inner, given = places[free & ~boundary].ravel(), places[free & boundary].ravel()
    assert len(inner) > 60
    solved = np.linalg.solve(K[np.ix_(inner, inner)], -K[np.ix_(inner, given)] @ u.ravel()[given])
    assert abs(solved - u.ravel()[inner]).max() < 1e-11 * abs(u).max()


def test_step_of_a_cube():
    h = 1.3e-3
    points, cells = shapes.grid((1, 1, 1), h)
    K = element_stiffness(points, cells, lame_constants(E, 0.29), "full")
    lame, G = lame_constants(E, 0.29)
    step = 2 / shapes.fastest(K[0], lumped_mass(points, cells, RHO)[0])
    assert step * np.sqrt((lame + 2 * G) / RHO) / h == pytest.approx(0.742, abs=5e-4)


def test_no_assembly_is_faster_than_its_fastest_element():
    points, cells = shapes.distorted((2, 2, 2), 0.2, seed=9)
    K, mass = element_stiffness(points, cells, LAME, "incompatible"), lumped_mass(points, cells, RHO)
    root = np.repeat(np.bincount(cells.ravel(), mass.ravel()), 3) ** -0.5
    whole = np.sqrt(np.linalg.eigvalsh(shapes.dense(K, cells) * root[:, None] * root)[-1])
    single = max(map(shapes.fastest, K, mass))  # Irons & Treharne 1971
    assert 0.5 * single < whole <= single


def _tip_deflection(kind, nu=0.29):
    """Deflection of a slender cantilever under an end force over that of Timoshenko's beam."""
    length, side = 60e-3, 2e-3
    points, cells = shapes.grid((20, 1, 1), 1.0)
    points = points * [length / 20, side, side]
    K = shapes.dense(element_stiffness(points, cells, lame_constants(E, nu), kind), cells)
    end, held = np.isclose(points[:, 0], length), np.isclose(points[:, 0], 0.0)
    load = np.zeros(points.shape)
    load[end, 2] = 0.25
    free = ~np.repeat(held, 3)
    u = np.zeros(points.size)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], load.ravel()[free])
    I, A, G = side**4 / 12, side**2, E / (2 * (1 + nu))
    beam = length**3 / (3 * E * I) + length / (5 / 6 * G * A)
    return u.reshape(-1, 3)[end, 2].mean() / beam


def test_bending_does_not_lock_in_shear():
    assert _tip_deflection("incompatible") == pytest.approx(1.0, abs=0.01)
    assert _tip_deflection("full") < 0.6


@pytest.mark.parametrize("kind", ["bbar", "incompatible"])
def test_nearly_incompressible_material_does_not_lock(kind):
    points, cells = shapes.grid((1, 1, 1), 1.0)
    energy = []
    for used in (kind, "full"):
        K = element_stiffness(points, cells, lame_constants(1.0, 0.4999), used)[0]
        x = points[cells[0]] - 0.5
        bend = np.stack([x[:, 0] * x[:, 1], 0 * x[:, 0], 0 * x[:, 0]], axis=1).ravel()
        energy.append(bend @ K @ bend)
    assert energy[0] < 0.01 * energy[1]


def test_lumped_masses_add_up_to_density_times_volume():
    points, cells = shapes.distorted((2, 3, 2), 0.2, seed=10)
    mass = lumped_mass(points, cells, RHO)
    assert mass.min() > 0
    exact = [RHO * shapes.volume(points[c]) for c in cells]
    assert mass.sum(axis=1) == pytest.approx(exact, rel=1e-12)
    mesh = meshes.block(
        [-2e-3, 0, -3e-3],
        [2e-3, 1e-3, 0],
        1e-3,
        [Zone(np.zeros(3), np.eye(3), -0.5e-3 * np.ones(3), 0.5e-3 * np.ones(3))],
    )
    assert lumped_mass(mesh.points, mesh.cells, RHO).sum() == pytest.approx(RHO * 12e-9, rel=1e-12)


def test_corners_are_numbered_as_scikit_fem_numbers_them():
    from skfem.io import meshio

    assert tuple(meshio.HEX_MAPPING[:8]) == HEX_MAPPING
