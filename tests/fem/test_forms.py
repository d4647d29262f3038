"""The weak forms: against operators written by hand, the compiled kernels, and exact fields."""

import by_hand
import numpy as np
import pytest
import scipy.sparse as sp
import solid_shapes as shapes
from skfem import Basis, ElementHex1, ElementVector, FacetBasis, Functional, LinearForm
from skfem.helpers import dot, mul, sym_grad

import meshes
from fem_impact.fem import forms
from fem_impact.fem.boundary import spread_boundary
from fem_impact.fem.elements import element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.hexmodes import dummy_element
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import NodeProduct, assemble, tie_operator
from fem_impact.films.motion import fibres, stretch
from fem_impact.physics.hardening import linear_hardening
from fem_impact.solid.yielding import YieldingZone
from meshes import OUTER, Zone

E, NU, RHO = shapes.E, shapes.NU, shapes.RHO
LAME, G = lame_constants(E, NU)
LINEAR, MODES = ElementVector(ElementHex1()), ElementVector(forms.ElementHexModes())
KINDS = {
    "full": (forms.stiffness, LINEAR),
    "bbar": (forms.mean_dilatation_stiffness, LINEAR),
    "incompatible": (forms.stiffness, MODES),
}


def off(ours, exact):
    """Return the largest difference over the largest exact number."""
    return abs(ours - exact).max() / abs(exact).max()


def local(kind, points, cells):
    form, element = KINDS[kind]
    return forms.element_matrices(form, forms.hex_mesh(points, cells), element, lame=LAME, G=G)


def whole(form, mesh, **parameters):
    basis = Basis(mesh, LINEAR, intorder=2)
    return form.assemble(basis, dx=basis.dx, **parameters)


def block(levels=1):
    zone = Zone(np.zeros(3), np.eye(3), np.array([-0.9e-3, 0.0, -0.9e-3]), np.array([0.9e-3, 0.9e-3, 0.0]))
    return meshes.block([-4e-3, 0, -3e-3], [3e-3, 3e-3, 0], 1e-3, [zone] * levels, buffer=1)


@pytest.mark.parametrize("kind", KINDS)
def test_element_stiffness_is_that_written_by_hand(kind):
    points, cells = shapes.distorted((6, 5, 5), 0.25, seed=1)
    exact = by_hand.element_stiffness(points, cells, by_hand.hooke(E, NU), kind)
    assert off(element_stiffness(points, cells, (LAME, G), kind), exact) < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_forms_side_by_side_are_what_scikit_fem_makes_of_them(kind):
    points, cells = shapes.distorted((2, 1, 1), 0.25, seed=13)
    form, element = KINDS[kind]
    basis = Basis(forms.hex_mesh(points, cells), element, intorder=2)
    K = form.assemble(basis, dx=basis.dx, lame=LAME, G=G).toarray()
    n = points.size
    if len(K) > n:  # without load the modes follow the nodes
        K = K[:n, :n] - K[:n, n:] @ np.linalg.solve(K[n:, n:], K[n:, :n])
    assert off(shapes.dense(local(kind, points, cells), cells), K) < 1e-12


def test_the_three_stiffnesses_differ():
    points, cells = shapes.distorted((1, 1, 2), 0.25, seed=2)
    full, bbar, modes = (local(kind, points, cells) for kind in KINDS)
    assert min(off(full, bbar), off(full, modes), off(bbar, modes)) > 0.01


def test_lumped_masses_are_the_row_sums_of_the_form():
    points, cells = shapes.distorted((3, 2, 4), 0.25, seed=3)
    ours = lumped_mass(points, cells, RHO)
    assert off(ours, by_hand.lumped_mass(points, cells, RHO)) < 1e-12
    nodal = whole(forms.mass, forms.hex_mesh(points, cells), rho=RHO) @ np.ones(points.size)
    assert off(np.repeat(np.bincount(cells.ravel(), ours.ravel()), 3), nodal) < 1e-12


@pytest.mark.parametrize("kind", ["full", "bbar"])
def test_assembly_through_ties_is_the_form(kind):
    mesh, points = shapes.refined_patch(seed=4)
    T = tie_operator(mesh.tie, np.arange(points.size).reshape(-1, 3), points.size)
    K = whole(KINDS[kind][0], forms.hex_mesh(points, mesh.cells), lame=LAME, G=G)
    assert off(assemble(points, mesh.cells, (LAME, G), kind, T), T.T @ K @ T) < 1e-12


@pytest.mark.parametrize("levels", [0, 1])
def test_springs_and_dashpots_of_the_boundary_are_those_written_by_hand(levels):
    mesh = block(levels)
    assert (mesh.is_hanging.sum() > 20) == (levels > 0)
    exact = by_hand.boundary(mesh, G, RHO, np.sqrt((LAME + 2 * G) / RHO), np.sqrt(G / RHO))
    for ours, written in zip(spread_boundary(mesh, E, NU, RHO), exact, strict=True):
        assert off(ours, written) < 1e-12
        assert ((ours > 0) == (written > 0)).all()


