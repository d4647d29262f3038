"""What a real terminal gets: tables and pages set by rich; plain text where it asks for that."""

import os
import pty
import subprocess
import sys

import pytest

from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import print_markdown

PAGE = "# Title\n\n![a figure](figures/a.png)\n\n| key | value |\n|---|---|\n| e | 0.33 |\n"


def on_terminal(*words, **environment):
    """Run the command on a pseudo-terminal; return what it printed."""
    leader, follower = pty.openpty()
    plain = {name: value for name, value in os.environ.items() if name not in ("NO_COLOR", "COLUMNS")}
    subprocess.run(
        [sys.executable, "-m", "fem_impact", *words],
        stdout=follower,
        stderr=subprocess.DEVNULL,
        stdin=subprocess.DEVNULL,
        env={**plain, "TERM": "xterm", "COLUMNS": "100", **environment},
        check=True,
    )
    os.close(follower)
    with os.fdopen(leader, "rb", buffering=0) as shown:
        return _all(shown).decode()


def _all(stream):
    parts = []
    while True:
        try:
            part = stream.read(65536)
        except OSError:  # the other end is closed
            part = b""
        if not part:
            return b"".join(parts)
        parts.append(part)


@pytest.mark.long
def test_a_table_on_a_terminal_is_set_by_rich():
    shown = on_terminal("verify", "modes", "--parameters")
    assert "━" in shown or "─" in shown
    assert "\x1b[1m" in shown


@pytest.mark.long
@pytest.mark.parametrize("asked", [{"NO_COLOR": "1"}, {"TERM": "dumb"}])
def test_a_terminal_that_asks_for_plain_text_gets_it(asked):
    shown = on_terminal("verify", "modes", "--parameters", **asked)
    assert "\x1b" not in shown and "─" not in shown
    assert "default" in shown


def test_quiet_gets_plain_text():
    assert "\x1b" not in on_terminal("verify", "modes", "--parameters", "--quiet")


def test_markdown_stays_as_it_is_in_a_pipe(capsys):
    print_markdown(PAGE, Options())
    assert capsys.readouterr().out == PAGE


def test_markdown_is_set_as_a_page_on_a_terminal(monkeypatch, capsys):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("NO_COLOR", "1")
    print_markdown(PAGE, Options())
    shown = capsys.readouterr().out
    assert not {"|", "#", "!["} & set(shown.split())
    assert "Title" in shown and "0.33" in shown and "figure" not in shown
    assert "\x1b" not in shown


def test_rich_is_not_loaded_where_no_terminal_is():
    probe = (
        "import sys\nfrom fem_impact.cli.main import main\nmain(['scenes'])\n"
        "print('rich' in sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "False"
