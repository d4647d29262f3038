"""Benchmarks, run with ``pytest tests/rigid/test_speed.py --benchmark-only``: a million impacts each."""

import numpy as np
import pytest

from rigid import General, coefficients, losses, sliding_path, solve

N = 1_000_000
ROD = {"d_c": 0.0226, "d_d": 0.035, "k2": 5.56e-4}


@pytest.fixture(scope="module")
def drops():
    rng = np.random.default_rng(0)
    return -rng.uniform(1, 3, N), -rng.uniform(0, 3, N)


def algebra(v_n, v_t):
    after = solve(v_n, v_t, e=0.4, mu=0.5, **ROD)
    return coefficients(v_n, v_t, *after, **ROD), losses(v_n, v_t, *after, **ROD, mass=0.175)


def test_algebraic_impacts(benchmark, drops):
    found, _ = benchmark(algebra, *drops)
    np.testing.assert_allclose(found.e, 0.4, rtol=1e-9)


def test_sliding_paths(benchmark, drops):
    path = benchmark(lambda: sliding_path(*drops, e=0.4, f=0.57, **ROD))
    assert path.loss.min() >= 0


def test_general_systems(benchmark, drops):
    after = benchmark(lambda: General(*drops, e=0.4, mu=0.3, mass=0.175, **ROD).solve())
    assert after.V_n.shape == (N,)
