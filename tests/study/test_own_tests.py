"""A scene that names a file of the user's own tests is compared with them as the paper's sets are."""

import json
from pathlib import Path

import numpy as np
import pytest

from fem_impact.errors import ResultError, SceneError
from fem_impact.run.simulate import simulate
from fem_impact.run.tests import tests_of as measured_by
from fem_impact.scene.library import stated
from fem_impact.scene.read import read_toml
from fem_impact.scene.shipped import load, replace
from fem_impact.scene.write import to_toml
from fem_impact.study import sets
from fem_impact.study.compare import compare
from rigid.experiments import measured_set

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


def test_run_prints_the_comparison(cli, tmp_path):
    write(tmp_path)
    code, out, _ = cli("run", "mine.toml", "--fidelity", "rigid")
    assert code == 0
    assert f"beside {len(measured_set('t5b').motion['v_n'])} measured tests" in out


def test_a_study_of_sets_takes_scene_files(tmp_path, monkeypatch):
    path = write(tmp_path)
    jobs = sets.jobs_of(str(path), True, tmp_path / "out")
    assert jobs["fine"].name == "mine" and jobs["fine"].out == tmp_path / "out" / "mine"
    request = sets.Request(tmp_path / "out", (str(path),), True)
    run = simulate(read_toml(path), "modal")
    monkeypatch.setattr(sets, "with_limits", lambda fine, coarse: fine[0])
    seen = []
    monkeypatch.setattr(sets, "publish", lambda report, *_: seen.append(report) or sets.StudyResult({}, ""))
    sets.conclude(request, {job.name: run for job in jobs.values()}, None)
    measured = {row["quantity"]: row["measured_mean"] for row in seen[0].comparison}
    assert measured["mu"] == pytest.approx(float(np.mean(measured_set("t5b").recomputed()["mu"])))
    json.dumps(seen[0].comparison)


def test_a_study_refuses_a_scene_without_tests(cli, tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace('measured = "my_tests.csv"\n', ""))
    assert "measured" not in stated("elastic-frictionless")
    code, _, err = cli("study", "sets", str(path))
    assert code == 2
    assert "states no measured tests" in err
    assert not Path("results").exists()
