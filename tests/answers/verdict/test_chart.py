"""The design chart: its points are what the program computes, and what it says of their collapse."""

import runpy
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from fem_impact.answers.verdict.assess import assess
from fem_impact.answers.verdict.chart import COLUMNS, ChartPoints, chart, collapse, points
from fem_impact.answers.verdict.screening import screening
from fem_impact.answers.verdict.vibration import modal_pair
from fem_impact.case.case import Case
from fem_impact.outcome.keys import known
from fem_impact.scene.shipped import load

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "design_chart.py"


def made(n, change):
    """ChartPoints of random T1/tau and mu, and their change of e as a function of both."""
    rng = np.random.default_rng(0)
    ratio, mu = rng.uniform(0.3, 3.0, n), rng.uniform(0.0, 0.6, n)
    return ChartPoints("made", ratio, mu, change(ratio, mu, rng), ratio, np.ones(n, dtype=bool))


@pytest.mark.long
@pytest.mark.parametrize("row", [5, 101, 401, 702])  # without friction a tip follows round-off
def test_a_stored_point_is_what_the_program_computes(row):
    cases = runpy.run_path(str(SCRIPT))["cases"]()
    (_, scene), stored = next(islice(cases, row, None)), points()
    free, stiff = modal_pair(scene)
    assert stored.ratio[row] == pytest.approx(screening(Case(scene).bodies).ratio, rel=1e-4)
    assert stored.mu[row] == pytest.approx(known(free.restitution.mu), rel=1e-3, abs=1e-5)
    change = known(free.restitution.edge.e) - known(stiff.restitution.edge.e)
    assert stored.change[row] == pytest.approx(change, rel=1e-3, abs=1e-5)
    assert stored.E_vib[row] == pytest.approx(known(free.energy.vibration), rel=1e-3, abs=1e-7)


def test_every_case_is_stored_and_the_file_says_when_it_was_made():
    assert len(points().ratio) == sum(1 for _ in runpy.run_path(str(SCRIPT))["cases"]())
    assert points().made.startswith("made 20") and "commit" in points().made
    assert len(COLUMNS) == 10


def test_points_on_one_surface_collapse_and_scattered_ones_do_not():
    smooth = made(600, lambda ratio, mu, rng: 0.1 * np.log(ratio) + 0.2 * mu)
    scattered = made(600, lambda ratio, mu, rng: rng.normal(size=len(ratio)))
    one, none = collapse(smooth, smooth.change), collapse(scattered, scattered.change)
    assert one.within < 0.25 * one.among
    assert none.within > 0.7 * none.among
    assert one.compared > 300


def test_the_stored_points_do_not_fall_on_one_curve():
    """Like rods differ by a third of all: neither number nor both tell the change of e."""
    stored = points()
    for yielding in (True, False):
        some = stored.where(stored.yielding == yielding)
        found = collapse(some, np.abs(some.change))
        assert found.within > 0.25 * found.among


def test_the_verdict_stands_among_the_points():
    verdict = assess(load("t5b"), "modal", tolerance=0.07)
    picture = chart(verdict)
    e, vibration = picture.panels
    assert e.levels[0].at == 0.07
    for panel, value, band in (
        (e, abs(verdict.here.value), verdict.here.band),
        (vibration, verdict.here.E_vib, verdict.here.E_vib_band),
    ):
        own = panel.series[-1]
        assert (own.x[0], own.y[0], own.band[0]) == (verdict.screening.ratio, value, band)
        assert sum(len(series.x) for series in panel.series[:-1]) == int(points().yielding.sum())
    assert "do not fall on one curve" in picture.caption
