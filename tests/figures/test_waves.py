"""The diagram of position against time: its data, its lines, its units."""

import numpy as np
import pytest
import result_maker

from fem_impact.errors import UsageError
from fem_impact.figures.runs import ROWS, draw_waves, waves_picture
from fem_impact.files.waves import read_waves


def test_the_data_beside_the_diagram_are_the_strains_of_the_run_and_of_the_flight(tmp_path):
    result_maker.write_waves(tmp_path / "waves.h5")
    waves = read_waves(tmp_path / "waves.h5")
    data = waves_picture(waves).table()
    time = data.numbers("time_s")
    assert len(time) == ROWS * len(waves.position)
    assert time[-1] == pytest.approx(waves.end + 4 * waves.length / 5282.0, rel=1e-5)
    after = waves.ringing.strain(np.array([waves.end + 4 * waves.transit]))[1][0]
    assert data.numbers("bending")[-len(waves.position) :] == pytest.approx(after, rel=1e-4)
    assert np.abs(data.numbers("stretch")).max() == pytest.approx(np.abs(waves.stretch).max(), rel=0.05)


def test_a_gauge_shows_the_strain_of_its_place_and_side_and_the_picture_is_drawn(tmp_path):
    result_maker.write_waves(tmp_path / "waves.h5")
    waves = read_waves(tmp_path / "waves.h5")
    place = 0.5 * (waves.position[3] + waves.position[4])
    mean = waves.stretch[:, 3:5].mean(axis=1)
    assert waves.gauge(place, 0.0) == pytest.approx(mean, abs=1e-9) and np.abs(mean).max() > 1e-4
    assert waves.gauge(place) == pytest.approx(0.8 * mean, abs=1e-9)
    assert waves.gauge(place, across=-1.0) == pytest.approx(1.2 * mean, abs=1e-9)
    with pytest.raises(UsageError, match="off the cylinder"):
        waves.gauge(2 * waves.length)
    assert draw_waves(str(tmp_path)).name == "waves.svg" and (tmp_path / "waves.csv").is_file()
