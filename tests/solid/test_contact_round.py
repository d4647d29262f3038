"""A rod over a barrier that flows: quads bent to the round tip, edges left sharp, and who is held by whom."""

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.contact.patch import lowest_gap, make_patch, vertex_normals
from fem_impact.solid.march import advance, evaluate

RADIUS = 3e-3
FLOWS = ("vibration", "friction", "barrier-elastoplastic")


def _ball(h):
    """Patch of a ball's upper side with uneven quads, their neighbours up to 1.4 times as long."""
    u = h * np.array([-3.4, -2, -1, 0, 1.4, 2.4, 3.8])
    t, b = np.meshgrid(u, u[u >= 0], indexing="ij")
    rows = t.shape[1]
    node = (np.arange(len(u) - 1)[:, None] * rows + np.arange(rows - 1)).ravel()
    quads = np.stack([node, node + rows, node + rows + 1, node + 1], axis=1)
    points = np.stack([t, b, np.sqrt(RADIUS**2 - t**2 - b**2)], axis=-1).reshape(-1, 3)
    return make_patch(quads, np.arange(points.size).reshape(-1, 3), points), points


def _off(h):
    """Largest distance between the bent patch and the ball, m, and that of its flat quads."""
    patch, points = _ball(h)
    x, normals = points.ravel(), np.zeros_like(points)
    vertex_normals(x, patch.places, patch.quads, patch.mirrored, normals)
    t, b = np.meshgrid(np.linspace(-1.9, 2.3, 15) * h, np.linspace(0, 1.3, 7) * h)
    n = np.sqrt(RADIUS**2 - t**2 - b**2)
    probes = np.stack([t, b, n], axis=-1).reshape(-1, 3)
    both = np.concatenate([x, probes.ravel()])
    off = []
    for surface in (patch.rounded(x), patch):
        assert surface.sag >= 0
        gaps = [
            lowest_gap(both, x.size + 3 * k + np.arange(3)[None], surface, normals, np.zeros(1, int), 1.0)
            for k in range(len(probes))
        ]
        off.append(np.abs(gaps).max())
    return off


def test_bent_quads_follow_a_ball_to_third_order():
    coarse, fine = _off(0.4e-3), _off(0.2e-3)
    assert 3.5 < coarse[1] / fine[1] < 4.5
    assert coarse[0] < 0.2 * coarse[1]
    assert coarse[0] / fine[0] > 6


def test_sag_holds_all_that_bending_adds():
    h = 0.4e-3
    patch, points = _ball(h)
    assert _off(h)[1] < patch.rounded(points.ravel()).sag < 8 * _off(h)[1]


def test_normals_of_uneven_quads_on_a_ball_are_exact_to_second_order():
    patch, points = _ball(0.2e-3)
    normals = np.zeros_like(points)
    vertex_normals(points.ravel(), patch.places, patch.quads, patch.mirrored, normals)
    inside = (np.abs(points[:, 0]) < 0.5e-3) & (points[:, 1] < 0.3e-3)
    # means by area lean by a tenth of the turn over a quad
    assert np.abs(normals - points / RADIUS)[inside].max() < 1e-3


@pytest.mark.parametrize(("lean", "bend"), [(0.2, 0.5), (0.8, 0.0)], ids=["rounding", "edge"])
def test_an_edge_stays_sharp(lean, bend):
    """Two flat faces that meet at t = 0 and fall by ``lean`` away from it."""
    t, b = np.meshgrid([-1e-3, 0.0, 1e-3], [0.0, 1e-3], indexing="ij")
    points = np.stack([t, b, -lean * np.abs(t)], axis=-1).reshape(-1, 3)
    quads = np.array([[0, 2, 3, 1], [2, 4, 5, 3]])
    patch = make_patch(quads, np.arange(18).reshape(-1, 3), points).rounded(points.ravel())
    assert (patch.bend[2:4] == bend).all()


