"""Every picture of the gallery is made by its lines, is stored, and stands on the page."""

import runpy

import matplotlib.pyplot as plt
import pytest
from page_blocks import PAGES, ROOT

SCRIPTS = sorted((ROOT / "docs" / "gallery").glob("*.py"))


@pytest.fixture(autouse=True)
def closed_figures(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    plt.switch_backend("Agg")
    yield
    plt.close("all")


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_picture_is_made_by_its_lines(script, tmp_path):
    runpy.run_path(str(script))
    assert [path.name for path in tmp_path.iterdir()] == [f"{script.stem}.svg"]
    assert plt.gcf().axes[0].has_data()
    assert (ROOT / "docs" / "pictures" / "gallery" / f"{script.stem}.svg").stat().st_size > 5000


def test_all_are_on_the_page_and_short():
    page = PAGES["docs/gallery/index.md"]
    assert len(SCRIPTS) >= 12
    for script in SCRIPTS:
        assert f"literalinclude}} {script.name}" in page
        assert f"gallery/{script.stem}.svg" in page
        assert len(script.read_text().splitlines()) <= 24
