import json
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest
import result_maker
from outcome_maker import altered

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.figures import still
from fem_impact.figures.live import live
from fem_impact.figures.runs import (
    comparison_picture,
    force_picture,
    ledger_picture,
    partition_picture,
    study_partition_picture,
)
from fem_impact.figures.still import draw, percent
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import ACCOUNTS, shares
from fem_impact.tables.history import HISTORY
from fem_impact.tables.table import read_csv


@pytest.fixture(scope="module")
def history(result):
    return read_csv(result / "history.csv")


def test_ledger_data_are_the_history_over_e_0(history, tmp_path):
    draw(ledger_picture(history, 2.0), tmp_path / "ledger.svg")
    data = read_csv(tmp_path / "ledger.csv")
    assert np.allclose(data.numbers("W_friction_over_E_0"), history.numbers("W_friction_J") / 2.0)
    assert data.numbers("time_s").tolist() == history.numbers("time_s").tolist()


def test_letters_that_the_font_lacks_are_question_marks(tmp_path):
    drawn = still.new_figure(1.0)
    drawn.text(0.1, 0.5, "Zürich 零, µ 🦊 $x_1$")
    still.save(drawn, tmp_path / "title.png")
    assert drawn.texts[0].get_text() == "Zürich ?, µ ? $x_1$"


def test_ledger_areas_add_up_to_what_the_history_holds(history):
    data = ledger_picture(history, result_maker.E_0).table()
    total = sum(data.numbers(account.column.removesuffix("_J") + "_over_E_0") for account in ACCOUNTS)
    assert np.allclose(total, 1.0, atol=3e-6)


def test_every_energy_column_is_drawn_or_named():
    energies = {name for name in HISTORY if name.startswith(("E_", "W_"))}
    assert energies == {account.column for account in ACCOUNTS} | {"E_gravity_J"}


def test_accounts_differ_in_colour():
    for accounts in (ACCOUNTS, shares("figure")):
        assert len({account.colour for account in accounts}) == len(accounts)


def test_a_run_whose_shares_are_all_withheld_has_a_picture_without_bars(record):
    """The report ended in a fault of Python."""
    outcome = Outcome.from_dict(record)
    names = [share.key.path[-1] for share in shares("figure")]
    energy = replace(outcome.energy, **{name: Unknown("withheld") for name in names if name != "residual"})
    (panel,) = partition_picture(replace(outcome, energy=energy)).panels
    assert len(panel.series) <= 1  # what is not accounted for is always known


def test_figures_of_a_run_are_pictures_with_their_numbers(history, tmp_path, record):
    outcome = Outcome.from_dict(record)
    paths = [
        draw(ledger_picture(history, result_maker.E_0), tmp_path / "ledger.svg"),
        draw(force_picture(history, known(outcome.contact.intervals)), tmp_path / "force.svg"),
        draw(partition_picture(outcome), tmp_path / "partition.svg"),
    ]
    for path in paths:
        root = ElementTree.parse(path).getroot()
        assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 10
        assert len(read_csv(path.with_suffix(".csv"))) > 5


def test_figures_of_a_study(tmp_path):
    rows = [Outcome.from_dict(row) for row in result_maker.study_rows()]
    compared = result_maker.comparison()
    compared[0] |= {"model": None, "band": None, "measured_sd": None, "measured_low": None}
    draw(study_partition_picture(rows), tmp_path / "partition.png")
    draw(comparison_picture(compared), tmp_path / "comparison.png")
    assert (tmp_path / "comparison.png").stat().st_size > 20_000
    shares = read_csv(tmp_path / "partition.csv")
    assert shares.texts("scene_id") == list(result_maker.SETS)
    assert len(read_csv(tmp_path / "comparison.csv")) == len(compared)


@pytest.fixture
def kept(monkeypatch):
    """The figures that are saved."""
    figures, save = [], still.save
    monkeypatch.setattr(still, "save", lambda figure, path: (figures.append(figure), save(figure, path)))
    return figures


def test_titles_of_a_comparison_stand_over_their_panels(tmp_path, kept):
    names = [
        "energy locked in rod/E_0",
        "plastic barrier/E_0",
        "energy locked in barrier/E_0",
        "energy locked in barrier/E_0 ",
    ]
    first = result_maker.comparison()[0] | {"set": "t3-contaminated"}
    draw(comparison_picture([first | {"quantity": name} for name in names]), tmp_path / "comparison.svg")
    kept[0].draw_without_rendering()  # the file had other dots per inch
    boxes = [axes._left_title.get_window_extent() for axes in kept[0].axes]
    assert all(0 < box.x0 and box.x1 <= kept[0].bbox.x1 for box in boxes)
    assert not any(a.overlaps(b) for at, a in enumerate(boxes) for b in boxes[:at])


