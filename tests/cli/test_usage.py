"""A wrong command line is exit code 2; what is understood and refused is 3."""

import ctypes
import json
import re
import shlex
import signal
import sys
import time
import weakref
from functools import partial
from importlib import import_module

import pytest

from fem_impact.answers.report import Request
from fem_impact.answers.verdict.criteria import LIMITED
from fem_impact.cli.parser import build_parser, every_command, read_line
from fem_impact.cli.study import STUDIES
from fem_impact.films.motion import FIELDS
from fem_impact.options import FIDELITIES

ROD = ("--length", "80 mm", "--diameter", "19 mm", "--angle", "45 deg")
DROP = (*ROD, "--height", "0.82 m", "--surface", "machined")


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        (("run", "t5bb"), "Did you mean t5b?"),
        (("check", "nowhere/qick.toml"), "there is no such file. Did you mean quick?"),
        (("run", "t5b", "--set", "accuracy.tip_size"), "is not of the form key=value"),
        (("check", "t5b", "--set", "impact.angle=30 deg", "--set", "impact.angle=40 deg"), "is given twice."),
        (("run", "t5b", "--fidelity", "modal", "--resume"), "--resume: is for finite elements only: a modal"),
        (("assess", "t5b", "--fidelity", "modal", "--budget", "30 s"), "--fidelity modal runs none"),
        (("run", "t5b", "--fidelity", "rigid", "--budget", "30 s"), "--fidelity rigid runs none"),
        (("study", "gama"), "there is no 'gama'. Did you mean gamma?"),
        (("run", "t5b", "--stet"), "there is no option --stet. Did you mean --set?"),
        (("runn", "t5b"), "there is no 'runn'. Did you mean run?"),
        (("run",), "the following arguments are required: SCENE"),
        (("run", "t5b", "--fidelity", "sold"), "there is no 'sold'. Did you mean solid?"),
        (("study", "sets", "t3-machned"), "Did you mean t3-machined?"),
        (("study", "gamma", "t4"), "study gamma: 't4' is not expected here"),
        (("study", "report", "--estimate"), "there is no option --estimate"),
        (("cost", "paper", "--target", "5 %"), "are about one scene"),
        (("cost", "t5b", "--target", "2"), "--target"),
        (("cost", "t5b", "--budget", "30"), "has no unit"),
        (("run", "t5b", "--budget", "30"), "has no unit"),
        (
            ("run", "t5b", "--budget", "30 s", "--set", "accuracy.levels=1"),
            "is for several meshes, and the scene asks for one",
        ),
        (("run", "t5b", "--set", "accuracy=5 %", "--budget", "-1 min"), "must lie above 0"),
        (("cost", "t5b", "--of", "speed"), "is not a quantity of interest"),
        (("cost", "t5b", "--finer", "9"), "Known: 0, 1, 2, 3"),
        (("verify", "nope"), "is no problem of the verification"),
        (("verify", "ber"), "Did you mean bar?"),
        (("verify", "modes", "--set", "length"), "is not of the form"),
        (("verify", "--set", "length=0.1"), "belongs to one problem"),
        (("verify", "--parameters"), "needs a problem"),
        (("verify", "bar", "--parameters", "--set", "length=1"), "lists parameters and runs nothing"),
        (("verify", "bar", "--page", "page.md"), "runs all problems"),
        (("stress", "--only", "nope"), "is no hard case"),
        (("stress", "--only", "painleve", "--page", "page.md"), "runs all cases"),
        (("audit", "--set", "t5e"), "is not a measured set"),
        (("coefficients", "mine.csv", *ROD, "--d-c", "22 mm"), "one arm alone"),
        (("assess", *DROP, "--length", "80"), "has no unit"),
        (("assess", *DROP, "--set", "surface.friction=0.3"), "--set: changes a scene, and none is named."),
    ],
)
def test_a_wrong_command_line_is_two(cli, line, complaint):
    code, out, err = cli(*line)
    assert (code, out) == (2, "")
    assert complaint in err


@pytest.mark.parametrize(
    "line",
    [
        ("check", "t5b", "--set", "projectile.length=1 mm"),
        ("check", "t5b", "--set", "projectile.lenght=80 mm"),
        ("verify", "modes", "--set", "length=50 m"),
        ("assess", *DROP, "--angle", "95 deg"),
        ("assess", *DROP, "--diameter", "2 m"),
    ],
)
def test_what_is_understood_and_refused_is_three(cli, line):
    assert cli(*line)[0] == 3


COMMANDS = dict(every_command(build_parser()))


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_every_command_shows_examples_that_are_understood(name):
    text = COMMANDS[name].format_help().replace("\\\n", "")
    examples = re.findall(r"^  (fem-impact .*|eval .*)$", text.partition("\nexample")[2], re.MULTILINE)
    assert examples
    for line in examples:
        words = shlex.split(re.sub(r'^eval "\$\((.*)\)"$', r"\1", line).partition(" > ")[0])[1:]
        assert words[: len(name.split())] == name.split()
        assert read_line(words).handler


def test_an_option_offers_what_the_program_knows():
    offered = {
        (name, action.dest): (*action.choices,)
        for name, command in COMMANDS.items()
        for action in command._actions
        if action.choices and action.option_strings
    }
    fidelities = [of for (name, dest), of in offered.items() if dest == "fidelity" and name != "assess"]
    assert {*fidelities, offered["validate", "inputs_by"]} == {FIDELITIES}
    assert offered["assess", "question"] == ("rigid", *LIMITED)
    assert {*FIELDS} <= {*offered["render", "field"]}


