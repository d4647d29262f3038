"""Meshes of discs, rings, lids and short pins: sections alone, one upon the other."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import meshes
import rigid
from meshes import Zone
from meshes.hexmesh import SKIN
from meshes.quality import quality, require_positive

R = 12e-3
FLATNESS = [0.05, 1 / 12, 0.25, 0.5, 1.0]
CELLS = [6, 8, 12, 24, 64]


def disc(length, chamfer=0.0):
    edge = [[R - chamfer, 0], [R, chamfer], [R, length - chamfer], [R - chamfer, length]]
    return np.array([[0, 0], *(edge if chamfer else [[R, 0], [R, length]])])


def shape(name, length):
    """Outline and bore, m, of a body of radius R."""
    straight = {"ring": (0.67, 0, 1), "thin": (0.93, 0, 1), "lid": (0.8, 0.3, 1), "cap": (0.8, 0, 0.7)}
    if name in straight:
        radius, first, last = straight[name]
        return disc(length), np.array([[radius * R, first * length], [radius * R, last * length]])
    return disc(length, 0.2 * length if name == "chamfered" else 0.0), None


def mass(line, bore):
    """Volume, m3, of the whole solid of revolution."""
    return rigid.Turned(line, [(line[-1, 1], 1.0)], bore).mass


def about(place, size):
    return Zone(np.asarray(place), np.eye(3), np.full(3, -size), np.full(3, size))


@pytest.mark.long
@pytest.mark.parametrize("flat", FLATNESS)
@pytest.mark.parametrize("name", ["disc", "chamfered", "ring", "thin", "lid", "cap"])
def test_short_bodies_are_meshed_with_any_cells_across(name, flat):
    """Of their exact volume: without a zone every section has the area of the circle, but that at z = 0."""
    line, bore = shape(name, 2 * R * flat)
    for across in CELLS:
        body = meshes.turned(line, across, bore=bore)
        found = quality(body.mesh)
        assert found.min_scaled_jacobian > 0.5
        assert found.aspect < 10.0
        assert 2 * found.volume == pytest.approx(mass(line, bore), rel=0.03 if across < 12 else 6e-3)


@pytest.mark.parametrize("flat", FLATNESS)
@pytest.mark.parametrize("across", CELLS)
def test_a_disc_bends_over_two_cells_that_are_about_as_high_as_wide(flat, across):
    length = 2 * R * flat
    mesh = meshes.turned(disc(length), across).mesh
    heights = np.unique(np.round(mesh.points[:, 2] / length, 9))
    assert len(heights) >= 3
    step = length * np.diff(heights).max()
    assert step == pytest.approx(2 * R / max(across, 2 / flat), rel=0.5)


@pytest.mark.parametrize("place", [(1, 0), (1, 1), (-1, 0), (0, 0), (0, 1), (0.9, 0.5)])
@pytest.mark.parametrize("name", ["disc", "chamfered", "ring", "lid"])
def test_a_zone_may_lie_anywhere_in_a_short_body(name, place):
    length = 4e-3
    line, bore = shape(name, length)
    zone = about([place[0] * R, 0.0, place[1] * length], 0.2 * length)
    body = meshes.turned(line, 8, [zone] * 3, bore=bore, buffer=1)
    assert quality(body.mesh).min_scaled_jacobian > 0.35
    near = zone.gap(body.mesh.points[body.mesh.cells], np.full(len(body.mesh.cells), 1e-9)) == 0.0
    assert (body.mesh.level[near] == 3).all()
    assert near.any() or (bore is not None and place[0] == 0)


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_both_rims_are_round_where_their_cells_are_split(end):
    length = 2e-3
    zone = about([R, 0.0, end * length], 1e-3)
    body = meshes.turned(disc(length), 8, [zone] * 2, buffer=1)
    free = body.mesh.points[body.mesh.free_skin]
    rim = free[(zone.distance(free) == 0.0) & (np.abs(free[:, 2] - end * length) < 1e-12)]
    away = R - np.hypot(*rim[:, :2].T)
    assert (np.abs(away) < 1e-12).sum() >= 3
    assert away[np.abs(away) > 1e-12].min() > 0.1e-3


def test_faces_may_be_stated_with_or_without_their_centres():
    plain = meshes.turned(disc(2e-3), 8).mesh
    line = np.array([[0, 0], [6e-3, 0], [R, 0], [R, 2e-3], [3e-3, 2e-3], [0, 2e-3]])
    assert np.array_equal(meshes.turned(line, 8).mesh.points, plain.points)


def test_cells_of_a_thin_disc_are_told_as_they_are():
    """Not as asked for: so many that they are as wide as half the thickness."""
    line, place = disc(2e-3), np.array([R, 0.0])
    assert meshes.cells_across(line, 8) == 24
    assert meshes.contact_radius(line, place, 8) == pytest.approx(R / 3)
    assert meshes.cells_across(disc(24e-3), 8) == 8


@st.composite
def short_bodies(draw):
    """Outline, m, of a body that is no longer than wide, with chamfers or none, and its bore, if any."""
    length = 2 * R * draw(st.floats(0.05, 1.0))
    chamfers = draw(st.tuples(*[st.sampled_from([0.0, 0.1, 0.3])] * 2))
    lean = draw(st.floats(0.5, 2.0))
    (low, high), deep = np.array(chamfers) * length, np.minimum(lean * np.array(chamfers) * length, 0.3 * R)
    line = [[0, 0], [R - deep[0], 0], [R, low], [R, length - high], [R - deep[1], length]]
    line = np.array([point for point, there in zip(line, (1, 1, low > 0, high > 0, 1), strict=True) if there])
    if not draw(st.booleans()):
        return line, None
    radius, thick = draw(st.floats(0.21 * R, 0.95 * (R - deep.max()))), draw(st.floats(0.2, 0.4)) * length
    first, last = draw(st.sampled_from([(0, 1), (0, 0), (1, 1)]))
    return line, np.array([[radius, first * thick], [radius, length - (1 - last) * thick]])


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(short_bodies(), st.sampled_from([6, 8, 10, 16]), st.floats(0.0, 1.0), st.integers(0, 2))
def test_a_random_short_body_is_meshed_and_refined_anywhere(body, across, place, levels):
    line, bore = body
    if bore is None or bore[0, 1] > 0:
        rho, z = line[1 + round(place * (len(line) - 2))]
    else:
        rho, z = line[-1]
    zones = [about([rho, 0.0, z], 0.1 * line[-1, 1])] * levels
    mesh = meshes.turned(line, across, zones, bore=bore, buffer=1).mesh
    require_positive(mesh)
    assert quality(mesh).min_scaled_jacobian > 0.12
    skin = mesh.points[mesh.faces_with(SKIN)]
    assert np.hypot(skin[..., 0], skin[..., 1]).max() < 1.08 * R


def rounded(length, rounding, both=False):
    """Outline of a disc, the edge at its tip or both edges rounded; with 200 steps a rounding."""
    turn = np.linspace(0.0, np.pi / 2.0, 200)
    arc = np.stack([R - rounding + rounding * np.sin(turn), rounding - rounding * np.cos(turn)], axis=1)
    tail = np.stack([arc[::-1, 0], length - arc[::-1, 1]], axis=1) if both else np.array([[R, length]])
    line = np.concatenate([[[0.0, 0.0]], arc, tail])
    return line[np.concatenate([[True], np.linalg.norm(np.diff(line, axis=0), axis=1) > 1e-9])]


@pytest.mark.parametrize("both", [False, True])
@pytest.mark.parametrize("rounding", [0.05e-3, 0.4e-3, 1.2e-3])
@pytest.mark.parametrize("length", [2.4e-3, 6e-3])
def test_the_rim_of_a_disc_is_round_where_its_cells_are_split(length, rounding, both):
    line = rounded(length, rounding, both)
    middle = np.array([R - rounding * (1 - np.sqrt(0.5)), 0.0, rounding * (1 - np.sqrt(0.5))])
    centre = np.array([R - rounding, rounding])  # of the rounding
    for across in (8, 16):
        assert quality(meshes.turned(line, across).mesh).min_scaled_jacobian > 0.3
        fine = meshes.turned(line, across, [about(middle, size) for size in (1e-3, 1e-3, 0.5e-3)]).mesh
        require_positive(fine)
        skin = fine.points[fine.free_skin]
        away = np.column_stack([np.hypot(skin[:, 0], skin[:, 1]), skin[:, 2]]) - centre
        round_there = (away[:, 0] > 0.0) & (away[:, 1] < 0.0) & (np.linalg.norm(skin - middle, axis=1) < 1e-3)
        assert round_there.any()
        assert np.linalg.norm(away[round_there], axis=1) == pytest.approx(rounding, rel=1e-3)
