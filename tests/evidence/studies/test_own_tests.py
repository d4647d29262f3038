"""A scene that names a file of the user's own tests is compared with them as the paper's sets are."""

import html
import json
from html import escape
from pathlib import Path

import numpy as np
import pytest
from study_fakes import published

from fem_impact.answers.compare import compare
from fem_impact.case.case import Case
from fem_impact.errors import ResultError, SceneError
from fem_impact.evidence.studies import sets
from fem_impact.outcome.record import Outcome
from fem_impact.run.simulate import simulate
from fem_impact.run.tests import tests_of as measured_by
from fem_impact.scene.library import stated
from fem_impact.scene.own_tests import read_means
from fem_impact.scene.read import read_toml
from fem_impact.scene.shipped import load, replace
from fem_impact.scene.types import to_toml
from rigid.experiments import measured_set

pytestmark = pytest.mark.usefixtures("unrendered")

HEADER = "v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"


def write(folder, arms=(), change=""):
    """Write the rows of t5b as a file of own tests, and a scene that names it."""
    s = measured_set("t5b")
    names = ("v_n", "v_t", "V_n", "V_t", "Omega")
    rows = [
        ",".join(repr(float(x)) for x in (*row, *arms))
        for row in zip(*(s.motion[n] for n in names), strict=True)
    ]
    head = HEADER + (",d_c_m,d_d_m" if arms else "")
    (folder / "my_tests.csv").write_text("\n".join([head, *rows]) + "\n" + change)
    scene = to_toml(load("t5b")).replace('id = "t5b"', 'id = "mine"')
    path = folder / "mine.toml"
    path.write_text(scene.replace('measured = "t5b"', 'measured = "my_tests.csv"'))
    return path


def test_the_same_rows_and_arms_give_what_the_published_set_gives(tmp_path):
    s = measured_set("t5b")
    scene = read_toml(write(tmp_path, (float(s.arms.d_c), float(s.arms.d_d))))
    own, published = (simulate(one, "rigid") for one in (scene, load("t5b")))
    assert own.restitution.paper == published.restitution.paper
    rows = {row["quantity"]: row for row in compare(own, measured_by(scene))}
    for row in compare(published):
        if row["quantity"] in ("e", "mu", "Omega"):
            mine = rows[row["quantity"]]
            assert [mine[k] for k in ("model", "measured_mean", "measured_sd", "verdict")] == pytest.approx(
                [row[k] for k in ("model", "measured_mean", "measured_sd", "verdict")]
            )


def test_without_arms_those_of_the_tip_are_taken(tmp_path):
    scene = read_toml(write(tmp_path))
    outcome = simulate(scene, "rigid")
    assert outcome.restitution.paper.e == outcome.restitution.edge.e
    assert simulate(load("t5b"), "rigid").restitution.paper.e != outcome.restitution.edge.e


def test_a_changed_file_is_read_again(tmp_path):
    path = write(tmp_path)
    scene = read_toml(path)
    first = measured_by(scene)
    lines = (tmp_path / "my_tests.csv").read_text().splitlines()
    (tmp_path / "my_tests.csv").write_text("\n".join(lines[:-2]) + "\n")
    assert len(measured_by(scene).motion["v_n"]) == len(first.motion["v_n"]) - 2


def test_a_file_that_is_not_there_or_is_damaged_is_refused_before_any_work(tmp_path):
    path = write(tmp_path, change="-1,-1,nan,0,0\n")
    with pytest.raises(ResultError, match="is not a finite number"):
        simulate(read_toml(path), "rigid")
    (tmp_path / "my_tests.csv").unlink()
    with pytest.raises(SceneError, match=r"measured = .*there is no such file"):
        read_toml(path)


@pytest.mark.parametrize("head", [",d_c_m", ",d_c_m,d_d_m"])
def test_one_arm_or_several_are_refused(tmp_path, head):
    path = write(tmp_path)
    values = (",0.02", ",0.021") if head == ",d_c_m" else (",0.02,0.03", ",0.021,0.03")
    (tmp_path / "my_tests.csv").write_text(
        f"{HEADER}{head}\n-1.5,-1.5,0.4,-0.4,5{values[0]}\n-1.5,-1.5,0.4,-0.4,5{values[1]}\n"
    )
    with pytest.raises(ResultError, match="not one pair"):
        measured_by(read_toml(path))


