"""A wrong command line is exit code 2; what is understood and refused is 3."""

import argparse
import json
import shlex

import pytest

from fem_impact.commands.parser import EXAMPLES, build_parser, read_line

ROD = ("--length", "80 mm", "--diameter", "19 mm", "--angle", "45 deg")
DROP = (*ROD, "--height", "0.82 m", "--surface", "machined")


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        (("run", "t5bb"), "Did you mean t5b?"),
        (("check", "nowhere/qick.toml"), "there is no such file. Did you mean quick?"),
        (("run", "t5b", "--set", "accuracy.tip_size"), "is not of the form key=value"),
        (("run", "t5b", "--fidelity", "modal", "--resume"), "is of finite elements"),
        (("study", "nope"), "invalid choice"),
        (("study", "sets", "t3-machned"), "Did you mean t3-machined?"),
        (("study", "gamma", "t4"), "is nothing to study gamma"),
        (("study", "report", "--quick"), "reads what others have computed"),
        (("cost", "paper", "--target", "5 %"), "are about one scene"),
        (("cost", "t5b", "--target", "2"), "--target"),
        (("cost", "t5b", "--budget", "30"), "has no unit"),
        (("cost", "t5b", "--of", "speed"), "is not a quantity of interest"),
        (("cost", "t5b", "--finest", "0.5 mm"), "Give at most"),
        (("verify", "nope"), "is no problem of the verification"),
        (("verify", "ber"), "Did you mean bar?"),
        (("verify", "modes", "--set", "length"), "is not of the form"),
        (("verify", "--set", "length=0.1"), "belongs to one problem"),
        (("verify", "--parameters"), "needs a problem"),
        (("verify", "bar", "--parameters", "--set", "length=1"), "only lists"),
        (("verify", "bar", "--page", "page.md"), "takes all problems"),
        (("stress", "--only", "nope"), "is no hard case"),
        (("stress", "--only", "painleve", "--page", "page.md"), "takes all cases"),
        (("audit", "--set", "t5e"), "is not a measured set"),
        (("coefficients", "mine.csv", *ROD, "--d-c", "22 mm"), "one arm alone"),
        (("assess", *DROP, "--length", "80"), "has no unit"),
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
        ("assess", *DROP, "--diameter", "200 mm"),
    ],
)
def test_what_is_understood_and_refused_is_three(cli, line):
    assert cli(*line)[0] == 3


def test_the_help_of_every_command_shows_examples_that_are_understood():
    (several,) = (a for a in build_parser()._actions if isinstance(a, argparse._SubParsersAction))
    assert set(several.choices) == set(EXAMPLES)
    for name, lines in EXAMPLES.items():
        assert lines
        assert all(f"\n  {line}" in several.choices[name].format_help() for line in lines)
        assert all(read_line(shlex.split(line.replace("\\\n", ""))[1:]).handler for line in lines)


def test_an_error_under_json_is_json_as_well(cli):
    code, out, err = cli("check", "t5bb", "--json")
    told = json.loads(out)["error"]
    assert (told["exit_code"], code) == (code, 2)
    assert "Did you mean t5b?" in told["message"] and told["message"] in err
