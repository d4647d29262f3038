"""Joint validation: the distance of Mahalanobis of a set's errors, and what it is made of."""

from math import erfc, exp, pi, sqrt

import numpy as np
import pytest
from study_fakes import outcome, published

from fem_impact.answers.report import Request
from fem_impact.evidence.studies.joint import (
    HEAD,
    SHOWN,
    SIZE,
    conclude,
    joint_error,
    plan,
    report_of,
    stored_rows,
)
from fem_impact.evidence.studies.report_parts import error_panel, rests_on
from fem_impact.scene.types import MEASURED_SETS


def rows(errors, u_num=0.0, u_input=0.0, u_D=0.0):
    """Numbers with errors and standard uncertainties, the same of each."""
    known = {"u_num": u_num, "u_input": u_input, "u_D": u_D}
    return [{"S": error, "D": 0.0, **known} for error in errors]


def along(*ways):
    """A sample of many inputs that move the numbers along ways, by amounts that do not belong together."""
    signs = np.array(np.meshgrid(*len(ways) * [[-1.0, 1.0]])).reshape(len(ways), -1)
    return signs.T @ np.array(ways, float)


FREE = along((1, 0, 0), (0, 1, 0), (0, 0, 1))


def test_errors_that_do_not_belong_together_add_their_squares():
    one = joint_error("a", rows((1.0, 1.9, -1.9), u_input=1.0), FREE, FREE)
    assert one.distance == pytest.approx(8.22) and one.shares == pytest.approx([1 / 8.22, *2 * [3.61 / 8.22]])
    # of three degrees of freedom
    assert one.p == pytest.approx(erfc(sqrt(4.11)) + sqrt(16.44 / pi) * exp(-4.11)) and one.alone == 0
    assert joint_error("a", rows((1.0, 2.1, 1.9), u_input=1.0), FREE, FREE).alone == 1


def test_numbers_that_agree_alone_disagree_where_the_inputs_move_them_together():
    """Friction raises both; one too high and one too low is what no friction gives."""
    together = along((1, 0.95, 0), (0, 0.3122499, 0), (0, 0, 1))  # correlation .95
    against = joint_error("a", rows((1.0, -1.0, 0.0), u_input=1.0), together, FREE)
    along_it = joint_error("a", rows((1.0, 1.0, 0.0), u_input=1.0), together, FREE)
    assert against.distance == pytest.approx(2 / (1 - 0.95), rel=1e-4) and against.alone == 0
    assert along_it.distance == pytest.approx(2 / 1.95, rel=1e-4)
    assert against.p < 0.05 < along_it.p


def test_uncertainties_of_mesh_and_tests_count_and_keep_their_size():
    one = joint_error("a", rows((3.0, 0.0, 0.0), 1.0, 2.0, 2.0), 7.0 * FREE, 0.1 * FREE)
    assert one.u == pytest.approx([3.0] * 3) and one.distance == pytest.approx(1.0)


def test_each_set_has_stored_values_and_runs_of_the_reduced_model():
    assert set(stored_rows()) == {*MEASURED_SETS}
    jobs = plan(Request("x"), {})
    assert len(jobs) == len(MEASURED_SETS) * (SIZE + 1) and {job.fidelity for job in jobs} == {"modal"}


def test_rejected_sets_are_named_with_the_way_that_they_are_off(tmp_path):
    far = joint_error("t2", rows((0.1, -9.0, 0.1), u_input=1.0), FREE, FREE)
    near = joint_error("t4", rows((0.1, 0.1, -0.1), u_input=1.0), FREE, FREE)
    report = report_of([far, near])
    assert "1 of 2 sets" in report.findings[0] and "(t2)" in report.findings[0]
    assert "mu too low in 1, too high in 1" in report.findings[1] and "mu in 1" in report.findings[1]
    assert "fail" in published(conclude, Request(tmp_path, ids=("t5b",)), {}).text


def test_the_study_reads_its_runs(tmp_path):
    request, rng = Request(tmp_path, quick=True), np.random.default_rng(1)
    results = {}
    for job in plan(request, {}):
        V_n, V_t, Omega = rng.normal((0.3, -0.4, 20.0), (0.1, 0.05, 2.0))
        results[job.name] = outcome(
            v_n_m_per_s=-1.5,
            v_t_m_per_s=-1.5,
            V_n_m_per_s=V_n,
            V_t_m_per_s=V_t,
            Omega_rad_per_s=Omega,
            k_squared_m2=6e-4,
            E_vib_over_E_0=0.01,
        )
    published(conclude, request, results)
    lines = (tmp_path / "joint.csv").read_text().splitlines()
    assert len(lines) == 2 and lines[1].startswith("t5b,") and len(HEAD) == 1 + 2 * len(SHOWN) + 4


def test_errors_stand_in_the_row_of_their_set_and_texts_tell_the_numbers_of_the_code():
    panel = error_panel("e", ("t4", "t5b"), {"default": [(0, 1.5), (1, -3.0)], "skin": [(1, 2.5)]})
    assert [(s.label, s.x, s.y, s.colour) for s in panel.series] == [
        ("default", [1.5, -3.0], [0.0, 1.0], 0),
        ("skin", [2.5], [1.0], 1),
    ]
    assert [mark.at for mark in panel.marks] == [-2.0, 2.0] and panel.rows == ("t4", "t5b")
    first, second = rests_on("joint", LEVEL=0.05, COVERAGE=2.0)
    assert "below 0.05 the set is rejected. Alone: numbers beyond 2 u_val." in first
    assert second.startswith("S, D and their uncertainties")