def test_another_impact_no_longer_repeats_the_tests(tmp_path):
    scene = read_toml(write(tmp_path))
    assert replace(scene, "projectile.length", "90 mm").measured is None
    assert replace(scene, "surface.friction", 0.5).measured == str((tmp_path / "my_tests.csv").resolve())


@pytest.mark.parametrize(("arms", "told"), [((), "tip's"), ((0.02, 0.036), "tests'")])
def test_the_arms_of_e_are_called_the_tests_only_where_these_state_them(cli, tmp_path, arms, told):
    write(tmp_path, arms)
    _, out, _ = cli("run", "mine.toml", "--fidelity", "rigid", "--out", "made")
    assert f"restitution e ({told} arms)" in out
    cli("report", "made")
    assert f"e, the {told} arms" in html.unescape((tmp_path / "made" / "report.html").read_text())


def test_a_study_of_sets_takes_scene_files(tmp_path):
    path = write(tmp_path)
    job = sets.set_job(str(path), True, tmp_path / "out")
    assert job.name == "mine" and job.out == tmp_path / "out" / "mine"
    request = sets.Request(tmp_path / "out", (str(path),), True)
    run = simulate(read_toml(path), "modal")
    report = sets.conclude(request, {job.name: run})
    measured = {row["quantity"]: row["measured_mean"] for row in report.comparison}
    assert measured["mu"] == pytest.approx(float(np.mean(measured_set("t5b").recomputed()["mu"])))
    json.dumps(report.comparison)


def means_of(scatter="sd"):
    """Return a file of means of the rows of t5b."""
    found, arms = measured_set("t5b").statistics(), measured_set("t5b").arms
    lines = [f"quantity,mean,{scatter},n,d_c_m,d_d_m"]
    for name, column in (("e", "e"), ("mu", "mu"), ("Omega", "Omega_rad_per_s")):
        s = found[name]
        spread = s.sd if scatter == "sd" else s.sd / s.n**0.5
        lines.append(f"{column},{s.mean!r},{spread!r},{s.n},{float(arms.d_c)!r},{float(arms.d_d)!r}")
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("scatter", ["sd", "standard_error"])
def test_means_with_their_scatter_give_what_the_single_tests_give(tmp_path, scatter):
    scene = read_toml(write(tmp_path))
    (tmp_path / "my_tests.csv").write_text(means_of(scatter))
    outcome = simulate(scene, "rigid")
    assert outcome.restitution.paper == simulate(load("t5b"), "rigid").restitution.paper
    rows = {row["quantity"]: row for row in compare(outcome, measured_by(scene))}
    columns = ("measured_mean", "measured_sd", "measured_low", "measured_high", "n")
    for name in ("e", "mu", "Omega"):
        single = measured_set("t5b").statistics()[name]
        assert [rows[name][c] for c in columns] == pytest.approx(
            [single.mean, single.sd, single.low, single.high, single.n]
        )
    assert rows["V_n"]["measured_mean"] is None
    assert rows["V_n"]["verdict"] == "not measured"


