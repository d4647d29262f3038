"""The fine zone of the barrier: where its surface may flow."""

from types import SimpleNamespace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.case.zones import DRAG, LOW, SLIDE, half_widths
from fem_impact.fem.geometry import build_geometry
from fem_impact.run.simulate import simulate
from fem_impact.run.solid import reduce
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.contact_watch import ContactWatch
from fem_impact.solid.fine_zone import SkinWatch, outside_zones
from fem_impact.solid.run import solve

SCENE = replace(load("t6-17"), "accuracy.tip_size", "0.6 mm")


def _geometry(scene):
    return build_geometry(Case.of(scene).bodies, Case.of(scene).zones, 2e-6, True)


def _estimate(scene):
    return Case.of(scene).bodies.estimate


def _reach(scene):
    """Return the extent of the finest cells down and up the slope over the half-width along t."""
    geometry = _geometry(scene)
    block = geometry.barrier
    t = block.points[block.cells[block.finest], 0]
    return -t.min() / _half_width(scene, geometry), t.max() / _half_width(scene, geometry)


def _half_width(scene, geometry):
    return half_widths(_estimate(scene), geometry.tip_size)[0]


def test_it_follows_the_surface_that_a_sticking_rod_drags_down_the_slope():
    down, up = _reach(SCENE)
    assert 1 + DRAG <= down and 1 <= up < 1 + DRAG


def test_without_sliding_it_lies_even():
    down, up = _reach(replace(SCENE, "impact.v_t", "0 m/s"))
    assert 1 <= down < 1 + DRAG
    assert down == pytest.approx(up, rel=0.2)


def test_it_follows_a_long_slide():
    steep = replace(SCENE, "impact.v_t", "-20 m/s")
    slide = SLIDE * _estimate(steep).depth * 20 / -steep.impact.v_n
    half = _half_width(steep, _geometry(steep))
    assert slide > DRAG * half
    assert _reach(steep)[0] >= 1 + slide / half


def test_the_grid_is_displaced_as_a_whole_and_nothing_else():
    here, there = (_geometry(replace(SCENE, "accuracy.grid_shift", s)) for s in (0, 0.5))
    moved = there.barrier.points - here.barrier.points
    assert np.allclose(moved, [0.5 * here.tip_size, 0, 0], rtol=0, atol=1e-15)
    assert np.array_equal(here.barrier.cells, there.barrier.cells)
    assert np.array_equal(here.rod_points, there.rod_points)


def test_an_elastic_impact_hardly_feels_the_place_of_the_grid():
    still = scenes.scene("vibration", "friction", "barrier-elastic", length=0.08, max_time=3e-4)
    e = [
        reduce(solve(Case.of(s))).restitution.edge.e
        for s in (still, replace(still, "accuracy.grid_shift", 0.5))
    ]
    assert 0 < abs(e[1] - e[0]) < 0.002


@pytest.mark.parametrize(
    ("effects", "rows"),
    [
        (("vibration", "friction", "barrier-elastoplastic"), 3),
        (("vibration", "barrier-elastoplastic"), 0),
        (("vibration", "friction", "barrier-elastic"), 0),
    ],
)
def test_rows_are_thin_where_a_plate_that_flows_may_stick(effects, rows):
    geometry = _geometry(replace(SCENE, "effects", effects))
    z = geometry.barrier.points[geometry.barrier.cells][:, :, 2]
    assert geometry.skin_rows == rows
    assert np.ptp(z, axis=1).min() / geometry.tip_size == pytest.approx(0.5**rows, rel=0.15)


@pytest.mark.long
def test_corners_of_the_fine_zone_stay_elastic_and_never_flow(monkeypatch):
    scene = replace(SCENE, "save.frames", 0)
    part = solve(Case.of(scene))
    monkeypatch.setattr("fem_impact.case.zones._round", lambda mesh, *_: mesh.finest)
    whole = solve(Case.of(scene))
    counts = [[zone.count for zone in found.model.zones] for found in (part, whole)]
    assert max(few / many for few, many in zip(*counts, strict=True)) < 0.75
    few, many = (reduce(found) for found in (part, whole))
    for key in ("e_edge", "mu", "E_vib_over_E_0", "E_plastic_rod_over_E_0", "E_plastic_barrier_over_E_0"):
        assert few.to_dict()[key] == pytest.approx(many.to_dict()[key], abs=2e-4)
    assert few.restitution.edge.e != many.restitution.edge.e


