"""A rod with a round end along its axis, through the solver."""

import pytest

from fem_impact.verify.catalogue import verify


def test_a_short_rod():
    assert verify("sears", {"length": 0.08, "speed": 4.0, "cells": 2}).passed


@pytest.mark.validation
@pytest.mark.parametrize("change", [{}, {"length": 0.08, "speed": 4.0}])
def test_a_rod_is_sears(change):
    assert verify("sears", change).passed
