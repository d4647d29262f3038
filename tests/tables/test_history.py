"""history.csv is read whole and unchanged, or refused with the row."""

import pytest
import result_maker

from fem_impact.errors import ResultError
from fem_impact.tables.history import read_history


@pytest.fixture
def path(tmp_path):
    """The history of a made-up run."""
    return result_maker.write_result(tmp_path) / "history.csv"


def changed(path, row, column, value):
    """Set one cell of the file."""
    lines = [line.split(",") for line in path.read_text().splitlines()]
    lines[row][lines[0].index(column)] = value
    path.write_text("".join(",".join(line) + "\n" for line in lines))


def test_an_unchanged_history_is_read(path):
    assert len(read_history(path)) == 600


@pytest.mark.parametrize(
    ("row", "column", "value", "reason"),
    [
        (5, "time_s", "0.0", "row 5: its time is not after"),
        (1, "time_s", "nan", 'row 1, column time_s = "nan" is not a finite number'),
        (7, "force_n_N", "inf", 'row 7, column force_n_N = "inf" is not a finite number'),
        (7, "force_n_N", "", "row 7: column force_n_N is empty"),
        (9, "W_friction_J", "0.3", "row 9: its energies do not add up"),
        (0, "V_n_m_per_s", "V_n", 'column "V_n_m_per_s" is missing'),
    ],
)
def test_a_changed_history_is_refused(path, row, column, value, reason):
    changed(path, row, column, value)
    with pytest.raises(ResultError, match=reason):
        read_history(path)


def test_a_history_that_ends_early_is_read_up_to_its_last_line(path):
    text = path.read_text()
    path.write_text(text[: len(text) // 2])
    assert 200 < len(read_history(path)) < 400
