"""Plates that are thin beside the contact: which are meshed through, and what is refused."""

import re

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.case.cells import body_cell
from fem_impact.case.layers import block_of
from fem_impact.case.limits import not_reduced
from fem_impact.case.plates import contact_width, half_space_error, widening
from fem_impact.errors import SceneError
from fem_impact.fem.geometry import build_geometry
from fem_impact.outcome.groups import texts
from fem_impact.physics.plate import least_span
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.tables.text import plain


def stated(thickness, **changes):
    bends = {"barrier.thickness": thickness, "barrier.support": "infinite"}
    return replace_all(load("t5b"), {"accuracy.tip_size": "0.7 mm", **bends, **changes})


def about(sentences, words):
    return [sentence for sentence in sentences if words in sentence]


def test_a_plate_bends_by_its_mesh_where_the_half_space_is_told_to_be_wrong():
    """The mesh stands in place of the impedance, never beside it."""
    thin, thick = Case.of(stated("5 mm")), Case.of(stated("12 mm"))
    assert (half_space_error(thin.bodies) > 0.02, half_space_error(thick.bodies) > 0.02) == (True, False)
    assert thin.slots.plate is None and thin.slots.bending > 0 and thin.zones.edges > 0
    assert thick.slots.plate > 0 and thick.slots.bending is None and thick.zones.edges == 0
    assert about(texts(thin.limitations, "model"), "its impedance is not added")
    assert not about(texts(thin.limitations, "model"), "may be off")
    assert not about(texts(thick.limitations, "model"), "thickness")


def test_the_reduced_model_keeps_the_impedance_and_tells_its_error():
    planned = Case.of(stated("5 mm"), "modal")
    assert planned.slots.plate > 0 and planned.slots.bending is None
    assert about(texts(planned.limitations, "model"), "e may be off by some")


@pytest.mark.parametrize("changes", [{"barrier.support": "backed"}, {"effects": ["auto", "-plate-bending"]}])
def test_a_plate_on_a_base_and_one_that_is_told_not_to_bend_are_not_meshed_through(changes):
    planned = Case.of(stated("5 mm", **changes))
    assert planned.slots.bending is None and planned.zones.edges == 0


def test_the_block_goes_no_further_beyond_a_thin_body_than_its_diameter():
    """The block of one of 19 mm goes 6 mm beyond its fine zone."""
    pin = {"projectile.length": "8 mm", "projectile.diameter": "1.9 mm", "projectile.tip_radius": "0.3 mm"}
    wide, told, close = (
        block_of(case.bodies, case.zones)
        for margin in ("6 mm", "1.9 mm", "0.6 mm")
        for case in [Case.of(replace_all(load("t5b"), pin | {"accuracy.block_margin": margin}))]
    )
    assert np.array_equal(wide, told)
    assert 1.0e-3 < wide[1][0] - close[1][0] < 1.6e-3


def test_its_edges_are_so_far_that_the_fastest_waves_do_not_come_back():
    planned = Case.of(stated("5 mm"))
    low, high = block_of(planned.bodies, planned.zones)
    assert planned.zones.edges == pytest.approx(0.5 * least_span(planned.contact), rel=1e-12)
    assert min(-low[0], high[0], high[1]) > planned.zones.edges


def test_a_contact_wider_than_the_plate_is_one_for_finite_elements():
    """One width is told of it, whatever says so."""
    scene = stated("2 mm", **{"accuracy.across": 10})
    width = f"{contact_width(Case(scene).bodies) * 1e3:.2g} mm"
    planned = Case.of(scene)
    assert planned.slots.bending > 0
    assert about(texts(planned.limitations, "model"), f"the contact is {width} wide")
    with pytest.raises(SceneError, match=rf"less than the width of the contact, {width}.*or use fidelity"):
        Case.of(scene, "modal")
    assert not_reduced(Case(scene).bodies) == "a plate thinner than its contact is wide"
    assert not_reduced(Case(stated("5 mm")).bodies) == ""


