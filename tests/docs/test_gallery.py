"""Every script of the gallery is short, says what it shows, and draws; the build of the pages runs all."""

import ast
import runpy

import matplotlib.pyplot as plt
import pytest
from page_blocks import ROOT

SCRIPTS = sorted((ROOT / "docs" / "plots").rglob("*.py"))
OBJECTS = {script.stem for script in SCRIPTS if script.parent.name == "objects"}
SLOW = {"contact_levels", "tail_speed", "angle_by_modes", "rigid_beside_modal"} | OBJECTS - {"coin"}


@pytest.fixture(autouse=True)
def closed_figures(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    plt.switch_backend("Agg")
    yield
    plt.close("all")


@pytest.mark.parametrize(
    "script",
    [pytest.param(p, marks=pytest.mark.slow if p.stem in SLOW else (), id=p.stem) for p in SCRIPTS],
)
def test_a_script_draws(script):
    runpy.run_path(str(script))
    assert plt.gcf().axes[0].has_data()


def test_all_are_short_and_say_what_they_show():
    assert len(OBJECTS) == 8
    assert len(SCRIPTS) >= 20
    for script in SCRIPTS:
        text = script.read_text()
        assert len(text.splitlines()) <= 48
        title, line, empty, about = (ast.get_docstring(ast.parse(text)) or "").splitlines()[:4]
        assert (line, empty) == ("=" * len(title), "") and about