def test_without_friction_no_row_is_thin_whatever_is_on():
    on = replace(SCENE, "effects", ("vibration", "friction", "barrier-elastoplastic"))
    assert _geometry(replace(on, "surface.friction", 0.0)).skin_rows == 0


def test_rows_are_no_lower_than_a_share_of_the_indentation():
    """Under a fast long rod cells were crushed at the edge of the contact."""
    fast = replace_all(load("t5b"), {"projectile.length": "200 mm", "impact.v_n": "-8 m/s"})
    depth = _estimate(fast).depth
    for size in ("0.6 mm", "0.3 mm", "0.15 mm"):
        geometry = _geometry(replace(fast, "accuracy.tip_size", size))
        assert 0 <= geometry.skin_rows < 3
        assert geometry.tip_size * 0.5**geometry.skin_rows >= LOW * depth
        assert geometry.tip_size * 0.5 ** (geometry.skin_rows + 1) < LOW * depth


@pytest.mark.slow
def test_the_mass_of_thin_rows_saves_steps_and_moves_nothing(monkeypatch):
    scene = replace_all(SCENE, {"save.frames": 0, "accuracy.mass_scaling": 1.0})
    heavy = simulate(scene)
    monkeypatch.setattr("fem_impact.fem.mass_scaling.LOW", 1e-6)
    true = simulate(scene)
    assert heavy.cost.steps < 0.3 * true.cost.steps
    for key in ("e_edge", "mu", "E_vib_over_E_0", "W_friction_over_E_0", "E_plastic_barrier_over_E_0"):
        assert heavy.to_dict()[key] == pytest.approx(true.to_dict()[key], abs=1e-3)
    assert heavy.motion.Omega == pytest.approx(true.motion.Omega, rel=5e-3)
    assert heavy.restitution.edge.e != true.restitution.edge.e


def test_nodes_that_leave_the_barriers_zone_are_told_with_what_makes_it_wider():
    scene = load("t5b")
    model, watch = (
        SimpleNamespace(book=SimpleNamespace(outside=9), zones=()),
        SimpleNamespace(below=lambda: ""),
    )
    (told,) = filter(None, outside_zones(model, watch))
    assert told.startswith("9 rod nodes left the fine zone of the barrier")
    width = Case.of(scene).zones.barrier[-1][0]
    size = Case.of(scene).zones.barrier_size
    for key, value in (("accuracy.fine_zone", "even"), ("accuracy.barrier_size", f"{2e3 * size} mm")):
        assert key in told
        assert Case.of(replace(scene, key, value)).zones.barrier[-1][0] > 1.2 * width


def test_skin_that_came_down_elsewhere_has_a_fine_zone_in_the_next_mesh():
    model = build(Case.of(SCENE))
    state, watch = model.initial_state(), SkinWatch(model)
    z = model.geometry.rod.mesh.points[:, 2]
    tail = model.layout.rod[z > 0.95 * z.max()]
    before = ContactWatch(model, 1.0, moves=False).record()
    assert watch.with_landed(before, model, state.x) is before
    state.x[tail[:, 2]] = -2e-3 + 0.1 * (state.x[tail[:, 0]] - state.x[tail[:, 0]].mean())
    assert watch.observe(state)
    after = watch.with_landed(before, model, state.x)
    skin, under = after.rod.touched, after.barrier.touched
    assert len(skin) == len(under) > 50 and skin[:, 2].min() > 0.8 * z.max()
    t = state.x[tail[:, 0]]
    assert t.min() <= under[:, 0].min() < under[:, 0].max() <= t.max() and not under[:, 2].any()
    places = np.unique(skin.round(9), axis=0)  # without corners that faces share
    gap = np.linalg.norm(places[:, None] - places, axis=2) + np.where(np.eye(len(places)), np.inf, 0.0)
    assert gap.min(axis=1).max() < 1.01 * after.rod.edge  # as close as cells of the record
