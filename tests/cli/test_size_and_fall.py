"""What `check` and `run` say beforehand: how large a run becomes, and velocities of another angle."""

import json

import pytest

from fem_impact.answers.verdict.sentences import case_sentence
from fem_impact.case.case import Case
from fem_impact.outcome.groups import texts
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_toml


def test_check_tells_elements_memory_steps_and_time(cli):
    code, out, err = cli("check", "t5b")
    assert code == 0 and "A run with finite elements" in out
    assert "and all take 2 s to 37 s of processor time in nine of ten scenes" in " ".join(out.split())
    code, out, err = cli("check", "t5b", "--set", "accuracy.levels=1")
    assert code == 0 and not err
    assert "Size of a run with finite elements" in out and "MB of memory" in out and "of computing" in out
    size = json.loads(cli("check", "t5b", "--json")[1])["size"]
    assert 2000 < size["elements_rod"] + size["elements_barrier"] < 8000
    assert 0 < size["cpu_s"] < size["most_cpu_s"] and size["steps"] < size["most_steps"]


def test_check_refuses_a_mesh_that_no_machine_holds(cli):
    code, _, err = cli("check", "t5b", "--set", "accuracy.tip_size=0.01 mm")
    assert code == 3 and "GB of memory" in err and "Give at least" in err


@pytest.mark.parametrize("words, said", [(("--set", "accuracy.tip_size=0.05 mm"), True), ((), False)])
def test_a_run_over_ten_minutes_says_so_before_it_starts(cli, monkeypatch, words, said):
    monkeypatch.setattr("fem_impact.answers.simulate.simulate", stop)
    _, _, err = cli("run", "t5b", *words)
    assert ("This run takes about" in err) is said and "stopped here" in err
    assert "This run takes" not in cli("run", "t5b", *words, "--fidelity", "rigid")[2]


def stop(*_, **__):
    from fem_impact.errors import RunError

    raise RunError("stopped here")


OLD = "v_n and v_t are those of the old angle"
BESIDE = "the measured rods moved along theirs"


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_fall_at_a_new_angle_stays_a_fall_and_the_user_is_told(cli, command):
    rigid = () if command == "check" else ("--fidelity", "rigid")
    _, out, err = cli(command, "t5b", "--set", "impact.angle=30 deg", *rigid)
    assert "along its axis at 2.11 m/s, which turns its velocity: v_n = -1.828 m/s" in err
    assert "To keep the old one: --set impact.v_n='-1.502 m/s' --set impact.v_t='-1.482 m/s'" in err
    assert BESIDE not in " ".join(out.split())


def test_velocities_beside_the_axis_are_kept_at_a_new_angle_and_the_user_is_told(cli, tmp_path):
    mine = tmp_path / "mine.toml"
    mine.write_text(to_toml(replace_all(load("t5b"), {"impact.angle": "30 deg", "impact.v_n": "-1.5 m/s"})))
    _, out, err = cli("check", str(mine), "--set", "impact.angle=20 deg")
    assert OLD in err and "impact.speed='2.109 m/s'" in err and BESIDE in " ".join(out.split())
    _, out, err = cli("check", str(mine), "--set", "impact.angle=20 deg", "--set", "impact.speed=2.107 m/s")
    assert not err and BESIDE not in " ".join(out.split())
    _, _, err = cli("check", str(mine), "--set", "impact.angle=88 deg")
    assert not cli("check", str(mine), "--set", "impact.angle=30 deg")[2]  # as it is stated
    assert OLD in err and "impact.speed" not in err  # a fall along an axis that lies down hardly strikes


def test_the_outcome_keeps_the_doubt(cli):
    from fem_impact.run.simulate import simulate

    scene = replace_all(load("t5b"), {"impact.angle": "30 deg", "impact.v_n": "-1.5024 m/s"})
    told = " ".join(texts(simulate(scene, "rigid").validity.limitations, "range"))
    assert (
        "15 deg beside its axis; the measured rods moved along theirs. Are v_n and v_t those of 30 deg?"
        in told
    )


def test_a_tilted_body_that_falls_straight_down_on_level_ground_is_a_drop():
    changes = {"impact.slope": "0 deg", "impact.v_n": "-2 m/s", "impact.v_t": "0 m/s"}
    told = " ".join(texts(Case.of(replace_all(load("t5b"), changes), "rigid").limitations, "range"))
    assert "45 deg beside its axis, as it falls straight down" in told and BESIDE not in told


def test_a_body_is_called_what_it_is():
    plain = {"length": "80 mm", "diameter": "19 mm", "tip": "plain", "material": "rod-steel"}
    tube, disc = (
        replace_all(load("t5b"), {"projectile": plain | change})
        for change in ({"inner_diameter": "10 mm"}, {"length": "5 mm"})
    )
    assert [one.projectile.called for one in (load("t5b"), tube, disc)] == ["rod", "tube", "disc"]
    assert "80 mm x 19 mm tube of rod-steel" in case_sentence(tube)


@pytest.mark.parametrize("speed", ["-1e-300 m/s", "-1e-7 m/s", "0 m/s"])
def test_a_rod_without_speed_is_refused(cli, speed):
    code, _, err = cli("check", "t5b", "--set", f"impact.v_n={speed}")
    assert code == 3 and "must be at least -500 m/s" in err


def test_a_spin_that_all_but_stops_the_contact_point_is_refused(cli):

    scene = load("t5b")
    omega = -scene.impact.v_n / Case(scene).contact.arms[0] * (1 - 1e-15)
    code, _, err = cli("check", "t5b", "--set", f"impact.omega_rad_per_s={omega!r}")
    assert code == 3 and "impact.omega" in err
