"""README is short, and its set-up, documentation and test lines are those that CI runs."""

import re

import pytest
from page_blocks import BLOCKS, README, ROOT, marked

from fem_impact.cli.parser import read_line

OF_README = [block for block in BLOCKS if block.page == "README.md"]


def test_it_is_short():
    assert len(README.splitlines()) <= 220


@pytest.mark.parametrize("language", sorted({block.language for block in OF_README}))
def test_every_block_is_of_a_kind_that_is_tested(language):
    """Scenes are read, Python is run, outputs are compared, command lines are understood or run."""
    assert language in ("python", "sh", "text", "toml")


def test_all_of_its_python_is_run_and_all_of_its_text_is_compared():
    assert all(block.marker == "python" for block in OF_README if block.language == "python")
    assert all(block.marker.startswith("output: ") for block in OF_README if block.language == "text")


def test_other_command_lines_are_those_of_the_set_up():
    lines = [line for block in OF_README if block.language == "sh" for line in block.text.splitlines()]
    others = [line.split()[0] for line in lines if not line.startswith("fem-impact ")]
    assert sorted(others) == [".", *(3 * [".venv/bin/python"]), "apt-get", "python3"]


def test_ci_takes_its_lines_from_here():
    assert marked("test") == ".venv/bin/python -m pytest -n 2 --dist loadfile"
    script = (ROOT / ".ci" / "run").read_text()
    for marker in ("system", "packages", "docs", "test", "long-test"):
        assert f"commands {marker}" in script
        assert len(marked(marker).splitlines()) == 1


def test_the_scene_of_readme_is_the_one_of_the_tutorial_but_for_its_title():
    import tomllib

    short, long = (
        tomllib.loads(marked("scene", page)) for page in ("README.md", "docs/tutorials/own-projectile.md")
    )
    assert short["impact"] == long["impact"] and short["projectile"] == long["projectile"]
    assert read_line(["check", "my-rod.toml"]).scene == f"{short['id']}.toml"


def test_the_lock_pins_every_package_by_hash_and_names_no_host():
    lock = (ROOT / "requirements.lock").read_text()
    assert "://" not in lock
    assert "--index" not in lock
    packages = re.findall(r"^[a-z0-9][\w.-]*==[^\n]*", lock, re.MULTILINE)
    assert len(packages) > 30
    assert all(line.endswith("\\") for line in packages)
