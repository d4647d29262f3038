"""README is executed: its scene, its Python, its tables and its test line are those of the program."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from fem_impact.cli_parser import read_line
from fem_impact.errors import EXIT_CODES
from fem_impact.scene import Scene, surfaces

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = ("run", "study", "render", "report", "scenes", "check")


def block(marker):
    found = re.search(rf"<!-- {marker} -->\n```\w+\n(.*?)\n```", README, re.DOTALL)
    assert found, f"README has no block marked {marker}"
    return found.group(1)


def rows(first_cell):
    lines = [line for line in README.splitlines() if re.match(rf"\| {first_cell}", line)]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_scene_of_the_readme_is_valid():
    scene = Scene.from_dict(tomllib.loads(block("scene")), "README.md")
    assert scene.id == "my-rod"


def test_the_python_of_the_readme_runs(capsys):
    exec(compile(block("python"), "README.md", "exec"), {})
    assert re.fullmatch(r"-1\.5024 [0-9a-f]{8}\n", capsys.readouterr().out)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_table_lists_every_command_and_its_options_exist(command):
    (line,) = [row[0].strip("`") for row in rows(f"`fem-impact {command}")]
    words = re.sub(
        r"\[(--set key=value|--fidelity modal|--out \w+|--workers N|--quick|ID \.\.\.)\]", r"\1", line
    )
    words = words.replace("ID ...", "t4").replace("--workers N", "--workers 2")
    options = read_line(shlex.split(words)[1:])
    assert options.handler.startswith("fem_impact.cli_")


def test_the_table_of_exit_codes_is_the_programs():
    assert {int(code): words for code, words in rows(r"\d+ \|")} == EXIT_CODES


def test_the_table_of_friction_is_the_data():
    for state, surface in surfaces().items():
        ((_, f, interval, _, _),) = rows(rf"{state} \|")
        low, high = interval.split("-")
        assert (float(f), float(low), float(high)) == (
            surface.friction,
            surface.friction_low,
            surface.friction_high,
        )


def test_the_test_line_runs_pytest_and_ci_takes_its_lines_from_here():
    assert block("test").split() == [".venv/bin/python", "-m", "pytest"]
    script = (ROOT / ".ci" / "run").read_text()
    for marker in ("system", "packages", "test"):
        assert f"commands {marker}" in script
        assert len(block(marker).splitlines()) == 1


def test_the_lock_pins_every_package_by_hash_and_names_no_host():
    lock = (ROOT / "requirements.lock").read_text()
    assert "://" not in lock
    assert "--index" not in lock
    packages = re.findall(r"^[a-z0-9][\w.-]*==[^\n]*", lock, re.MULTILINE)
    assert len(packages) > 30
    assert all(line.endswith("\\") for line in packages)
