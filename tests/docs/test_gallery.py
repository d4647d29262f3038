"""Every picture of the gallery is made by its lines, shows what they draw today, and stands on the page.

The numbers that a stored picture shows are stored beside it. Where a change of the program moves them the
picture is stale: ``REMAKE_GALLERY=1 python -m pytest tests/docs/test_gallery.py`` draws it anew.
"""

import json
import os
import runpy
import shutil

import matplotlib.pyplot as plt
import numpy as np
import pytest
from page_blocks import PAGES, ROOT

SCRIPTS = sorted((ROOT / "docs" / "gallery").glob("*.py"))
STORED = ROOT / "docs" / "pictures" / "gallery"
STALE = 0.003
"""Largest difference of a number over the range of its panel: about a line's width."""


def drawn(figure):
    """Numbers of lines, points and bars of each panel, an entry a line."""
    panels = []
    for axes in figure.axes:
        shapes = [line.get_xydata() for line in axes.lines]
        shapes += [np.asarray(marks.get_offsets()) for marks in axes.collections]
        shapes += [path.vertices for marks in axes.collections for path in marks.get_paths()]
        shapes += [
            bar.get_extents().transformed(axes.transData.inverted()).get_points() for bar in axes.patches
        ]
        panels.append([np.asarray(shape, float).round(9).tolist() for shape in shapes])
    return panels


def assert_same(now, stored):
    """Compare the numbers of two pictures over the range of each panel."""
    assert [len(panel) for panel in now] == [len(panel) for panel in stored]
    for panel, old in zip(now, stored, strict=True):
        every = np.concatenate([np.reshape(shape, (-1, 2)) for shape in old])
        span = np.nanmax(every, axis=0) - np.nanmin(every, axis=0)
        for shape, was in zip(panel, old, strict=True):
            np.testing.assert_allclose(np.divide(shape, span), np.divide(was, span), atol=STALE)


SLOW = ("contact_levels",)  # runs finite elements on three levels


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
def test_a_picture_is_made_by_its_lines(script, tmp_path):
    runpy.run_path(str(script))
    assert [path.name for path in tmp_path.iterdir()] == [f"{script.stem}.svg"]
    assert plt.gcf().axes[0].has_data()
    now, kept = drawn(plt.gcf()), STORED / f"{script.stem}.json"
    if os.environ.get("REMAKE_GALLERY"):
        shutil.copy(tmp_path / f"{script.stem}.svg", STORED)
        kept.write_text(json.dumps(now) + "\n", encoding="utf-8")
    assert (STORED / f"{script.stem}.svg").stat().st_size > 5000
    assert_same(now, json.loads(kept.read_text(encoding="utf-8")))


def test_all_are_on_the_page_and_short():
    page = PAGES["docs/gallery/index.md"]
    assert len(SCRIPTS) >= 12
    for script in SCRIPTS:
        assert f"literalinclude}} {script.name}" in page
        assert f"gallery/{script.stem}.svg" in page
        assert len(script.read_text().splitlines()) <= 24
