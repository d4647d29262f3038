import sys
import types
from pathlib import Path

import h5py
import numpy as np
import pytest
import result_maker
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

import fem_impact.films.encode as encoding
from fem_impact.errors import MissingLibraryError, OutputPathError, ResultError, UsageError
from fem_impact.files.fields import read_fields
from fem_impact.films.encode import require_gl
from fem_impact.films.film import _on_one_scale, render, render_side_by_side
from fem_impact.films.frame import FrameLayout, SideBySideLayout
from fem_impact.films.motion import (
    axis_of,
    fibres,
    hex_volumes,
    nice_factor,
    nodal_volumes,
    prepare,
    rigid_motion,
    stretch,
    to_points,
)
from fem_impact.films.movement import Movement, Span

POINTS, CELLS = result_maker.grid((3, 2, 4))


def filmed(folder, field):
    """The arguments of `prepare` for all stored frames of a result."""
    fields = read_fields(folder / "fields.vtkhdf")
    return Movement(fields), field, fields.times


WEIGHTS = nodal_volumes(POINTS, CELLS)


def turned(points, angle):
    """Points turned about b by an angle that carries n towards t."""
    t, n = points[:, 0], points[:, 2]
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.column_stack([cosine * t - sine * n, points[:, 1], sine * t + cosine * n])


def test_volumes_fill_the_body():
    assert hex_volumes(POINTS * [2.0, 3.0, 0.5], CELLS).sum() == pytest.approx(3.0)
    assert WEIGHTS.sum() == pytest.approx(1.0)


