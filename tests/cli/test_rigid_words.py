"""The four commands of rigid theory in the documentation, in help, and what they import."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import rigid
from fem_impact.cli.parser import read_line

PAGES = Path(__file__).parents[2] / "docs"
PAGE = (PAGES / "explanation" / "rigid-theory.md").read_text(encoding="utf-8")
COMMANDS = ("audit", "coefficients", "figure", "assess")


@pytest.mark.parametrize("command", COMMANDS)
def test_help_is_light(command):
    probe = (
        "import sys\nfrom fem_impact.cli.main import main\n"
        f"try:\n    main([{command!r}, '--help'])\nexcept SystemExit:\n    pass\n"
        "print(*(n for n in ('numpy', 'matplotlib', 'rigid', 'h5py') if n in sys.modules), 'end')"
    )
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "end"
    assert f"usage: fem-impact {command}" in done.stdout


def page_lines():
    found = re.search(r"<!-- rigid -->\n```sh\n(.*?)\n```", PAGE, re.DOTALL)
    assert found
    return found.group(1).splitlines()


def test_lines_fit_a_terminal(cli, camera_file):
    """All but the wide tables of the audit."""
    rod = ("--length", "80 mm", "--diameter", "19 mm", "--tip", "B", "--angle", "45 deg")
    tests = camera_file("1,-1.572,-1.602,0.381,-0.371,3.607", "2,-1.516,-1.507,0.271,-0.369,1.019")
    told = [cli("figure", "7", "--out", tests.parent)[1].partition("\npicture: ")[0]]
    told += [cli("coefficients", tests, *rod)[1], cli("audit", "--set", "t5b")[1].partition("\n\n")[0]]
    assert [line for text in told for line in text.splitlines() if len(line) > 79] == []


@pytest.mark.long
def test_the_commands_of_the_page_work(cli, camera_file):
    lines = page_lines()
    assert {shlex.split(line)[1] for line in lines} == set(COMMANDS)
    header = "test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"
    assert header in (PAGES / "how-to" / "camera-data.md").read_text(encoding="utf-8")
    camera_file(
        "1,-1.572,-1.602,0.381,-0.371,3.607",
        "2,-1.516,-1.507,0.271,-0.369,1.019",
        header=header,
        name="tests.csv",
    )
    for line in lines:
        _, command, *rest = shlex.split(line)
        # meshes take minutes; the words are the same
        quick = ("--fidelity", "modal") if command == "assess" else ()
        code, out, err = cli(command, *rest, *quick)
        assert (code, err) == (0, "")
        assert len(out) > 200


def test_the_python_of_the_page_runs(capsys):
    found = re.search(r"<!-- rigid-python -->\n```python\n(.*?)\n```", PAGE, re.DOTALL)
    exec(compile(found.group(1), "rigid-theory.md", "exec"), {})
    assert capsys.readouterr().out == "0.322 0.583 -0.79\n"


def test_the_table_of_the_page_names_what_there_is():
    table = re.search(r"^\| in `rigid` \|.*?\n\n", PAGE, re.DOTALL | re.MULTILINE).group()
    firsts = [row.split("|")[1] for row in table.strip().splitlines()[2:]]
    names = re.findall("`([^`]+)`", " ".join(firsts))
    assert "solve_free" in names
    assert [name for name in names if name != "rigid.experiments" and name not in rigid.__all__] == []


def test_options_of_one_command_do_not_leak_into_another():
    options = read_line(["audit"])
    assert (options.set_id, options.out, options.json) == ("", None, False)