def test_a_long_contact_says_of_what_its_width_is_the_mean():
    """A tube on its side touched 280 mm x 1.4 mm, and 20 mm was called the width."""
    fall = {"impact.angle": "90 deg", "impact.v_n": "-5 m/s", "impact.v_t": "0 m/s"}
    scene = stated("1 mm", **fall)
    size = Case(scene).estimate
    long, short = (plain(2e3 * half, 2) for half in (size.a_t, size.a_b))
    with pytest.raises(SceneError, match=rf"the geometric mean of {long} mm and {short} mm"):
        Case.of(scene, "modal")


FINE = {"accuracy.across": 40, "accuracy.tip_size": "0.3 mm"}


def test_rows_too_flat_are_refused_with_the_cells_that_take_it():
    scene = stated("2 mm")
    with pytest.raises(SceneError, match=r"barrier.thickness = .2 mm.: leaves 2 rows") as refused:
        Case.of(scene)
    across = int(re.search(r"accuracy.across = (\d+) or", str(refused.value))[1])
    assert Case.of(replace_all(scene, {"accuracy.across": across})).slots.bending > 0


def test_a_plate_of_many_cells_has_larger_ones_away_from_the_contact():
    """As fine as asked for at the contact, and no flatter than half as high as wide."""
    coarse, fine = Case.of(stated("5 mm")), Case.of(stated("5 mm", **FINE))
    assert coarse.zones.base == body_cell(coarse.bodies)
    assert fine.zones.base == 4 * body_cell(fine.bodies) <= 5e-3
    assert fine.zones.barrier_size == pytest.approx(fine.scene.accuracy.tip_size, rel=0.5)
    assert fine.size.barrier < 1e5


def test_cells_of_a_plate_that_is_touched_for_long_widen_towards_its_edges():
    """The edges stay where they are; the shipped plate keeps equal cells."""
    shipped = Case.of(load("plate-10mm"))
    assert widening(shipped.bodies, shipped.zones.base) == 1.0
    case = Case.of(replace_all(load("plate-10mm"), {"barrier.thickness": "4 mm"}))
    bodies, zones = case.bodies, case.zones
    assert 2.0 < widening(bodies, zones.base) <= 4.0
    mesh = build_geometry(bodies, zones, 0.0, True).barrier
    assert mesh.points[:, 0].min() == pytest.approx(zones.block(zones.edges)[0][0])
    assert len(mesh.cells) == pytest.approx(case.size.barrier, rel=0.1) and len(mesh.cells) < 6000


def test_a_plate_of_too_many_cells_is_refused():
    with pytest.raises(SceneError, match=r"needs a mesh of .* cells: to \d+ mm.* Give a thicker plate"):
        Case.of(stated("0.3 mm", **{"accuracy.across": 64, "accuracy.tip_size": "0.1 mm"}))


def test_the_expected_elements_are_those_of_the_mesh():
    planned = Case.of(stated("5 mm", **{"accuracy.across": 6}))
    low, high = block_of(planned.bodies, planned.zones)
    assert planned.size.barrier > ((high - low) / planned.zones.base).prod() > 3000
    assert Case(planned.scene).active == planned.active


def test_it_is_told_what_a_dent_deep_beside_the_plate_leaves_out():
    def told(thickness):
        case = Case.of(stated(thickness, **{"impact.v_n": "-6 m/s", "barrier.support": "backed"}), "rigid")
        return about(texts(case.limitations, "model"), "tears or is pierced")

    assert told("0.1 mm") and not told("10 mm")


def test_a_wall_thinner_than_its_contact_counts_as_massive_where_there_is_no_mesh():
    for fidelity, is_told in (("rigid", True), ("modal", True), ("solid", False)):
        sentences = texts(Case.of(load("tube"), fidelity).limitations, "model")
        assert bool(about(sentences, "the bore 2.5 mm behind it: that the wall buckles")) == is_told


def test_a_sharp_edge_is_told_to_be_crushed_itself():
    sharp = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}
    for scene, is_told in ((replace_all(load("t5b"), sharp), True), (load("t5b"), False)):
        sentences = texts(simulate(scene, "rigid").validity.limitations, "model")
        assert bool(about(sentences, "it is crushed itself")) == is_told
