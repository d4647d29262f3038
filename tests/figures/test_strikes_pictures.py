"""The path of a body with its strikes, and its energy after each."""

from dataclasses import replace

import numpy as np
import pytest

from fem_impact.figures.live import live
from fem_impact.figures.runs import FRAMES, SHOWN, accounts_picture, path_picture
from fem_impact.figures.still import draw
from fem_impact.options import RunOptions
from fem_impact.outcome.strikes import strikes_table, told
from fem_impact.pages.run_page import run_page
from fem_impact.pages.sheet import write_sheet
from fem_impact.run.common import pull_of
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from rigid.strikes import outline

SCENE = replace_all(load("quick"), {"impact.slope": "10 deg", "impact.until": "rest"})


@pytest.fixture(scope="module")
def strikes():
    return simulate(SCENE, "rigid").strikes


def path(strikes):
    return path_picture(strikes.each, outline(SCENE.projectile.rigid_body), pull_of(SCENE))


def test_the_body_stands_on_the_barrier_at_each_strike_and_above_it_in_flight(strikes):
    flown, struck, places = path(strikes).panels[0].series
    bodies = np.split(np.array(struck.y), np.flatnonzero(np.isnan(struck.y)))
    lowest = [np.nanmin(body) for body in bodies if np.isfinite(body).any()]
    assert lowest == pytest.approx([0.0] * SHOWN, abs=0.01)  # arcs are drawn by points
    assert np.nanmin(flown.y) > 0.0
    assert np.isnan(flown.y).sum() == FRAMES * (SHOWN - 1)
    assert places.x == pytest.approx([1e3 * one.along for one in strikes.each[:SHOWN]])


def test_a_place_of_a_strike_is_the_lowest_of_the_body_there(strikes):
    _, struck, places = path(strikes).panels[0].series
    along, over = np.array(struck.x), np.array(struck.y)
    ends = np.flatnonzero(np.isnan(over))
    begin = 0
    for end, place in zip(ends, places.x, strict=True):
        low = begin + int(np.argmin(over[begin:end]))
        assert along[low] == pytest.approx(place, abs=0.3)  # between points of an arc
        begin = end + 1


def test_accounts_after_the_last_strike_are_the_totals(strikes):
    areas = {
        series.label: np.asarray(series.y)[-1] for series in accounts_picture(strikes.each).panels[0].series
    }
    assert areas["plastic"] == pytest.approx(strikes.plastic)
    assert areas["friction"] == pytest.approx(sum(one.friction for one in strikes.each))


def test_accounts_with_the_height_are_the_same_after_each_strike(strikes):
    areas = [np.asarray(series.y) for series in accounts_picture(strikes.each).panels[0].series]
    assert all((area >= 0.0).all() for area in areas)
    assert np.ptp(sum(areas)) < 1e-3 * strikes.each[0].before


def test_both_are_drawn_still_and_live(strikes, tmp_path):
    for picture in (path(strikes), accounts_picture(strikes.each)):
        assert draw(picture, tmp_path / f"{picture.name}.svg").stat().st_size > 5000
        assert live(picture)


def test_words_and_table_name_the_hardest_strike_and_the_other_end(strikes):
    text = " ".join(told(strikes))
    assert f"Hardest by energy: strike {strikes.hardest_energy}, " in text
    assert "The other end strikes" in text
    assert len(strikes_table(strikes).rows) == len(strikes.each)


def test_the_hardest_strike_is_told_of_the_certain_ones_and_the_agreement_with_it(strikes):
    certain = replace(strikes, certain=1, hardest_heat=2, hardest_energy=1, hardest_agree=41, heat_agree=39)
    energy, heat = (one for one in told(certain) if one.startswith("Hardest"))
    speed = f"{strikes.each[0].approach:.4g} m/s"
    assert energy.startswith(f"Hardest by energy: strike 1, tip at {speed}: rigid motion from ")
    assert energy.endswith(" J, the hardest in 41 of 64 sequences.")
    assert "not certain (strike 2 of this path, the hardest in 39 of 64 sequences); of the certain" in heat
    assert "ones strike 1, " in heat


@pytest.mark.long
def test_the_pages_of_a_run_show_the_strikes(tmp_path):
    simulate(SCENE, "rigid", RunOptions(out=tmp_path))
    sheet = write_sheet(tmp_path).read_text()
    assert sheet.index("It rests.") < sheet.index("Hardest by energy: strike") < sheet.index("first impact")
    page = run_page(tmp_path)
    assert "From the first strike to rest" in page
    assert (tmp_path / "figures" / "path.svg").is_file()
    assert (tmp_path / "figures" / "other-end.svg").is_file()
    assert (tmp_path / "strikes.csv").read_text().startswith("time_s,fidelity,part")
