"""The limits of measured sets: one family of meshes, one row a quantity, what failed is said."""

import json

import pytest
from study_fakes import outcome, published

from fem_impact.answers.refine.extrapolate import Limit
from fem_impact.answers.report import Request
from fem_impact.evidence.studies.convergence import (
    QUANTITIES,
    _pairs,
    conclude,
    convergence_rows,
    jobs_of,
    plan,
)
from fem_impact.jobs.job import Failure

NUMBERS = {key.name: 0.5 for key in QUANTITIES.values()}


def run(size, place=0.0):
    """An outcome whose e is .4 - 100/m x size, and lies .01 higher or lower at places of the grid."""
    e = 0.4 - 100.0 * size + (0.01 if place in (0.25, 0.5) else -0.01)
    return outcome(**NUMBERS | {"tip_size_m": size, "e_paper": e, "cpu_s": 7.0})


def study(out, broken=(), ids=("t5b",)):
    """The study of some sets, whose runs with names that begin like one of ``broken`` failed."""
    request = Request(out, ids)
    results = {}
    for job in plan(request, {}):
        size, place = job.scene.accuracy.tip_size, job.scene.accuracy.grid_shift
        failed = job.name.startswith(tuple(broken))
        results[job.name] = Failure(job.name, "An element folded.") if failed else run(size, place)
    return published(conclude, request, results)


def test_every_mesh_is_run_at_the_places_of_the_grid_that_the_ladder_has():
    jobs = jobs_of("t5b", False)
    assert [[job.scene.accuracy.grid_shift for job in mesh] for mesh in jobs] == [
        [0.0, 0.5, 0.25, 0.75]
    ] * 2 + [[0.0, 0.5]]
    sizes = [mesh[0].scene.accuracy.tip_size for mesh in jobs]
    assert sizes == sorted(sizes, reverse=True)
    assert len({job.name for mesh in jobs for job in mesh}) == 10


def test_every_quantity_has_its_limit():
    meshes = [[run(h * 1e-4), run(h * 1e-4, 0.5)] for h in (4, 3, 2)]
    rows = {row["quantity"]: row for row in convergence_rows("t5b", meshes)}
    assert rows["e"]["values"] == pytest.approx([0.36, 0.37, 0.38])
    assert rows["e"]["apart"] == pytest.approx([0.02] * 3)
    assert rows["e"]["fit"].value == pytest.approx(0.4)
    assert rows["e"]["fit"].order == pytest.approx(1.0, abs=1e-3)
    assert rows["e"]["fit"].band == pytest.approx(1.25 * 0.02, rel=1e-3)
    assert rows["mu"]["fit"].value == pytest.approx(0.5)


def test_two_meshes_are_held_to_the_limit_of_all():
    fit = Limit(0.1, 1.0, 0.1, 0.0)
    row = {"tip_size_m": [4.0, 2.0, 1.0], "values": [0.5, 0.3, 0.2], "fit": fit, "places": 2}
    assert _pairs([row]) == ["Two meshes, extrapolated: 3 of 3 bands hold the limit of all."]
    astray = row | {"values": [0.5, 0.45, 0.2]}  # .45 and .5 lead to .4 and leave .1 open, the others not
    assert _pairs([astray]) == ["Two meshes, extrapolated: 2 of 3 bands hold the limit of all."]
    single = astray | {
        "values": [0.5, 0.39, 0.2],
        "places": 1,
    }  # .39 and .5 lead to .31 +- .08 or .24
    assert _pairs([single]) == ["Two meshes, extrapolated: 3 of 3 bands hold the limit of all."]
    assert _pairs([single | {"places": 2}]) == [
        "Two meshes, extrapolated: 2 of 3 bands hold the limit of all."
    ]
    assert _pairs([]) == []


def test_the_study_writes_table_data_and_figure(tmp_path):
    found = study(tmp_path)
    line = next(line for line in found.text.splitlines() if line.startswith("| t5b | e |"))
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[2:6] == ["0.3406", "0.3703", "0.3852", "0.4"]
    assert float(cells[6]) == pytest.approx(1, abs=1e-3)
    assert float(cells[7]) == pytest.approx(1.25 * 0.01484, rel=1e-2)
    assert float(cells[9]) == pytest.approx(0.02)
    assert (
        "0.3852 ± 0.019 at 0.148 mm, limit 0.4 (order 1.0); at 0.297 mm, the usual mesh, -0.03" in found.text
    )
    answer = next(line for line in found.text.splitlines() if line.startswith("- "))
    assert "lies at most 0.015 from its limit" in answer and answer.endswith("reach ± 0.019.")
    assert "Two meshes, extrapolated: 27 of 27 bands hold the limit of all." in found.text
    assert len((tmp_path / "convergence.csv").read_text().splitlines()) == 1 + len(QUANTITIES)
    assert (tmp_path / "figures" / "convergence.svg").stat().st_size > 1000
    assert json.loads((tmp_path / "study.json").read_text())["sheets"][0]["rows"]


def test_a_failed_mesh_is_said_and_the_others_still_count(tmp_path):
    found = study(tmp_path, {"t5b-0.594"}, ("t5b", "t6-17"))
    assert [f["scene_id"] for f in found.document["failures"]] == [
        f"t5b-0.594-{place}" for place in ("0", "0.5", "0.25", "0.75")
    ]
    assert "| t6-17 | e |" in found.text
    assert "| t5b | e |" not in found.text  # two meshes have no limit


def test_a_quick_study_leaves_out_the_dear_runs(tmp_path):
    full, quick = (plan(Request(tmp_path, ("t5b",), quick=q), {}) for q in (False, True))
    assert (len(full), len(quick)) == (10, 3)  # a limit takes three meshes
    finest = min(job.scene.accuracy.tip_size for job in full)
    assert all(job.scene.accuracy.tip_size > finest for job in quick)