def test_a_level_normal_is_not_bent_and_does_not_spoil_the_sag():
    """A side of an upright rod that a skew quad counts among what faces the barrier."""
    t, b = np.meshgrid([-1e-3, 0.0, 1e-3], [0.0, 1e-3], indexing="ij")
    points = np.stack([np.zeros_like(t), b, t], axis=-1).reshape(-1, 3)
    patch = make_patch(np.array([[0, 1, 3, 2], [2, 3, 5, 4]]), np.arange(18).reshape(-1, 3), points)
    found = patch.rounded(points.ravel())
    assert not found.bend.any()
    assert found.sag == 0.0


def test_a_barrier_that_flows_conforms_and_an_elastic_one_does_not():
    flowing, elastic = (scenes.model("vibration", b) for b in ("barrier-elastoplastic", "barrier-elastic"))
    assert flowing.geometry.conforming and not elastic.geometry.conforming
    contact = elastic.contact
    assert contact.play == 0.0 and not contact.rod.bend.any() and contact.rod.sag == 0.0
    contact = flowing.contact
    assert contact.play == 0.05 * flowing.geometry.tip_size and contact.rod.sag > 0
    assert not contact.barrier.bend.any()


def test_only_a_barrier_that_flows_under_all_of_the_contact_conforms():
    scene = load("t5b")
    assert Case.of(scene).bodies.contact.barrier_conforms
    elastic = replace(scene, "effects", ["vibration", "friction", "barrier-elastic"])
    assert not Case.of(elastic).contact.barrier_conforms
    assert not Case.of(replace(scene, "impact.v_n", "-1e-4 m/s")).bodies.contact.barrier_conforms
    softer = replace(scene, "projectile.material.yield_stress", "100 MPa")
    assert not Case.of(softer).bodies.contact.barrier_conforms  # the rod flows first


def test_a_sharp_edge_sinks_no_deeper_than_the_play():
    """Between two rows of the barrier's nodes only the rod's own nodes can hold it."""
    scene = scenes.scene(*FLOWS, length=0.08, v_n=-4.0, v_t=-4.0, sharp=True)
    scene = replace(scene, "accuracy.grid_shift", 0.25)  # the edge lands beside a row
    model = build(Case.of(scene))
    state, contact = model.initial_state(), model.contact
    assert (contact.rod.bend == 0).any()
    deepest, speed = 0.0, 4.0
    while state.time < 60e-6:
        evaluate(model, state)
        advance(model, state)
        nodes = contact.rod.places
        flat = np.zeros((len(contact.barrier.places), 3))
        gap = lowest_gap(state.x, nodes, contact.barrier, flat, contact.last[: len(nodes)].copy(), 1.0)
        deepest = max(deepest, -gap)
    assert model.book.touching
    assert 0.3 * contact.play < deepest < contact.play + 2 * speed * model.step


@pytest.mark.long
def test_a_rod_that_slides_through_its_crater_loses_nothing_but_friction():
    """Along the barrier's own normals, which lag behind the round tip, closing takes 5e-4 of E_0."""
    result = scenes.run(*FLOWS, length=0.12, v_n=-2.0, v_t=-8.0, f=0.16)
    assert result.model.geometry.conforming
    assert abs(result.accounts["contact_dissipation"]) < 1e-4 * result.E_0
    assert result.worst < 1e-6 * result.E_0


def test_a_flat_face_that_comes_down_flat_on_steel_that_yields_touches_with_finite_normals():
    """Its bulge is exactly 0, and still its quads take their normals from the rod."""
    flat = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm", "accuracy.tip_size": "1 mm"}
    upright = {"impact.angle": "0 deg", "impact.v_n": "-2 m/s", "impact.v_t": "0 m/s"}
    model = build(Case.of(replace_all(load("t5b"), flat | upright)))
    state = model.initial_state()
    for _ in range(20):
        evaluate(model, state)
        advance(model, state)
    assert model.contact.rod.sag == 0.0
    assert np.isfinite(state.v).all()
    assert model.book.step.active > 0
