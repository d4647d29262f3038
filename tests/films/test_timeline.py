"""The times of a film, and the motion between and after stored frames."""

import numpy as np
import pytest
import result_maker

from fem_impact.errors import ResultError, UsageError
from fem_impact.films.movement import FRAMES, WHOLE, Movement, Span, film_times, read_movement, slow_motion


@pytest.fixture(scope="module")
def movement(result):
    return read_movement(result)[0]


def test_a_film_has_twenty_frames_while_a_wave_runs_once_along_the_rod(movement):
    times = film_times(movement, "strain", WHOLE)
    assert len(times) == FRAMES
    assert (np.diff(times) > 0).all()
    for passed in range(2):
        start = passed * movement.waves.transit
        assert ((times >= start) & (times < start + movement.waves.transit)).sum() >= 20


def test_the_free_ringing_is_part_of_the_film_and_of_that_of_strain_only(movement):
    assert film_times(movement, "strain", WHOLE)[-1] == pytest.approx(result_maker.T_END + 2 / 12340)
    assert film_times(movement, "stress", WHOLE)[-1] == movement.stored_end


def test_span_and_speed(movement):
    times = film_times(movement, "strain", Span(1e-4, 3e-4, speed=1e-4))
    assert (times[0], times[-1], len(times)) == (1e-4, 3e-4, 40)
    assert slow_motion(times, 0) == pytest.approx(1e-4, rel=0.03)
    assert len(film_times(movement, "strain", Span(1e-4, 3e-4, frames=7))) == 7


@pytest.mark.parametrize("span", [Span(3e-4, 1e-4), Span(last=1.0), Span(frames=0), Span(first=-1e-6)])
def test_a_span_outside_the_run_is_refused(movement, span):
    with pytest.raises(UsageError, match=r"^frames=0: is no number|^the span of the film = "):
        film_times(movement, "strain", span)


def test_without_waves_the_stored_frames_are_shown(movement):
    bare = Movement(movement.fields)
    assert film_times(bare, "strain", WHOLE).tolist() == movement.fields.times.tolist()
    assert len(film_times(bare, "strain", Span(frames=2))) == 2


def test_frames_are_met_exactly_and_crossed_linearly(movement):
    fields = movement.fields
    first, second = (fields.point_data("displacement", at).astype(float) for at in (1, 2))
    assert np.array_equal(movement.point_data("displacement", fields.times[2]), second)
    half = movement.point_data("displacement", fields.times[1:3].mean())
    assert half == pytest.approx((first + second) / 2, abs=1e-15)


def test_the_rod_flies_on_after_the_run(movement):
    later = result_maker.T_END + 1e-4
    count = len(movement.ringing.rest)
    gone = (movement.points(later)[:count] - movement.ringing.points(result_maker.T_END)).mean(axis=0)
    assert gone[[0, 2]] == pytest.approx([4e-5, 4e-5], abs=3e-6)
    assert movement.velocity(later, np.ones(len(movement.fields.points))) == pytest.approx([0.4, 0, 0.4])


def test_waves_of_another_mesh_are_refused(tmp_path):
    result_maker.write_fields(tmp_path / "fields.vtkhdf", frames=1, across=4, along=4)
    result_maker.write_waves(tmp_path / "waves.h5", across=6, along=36)
    with pytest.raises(ResultError, match="other points"):
        read_movement(tmp_path)


def test_missing_waves_are_told(tmp_path):
    result_maker.write_fields(tmp_path / "fields.vtkhdf", frames=1, across=4, along=4)
    movement, (note,) = read_movement(tmp_path)
    assert movement.waves is None and "no waves.h5" in note