def test_means_may_be_in_units_and_without_arms(tmp_path):
    scene = read_toml(write(tmp_path))
    text = "# my tests\nquantity,mean,sd,n,remark\nOmega [deg/s],180,18,5,a\nmu,0.5,0.1,5,b\n"
    (tmp_path / "my_tests.csv").write_text(text)
    found = measured_by(scene)
    assert found.statistics()["Omega"].mean == pytest.approx(np.pi)
    assert found.statistics()["Omega"].sd == pytest.approx(np.pi / 10)
    assert tuple(found.arms) == pytest.approx(tuple(Case(scene).contact.arms))


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("quantity,mean,n\ne,0.3,8\n", "the header must be quantity,mean,sd,n"),
        ("quantity,mean,sd,standard_error,n\ne,0.3,0.1,0.1,8\n", "the header must be"),
        ("quantity,mean,sd,n\n", "holds no line below its header"),
        ("quantity,mean,sd,n\nomga,3,0.1,8\n", "'omga' is not a quantity of tests. Did you mean Omega?"),
        ("quantity,mean,sd,n\nOmega,3,1,8\n", "quantity 'Omega' names no unit"),
        ("quantity,mean,sd,n\nOmega_m_per_s,3,1,8\n", "is not a unit of angular speed"),
        ("quantity,mean,sd,n\nmu_rad,3,1,8\n", "mu is a pure number"),
        ("quantity,mean,sd,n\ne,0.3,0.1,0\n", "column n: 0 is not a number of tests"),
        ("quantity,mean,sd,n\ne,0.3,0.1,2.5\n", "column n: 2.5 is not a number of tests"),
        ("quantity,mean,sd,n\ne,0.3,0,8\n", "column sd: 0 must be above 0"),
        ("quantity,mean,sd,n\ne,x,0.1,8\n", "line 2, column mean: 'x' is not a finite number"),
        ("quantity,mean,sd,n\ne,0.3,0.1\n", "line 2 has 3 cells, the header 4"),
        ("quantity,mean,sd,n\ne,0.3,0.1,8\ne,0.4,0.1,8\n", "line 3: e has a line already"),
        ("quantity,mean,sd,n,d_c_m\ne,0.3,0.1,8,0.02\n", "not one pair"),
        ("quantity,mean,sd,n\nmu,1e9,0.1,8\n", "too large"),
    ],
)
def test_means_that_cannot_be_read_are_refused_with_their_place(tmp_path, text, complaint):
    scene = read_toml(write(tmp_path))
    (tmp_path / "my_tests.csv").write_text(text)
    with pytest.raises(ResultError) as refused:
        measured_by(scene)
    assert complaint in str(refused.value) and "my_tests.csv" in str(refused.value)


def test_tests_without_scatter_have_a_verdict(tmp_path):
    scene = read_toml(write(tmp_path))
    (tmp_path / "my_tests.csv").write_text(f"{HEADER}\n" + 2 * "-1.5,-1.5,0.9,-0.4,5\n")
    rows = {row["quantity"]: row for row in compare(simulate(scene, "rigid"), measured_by(scene))}
    assert rows["e"]["verdict"] == "miss: tests without scatter"


def test_what_all_tests_share_widens_the_interval_and_the_scatter(tmp_path):
    scene = read_toml(write(tmp_path))
    known = simulate(scene, "rigid")
    (tmp_path / "my_tests.csv").write_text("quantity,mean,sd,n\nmu,0.4,0.005,8\n")
    alone = measured_by(scene).statistics()["mu"]
    assert alone.spread == alone.sd
    (tmp_path / "my_tests.csv").write_text("quantity,mean,sd,n,systematic\nmu,0.4,0.005,8,0.15\n")
    tests = measured_by(scene)
    shared = tests.statistics()["mu"]
    assert shared.high - 0.4 == pytest.approx(np.hypot(alone.high - 0.4, 0.3))
    row = next(row for row in compare(known, tests) if row["quantity"] == "mu")
    assert row["measured_sd"] == pytest.approx(np.hypot(0.005, 0.15)) and row["verdict"] == "inside"
    (tmp_path / "my_tests.csv").write_text("quantity,mean,sd,n,systematic\nmu,0.1,,1,0.05\n")
    row = next(row for row in compare(known, measured_by(scene)) if row["quantity"] == "mu")
    assert row["verdict"] == f"miss by {(known.estimate('mu')[0] - 0.1) / 0.05:+.1f} SD"


def test_the_page_of_a_run_sets_it_beside_the_tests(cli, tmp_path):
    write(tmp_path)
    (tmp_path / "my_tests.csv").write_text(means_of())
    assert cli("run", "mine.toml", "--fidelity", "modal", "--quiet", "--out", "one")[0] == 0
    assert cli("report", "one")[0] == 0
    page = (tmp_path / "one" / "report.html").read_text()
    part = page.partition("Beside the measured tests")[2].partition("</section>")[0]
    assert "(8 tests, my_tests.csv)" in part
    found = measured_set("t5b").statistics()["mu"]
    assert found.sd < 0.057 and f"{found.mean:.3f} ± 0.057" in part, "what stands behind +- is rounded up"
    assert f"{found.low:#.3g} to {found.high:#.3g}" in part
    outcome = Outcome.read(tmp_path / "one" / "outcome.json")
    verdicts = [row["verdict"] for row in compare(outcome, measured_by(load("mine.toml")))][:3]
    assert all(f">{escape(verdict)}<" in part for verdict in verdicts)
    lines = (tmp_path / "one" / "figures" / "comparison.csv").read_text().splitlines()
    assert [line.split(",")[1] for line in lines[1:]] == ["e", "mu", "Omega"]
    (tmp_path / "my_tests.csv").write_text("quantity,mean\n")
    assert cli("report", "one")[0] == 0
    assert "The tests can no longer be read" in (tmp_path / "one" / "report.html").read_text()