def test_the_sliced_rod_is_the_form():
    rod = meshes.rod(np.array([[0.0, 0.0], [9.5e-3, 0.0]]), 30e-3, 6, nose=False)
    section, layers = rod.body_nodes.shape
    operator = SliceOperator.of_rod(
        rod, element_stiffness(rod.mesh.points, rod.mesh.cells[rod.body_cells[:, 0]], (LAME, G), "full")
    )
    K = whole(forms.stiffness, forms.hex_mesh(rod.mesh.points, rod.mesh.cells), lame=LAME, G=G)
    u = np.random.default_rng(5).normal(size=rod.mesh.points.shape)
    rows = np.ascontiguousarray(u[rod.body_nodes].transpose(2, 0, 1).reshape(3 * section, layers))
    force, exact = np.empty_like(rows), (K @ u.ravel()).reshape(-1, 3)[rod.body_nodes]
    operator.apply(rows, force)
    assert off(force.reshape(3, section, layers).transpose(1, 2, 0), exact) < 1e-12


def test_the_block_on_springs_is_the_form():
    mesh = block(levels=0)
    body = forms.hex_mesh(mesh.points, mesh.cells)
    places = np.arange(mesh.points.size).reshape(-1, 3)
    springs = sp.diags(spread_boundary(mesh, E, NU, RHO)[0].ravel())
    ours = (
        assemble(mesh.points, mesh.cells, (LAME, G), "bbar", sp.identity(places.size, format="csr")) + springs
    )
    product, force = NodeProduct.of(sp.csr_matrix(ours), places), np.zeros(places.size)
    outside = forms.springs.assemble(
        forms.face_basis(body, mesh.faces_with(OUTER)), G=G, middle=0.0, half=0.0
    )
    u = np.random.default_rng(6).normal(size=places.size)
    product.multiply(u)
    product.add_to(force)
    K = whole(forms.mean_dilatation_stiffness, body, lame=LAME, G=G)
    assert off(force, K @ u + (outside @ np.ones(len(u))) * u) < 1e-12


def test_the_yielding_kernel_starts_as_the_form_with_mean_dilatation():
    points, cells = shapes.distorted((3, 3, 2), 0.2, seed=7)
    places, size = np.arange(points.size).reshape(-1, 3), points.size
    dummy = size + np.arange(24).reshape(8, 3)
    law = linear_hardening(1e12, 0.0)  # never yields
    zone = YieldingZone.of("rod", places[cells], points[cells], E, NU, law, dummy)
    state = shapes.at_rest(np.concatenate([points.ravel(), dummy_element().ravel()]))
    u = 1e-12 * np.random.default_rng(8).normal(size=size)
    state.dt = 1e-8
    state.x[:size] += u
    state.v[:size] = u / state.dt
    zone.add(state)
    K = whole(forms.mean_dilatation_stiffness, forms.hex_mesh(points, cells), lame=LAME, G=G)
    assert off(-state.force[:size], K @ u) < 1e-5  # of strains of 1e-9 and of what positions round off


def test_a_constant_stress_is_in_balance_with_its_surface_load():
    points, cells = shapes.distorted((3, 3, 3), 0.2, seed=9)
    mesh = forms.hex_mesh(points, cells)
    H = np.random.default_rng(10).normal(size=(3, 3))
    strain = (H + H.T) / 2
    stress = LAME * np.trace(strain) * np.eye(3) + 2 * G * strain
    faces = FacetBasis(mesh, LINEAR, intorder=2)
    load = LinearForm(lambda v, w: dot(w.t, v)).assemble(
        faces, t=np.einsum("ij,jkl->ikl", stress, faces.normals)
    )
    K = whole(forms.stiffness, mesh, lame=LAME, G=G)
    assert off(K @ (points @ H.T).ravel(), load) < 1e-12


def test_axial_strain_is_what_films_show_of_a_small_motion():
    points, cells = shapes.grid((2, 2, 3), 1e-3)
    axis = np.array([0.6, 0.0, 0.8])
    u = 1e-9 * np.random.default_rng(11).normal(size=points.shape)
    basis = Basis(forms.hex_mesh(points, cells), LINEAR, intorder=1)
    axial_strain = Functional(lambda w: dot(w.a, mul(sym_grad(w.u), w.a)))
    strain = axial_strain.elemental(basis, u=u.ravel(), a=axis[:, None, None]) / basis.dx.sum(axis=1)
    shown = stretch(fibres(points, cells, axis), (points + u)[cells]) - 1.0
    assert off(shown, strain) < 1e-5
    H = np.random.default_rng(12).normal(size=(3, 3))
    linear = axial_strain.assemble(basis, u=(points @ H.T).ravel(), a=axis[:, None, None])
    assert linear == pytest.approx(axis @ H @ axis * 12e-9, rel=1e-12)
