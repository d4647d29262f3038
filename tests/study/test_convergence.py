"""The limits of measured sets: one family of meshes, one row a quantity, what failed is said."""

import json

import pytest
from study_fakes import outcome

from fem_impact.progress import NullMeter
from fem_impact.scene import load
from fem_impact.solid.geometry import levels_of
from fem_impact.study import convergence as convergence_module
from fem_impact.study import run_convergence
from fem_impact.study.cases import Failure
from fem_impact.study.convergence import LEVELS, QUANTITIES, convergence_rows, family

NUMBERS = {key: 0.5 for key in QUANTITIES.values()}


def run(size):
    values = NUMBERS | {"tip_size_m": size, "e_paper": 0.4 - 100.0 * size, "cpu_s": 7.0}
    return outcome(**values)


@pytest.fixture
def solver(monkeypatch):
    """A solver that answers at once; the mesh of ``broken`` cells fails."""
    broken = set()

    def run_cases(cases, *_):
        return {
            case.out.name: Failure(case, "An element folded.")
            if case.scene.accuracy.across in broken
            else run(case.scene.accuracy.tip_size)
            for case in cases
        }

    monkeypatch.setattr(convergence_module, "run_cases", run_cases)
    return broken


def test_all_meshes_of_a_family_are_split_as_often():
    scenes = family(load("t5b"), (6, 8, 12))
    assert [levels_of(scene) for scene in scenes] == [LEVELS] * 3
    sizes = [scene.accuracy.tip_size for scene in scenes]
    assert sizes[0] / sizes[2] == pytest.approx(2.0)


def test_every_quantity_has_its_limit():
    rows = {row["quantity"]: row for row in convergence_rows("t5b", [run(h * 1e-4) for h in (4, 3, 2)])}
    assert rows["e"]["limit"] == pytest.approx(0.4)
    assert rows["e"]["order"] == pytest.approx(1.0, abs=1e-3)
    assert rows["e"]["band"] == pytest.approx(1.25 * 0.02, rel=1e-3)
    assert rows["mu"]["limit"] == pytest.approx(0.5)


def test_the_study_writes_table_data_and_figure(solver, tmp_path):
    study = run_convergence(["t5b"], (6, 8, 12), tmp_path, NullMeter(), 1)
    line = next(line for line in study.table.splitlines() if line.startswith("| t5b | e |"))
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[2:] == ["0.3604", "0.3703", "0.3802", "0.4", "1.0", "0.025"]
    assert json.loads((tmp_path / "convergence.json").read_text())["rows"] == study.rows
    assert len((tmp_path / "convergence.csv").read_text().splitlines()) == 1 + 3 * len(QUANTITIES)
    assert (tmp_path / "convergence.svg").stat().st_size > 1000


def test_a_failed_mesh_is_said_and_the_others_still_count(solver, tmp_path):
    solver.add(8)
    study = run_convergence(["t5b"], (6, 8, 10, 12), tmp_path, NullMeter(), 1)
    assert [f["scene_id"] for f in study.failures] == ["t5b-8"]
    assert len(study.rows[0]["values"]) == 3
    assert "t5b" in study.table


def test_two_meshes_have_no_limit(solver, tmp_path):
    solver.update({6, 8})
    study = run_convergence(["t5b"], (6, 8, 10, 12), tmp_path, NullMeter(), 1)
    assert study.rows == []
