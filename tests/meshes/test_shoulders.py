"""A sudden step of the radius is meshed as a cone of the same volume."""

from itertools import pairwise

import numpy as np
import pytest

import meshes
import rigid
from meshes.revolved import without_shoulders
from meshes.shoulders import eased

PIN = np.array([[0, 0], [4e-3, 0], [4e-3, 0.08], [12e-3, 0.08], [12e-3, 0.18]])
UNDER = np.array([[0, 0], [9e-3, 0], [8e-3, 0.01], [5e-3, 0.01], [5e-3, 0.06]])  # a head with a tapered side


def volume(line):
    """Return the volume, m3, of the cones between points (rho, z), m."""
    return sum(
        np.pi / 3 * (high - low) * (wide**2 + wide * thin + thin**2)
        for (thin, low), (wide, high) in pairwise(line)
    )


@pytest.mark.parametrize(("line", "within"), [(PIN, 1e-12), (UNDER, 2e-2)])
def test_the_cone_has_the_volume_of_the_shoulder_between_straight_neighbours(line, within):
    new, (place,) = eased(line, line[:, 0] / 4)
    assert place == line[2, 1]
    assert volume(new) == pytest.approx(volume(line), rel=within)
    assert new[3, 1] - new[2, 1] == pytest.approx(0.5 * abs(line[3, 0] - line[2, 0]))
    assert not eased(new, new[:, 0] / 4)[1], "the cone is no shoulder itself"


@pytest.mark.parametrize("line", [PIN, UNDER, PIN[::-1] * [1, -1] + [0, 0.18]])
def test_a_body_with_a_shoulder_is_meshed(line):
    line = line if line[0, 0] == 0 else np.concatenate([[[0.0, 0.0]], line[:-1]])
    body = meshes.turned(line, 8).mesh
    assert 2 * meshes.volume(body) == pytest.approx(volume(eased(line, line[:, 0] / 4)[0]), rel=0.02)


def test_faces_and_gentle_steps_stay():
    plain = np.array([[0, 0], [4e-3, 0], [4e-3, 0.05], [5e-3, 0.06], [5e-3, 0.1], [0, 0.1]])
    new, cones = eased(plain, plain[:, 0] / 4)
    assert np.array_equal(new, plain) and not cones


@pytest.mark.parametrize("step", [0.2e-3, 1e-3])
def test_a_small_step_makes_no_row_of_slivers(step):
    line = np.array([[0, 0], [6e-3, 0], [6e-3, 0.05], [6e-3 + step, 0.05], [6e-3 + step, 0.12]])
    assert len(eased(line, line[:, 0] / 4)[1]) == 1
    mesh = meshes.turned(line, 8).mesh
    corners = mesh.points[mesh.cells]
    near = np.abs(corners[:, :, 2].mean(axis=1) - 0.05) < 6e-3
    rows = corners[near, 4:, 2].mean(axis=1) - corners[near, :4, 2].mean(axis=1)
    assert rows.min() > 0.9 * 2 * 6e-3 / 8


NO_BORE = np.zeros((0, 2))
DISC = np.array([[0, 0], [20, 0], [20, 6], [30, 6], [30, 12]]) * 1e-3
RING = np.array([[0, 0], [30, 0], [30, 12]]) * 1e-3, np.array([[10, 0], [10, 6], [15, 6], [15, 12]]) * 1e-3
TUBE = np.array([[0, 0], [9.5, 0], [9.5, 80]]) * 1e-3, np.array([[8, 0], [8, 40], [5, 40], [5, 80]]) * 1e-3


@pytest.mark.parametrize(("line", "bore"), [(DISC, None), RING, TUBE])
def test_a_mesh_has_its_mass_where_a_stepped_body_has_it(line, bore):
    """The disc had 1.18 of its mass, the ring .957; what was missing was put at the tip."""
    whole = meshes.cell_moments(meshes.turned(line, 8, bore=bore).mesh)
    stated = volume(line) - (0.0 if bore is None else volume(bore))
    assert 2.0 * whole.volume.sum() == pytest.approx(stated, rel=4e-3)
    centre = rigid.Turned(line, ((line[-1, 1], 1.0),), bore).z_c
    assert whole.z.sum() / whole.volume.sum() == pytest.approx(centre, abs=6e-3 * line[-1, 1])


def test_a_groove_without_room_for_cones_stays():
    line = np.array([[0, 0], [9.5, 0], [9.5, 30], [9, 30], [9, 31.5], [9.5, 31.5], [9.5, 80]]) * 1e-3
    assert np.array_equal(without_shoulders(line, NO_BORE, 8)[0], line)
    assert len(without_shoulders(line, NO_BORE, 16)[2]) == 2
