"""What the quick estimates of effects are worth: the stored table is what the stored runs say."""

import runpy
from pathlib import Path

import pytest

from fem_impact.case.measured import estimate_errors

SCRIPT = Path(__file__).parents[1] / "benchmarks" / "estimate_error.py"


def test_the_stored_errors_are_those_of_the_stored_runs():
    fresh = {name: rest for name, *rest in runpy.run_path(str(SCRIPT))["errors"]()}
    stored = estimate_errors()
    assert set(fresh) == set(stored)
    for name, (scenes, e, E_vib) in fresh.items():
        assert stored[name] == (scenes, pytest.approx(e, rel=0.01), pytest.approx(E_vib, rel=0.01))
    assert stored["friction"][1] > 0.1 and stored["contact-heating"][1] == 0.0
