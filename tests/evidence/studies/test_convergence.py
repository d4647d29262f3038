"""The limits of measured sets: the levels of each, one row a quantity, what failed is said."""

import json
from dataclasses import replace

import pytest
from study_fakes import outcome, published

from fem_impact.answers.refine.extrapolate import MeshRuns
from fem_impact.answers.refine.work import Levels
from fem_impact.answers.report import Request
from fem_impact.evidence.studies.convergence import QUANTITIES, conclude, convergence_rows, plan
from fem_impact.jobs.job import Failure

pytestmark = pytest.mark.usefixtures("unrendered")

NUMBERS = {key.name: 0.5 for key in QUANTITIES.values()}


def run(size, place):
    """An outcome whose e is .4 - 100/m x size, and lies .01 higher or lower at a place of the grid."""
    e = 0.4 - 100.0 * size + (0.01 if place else -0.01)
    return outcome(**NUMBERS | {"tip_size_m": size, "e_paper": e, "cpu_s": 7.0})


def levels_of(*sizes):
    return Levels(tuple(MeshRuns(size, [run(size, at) for at in (0, 1)]) for size in sizes), len(sizes) - 1)


def study(out, broken=(), ids=("t5b",)):
    """The study of some sets, of which ``broken`` failed."""
    request = Request(out, ids)
    results = {
        job.name: Failure(job.name, "An element folded.")
        if job.name in broken
        else levels_of(6e-4, 3e-4, 2e-4)
        for job in plan(request, {})
    }
    return published(conclude, request, results)


def test_every_quantity_has_its_limit():
    rows = {row["quantity"]: row for row in convergence_rows("t5b", levels_of(4e-4, 3e-4, 2e-4))}
    assert rows["e"]["values"] == pytest.approx([0.36, 0.37, 0.38])
    assert rows["e"]["apart"] == pytest.approx([0.02] * 3)
    assert rows["e"]["fit"].value == pytest.approx(0.4)
    assert rows["e"]["fit"].order == pytest.approx(1.0, abs=1e-3)
    assert rows["e"]["fit"].band == pytest.approx(1.25 * 0.02, rel=1e-3)
    assert rows["mu"]["fit"].value == pytest.approx(0.5)


def test_the_study_writes_table_data_and_figure(tmp_path):
    found = study(tmp_path)
    line = next(line for line in found.text.splitlines() if line.startswith("| t5b | e |"))
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[2:6] == ["0.34", "0.37", "0.38", "0.4"]
    assert float(cells[6]) == pytest.approx(1, abs=1e-3)
    assert float(cells[7]) == pytest.approx(1.25 * 0.02, rel=1e-2)
    assert float(cells[9]) == pytest.approx(0.02)
    assert (
        "0.38 ± 0.025 at 0.2 mm, limit 0.4 (order 1.0); the last level of a default run, at 0.3 mm, is -0.03 "
        "off the limit." in found.text
    )
    answer = next(line for line in found.text.splitlines() if line.startswith("- "))
    assert "default run lies at most 0.03 of e," in answer and "finest level here 0.02 of e," in answer
    assert "limits are at most 0.025 of e," in answer
    assert len((tmp_path / "convergence.csv").read_text().splitlines()) == 1 + len(QUANTITIES)
    assert (tmp_path / "figures" / "convergence.svg").exists()
    assert json.loads((tmp_path / "study.json").read_text())["sheets"][0]["rows"]


def test_what_the_default_levels_tell_is_held_to_the_limit_of_all(tmp_path):
    """.34 and .37 tell .392 +- .028, which holds .4; without order their e would stay at .37."""
    told = len(QUANTITIES)
    assert f"{told} of {told} bands that the levels of a default run tell" in study(tmp_path).text
    wide = levels_of(6e-4, 3e-4, 2e-4)
    wide.meshes[0].runs[:] = wide.meshes[1].runs
    (row,) = (row for row in convergence_rows("t5b", wide) if row["quantity"] == "e")
    value, half = row["default_band"]
    assert abs(value - 0.4) > 2 * half


def test_a_failed_set_is_said_and_the_others_still_count(tmp_path):
    found = study(tmp_path, {"t5b"}, ("t5b", "t6-17"))
    assert [f["scene_id"] for f in found.document["failures"]] == ["t5b"]
    assert "| t6-17 | e |" in found.text
    assert "| t5b | e |" not in found.text


def test_a_pilot_that_resolves_nothing_counts_where_there_are_no_three_others():
    levels = levels_of(6e-4, 4e-4, 3e-4, 2e-4)
    lost = [replace(levels.meshes[0], resolved=False), *levels.meshes[1:]]
    for meshes, sizes in ((lost, [4e-4, 3e-4, 2e-4]), (lost[:3], [6e-4, 4e-4, 3e-4])):
        row = convergence_rows("t5b", Levels(tuple(meshes), 3))[0]
        assert row["tip_size_m"] == sizes
        assert row["tip_size_m"][row["default"]] == 3e-4


def test_two_levels_have_no_limit():
    assert convergence_rows("t5b", levels_of(6e-4, 3e-4)) == []


def test_a_quick_study_leaves_out_the_dear_runs(tmp_path):
    (full,), (quick,) = (plan(Request(tmp_path, ("t5b",), quick=q), {}) for q in (False, True))
    assert (full.finer, full.scene.accuracy.offsets) == (1, 2)
    assert (quick.finer, quick.scene.accuracy.offsets) == (0, None)