@pytest.mark.parametrize("name", STUDIES)
def test_the_help_of_a_study_tells_what_is_its_own(cli, name):
    code, text, _ = cli("study", name, "--help")
    assert code == 0
    others = [COMMANDS[f"study {other}"].format_help() for other in STUDIES if other != name]
    about = " ".join(text.partition("\n\n")[2].partition("options:")[0].split())
    assert STUDIES[name].about in about and f"{STUDIES[name].runs} runs" in about
    assert not any(STUDIES[name].about in " ".join(other.split()) for other in others)
    assert ("ID" in text) == bool(STUDIES[name].sets)


@pytest.mark.parametrize("quick", [True, pytest.param(False, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", STUDIES)
def test_the_help_of_a_study_counts_its_runs(tmp_path, name, quick):
    told = STUDIES[name].quick_runs if quick else STUDIES[name].runs
    assert f"{told} runs" in (STUDIES[name].quick if quick else STUDIES[name].size)
    jobs = import_module(f"fem_impact.evidence.studies.{name}").plan(Request(tmp_path, quick=quick), {})
    assert len(jobs) == told


def test_what_follows_an_option_is_taken_where_it_may_be_left_out():
    assert read_line(["study", "sets", "--quick", "t4"]).ids == ["t4"]
    assert read_line(["study", "sets", "t3-machined", "--quick", "t4"]).ids == ["t3-machined", "t4"]
    assert read_line(["assess", "--fidelity", "modal", "t5b"]).scene == "t5b"
    assert read_line(["verify", "--set", "length=1", "bar"]).problem == "bar"


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        (("check", "t5bb"), "Did you mean t5b?"),
        (("run", "t5b", "--stet"), "Did you mean --set?"),
        (("study", "nope"), "there is no 'nope'"),
        (("render",), "are required: RESULT"),
    ],
)
def test_an_error_under_json_is_json_as_well(cli, line, complaint):
    code, out, err = cli(*line, "--json")
    told = json.loads(out)["error"]
    assert (told["exit_code"], code) == (code, 2)
    assert complaint in told["message"] and told["message"] in err


def test_both_compiled_models_run_in_the_set_up(cli):
    code, out, err = cli("compile", "--json")
    assert code == 0 and 0 <= json.loads(out)["compiling_s"] < 600
    assert "quick  t 0/256 us" in err and "t 0/2500 us" in err


def test_the_schema_of_an_outcome_is_printed(cli):
    code, out, err = cli("schema")
    assert (code, err) == (0, "")
    assert json.loads(out)["properties"]["mu"]["type"] == ["number", "null"]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (("check", "t5b", "--set", "barrier.material=steel"), "fem-impact scenes --materials"),
        (("check", "t5b", "--set", "barrier.material=unobtainium"), "fem-impact scenes --materials"),
        (("check", "t5b", "--set", "measured=x"), "or the path of a CSV file of your own tests (*.csv)"),
        (("report", "here", "--quite"), "Did you mean --quiet?"),
    ],
)
def test_a_refusal_says_what_there_is(cli, line, told):
    assert told in cli(*line)[2]


def test_a_far_option_is_not_proposed(cli):
    err = cli("report", "here", "--out", "there")[2]
    assert "there is no option --out." in err and "Did you mean" not in err


@pytest.fixture
def signals():
    """How signals and lost exceptions are answered, put back after the test."""
    kept = {one: signal.getsignal(one) for one in (signal.SIGTERM, signal.SIGINT)}
    hook = sys.unraisablehook
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what runs behind deaf to it
    yield
    sys.unraisablehook = hook
    for one, handler in kept.items():
        signal.signal(one, handler)


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_stop_in_a_callback_of_the_compiler_is_not_lost(cli, signals, stop):
    """What is raised there goes no further: the run went on, or ended by an error of the compiler."""
    scope = {"__name__": "llvmlite.binding.executionengine", "stop": partial(signal.raise_signal, stop)}
    exec("def notify(): stop(); reached.append(1)", scope | {"reached": (reached := [])}, scope)
    cli("schema")
    with pytest.raises(KeyboardInterrupt):
        ctypes.CFUNCTYPE(None)(scope["notify"])()
        for _ in range(500):
            time.sleep(0.01)
    assert reached == [1]


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_stop_in_a_callback_of_a_weak_reference_is_not_lost(cli, signals, stop):
    """A run went on for six minutes after it, with a traceback of `weakref`."""
    cli("schema")
    held = [set()]
    reference = weakref.ref(held[0], lambda _: signal.raise_signal(stop))
    with pytest.raises(KeyboardInterrupt):
        held.clear()
        for _ in range(500):
            time.sleep(0.01)
    assert reference() is None


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("impact.angle=44,45deg", "impact.angle=45,46deg"),
        ("impact.angle=44,45deg", "impact.angle_rad=0.78,0.8"),
        ("projectile.length_m=0.08,0.09", "projectile.length=80,90mm"),
    ],
)
@pytest.mark.parametrize(
    "line",
    [
        ("sweep", "t5b", "--fidelity", "rigid", "--vary"),
        ("validate", "t5b", "--fidelity", "rigid", "--samples", "2", "--uncertain"),
        ("assess", "t5b", "--fidelity", "modal", "--for", "force", "--limit", "9 kN", "--uncertain"),
    ],
)
def test_the_values_of_a_key_that_are_given_twice_are_refused(cli, line, first, second):
    *words, option = line
    code, out, err = cli(*words, option, first, option, second)
    assert (code, out) == (2, "")
    assert f'{option} "{second.partition("=")[0]}": is given twice.' in err
