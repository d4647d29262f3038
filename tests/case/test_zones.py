"""How far each level of splitting reaches, and the sizes that a scene gets unless it states them."""

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.case.cells import ADVISED, contact_radius, levels_of
from fem_impact.case.zones import FEWEST, share_of
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest


def zones(**changes):
    accuracy = {f"accuracy.{key}": value for key, value in changes.items()}
    return Case.of(replace_all(load("t5b"), accuracy)).zones


def test_finer_levels_reach_less_far():
    made = zones(tip_size="0.15 mm")
    assert len(made.rod) == len(made.barrier) == 4
    for extents in (made.rod, made.barrier):
        depth = [n for _, _, n in extents]
        assert depth == sorted(depth, reverse=True)
        assert depth[-1] < 0.6 * depth[1]
        for level, sides in enumerate(extents, 1):
            assert min(sides) >= FEWEST * made.base / 2**level * (1 - 1e-12)


def test_the_barrier_has_a_size_of_its_own():
    both, finer = zones(), zones(barrier_size="0.15 mm")
    assert finer.rod == both.rod
    assert (finer.tip_size, finer.barrier_size) == (both.tip_size, both.barrier_size / 2)


@pytest.mark.parametrize("name", ["t2", "t5b", "t5d", "t6-17", "t6-60", "elastic-frictionless"])
def test_a_scene_without_a_size_gets_one_from_its_contact(name):
    planned = Case.of(load(name))
    kind = "elastic" if name.startswith("elastic") else "yielding"
    cells = contact_radius(planned.bodies) / planned.zones.tip_size
    assert ADVISED[kind] / 1.6 < cells < 1.6 * ADVISED[kind]


def test_a_slower_rod_gets_smaller_cells():
    slow = Case.of(replace_all(load("t5b"), {"impact.v_n": "-0.15 m/s", "impact.v_t": "-0.15 m/s"}))
    assert levels_of(slow.bodies)[0] > levels_of(Case.of(load("t5b")).bodies)[0]


def test_shares_follow_the_cells_over_the_radius():
    shares = ((6.0, (0.5, 0.7, 0.2)), (3.0, (0.7, 0.9, 0.45)))
    assert share_of(7.0, shares) == (0.5, 0.7, 0.2)
    assert share_of(3.0, shares) == (0.7, 0.9, 0.45)
    assert share_of(2.9, shares) == (1.0, 1.0, 1.0)
    assert np.prod(share_of(100.0, ())) == 1.0


def test_even_zones_fill_what_may_yield_on_every_level():
    graded, even = zones(tip_size="0.15 mm"), zones(tip_size="0.15 mm", fine_zone="even")
    assert even.half == graded.half
    for extents, before in ((even.rod, graded.rod), (even.barrier, graded.barrier)):
        assert extents[-1] == pytest.approx(even.half)
        assert np.prod(extents[-1]) > 3 * np.prod(before[-1])
    scenes = [replace_all(load("t5b"), {"accuracy.fine_zone": word}) for word in ("graded", "even")]
    assert [digest(scene) == digest(load("t5b")) for scene in scenes] == [True, False]
