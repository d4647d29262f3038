"""The script by which a shell completes the command line."""

import json
import subprocess
import sys

import pytest


def test_it_says_what_to_install_where_shtab_is_missing(cli, monkeypatch):
    monkeypatch.setitem(sys.modules, "shtab", None)
    code, out, err = cli("completion", "bash")
    assert (code, out) == (7, "")
    assert "pip install 'fem-impact[completion]'" in err


def test_bash_completes_studies_and_options(cli, tmp_path):
    pytest.importorskip("shtab")
    code, script, _ = cli("completion", "bash")
    assert code == 0
    (tmp_path / "complete.sh").write_text(script)

    def completed(*words):
        """Let bash complete the last word; return what it proposes."""
        line = f"COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}"
        ask = f'source complete.sh; {line}; _shtab_fem_impact; echo "${{COMPREPLY[@]}}"'
        done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, cwd=tmp_path, check=True)
        return done.stdout.split()

    assert completed("fem-impact", "ass") == ["assess"]
    assert completed("fem-impact", "study", "conv") == ["convergence"]
    assert "--estimate" in completed("fem-impact", "study", "gamma", "--e")
    assert completed("fem-impact", "run", "--fidelity", "mo") == ["modal"]


def test_the_script_is_json_on_demand(cli):
    pytest.importorskip("shtab")
    assert json.loads(cli("completion", "zsh", "--json")[1])["shell"] == "zsh"