@pytest.mark.parametrize("scale", [1e-3, 1.3e-3, 1e-4, 0.47, 30.0])
def test_numbers_under_a_comparison_stand_apart(tmp_path, kept, scale):
    first = result_maker.comparison()[0] | {"set": "t3-contaminated", "measured_mean": 0.0}
    first |= {"measured_low": None, "measured_sd": None, "band": 0.0}
    shares = [first | {"quantity": name, "model": 0.0} for name in "abcd"]
    others = [share | {"set": "t4", "model": 0.54 * scale, "band": 0.35 * scale} for share in shares]
    draw(comparison_picture([*shares, *others]), tmp_path / "comparison.svg")
    kept[0].draw_without_rendering()
    for axes in kept[0].axes:
        boxes = [word.get_window_extent() for word in axes.get_xticklabels()]
        assert len(boxes) > 1 and "0" in [word.get_text() for word in axes.get_xticklabels()]
        assert all(a.x1 < b.x0 for a, b in pairwise(boxes))


def test_unknown_share_is_left_out(record):
    picture = partition_picture(altered(Outcome.from_dict(record), E_vib_over_E_0=None))
    accounts = picture.table().texts("account")
    assert "E_vib" not in accounts
    assert len(accounts) == len(shares("figure")) - 2  # nor damping, which is off


def test_vibration_that_the_modes_do_not_hold_has_a_bar_beside_them(record):
    """A blunt end's bars missed up to 6 % of E_0."""
    plain = Outcome.from_dict(record)
    before = known(plain.energy.vibration)
    picture = partition_picture(altered(plain, E_vib_check_over_E_0=before + 0.02))
    table = picture.table()
    at = table.texts("account").index("E_vib_above_modes")
    assert table.texts("account")[at - 1] == "E_vib"
    assert table.numbers("fraction_of_E_0")[at] == pytest.approx(0.02)
    assert "vibration above its modes" in picture.panels[0].rows
    same = partition_picture(altered(plain, E_vib_check_over_E_0=before + 1e-4))
    assert "E_vib_above_modes" not in same.table().texts("account")


def test_same_data_give_the_same_bytes(history, tmp_path):
    first = draw(ledger_picture(history, 0.4), tmp_path / "a.svg").read_bytes()
    assert draw(ledger_picture(history, 0.4), tmp_path / "b.svg").read_bytes() == first


def test_live_figures_are_what_plotly_draws_and_hold_the_numbers(history, record):
    import plotly.graph_objects as go

    outcome = Outcome.from_dict(record)
    rows = [Outcome.from_dict(row) for row in result_maker.study_rows()]
    pictures = (
        ledger_picture(history, result_maker.E_0),
        force_picture(history, known(outcome.contact.intervals)),
        partition_picture(outcome),
        study_partition_picture(rows),
        comparison_picture(result_maker.comparison()),
    )
    for picture in pictures:
        shown = json.loads(json.dumps(live(picture), allow_nan=False))
        for panel in shown["panels"]:
            go.Figure(panel["data"], panel["layout"])  # refuses what Plotly does not know
    force = live(pictures[1])["panels"][0]["data"][0]
    assert np.allclose(force["x"], 1e6 * history.numbers("time_s"), rtol=1e-4)
    assert np.allclose(force["y"], history.numbers("force_n_N") / 1e3, rtol=1e-4)


def test_missing_column_is_named(tmp_path):
    (tmp_path / "history.csv").write_text("time_s\n0.0\n")
    with pytest.raises(ResultError, match=r"E_kinetic_rod_J.* is missing"):
        ledger_picture(read_csv(tmp_path / "history.csv"), 1.0)


def test_place_that_cannot_be_written(history, tmp_path):
    (tmp_path / "figures").write_text("a file")
    with pytest.raises(OutputPathError, match="figures"):
        draw(force_picture(history, []), tmp_path / "figures" / "force.svg")


@pytest.mark.parametrize(
    ("fraction", "text"),
    [
        (0.001, "0.1 %"),
        (0.0004, "0.04 %"),
        (2e-7, "0.00002 %"),
        (0.0, "0 %"),
        (-0.02, "-2.0 %"),
        (0.0095, "0.9 %"),
    ],
)
def test_percent(fraction, text):
    assert percent(fraction) == text


def test_import_stays_light():
    code = "import sys, fem_impact.figures, fem_impact.films, fem_impact.pages; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"matplotlib", "pyvista", "vtkmodules", "h5py", "PIL", "plotly"} & set(done.stdout.split())
