"""``run`` and ``study``: what is passed on, printed and returned."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from fem_impact.answers.report import Request
from fem_impact.case.case import Case
from fem_impact.errors import RunError
from fem_impact.scene.shipped import load
from fem_impact.scene.types import digest, to_toml


def test_run_passes_the_scene_and_prints_the_outcome(cli, stand):
    code, out, err = cli("run", "t5b", "--out", "here")
    name, (scene, fidelity, options, *_) = stand.calls[0]
    assert (code, name, scene) == (0, "simulate", load("t5b"))
    assert fidelity is None
    assert options.out == Path("here")
    for words in ("results: here", "0.500 +- 0.010", "not in the stand-in", "E_0 = 0.39 J"):
        assert words in out
    assert "t 100/2500 us  about 1 min 01 s left  step 4000  energy drift +1.0e-06  touching, 12 nodes" in err


def test_an_own_rod_has_its_restitution_with_the_arms_of_its_tip(cli, stand):
    stand.outcome = stand.an_outcome(e_edge=0.296)
    assert f"restitution e (tip's arms){0.296:>24}\n" in cli("run", "t5b", "--quiet")[1]
    stand.outcome = stand.an_outcome(e_edge=0.296, e_paper=0.327)
    assert f"restitution e (paper's arms){0.327:>22}\n" in cli("run", "t5b", "--quiet")[1]


def test_a_moving_barrier_has_its_energy_seen_from_it_and_both_bodies_on_the_ground(cli):
    """A free barrier of 60 times the mass loses what the rod gains, less what the impact loses."""
    line = ("run", "moving-barrier", "--fidelity", "modal", "--quiet", "--set")
    out = " ".join(cli(*line, "barrier.mass=10 kg", "--json")[1].split())
    told = json.loads(out)
    out = " ".join(cli(*line, "barrier.mass=10 kg")[1].split())
    assert f"initial energy as seen from the barrier, E_0 = {told['E_0_J']:.4g} J" in out
    rod = 0.5 * told["mass_kg"] * (told["V_n_m_per_s"] ** 2 + told["V_t_m_per_s"] ** 2)
    struck = 5.0 * (told["V_bn_m_per_s"] ** 2 + told["V_bt_m_per_s"] ** 2)
    before, after = "the rod has 0 J before and", "the barrier has 20 J before and"
    assert f"{before} {rod:.4g} J after; {after} {struck:.4g} J after." in out
    assert 0 < rod < 20 - struck < rod + told["E_0_J"]
    resting = cli("run", "t5b", "--fidelity", "modal", "--quiet")[1]
    assert "as seen from" not in resting and "On the ground" not in resting


def test_changes_are_applied_and_filed_apart(cli, stand):
    code, _, _ = cli("run", "t5b", "--set", "accuracy.tip_size=0.5 mm", "--set", "save.frames=10", "--quiet")
    _, (scene, _, options, *_) = stand.calls[0]
    assert code == 0
    assert (scene.accuracy.tip_size, scene.save.frames) == (0.0005, 10)
    assert options.out == Path("results") / f"t5b-{digest(scene)[:8]}"


def test_a_target_runs_side_by_side_on_the_cores_there_are(cli, stand, monkeypatch):
    monkeypatch.setattr("fem_impact.cli.run.cores", lambda: 3)
    assert cli("run", "t5b", "--set", "accuracy=20 %", "--quiet")[0] == 0
    scene, fidelity, _, workers, *_ = stand.calls[0][1]
    assert (scene.accuracy.target, fidelity, workers) == (0.2, None, 3)


def test_effects_may_be_listed_with_commas(cli, stand):
    code, _, _ = cli("run", "t5b", "--set", "effects=vibration, barrier-rigid", "--quiet")
    assert code == 0
    assert stand.calls[0][1][0].effects == ("vibration", "barrier-rigid")


def test_json_is_one_document_and_nothing_else(cli, stand):
    _, out, _ = cli("run", "t5b", "--json")
    assert json.loads(out)["scene_id"] == "t5b"
    _, out, _ = cli("study", "sets", "t4", "--json")
    told = {"rows": [{"id": "t4", "e": 0.2}], "comparison": [], "failures": []}
    assert json.loads(out) == {**told, "notes": ["f matters", "no film: no GL"]}


def test_quiet_shows_no_progress(cli, stand):
    assert cli("run", "t5b", "--quiet")[2] == ""


def test_a_run_that_stops_early_keeps_its_results_and_says_so(cli, stand):
    stand.outcome = stand.an_outcome(
        finished=False, stopped_because="the step fell below 1 ps.", E_vib_below_floor=None
    )
    code, out, err = cli("run", "t5b", "--quiet")
    assert code == 6
    assert "the step fell below 1 ps" in err
    assert not out and "Results: results/t5b" in err


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (OSError(28, "No space left on device", "results/history.csv"), 4, "disk is full"),
        (OSError(13, "Permission denied", "results/history.csv"), 4, "Permission denied"),
        (MemoryError(), 6, "out of memory"),
    ],
)
def test_trouble_during_a_run_is_one_sentence(cli, stand, error, code, words):
    stand.error = error
    got, out, err = cli("run", "t5b", "--quiet")
    assert (got, out) == (code, "")
    assert words in err
    assert "Traceback" not in err
    assert err.count("\n") == 1


def test_a_fault_of_the_program_is_not_hidden(cli, stand):
    stand.error = ZeroDivisionError("a bug")
    with pytest.raises(ZeroDivisionError):
        cli("run", "t5b", "--quiet")


def test_study_passes_what_is_asked(cli, stand):
    assert cli("study", "sets", "t4", "t5a", "t4", "--workers", "1")[0] == 0
    assert cli("study", "convergence", "--quick", "--out", "here")[0] == 0
    names = [args[0] for _, args in stand.calls]
    asked = [args[1] for _, args in stand.calls]
    assert names == ["studies.sets", "studies.convergence"]
    assert asked[0] == Request(Path("results/sets"), ("t4", "t5a"))
    assert asked[1] == Request(Path("here"), (), quick=True)


def test_options_that_nothing_would_look_at_are_refused(cli, stand):
    assert "is for finite elements only" in cli("run", "t5b", "--fidelity", "modal", "--resume")[2]
    assert "there is no option --quick" in cli("study", "report", "--quick")[2]
    assert "are about one scene" in cli("cost", "paper", "--target", "5 %")[2]
    assert "lists parameters and runs nothing" in cli("verify", "bar", "--parameters", "--set", "length=1")[2]
    assert not stand.calls


@pytest.mark.parametrize("words", [("gamma", "t5b")])
def test_what_a_study_would_not_look_at_is_refused(cli, stand, words):
    code, _, err = cli("study", *words)
    assert code == 2
    assert f"study gamma: '{words[-1]}' is not expected here" in err
    assert not stand.calls


def test_an_interrupted_run_says_whether_it_can_go_on(cli, stand):
    stand.error = KeyboardInterrupt()
    assert "no checkpoint was due yet" in cli("run", "t5b", "--out", "here")[2]
    first = Path("here", "level-1")
    first.mkdir()
    for name in ("scene.toml", ".lock"):
        Path("here", name).write_text("of this run")
    (first / "level.stamp").write_text("of a level that has stored no checkpoint yet")
    assert "no checkpoint was due yet" in cli("run", "t5b", "--out", "here")[2]
    (first / "run.checkpoint").write_text("of this level")
    assert "--resume goes on from the last checkpoint" in cli("run", "t5b", "--out", "here")[2]


def test_a_closed_output_is_no_traceback():
    command = [sys.executable, "-m", "fem_impact", "scenes"]
    done = subprocess.run(["sh", "-c", '"$@" >&-', "sh", *command], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_an_unknown_set_is_refused_with_the_nearest(cli, stand):
    code, _, err = cli("study", "sets", "t3-machned")
    assert code == 2
    assert "Did you mean t3-machined" in err
    assert not stand.calls


def test_sets_may_follow_the_options(cli, stand):
    assert cli("study", "sets", "t5a", "--quick", "t4", "--quiet")[0] == 0
    assert stand.calls[0][1][1] == Request(Path("results/sets"), ("t5a", "t4"), quick=True)


@pytest.mark.parametrize(
    "words",
    [
        ["fly"],
        ["run"],
        ["run", "t4", "t5a"],
        ["study", "sets", "--fast"],
        ["study", "cats"],
        ["study", "sets", "--workers", "0"],
    ],
)
def test_a_line_that_is_not_understood_ends_with_2(cli, words):
    assert cli(*words)[0] == 2


def test_no_command_shows_the_help(cli):
    code, out, err = cli()
    assert (code, out) == (2, "")
    assert "study" in err


def test_resume_and_the_time_between_checkpoints_are_passed_on(cli, stand):
    assert cli("run", "t5b", "--resume", "--checkpoint", "5", "--quiet")[0] == 0
    options = stand.calls[0][1][2]
    assert options.resume is True and options.checkpoint_s == 5.0
    assert cli("run", "t5b", "--quiet")[0] == 0
    options = stand.calls[1][1][2]
    assert options.resume is False and options.checkpoint_s == 30.0
    for wrong in ("-1", "nan", "soon", "inf"):
        code, _, err = cli("run", "t5b", "--checkpoint", wrong)
        assert code == 2 and "not a time in seconds" in err


def test_a_spoiled_checkpoint_is_refused_by_the_command(cli, tmp_path):
    words = ("--set", "accuracy.tip_size=0.8 mm", "--set", "accuracy.across=6", "--set", "save.frames=0")
    words += ("--set", "accuracy.levels=1")
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "scene.toml").write_text(to_toml(load("t5b")))
    (tmp_path / "here" / "history.csv").write_text("")
    (tmp_path / "here" / "run.checkpoint").write_bytes(b"nothing like it")
    code, out, err = cli("run", "t5b", *words, "--resume", "--quiet", "--out", "here")
    assert (code, out) == (5, "")
    assert "is damaged" in err and "Run again without resuming to start anew." in err


def test_a_body_that_does_not_yield_has_no_residual_stress(cli, stand):
    stand.outcome = stand.an_outcome(
        E_plastic_rod_over_E_0=0.0,
        E_locked_rod_over_E_0=4e-5,
        E_plastic_barrier_over_E_0=0.2,
        E_locked_barrier_over_E_0=0.01,
    )
    out = cli("run", "t5b", "--quiet")[1]
    assert f"elastic energy left in rod{'0.004 %':>26}" in out
    assert f"energy locked in barrier{'1 %':>28}" in out


@pytest.mark.long
@pytest.mark.parametrize(("fidelity", "levels", "cases"), [("rigid", 3, 3), ("solid", 1, 1), ("solid", 3, 5)])
def test_the_command_compiles_its_scene_once(cli, monkeypatch, fidelity, levels, cases):
    """For its expected time, run and screening; each level has its own, the first one for its budget too.

    So has each later level that is planned, once. A finished run has two at the ends of
    its interval of friction.
    """
    made, compiled = [], Case.__init__
    monkeypatch.setattr(Case, "__init__", lambda *case: made.append(case) or compiled(*case))
    code, out, _ = cli(
        "run",
        "quick",
        "--fidelity",
        fidelity,
        "--quiet",
        "--set",
        "accuracy.max_time=20 us",
        "--set",
        f"accuracy.levels={levels}",
    )
    assert code == (0 if fidelity == "rigid" else RunError.exit_code)  # cut off before the separation
    assert ("T1/tau" in out) == (not code)
    assert len(made) == cases


def test_every_limitation_is_printed_after_its_kind(cli, stand):
    limited = [{"kind": "range", "text": "Too fast."}, {"kind": "result", "text": "It comes down again."}]
    limited += [{"kind": "model", "text": "No waves."}]
    stand.outcome = stand.an_outcome(limitations=limited)
    numbers, shares = cli("run", "t5b", "--quiet")[1].split("of the initial energy")
    assert "\n\nresult: It comes down again.\n" in numbers  # beside what it may make wrong
    assert "\n\nrange: Too fast.\nmodel: No waves.\n" in shares


@pytest.mark.slow
def test_vibration_above_the_modes_is_listed_so_that_the_shares_add_up(cli):
    """A blunt end on a rigid plane excites shapes that the modes do not hold."""
    changes = ("impact.angle=0 deg", "effects=auto,barrier-rigid", "accuracy.levels=1")
    flat = [word for change in changes for word in ("--set", change)]
    said = cli("run", "quick", *flat, "--out", "flat")[1]
    listed = said.split("E_0 = ")[1].split("not accounted")[0]
    shares = [float(part) for part in re.findall(r"([\d.e-]+) %", listed)]
    assert "vibration above its modes" in said
    assert sum(shares) == pytest.approx(100, abs=0.2)  # each is told to three digits
    assert "above its modes" not in cli("run", "quick", "--set", "accuracy.levels=1", "--out", "inclined")[1]


def test_a_reduced_run_without_half_widths_says_why_beside_its_numbers(cli):
    code, out, _ = cli("run", "quick", "--fidelity", "modal", "--set", "barrier.mass=0.5 g")
    assert code == 0
    assert "\n\nerror of these numbers not known: The barrier's mass of 0.0005 kg" in out


def test_a_followed_body_is_answered_by_its_sequence_first(cli, tmp_path):
    line = (
        "run",
        "quick",
        "--until",
        "2 strikes",
        "--fidelity",
        "rigid",
        "--quiet",
        "--out",
        str(tmp_path / "r"),
    )
    out = cli(*line)[1]
    heading, count, totals = out.splitlines()[0], out.index("2 strikes. "), out.index("the body keeps ")
    assert heading.startswith("quick: ") and count < totals < out.index("Hardest by energy")
    assert out.index("Hardest by energy") < out.index("The first strike alone") < out.index("restitution e")


def test_what_a_model_refuses_of_a_scene_is_told_with_its_place(cli):
    text = (
        'id = "mine"\n[projectile]\nlength = "60 mm"\ndiameter = "10 mm"\nmaterial = "rod-steel"\n'
        'tip = "plain"\n'
        '[barrier]\nmaterial = "plate-steel"\nmass = "1 kg"\n[surface]\nstate = "machined"\n'
        '[impact]\nangle = "20 deg"\nheight = "0.2 m"\n'
    )
    Path("mine.toml").write_text(text)
    told = cli("run", "mine.toml", "--fidelity", "rigid", "--until", "rest")[2]
    assert 'error: --set: impact.until = "rest"' in told
    Path("mine.toml").write_text(f'{text}until = "rest"\n')
    assert 'error: mine.toml: impact.until = "rest"' in cli("run", "mine.toml", "--fidelity", "rigid")[2]


@pytest.mark.parametrize("resume", [(), ("--resume",)])
def test_a_run_stopped_as_its_first_level_began_runs_in_its_directory(cli, monkeypatch, resume):
    """Only the level's stamp stood there: the directory was taken for somebody else's."""
    runs = []

    def stopped(*_):
        runs.append(1)
        raise KeyboardInterrupt

    monkeypatch.setattr("fem_impact.answers.refine.level.simulate_recorded", stopped)
    for more in ((), resume):
        code, _, err = cli("run", "t5b", "--quiet", "--out", "here", *more)
        assert (code, "interrupted" in err) == (130, True), err
        files = {path.name for path in Path("here").rglob("*") if path.is_file()}
        assert files == {"level.stamp", "scene.toml"}
    assert len(runs) == 2
