"""What a terminal of 80 columns shows: no line broken in a word, every reason once, names as they are."""

import re

import pytest

from fem_impact.cli.parser import build_parser, every_command
from fem_impact.tables.text import wrapped

COMMANDS = [name for name, _ in every_command(build_parser())]


@pytest.mark.parametrize("command", [None, *COMMANDS])
def test_help_fits_and_keeps_names(capsys, monkeypatch, command):
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        build_parser().parse_args([*(command or "").split(), "--help"])
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= 80
    assert "html" not in text.replace(".html", "")


def test_sentences_of_a_scene_fit(cli):
    text = cli("check", "t5b", "--long")[1].partition("\nSources\n")[2]
    assert "barrier.material.nu" in text
    assert max(map(len, text.splitlines())) < 80


def test_unknown_shares_give_each_reason_once_and_nothing_runs_over(cli, stand):
    known = {"W_friction_over_E_0": 0.3, "residual_over_E_0": -1e-9}
    stand.outcome = stand.an_outcome(
        **known, limitations=[{"kind": "model", "text": "as far as anybody can tell " * 6}]
    )
    out = cli("run", "t5b", "--quiet")[1]
    motion, shares = out.split("of the initial energy")
    sentences = " ".join(shares.split()).split("later strikes")[0]
    assert f"  restitution e (tip's arms){'not known':>24}\n" in motion
    assert sentences.count("not in the stand-in") == 1
    assert "energy locked in rod; energy locked in barrier; radiated;" in sentences
    assert f"  friction{'30 %':>44}\n" in shares
    assert f"  not accounted for{'under 0.001 %':>35}\n" in shares
    assert max(map(len, out.splitlines())) < 80


def test_names_are_never_broken():
    name = "a-name-" * 20
    assert wrapped(f"the word {name} stands whole", "  ") == ["  the word", f"    {name}", "    stands whole"]


def test_the_printed_shares_add_up_to_the_initial_energy_and_what_gravity_added(cli):
    line = (
        "run",
        "t5b",
        "--fidelity",
        "modal",
        "--set",
        "effects=auto,gravity",
        "--set",
        "impact.height=1 mm",
    )
    _, out, _ = cli(*line)
    head, listed = re.search(r"of the initial energy, (.*):\n((?:  .*\n)*)  not acc", out).groups()
    added = re.fullmatch(r"E_0 = \S+ J, to which gravity added (\S+) %", head)
    shares = [float(share) for share in re.findall(r"([-\d.]+)(?: \+- \S+)? %", listed)]
    assert float(added[1]) > 1 and "gravity" not in listed
    assert sum(shares) == pytest.approx(100 + float(added[1]), abs=1.0)  # no digit more than holds
    assert "gravity added" not in cli("run", "t5b", "--fidelity", "modal")[1]
