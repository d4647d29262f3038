"""A started run of a study goes on from its checkpoint; one that does not fit is begun anew."""

import pytest

import fem_impact.run.simulate
from fem_impact.errors import ResultError
from fem_impact.jobs.job import Job, compute
from fem_impact.scene.shipped import load


class Told:
    """Stands for the outcome of a run."""

    def to_json(self):
        return "outcome"


@pytest.mark.parametrize(("fits", "tries"), [(True, [True]), (False, [True, False])])
def test_a_started_run_resumes_if_it_fits(fits, tries, tmp_path, monkeypatch):
    asked = []

    def simulate(scene, fidelity, options):
        asked.append(options.resume)
        if options.resume and not fits:
            raise ResultError("another program")
        return Told()

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", simulate)
    answer = compute(Job("one", load("t5b"), out=tmp_path))
    assert (answer.outcome, answer.reason, asked) == ("outcome", "", tries)
