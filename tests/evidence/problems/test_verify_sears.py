"""A rod with a round end along its axis, through the solver."""

import numpy as np
import pytest

from fem_impact.evidence.problems.problem import problem, verify
from fem_impact.evidence.problems.sears_rod import rod_model
from fem_impact.evidence.references.hertz import contact_modulus
from fem_impact.evidence.references.rod_end import sears

SHORT = {"length": 0.08, "speed": 4.0, "cells": 2}


@pytest.mark.long
def test_a_short_rod():
    assert verify("sears", SHORT).passed


@pytest.mark.long
def test_the_edge_of_the_study():
    found = verify("sears", SHORT | {"tip_radius": "3 mm", "block": 0, "speed": 2.0})
    assert found.passed
    assert abs(found.checks[0].error) < 0.02


@pytest.mark.parametrize(
    "change",
    [
        SHORT,
        pytest.param(SHORT | {"across": 16}, marks=pytest.mark.long),
        SHORT | {"tip_radius": "3 mm", "block": 0},
    ],
)
def test_the_cells_are_counted_where_it_touches(change):
    """Not over the diameter: with 8 cells across they are 1.2 times as wide, with 16 0.86 times."""
    p = problem("sears").values(SHORT | change)
    E_star = contact_modulus(p["E"], p["nu"], p["barrier_E"] if p["block"] else np.inf, p["nu"])
    rod = p["E"], p["rho"], p["length"], p["diameter"] / 2
    force = sears(*rod, E_star, p["tip_radius"], p["speed"]).force
    touch = (3 * force * p["tip_radius"] / (4 * E_star)) ** (1 / 3)
    model, edge = rod_model(p, touch)
    points = model.geometry.rod_points
    beside = np.sort(np.hypot(points[:, 0], points[:, 1])[points[:, 2] < 0.1 * touch])
    assert edge >= beside[1] * (1 - 1e-9)
    assert 0.93 * p["cells"] < touch / beside[1] < 1.98 * p["cells"]  # each level halves the edge, nearly


@pytest.mark.validation
@pytest.mark.parametrize("change", [{}, {"length": 0.08, "speed": 4.0}, {"tip_radius": "3 mm"}])
def test_a_rod_is_sears(change):
    found = verify("sears", change)
    assert found.passed
    assert found.checks[0].tolerance < 0.02
