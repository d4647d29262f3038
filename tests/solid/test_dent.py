"""The dent that stays: of a skin whose shape is known."""

import numpy as np
import pytest

from fem_impact.solid.contact.patch import make_patch
from fem_impact.solid.dent import border, dent, sunk

N, SIZE = 40, 2e-3


@pytest.mark.parametrize("tilt", [0.0, 0.02])
def test_depth_and_volume_of_a_paraboloid_with_a_lip_in_a_plane_that_moved_and_tilted(tilt):
    """Half of it is meshed; pi a^2 d / 2 is its volume, and what stands above the plane does not count."""
    a, d, risen = 1e-3, 5e-5, 3e-4
    t, b = np.meshgrid(np.linspace(-SIZE, SIZE, 2 * N + 1), np.linspace(0, SIZE, N + 1), indexing="ij")
    r = np.hypot(t, b)
    n = np.where(r < a, d * (r**2 / a**2 - 1), np.where(r < 1.4 * a, 0.2 * d, 0.0))
    points = np.stack([t, b, n + risen + tilt * t], axis=-1).reshape(-1, 3)
    numbers = np.arange(len(points)).reshape(t.shape)
    quads = np.stack([numbers[:-1, :-1], numbers[1:, :-1], numbers[1:, 1:], numbers[:-1, 1:]], axis=-1)
    patch = make_patch(quads.reshape(-1, 4), np.arange(points.size).reshape(-1, 3), points)
    depth, volume = dent(patch, points.ravel())
    # that the motion is not finite is said by the guard of the step, which looks less often
    assert np.isnan(sunk(patch, border(patch), np.full(points.size, np.nan))).all()
    assert depth == pytest.approx(d, rel=1e-9)
    assert volume == pytest.approx(0.5 * np.pi * a**2 * d, rel=0.01)
