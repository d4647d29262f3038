"""Tables that commands print."""

import pytest

from fem_impact.cli.main import main
from fem_impact.scene.types import MEASURED_SETS


def test_scenes_are_listed_one_a_line(capsys):
    assert main(["scenes"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == ["id", "speed", "title"]
    assert {line.split()[0] for line in lines} >= set(MEASURED_SETS)


@pytest.mark.parametrize("words", ["default", "range", "diameter"])
def test_parameters_of_a_problem_are_a_table(capsys, words):
    assert main(["verify", "bar", "--parameters"]) == 0
    assert words in capsys.readouterr().out