@pytest.mark.parametrize("means", [True, False])
def test_a_report_over_a_study_of_own_scenes_judges_them_not_the_paper(cli, tmp_path, means):
    path = write(tmp_path)
    if means:
        (tmp_path / "my_tests.csv").write_text(means_of())
    request = sets.Request(tmp_path / "results" / "sets", (str(path),), True)
    run = simulate(read_toml(path), "modal")
    (request.out / "mine").mkdir(parents=True)
    run.write(request.out / "mine" / "outcome.json")
    published(sets.conclude, request, {sets.set_job(str(path), True, request.out).name: run})
    code, _, err = cli("study", "report", "--quiet")
    assert (code, err) == (0, "")
    page = (tmp_path / "results" / "report" / "report.html").read_text()
    assert "Model and measurements" in page and "mine" in page
    assert "What the paper concluded" not in page
    assert cli("report", "results/sets")[0] == 0
    lines = (request.out / "beside.csv").read_text().splitlines()
    assert lines[1].startswith("mine,") and lines[1].endswith("/ –") == means


def test_a_study_refuses_a_scene_without_tests(cli, tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace('measured = "my_tests.csv"\n', ""))
    assert "measured" not in stated("elastic-frictionless")
    code, _, err = cli("study", "sets", str(path))
    assert code == 2
    assert "states no measured tests" in err
    assert not Path("results").exists()


def test_a_study_refuses_two_scenes_of_one_id(cli, tmp_path):
    """The run of the first was lost, and the results of the second were compared with its tests."""
    path = write(tmp_path)
    other = tmp_path / "other.toml"
    other.write_text(path.read_text().replace("45 deg", "60 deg"))
    code, _, err = cli("study", "sets", "mine.toml", "other.toml", "--quick")
    assert code == 3
    assert 'other.toml: id = "mine": is the id of mine.toml, too' in err and "id of its own" in err
    assert not Path("results").exists()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("quantity,mean,sd,n\ne,5,0.1,8\n", "line 2: e = 5 is none of an impact"),
        ("quantity,mean,sd,n\ne,0.3,0.1,8\nmu,40,2,8\n", "line 3: mu = 40 is none of an impact"),
        ("quantity,mean,sd,n\nE_r_over_E_0,18,2,8\n", "line 2: E_r_over_E_0 = 18 is none of an impact"),
        ("quantity,mean,sd,n\nV_n_m_per_s,1700,10,8\n", "line 2: V_n = 1700 m/s is more than 500 m/s"),
        ("quantity,mean,sd,n\nmarker_V_n_m_per_s,-1700,10,8\n", "-1700 m/s is more than 500 m/s"),
        ("quantity,mean,sd,n\ne,0.3,0.1\n", "line 2"),
        ("speed,time\n1,2\n", "the header lacks v_n"),
        ("e,mu,Omega\n0.3,0.5,5\n", f"lacks v_n, v_t, V_n, V_t. It needs {HEADER}"),
        ("e,mu,Omega\n0.3,0.5,5\n", "e, mu, Omega alone can be given as means: a file quantity,mean,sd,n"),
        ("V_n_m_per_s,Omega_rpm\n0.3,5\n", "V_n, Omega alone can be given as means: a file quantity,mean"),
    ],
)
def test_check_refuses_a_file_of_tests_that_cannot_be_used(cli, tmp_path, text, words):
    (tmp_path / "my.csv").write_text(text)
    (tmp_path / "own.toml").write_text(OWN_SCENE)
    code, out, err = cli("check", str(tmp_path / "own.toml"))
    assert (code, out) == (5, "")
    assert words in " ".join(err.split())


