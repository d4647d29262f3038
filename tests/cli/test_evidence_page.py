"""Pages of evidence: what they record, where their figures go, and what is refused."""

import re
from pathlib import Path

import pytest

from fem_impact.cli.page import checked_page, machine, version, write_page, write_study_page
from fem_impact.errors import OutputPathError, UsageError

SUMMARY = (
    "# Rods\n\n- The answer.\n\n`fem-impact study gamma`: 3 runs\n\n"
    "![seen](figures/one.png)\n\n| a |\n| --- |\n"
)


def test_a_page_records_command_day_machine_and_commit(tmp_path):
    path = tmp_path / "page.md"
    write_page(path, "Title", "About.", "fem-impact verify", "the table\n")
    title, _, about, _, made, _, body = path.read_text().splitlines()
    assert (title, about, body) == ("# Title", "About.", "the table")
    assert re.fullmatch(
        r"Made by `fem-impact verify` on 20\d\d-\d\d-\d\d, .+, \d+ cores, .*commit .+\.", made
    )
    assert machine() in made and version() in made
    assert checked_page(str(path)) == path  # may be written again


def test_figures_of_a_study_lie_beside_its_page(tmp_path):
    (tmp_path / "results" / "figures").mkdir(parents=True)
    (tmp_path / "results" / "figures" / "one.svg").write_text("<svg/>")
    write_study_page(tmp_path / "gamma.md", "fem-impact study gamma", SUMMARY, tmp_path / "results")
    text = (tmp_path / "gamma.md").read_text()
    assert text.startswith("# Rods\n\n- The answer.\n\nMade by `fem-impact study gamma` on ")
    assert f"{version()}: 3 runs\n" in text
    assert "![seen](gamma/one.svg)" in text and text.endswith("| --- |\n")
    assert (tmp_path / "gamma" / "one.svg").read_text() == "<svg/>"


def test_other_files_are_never_overwritten(tmp_path):
    (tmp_path / "notes.md").write_text("# Notes\n")
    for name in ("notes.md", "page.txt"):
        with pytest.raises(UsageError, match="--page"):
            checked_page(str(tmp_path / name))
    with pytest.raises(OutputPathError, match="no such directory"):
        checked_page(str(tmp_path / "none" / "page.md"))


def test_a_study_writes_its_page(cli, stand):
    code, _, _ = cli("study", "sets", "--quick", "--quiet", "--page", "sets.md")
    assert code == 0
    assert "\nMade by `fem-impact study sets --quick` on " in Path("sets.md").read_text()


def test_a_study_refuses_a_page_before_it_runs(cli, stand):
    assert cli("study", "sets", "--quick", "--page", "sets.txt")[0] == 2
    assert cli("study", "report", "--page", "report.md")[0] == 2
    assert stand.calls == []
