"""The page on which a run can be turned: its mesh, its moments, and what is refused."""

import base64
import json
import re
from types import SimpleNamespace

import numpy as np
import plotly.graph_objects as go
import pytest
import result_maker

from fem_impact.cli.main import main
from fem_impact.errors import UsageError
from fem_impact.films.motion import prepare
from fem_impact.films.movement import Span, read_movement
from fem_impact.pages.turning import _eye, write_view


@pytest.fixture
def run(tmp_path):
    return result_maker.write_result(tmp_path, frames=4)


def panel_of(page):
    """Return the one panel of a page."""
    (figure,) = re.findall(r'<script type="application/json">(.*?)</script>', page.read_text(), re.DOTALL)
    (panel,) = json.loads(figure)
    return panel


def numbers(packed):
    return np.frombuffer(base64.b64decode(packed["bdata"]), f"<{packed['dtype']}")


def test_every_moment_shows_both_halves_where_the_film_does(run):
    made = write_view(run, run / "view.html", Span(frames=3), "stress")
    panel = panel_of(run / "view.html")
    assert made.frames == len(panel["frames"]) == 3
    movement, _ = read_movement(run)
    times = movement.fields.times
    shown = 1e3 * prepare(movement, "stress", times).positions(float(times[-1]))[1]
    last = np.stack([numbers(panel["frames"][-1]["data"][0][axis]) for axis in "xyz"], axis=1)
    half, mirrored = np.split(last, 2)
    assert np.allclose(half * [1.0, -1.0, 1.0], mirrored)
    apart = np.abs(half[:, None] - shown[None]).max(axis=2).min(axis=1)
    assert apart.max() < 1e-3  # mm, single precision
    assert np.ptp(half[:, 1]) > 0


def test_the_camera_stands_further_from_a_longer_body(run):
    """Plotly makes sides l, w, w of a body of the mean 1: a body 100 times as long as wide is 21 long."""
    motion = prepare(read_movement(run)[0], "stress", np.zeros(1))
    away = []
    for stretched in (1.0, 20.0):
        long = SimpleNamespace(positions=lambda time, by=stretched: (None, motion.fields.points * [by, 1, 1]))
        away.append(_eye(long, np.zeros(1), np.arange(len(motion.fields.points)))["y"])
    assert away[1] < 3 * away[0] < 0


def test_the_mesh_is_closed_over_the_plane_of_motion_and_one_that_plotly_draws(run):
    write_view(run, run / "view.html", Span(frames=2), "velocity")
    panel = panel_of(run / "view.html")
    (mesh,) = panel["data"]
    go.Figure(panel["data"], panel["layout"], panel["frames"])
    places = np.stack([numbers(mesh[axis]) for axis in "xyz"], axis=1)
    corners = np.stack([numbers(mesh[name]) for name in "ijk"], axis=1)
    assert corners.max() == len(places) - 1
    # a triangle has no other two of its sides on the plane of motion: the halves are open there
    assert not (np.abs(places[corners][:, :, 1]) < 1e-6).all(axis=1).any()
    a, b, c = places[corners].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume > 0  # all sides look outwards, those of the mirrored half as well


def test_a_command_writes_the_page_and_refuses_two_runs_and_too_many_moments(run, capsys):
    page = run / "view.html"
    assert main(["render", str(run), "--out", str(page), "--frames", "2", "--quiet"]) == 0
    assert "view.html" in capsys.readouterr().out and page.stat().st_size < 4e6
    assert main(["render", str(run), str(run), "--out", str(page)]) == UsageError.exit_code
    assert "shows one result only" in capsys.readouterr().err
    with pytest.raises(UsageError, match="Up to 200"):
        write_view(run, page, Span(first=0.0, last=1e-6, frames=201), "stress")
