"""The diagram of position against time: its data, its lines, its units."""

import numpy as np
import pytest
import result_maker

from fem_impact.figures.runs import ROWS, waves_picture
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