@given(st.floats(-2.0, 2.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
@settings(max_examples=30, deadline=None)
def test_rigid_motion_is_recognised_whole(angle, along_t, along_n):
    moved = turned(POINTS, angle) + np.array([along_t, 0.0, along_n])
    assert np.allclose(rigid_motion(POINTS, moved, WEIGHTS), moved, atol=1e-12)


def test_best_rigid_motion_leaves_no_drift_and_no_spin():
    moved = turned(POINTS, 0.3)
    moved[:, 0] += 0.05 * np.sin(3.0 * POINTS[:, 2])
    rigid = rigid_motion(POINTS, moved, WEIGHTS)
    arm, rest = rigid - np.average(rigid, axis=0, weights=WEIGHTS), moved - rigid
    assert np.allclose(WEIGHTS @ rest, 0.0, atol=1e-12)
    assert WEIGHTS @ (arm[:, 0] * rest[:, 2] - arm[:, 2] * rest[:, 0]) == pytest.approx(0.0, abs=1e-12)


@given(st.floats(-2.0, 2.0), st.floats(-1e-3, 1e-3))
@settings(max_examples=20, deadline=None)
def test_stretch_sees_strain_along_the_axis_only(angle, strain):
    axis = np.array([np.sin(0.6), 0.0, np.cos(0.6)])
    across = np.array([np.cos(0.6), 0.0, -np.sin(0.6)])
    longer = (
        POINTS + strain * np.outer(POINTS @ axis, axis) - 0.3 * strain * np.outer(POINTS @ across, across)
    )
    found = stretch(fibres(POINTS, CELLS, axis), turned(longer, angle)[CELLS])
    assert np.allclose(found, 1.0 + strain, atol=1e-12)


def test_the_axis_is_found_from_the_shape():
    long = turned(POINTS * [0.2, 0.3, 2.0], 0.7)
    assert abs(axis_of(long) @ turned(np.array([[0.0, 0.0, 1.0]]), 0.7)[0]) == pytest.approx(1.0)


def test_strain_is_shown_with_its_sign_and_not_in_the_barrier(result):
    motion = prepare(*filmed(result, "strain"))
    assert motion.far[0] == -motion.far[1] < 0.0
    colours, body = motion.colours(motion.fields.times[2]), motion.fields.static["body"]
    assert not colours[body == 1].any()
    assert colours[body == 0].min() < 0.0 < colours[body == 0].max()


def test_rods_side_by_side_share_scale_and_colours(result):
    movement, _, times = filmed(result, "strain")
    motions = [prepare(movement, "strain", times[[frame]]) for frame in (1, 3)]
    assert motions[0].far != motions[1].far
    assert motions[0].peak != motions[1].peak
    one, other = _on_one_scale(motions)
    assert one.far == other.far == max((m.far for m in motions), key=lambda far: far[1])
    assert one.peak == other.peak == min(m.peak for m in motions)
    assert one.factor.max() == one.peak


@pytest.mark.parametrize(
    ("wanted", "factor"), [(0.3, 1), (1.0, 1), (4.9, 2), (5.0, 5), (99.0, 50), (100.0, 100), (np.inf, 1)]
)
def test_nice_factor(wanted, factor):
    assert nice_factor(wanted) == factor


def test_cell_values_at_points_keep_a_constant():
    assert np.allclose(to_points(CELLS, np.full(len(CELLS), 3.5), len(POINTS)), 3.5)


@pytest.mark.parametrize("size", [(1000, 720), (1280, 700), (320, 240)])
def test_size_an_encoder_cannot_take_is_refused(size):
    with pytest.raises(UsageError, match="multiples of 16"):
        FrameLayout(*size)


def test_ranges_are_fixed_over_the_film(result):
    movement, field, times = filmed(result, "stress")
    motion = prepare(movement, field, times)
    peak = max(movement.fields.cell_data("mises", frame).max() for frame in range(4)) * 1e-6
    assert 0.0 == motion.far[0] < motion.far[1] < motion.near[1] <= peak * (1 + 1e-6)
    assert motion.far == prepare(movement, field, times[[3, 1, 2, 0]]).far
    assert motion.span == pytest.approx(2.0 * result_maker.RADIUS)


def test_deformation_is_true_at_the_contact_and_magnified_far_from_it(result):
    motion = prepare(*filmed(result, "stress"))
    distance = np.linalg.norm(motion.fields.points - motion.contact, axis=1)
    assert np.allclose(motion.factor[distance < 0.4 * motion.span], 1.0)
    assert np.allclose(motion.factor[distance > 2.1 * motion.span], motion.peak)
    assert motion.peak > 1.0
    true, shown = motion.positions(motion.fields.times[2])
    near = distance < 0.4 * motion.span
    assert np.allclose(true[near], shown[near])
    assert np.abs(true - shown).max() > 1e-5


def test_unknown_field(result):
    with pytest.raises(ResultError, match="choose one of strain, stress, velocity, plastic"):
        prepare(*filmed(result, "heat"))


def test_nothing_to_draw(tmp_path):
    with pytest.raises(ResultError, match="no such field file"):
        render(tmp_path)
    result_maker.write_fields(tmp_path / "fields.vtkhdf", frames=0, along=4)
    with pytest.raises(ResultError, match="no frames yet"):
        render(tmp_path)


def test_missing_gl_is_a_clear_error_and_the_result_is_kept(result, tmp_path, monkeypatch):
    encoding._trial.cache_clear()
    monkeypatch.setattr(encoding, "_TRIAL", "import os; os.kill(os.getpid(), 11)")
    with pytest.raises(MissingLibraryError, match=r"code -11.*libegl1 and libgl1-mesa-dri.*result is kept"):
        render(result, tmp_path / "film.gif")
    encoding._trial.cache_clear()
    assert list(tmp_path.iterdir()) == []


FRAMES = [Image.new("RGB", (96, 64), (shade,) * 3) for shade in (0, 120, 240)]


@pytest.mark.parametrize("suffix", [".webp", ".gif"])
def test_free_formats_hold_every_frame(tmp_path, suffix):
    path = encoding.encode(FRAMES, tmp_path / f"film{suffix}", fps=10)
    with Image.open(path) as film:
        assert film.n_frames == 3
        film.seek(2)
        assert abs(int(np.asarray(film.convert("RGB")).mean()) - 240) < 4


def test_the_mp4_encoder_gets_every_frame(tmp_path, monkeypatch):
    """A stand-in for the optional encoder, with its calls: a generator that takes frames after a None."""
    got = []

    def write_frames(path, size, **options):
        Path(path).write_bytes(b"film")
        got.append((size, options["fps"]))
        while True:
            frame = yield
            got.append(frame if frame is None else len(frame))

    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", types.SimpleNamespace(write_frames=write_frames))
    monkeypatch.setattr(encoding, "_has_ffmpeg", lambda: True)
    path = encoding.encode(FRAMES, tmp_path / "film.mp4", fps=10)
    assert got == [((96, 64), 10), *[3 * 96 * 64] * len(FRAMES)]
    assert path.read_bytes() == b"film"


def test_png_frames_replace_older_ones(tmp_path):
    encoding.encode(FRAMES, tmp_path / "film.png", fps=10)
    folder = encoding.encode(FRAMES[:2], tmp_path / "film.png", fps=10)
    assert sorted(path.name for path in folder.iterdir()) == ["frame_0000.png", "frame_0001.png"]


def test_without_its_encoder_mp4_is_refused_and_webp_chosen(tmp_path, monkeypatch):
    monkeypatch.setattr(encoding.importlib.util, "find_spec", lambda name: None)
    assert encoding.best_suffix() == ".webp"
    with pytest.raises(MissingLibraryError, match=r"fem-impact\[mp4\]"):
        encoding.encode(FRAMES, tmp_path / "film.mp4", fps=10)


def test_unknown_format_leaves_nothing(tmp_path):
    with pytest.raises(OutputPathError, match=r"a film ends in \.mp4"):
        encoding.encode(FRAMES, tmp_path / "film.avi", fps=10)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.render
def test_film_shows_motion_and_carries_the_marker(result, tmp_path):
    require_gl()
    made = render(result, tmp_path / "film.png", Span(frames=3), "stress", (640, 480))
    assert (made.frames, made.notes) == (3, ())
    pictures = [np.asarray(Image.open(path)).astype(int) for path in sorted(made.path.iterdir())]
    layout = FrameLayout(640, 480)
    for view in (layout.rod, layout.close, layout.strip):
        cut = np.s_[view.top : view.top + view.height, view.left : view.left + view.width]
        for picture in pictures:
            assert picture[cut].std() > 5
        assert (np.abs(pictures[0][cut] - pictures[1][cut]) > 30).mean() > 1e-3


@pytest.mark.render
def test_velocity_film_without_barrier_history_or_record(tmp_path):
    points, cells, body, rod = result_maker.mesh(4, 6)
    static = {"body": body[body == 0]}
    fields = result_maker.FieldWriter(tmp_path / "fields.vtkhdf", points[:rod], cells[body == 0], static)
    moved = np.zeros((rod, 3))
    fields.append(0.0, {"displacement": moved, "velocity": moved - np.array([0.0, 0.0, 1.0])})
    made = render(tmp_path, tmp_path / "film.gif", field="velocity", size=(640, 480))
    assert made.frames == 1
    assert any("no force curve" in note for note in made.notes)
    assert any("named after its folder" in note for note in made.notes)


@pytest.mark.render
def test_side_by_side_film_moves_in_every_view(result, tmp_path):
    require_gl()
    made = render_side_by_side([result, result], tmp_path / "film.png", Span(frames=3), size=(640, 480))
    assert (made.frames, made.notes) == (3, ())
    first, second = (np.asarray(Image.open(p)).astype(int) for p in sorted(made.path.iterdir())[:2])
    layout = SideBySideLayout(640, 480, 2)
    for view in (*layout.views, *layout.strips):
        cut = np.s_[view.top : view.top + view.height, view.left : view.left + view.width]
        assert first[cut].std() > 5
        assert (np.abs(first[cut] - second[cut]) > 30).mean() > 1e-3


@pytest.mark.parametrize(
    ("harm", "reason"),
    [
        (lambda root: root["CellData/body"].__setitem__(slice(None), 1), "names no rod"),
        (lambda root: root["CellData"].move("body", "other"), "names no rod"),
        (lambda root: root["Points"].__setitem__(slice(None), root["Points"][:] * [1, 1, -1]), "volume -"),
        (lambda root: root["PointData/displacement"].__setitem__((400, 0), 1e30), "moves points by 1e"),
    ],
)
def test_a_forged_result_is_refused_before_anything_is_drawn(tmp_path, monkeypatch, harm, reason):
    monkeypatch.setattr("fem_impact.films.film.require_gl", lambda: pytest.fail("drawing begins"))
    fields = result_maker.write_fields(tmp_path / "fields.vtkhdf", frames=2, across=4, along=6)
    with h5py.File(fields.path, "r+") as file:
        harm(file["VTKHDF"])
    with pytest.raises(ResultError, match=rf"fields\.vtkhdf: .*{reason}"):
        render(tmp_path)
