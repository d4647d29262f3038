"""Tests of other people beside the solver: what is compared, with which uncertainty."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2, f

from fem_impact.answers.report import Request
from fem_impact.answers.v_and_v import Comparison
from fem_impact.evidence.studies import others
from fem_impact.evidence.studies.others import Rod

ROD = Rod("mine", "steel-4340", 0.03, 0.006, 200.0, 0.9, float("nan"))


def test_what_is_compared(tmp_path):
    every = others.rods()
    counts = {name: sum(rod.series == name for rod in every) for name in {rod.series for rod in every}}
    assert counts == {"wilkins-guinan-1973": 10, "house-1995": 23, "gust-1982": 5, "rods-4340": 6}
    assert all(rod.drive <= 1.6 and rod.final <= 0.96 for rod in every)
    assert len(others.plan(Request(tmp_path), {})) == 15
    assert others.spheres()["e_t at 20.1 deg"] == ("e_t", 20.0845, 0.5964)


def test_one_flow_stress_moves_all_numbers_of_a_series(monkeypatch):
    def flattened(self, slices, factor=1.0):
        return np.array([self.final + 0.01 + 0.1 * (factor - 1) + 0.002 * (slices < others.SLICES), 1.2])

    monkeypatch.setattr(Rod, "flattened", flattened)
    tests = [replace(ROD, speed=speed, final=1 - 2e-6 * speed**2) for speed in (100.0, 150.0, 200.0, 250.0)]
    found = others.compared_rods(tests)
    moved = 0.1 * (others.FASTER["steel-4340"] - 1) / 3**0.5
    for one in found.comparisons:
        assert (one.E, one.u_num, one.u_input) == pytest.approx((0.01, 0.001, moved))
        assert one.u_D == pytest.approx(0.0, abs=1e-12)  # these lie on their curve
    assert found.C == pytest.approx(moved**2 + 1e-6 * np.eye(4))


def test_the_scatter_of_tests_is_that_about_their_curve():
    rods = [replace(ROD, speed=100.0, final=0.9 + change) for change in (-0.01, 0.01, -0.01, 0.01)]
    rods.append(replace(ROD, speed=200.0, final=0.7))
    assert others._scatter(rods, "final") == pytest.approx(((4 * 0.01**2 / 3) ** 0.5, 3))


def test_the_scatter_of_two_tests_about_one_parameter_is_hardly_known():
    """Two feet of wilkins-guinan-1973 made p = 6e-17 of a distance that a scatter so badly known allows."""
    ones = tuple(Comparison("s", f"foot {at}", 1.0, 0.0, 0.0, 0.0, 0.1, dof=1.0) for at in range(2))
    badly, well = (
        others.OthersSeries("s", ones, 0.01 * np.eye(2), (("foot", dof),) * 2).together
        for dof in (1.0, np.inf)
    )
    assert badly == pytest.approx((200.0, f.sf(100.0, 2, 1)))
    apart = others.OthersSeries("s", ones, 0.01 * np.eye(2), (("foot", 3.0), ("length", 3.0))).together
    assert apart[1] == pytest.approx(f.sf(100.0, 2, 6))  # two scatters, each known by three
    assert well == pytest.approx((200.0, chi2.sf(200.0, 2)))
