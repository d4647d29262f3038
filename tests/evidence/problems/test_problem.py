"""Parameters are read and refused, checks judge, the command prints both."""

import json

import numpy as np
import pytest

from fem_impact.cli.main import main
from fem_impact.errors import SceneError, UsageError
from fem_impact.evidence.problems.problem import PROBLEMS, Check, Problem, Solved, problem, verify
from fem_impact.scene.fields import Parameter

LENGTH = Parameter("length", "of it", "length", 0.02, 2.0, default=0.24)
COUNT = Parameter("across", "cells", "", 6, 24, default=8, even=True)
TWICE = Problem(
    "twice",
    "a stand-in",
    (LENGTH, COUNT),
    lambda p: Solved((Check("double", "m", 2 * p["length"], 0.48, 1e-9),), 3, 4),
)


@pytest.mark.parametrize(("given", "SI"), [("80 mm", 0.08), ("0.08", 0.08), (0.08, 0.08), ("8 cm", 0.08)])
def test_a_parameter_is_si_or_has_its_unit(given, SI):
    assert LENGTH.read(given) == SI


@pytest.mark.parametrize("given", ["80 MPa", "nan", "3 m", "1 mm", "", "inf"])
def test_a_bad_length_is_refused(given):
    with pytest.raises(SceneError, match="length"):
        LENGTH.read(given)


@pytest.mark.parametrize("given", ["7", "8.5", "26", "eight"])
def test_a_bad_count_is_refused(given):
    with pytest.raises(SceneError, match="across"):
        COUNT.read(given)


def test_an_unknown_parameter_is_refused_with_a_hint():
    with pytest.raises(SceneError, match="Did you mean length"):
        TWICE.run({"lenght": 1.0})


@pytest.mark.parametrize(
    ("kind", "computed", "passed", "error"),
    [
        ("relative", 1.01, True, 0.01),
        ("relative", 0.97, False, -0.03),
        ("absolute", 1.03, False, 0.03),
        ("at most", 0.5, True, 0.0),
        ("at most", 1.03, False, 0.03),
        ("relative", float("nan"), False, None),
    ],
)
def test_a_check_judges(kind, computed, passed, error):
    check = Check("x", "1", computed, 1.0, 0.02, kind)
    assert check.passed is passed
    if error is not None:
        assert check.error == pytest.approx(error)


def test_a_check_of_numpy_numbers_can_be_written_as_json():
    assert '"passed": true' in json.dumps(Check("x", "1", np.float64(1.0), np.float64(1.0), 0.1).document())


def test_what_is_only_shown_judges_nothing_and_says_why():
    check = Check.shown("x", "1", 2.0, 1.0, "far too large")
    assert check.passed
    assert check.error == pytest.approx(1.0)
    assert (check.document()["tolerance"], check.document()["note"]) == (None, "far too large")
    assert not Check.shown("x", "1", float("nan"), 1.0, "").passed


def test_a_run_has_values_verdict_and_cost():
    good, bad = TWICE.run(), TWICE.run({"length": "1 m"})
    assert good.passed and not bad.passed
    assert bad.parameters == {"length": 1.0, "across": 8}
    assert bad.checks[0].error == pytest.approx(2 / 0.48 - 1)
    assert (good.cost.steps, good.cost.elements) == (3, 4)
    assert good.document()["checks"][0]["computed"] == 0.48


@pytest.mark.parametrize("name", PROBLEMS)
def test_every_problem_states_its_parameters(name, capsys):
    found = problem(name)
    assert found.name == name
    for p in found.parameters:
        assert p.read(p.default) == p.default
    assert main(["verify", name, "--parameters"]) == 0
    shown = capsys.readouterr().out
    assert all(p.key in shown and p.si_unit in shown for p in found.parameters)
    assert main(["verify", name, "--parameters", "--json"]) == 0
    assert [p["name"] for p in json.loads(capsys.readouterr().out)] == [p.key for p in found.parameters]


@pytest.mark.validation
@pytest.mark.parametrize("name", ["bar", "free-spin", "taylor", "thornton"])
def test_a_problem_whose_defaults_are_dear_passes_with_them(name):
    assert verify(name).passed


def test_the_command_refuses_what_it_does_not_know(capsys):
    assert main(["verify", "no-such"]) == 2
    assert main(["verify", "modes", "--set", "lengt=0.1"]) == 3
    assert main(["verify", "modes", "--set", "length"]) == 2
    assert main(["verify", "--set", "length=0.1"]) == 2
    assert main(["verify", "--parameters"]) == 2
    assert "Did you mean length" in capsys.readouterr().err
    with pytest.raises(UsageError, match="no problem"):
        verify("no-such")


def test_the_command_prints_the_verdict(capsys):
    line = ["verify", "waves", "--set", "aspect=2"]
    assert main(line) == 6  # slices twice as high as cells are wide
    shown, told = capsys.readouterr()
    assert told.startswith("waves: phase speeds")
    assert "waves: FAILED" in shown and "longitudinal c/c0 at radius/wavelength 0.2: 0.9" in shown
    assert max(map(len, shown.splitlines())) < 80
    assert " 1, reference" not in shown
    main([*line, "--json"])
    document = json.loads(capsys.readouterr().out)
    assert document["parameters"]["aspect"] == 2
    assert document["passed"] is False
