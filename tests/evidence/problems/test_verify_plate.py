"""A sphere on thin plates through the solver."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.evidence.problems.problem import verify


def held(values):
    found = verify("plate", values)
    assert found.passed, [(c.name, c.error) for c in found.checks if not c.passed]
    return {c.name: c for c in found.checks}


@pytest.mark.long
def test_a_sphere_on_plates_under_a_rigid_skin_obeys_zeners_equation():
    found = held({"cells": 3, "across": 8, "block": 0})
    assert found["e, lambda 1"].reference < 0.2 < 0.9 < found["e, lambda 0.05"].reference


@pytest.mark.slow
def test_a_sphere_on_plates_that_dent_obeys_zeners_equation():
    assert len(held({})) == 12


def test_plates_in_no_order_are_refused():
    with pytest.raises(SceneError, match="above the least"):
        verify("plate", {"least": 0.5, "most": 0.3})


@pytest.mark.slow
def test_a_sphere_on_plates_meshed_through_obeys_zeners_equation_and_feels_no_edges():
    found = verify("thin-plate", {"speed": 1.0, "cells": 2, "across": 6})
    assert found.passed, [(c.name, c.error) for c in found.checks if not c.passed]
    shown = next(check for check in found.checks if not check.judged)
    assert shown.computed < 0.97 * shown.reference  # a half-space under a wide contact gives too large an e


def test_speeds_in_no_order_are_refused():
    with pytest.raises(SceneError, match="above the slow speed"):
        verify("thin-plate", {"speed": 1.0, "fast": 0.5})
