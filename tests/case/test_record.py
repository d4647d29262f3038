"""What may touch, from the shapes alone."""

from math import cos, radians, sin

import numpy as np
import pytest
from scipy.spatial import cKDTree

from fem_impact.case.bodies import Bodies
from fem_impact.case.record import MOST, low_skin
from fem_impact.scene.shipped import load, replace_all

MM = 1e-3


@pytest.mark.parametrize("angle", [0.0, 25.0, -25.0, 89.95, 90.0])
def test_all_skin_that_is_low_is_among_what_may_touch(angle):
    """A rod of 19 x 80 mm: points at random on its side and its faces stand near a place, or lie higher."""
    impact = {"impact.angle": f"{angle} deg", "impact.v_n": "-2 m/s", "impact.v_t": "0 m/s"}
    rod = {"projectile.length": "80 mm", "projectile.tip": "plain", "projectile.tip_radius": "0 mm"}
    bodies = Bodies(replace_all(load("t5b"), {**impact, **rod}), ())
    apart, high = 0.2 * MM, 0.5 * MM
    places, spacing = low_skin(bodies, apart, high)
    assert spacing == apart and 20 < len(places) < MOST

    random, count = np.random.default_rng(4), 200_000
    rho, z = np.full(count, 9.5 * MM), random.uniform(0, 80 * MM, count)
    face = random.random(count) < 0.3
    rho[face], z[face] = (
        9.5 * MM * random.random(face.sum()) ** 0.5,
        random.choice([0.0, 80 * MM], face.sum()),
    )
    around = random.uniform(0, np.pi, count)
    skin = np.stack([rho * np.cos(around), rho * np.sin(around), z], axis=1)
    turn = radians(angle)
    heights = [x[:, 2] * cos(turn) - x[:, 0] * sin(turn) for x in (skin, places)]
    lowest = min(heights[0].min(), heights[1].min())
    assert heights[1].max() <= lowest + high * (1 + 1e-9)
    low = skin[heights[0] <= lowest + high - apart]
    assert len(low) > 20
    assert cKDTree(places).query(low)[0].max() < 1.5 * apart


def test_places_stand_farther_apart_where_no_machine_holds_so_many():
    bodies = Bodies(replace_all(load("t5b"), {"impact.angle": "0 deg"}), ())
    places, spacing = low_skin(bodies, 1e-7, 1e-5)
    assert MOST / 5 < len(places) <= MOST
    nearest = cKDTree(places).query(places[::1000], k=2)[0][:, 1]
    assert spacing / 2 < nearest.max() < 1.01 * spacing