@pytest.mark.parametrize(
    "text",
    ["quantity,mean,sd,n,remark\ne,0.3,0.1,8,wet\n", f"{HEADER},remark\n" + 3 * "-1.5,-1.48,.3,-.4,4,wet\n"],
)
def test_columns_that_are_not_used_are_told(cli, tmp_path, text):
    path = write(tmp_path)
    (tmp_path / "my_tests.csv").write_text(text)
    quick = ("--fidelity", "rigid", "--quiet")
    for line in (("check",), ("run", *quick), ("validate", *quick, "--samples", "2")):
        code, out, _ = cli(line[0], str(path), *line[1:])
        assert code == 0 and "columns not used: remark" in out


@pytest.mark.parametrize("mean", ["e,-0.2", "e,1.4", "mu,-0.6", "mu,3"])
def test_unusual_means_are_read(tmp_path, mean):
    (tmp_path / "my.csv").write_text(f"quantity,mean,sd,n\n{mean},0.1,8\n")
    (read,) = read_means(tmp_path / "my.csv").means.values()
    assert read.mean == float(mean.split(",")[1])


def test_arms_beside_means_have_any_unit_of_length(tmp_path):
    file = tmp_path / "my.csv"
    file.write_text("quantity,mean,sd,n,d_c_mm,d_d [cm]\ne,0.3,0.1,8,20,3.5\nmu,0.5,0.1,8,20,3.5\n")
    assert read_means(file).arms == pytest.approx((0.02, 0.035), rel=1e-12)
    file.write_text("quantity,mean,sd,n,d_c,d_d\ne,0.3,0.1,8,20,35\n")
    with pytest.raises(ResultError, match=r"my\.csv: column 'd_c' names no unit"):
        read_means(file)


def test_large_numbers_of_an_outcome_are_means_too(tmp_path):
    """What no velocity can be: a heat flux, a force. Their variances are finite."""
    file, others = tmp_path / "my.csv", ("friction_flux_W_per_m2", "peak_force_N")
    file.write_text("quantity,mean,sd,n\nfriction_flux_W_per_m2,5e9,1e8,5\npeak_force_N,2e6,1e5,5\n")
    assert [one.mean for one in read_means(file, others).means.values()] == [5e9, 2e6]
    for row in ("peak_force_N,1e200,1e199,5", "V_n_m_per_s,2e6,1,5", "e,0.5,2e6,5"):
        file.write_text(f"quantity,mean,sd,n\n{row}\n")
        with pytest.raises(ResultError, match="too large"):
            read_means(file, others)


OWN_SCENE = """
id = "own"
measured = "my.csv"
projectile = { length = "80 mm", diameter = "19 mm", tip = "B", tip_radius = "3 mm", material = "rod-steel" }
barrier = { material = "plate-steel" }
surface = { state = "machined" }
impact = { angle = "45 deg", v_n = "-1.54 m/s", v_t = "-1.56 m/s" }
"""


GOOD = "-1.5,-1.48,0.3,-0.4,4"


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (GOOD, ""),
        ("-3.74,-1.48,0.3,-0.4,4", "warning: Test 2 of 3 has v_n = -3.74 m/s, the scene -1.502 m/s"),
        ("-1.5,-2.5,0.3,-0.4,4", "warning: Test 2 of 3 has v_t = -2.5 m/s, the scene -1.482 m/s"),
        (
            "-1.5,-1.48,3.1,-0.4,4",
            "more kinetic energy after than before the impact: V_n = 3.1 m/s after v_n = -1.5",
        ),
    ],
)
def test_check_and_run_count_the_tests_and_name_doubtful_ones(cli, tmp_path, row, words):
    path = write(tmp_path)
    (tmp_path / "my_tests.csv").write_text("\n".join([HEADER, GOOD, row, GOOD]) + "\n")
    rigid = ("--fidelity", "rigid", "--quiet", "--out", str(tmp_path / "out"))
    for command, options, count in (("check", (), "3 tests"), ("run", rigid, "beside 3 measured tests")):
        code, out, _ = cli(command, str(path), *options)
        told = " ".join(out.split())
        assert code == 0 and count in told
        assert words in told
        assert ("Test 2 of 3" in told) is bool(words)


def test_check_counts_published_tests_too(cli):
    assert "measured: 8 tests, t5b" in cli("check", "t5b")[1]
