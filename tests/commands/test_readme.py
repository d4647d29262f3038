"""README is executed: its scene, its Python, its tables and its test line are those of the program."""

import argparse
import re
import shlex
import tomllib
from pathlib import Path

import pytest

from fem_impact.commands.parser import build_parser, read_line
from fem_impact.errors import EXIT_CODES
from fem_impact.scene.library import surfaces
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load
from fem_impact.scene.write import to_dict
from rigid import SHAPES

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
# marker before it, language, text
BLOCKS = re.findall(r"(?:<!-- ([^\n]*) -->\n)?```(\w*)\n(.*?)\n```", README, re.DOTALL)
PROSE = re.sub(r"```.*?```", "", README, flags=re.DOTALL)
OUTPUTS = [(marker.removeprefix("output: "), text) for marker, language, text in BLOCKS if language == "text"]
QUICK = (
    "fem-impact --version",
    "fem-impact check my-rod.toml",
    "fem-impact audit",
    'fem-impact coefficients tests.csv --length "80 mm" --diameter "19 mm" --tip B --angle "45 deg"',
    "fem-impact figure 7",
    "fem-impact verify modes --parameters",
    'fem-impact verify modes --set length="120 mm"',
)
CAMERA = """test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s
1,-1.572,-1.602,0.381,-0.371,3.607
2,-1.516,-1.507,0.271,-0.369,1.019
3,-1.475,-1.475,0.340,-0.338,2.933
"""


def block(marker):
    found = re.search(rf"<!-- {marker} -->\n```\w+\n(.*?)\n```", README, re.DOTALL)
    assert found, f"README has no block marked {marker}"
    return found.group(1)


def texts(wanted):
    return [text for _, language, text in BLOCKS if language == wanted]


def rows(first_cell):
    lines = [line for line in README.splitlines() if re.match(rf"\| {first_cell}", line)]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_scene_and_the_python_of_the_readme(capsys):
    assert read_dict(tomllib.loads(block("scene")), "README.md").id == "my-rod"
    exec(compile(block("python"), "README.md", "exec"), {})
    assert re.fullmatch(r"-1\.5024 [0-9a-f]{8}\n", capsys.readouterr().out)


COMMAND_PARSERS = next(
    action.choices for action in build_parser()._actions if isinstance(action, argparse._SubParsersAction)
)


def test_the_table_lists_every_command():
    listed = [row[0].strip("`").split()[1] for row in rows("`fem-impact ")]
    assert sorted(set(listed)) == sorted(COMMAND_PARSERS)
    assert len(listed) == len(set(listed))


@pytest.mark.parametrize("words", re.findall(r"`fem-impact (\w+ [^`]*-[^`]*)`", PROSE))
def test_options_named_in_the_text_exist(words):
    command, *rest = words.split()
    named = {word.strip("[]") for word in rest if word.startswith(("--", "[--"))}
    assert named <= {name for action in COMMAND_PARSERS[command]._actions for name in action.option_strings}


@pytest.mark.parametrize("language", sorted({language for _, language, _ in BLOCKS}))
def test_every_block_is_of_a_kind_that_is_tested(language):
    """Scenes are read, Python is run, outputs are compared, command lines are understood or run."""
    assert language in ("python", "sh", "text", "toml")


def _merged(whole, part):
    """Nested tables with those of a part laid over them."""
    both = {name: _merged(whole[name], part[name]) for name in part if isinstance(part[name], dict)}
    return whole | part | both


@pytest.mark.parametrize("text", texts("toml"))
def test_every_scene_is_valid(text):
    stated = tomllib.loads(text)
    whole = stated if "id" in stated else _merged(to_dict(load("t5b")), stated)
    assert to_dict(read_dict(whole, "README.md")) == to_dict(read_dict(whole))


@pytest.mark.parametrize("text", texts("python"))
def test_every_block_of_python_runs(text, capsys):
    shapes = dict(SHAPES)
    try:
        exec(compile(text, "README.md", "exec"), {})
    finally:
        SHAPES.clear()
        SHAPES.update(shapes)
    assert capsys.readouterr().out


LINES = [line for text in texts("sh") for line in text.splitlines()]
OWN = [line.removeprefix(".venv/bin/") for line in LINES if "fem-impact " in line.split("--no-deps")[0]]


@pytest.mark.parametrize("line", OWN)
def test_every_command_line_is_understood(line):
    options = read_line(shlex.split(line)[1:])
    assert options.version or options.handler.startswith("fem_impact.commands.")


def test_other_command_lines_are_those_of_the_set_up_and_of_a_cluster():
    others = [line.split()[0] for line in LINES if line.removeprefix(".venv/bin/") not in OWN]
    assert sorted(others) == [".", ".venv/bin/python", "apt-get", "dask", "dask", "python3"]


@pytest.mark.parametrize("line", [line for line in OWN if line in QUICK])
def test_quick_command_lines_do_what_they_say(line, cli, tmp_path):
    (tmp_path / "my-rod.toml").write_text(block("scene"))
    (tmp_path / "tests.csv").write_text(CAMERA)
    code, out, _ = cli(*shlex.split(line)[1:])
    assert (code, bool(out)) == (0, True)


def test_quick_command_lines_are_there():
    assert set(QUICK) <= set(OWN)


NUMBER = r"-?\d+\.?\d*(?:e[+-]\d+)?"


@pytest.mark.parametrize(("line", "told"), OUTPUTS)
def test_every_output_shown_is_that_of_its_command(line, told, cli, tmp_path):
    """Words to the letter, numbers within what processors differ by."""
    (tmp_path / "my-rod.toml").write_text(block("scene"))
    _, out, err = cli(*shlex.split(line)[1:])
    found = (out + err).rstrip()
    squeezed = [re.sub(r" +", " ", re.sub(NUMBER, "#", text)) for text in (found, told)]
    assert squeezed[0] == squeezed[1]
    for a, b in zip(re.findall(NUMBER, found), re.findall(NUMBER, told), strict=True):
        assert float(a) == pytest.approx(float(b), rel=0.02, abs=2e-3)


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)]+)\)", README))))
def test_every_link_leads_somewhere(target):
    titles = [line.lstrip("# ") for line in README.splitlines() if re.match("#+ ", line)]
    anchors = {"#" + re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}
    assert target in anchors if target.startswith("#") else (ROOT / target).exists()


@pytest.mark.parametrize(
    "place", sorted(set(re.findall(r"`(?:python )?((?:fem_impact|tests|rigid|meshes)/[\w./-]+)`", README)))
)
def test_every_file_named_is_there(place):
    assert (ROOT / place).exists()


def test_the_words_that_the_trouble_table_quotes_are_the_programs():
    table = README.partition("| what you see |")[2].partition("\n\n")[0]
    quoted = [words for row in table.splitlines()[2:] for words in re.findall("`([^`]+)`", row.split("|")[1])]
    ours = [
        words for words in quoted if "=" not in words and not words.startswith(("fem-impact:", "ensurepip"))
    ]
    sources = "".join(path.read_text() for path in (ROOT / "fem_impact").rglob("*.py"))
    assert len(ours) > 6
    assert [words for words in ours if words not in sources] == []


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
    assert block("test") == ".venv/bin/python -m pytest -n 2 --dist loadfile"
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
