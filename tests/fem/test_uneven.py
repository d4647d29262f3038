"""A mesh that puts the mass of a body elsewhere is told."""

import pytest

from fem_impact.case.case import Case
from fem_impact.fem.body import MeshedBodies
from fem_impact.fem.uneven import uneven
from fem_impact.scene.shipped import load, replace_all

# what there is room for becomes a cone; a groove of two steps that are nearer than their cones does not
GROOVE = [["0 mm", "4 mm"], ["40 mm", "4 mm"], ["40 mm", "8 mm"], ["42 mm", "8 mm"]]
GROOVE += [["42 mm", "4 mm"], ["80 mm", "4 mm"]]
STEP = [["0 mm", "8.5 mm"], ["40 mm", "8.5 mm"], ["40 mm", "2.5 mm"], ["80 mm", "2.5 mm"]]
SLOPE = [["0 mm", "6 mm"], ["80 mm", "6 mm"]]


@pytest.mark.parametrize(("bore", "told"), [(GROOVE, True), (STEP, False), (SLOPE, False)])
def test_a_step_of_the_bore_that_cells_do_not_follow_is_told(bore, told):
    """Of a step the nose had .54 of its mass, the body .88 of its radius of gyration squared, untold."""
    stated = {"projectile.bore": bore, "projectile.tip": "plain", "impact.angle": "20 deg"}
    meshed = MeshedBodies(Case(replace_all(load("t5b"), stated)))
    assert ("mass centre of the mesh" in uneven(meshed)) == told


def test_a_ball_is_told_what_makes_its_mesh_rounder():
    """A step was told, which it has not."""
    ball = replace_all(load("t5b"), {"projectile.shape": "ball"})
    assert "step" not in (told := uneven(MeshedBodies(Case(ball))))
    assert "accuracy.across = 16" in told
    assert not uneven(MeshedBodies(Case(replace_all(ball, {"accuracy.across": 16}))))
