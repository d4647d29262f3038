"""Tables that users wrote: what they may hold, and what is refused by file, line and column."""

import pytest

from fem_impact.errors import ResultError
from fem_impact.scene.user_table import read_user_table


def table(folder, text):
    """Return a table that stands in a file ``my.csv``."""
    file = folder / "my.csv"
    file.write_text(text, encoding="utf-8")
    return read_user_table(file, "quantity,mean,sd,n")


def test_a_column_that_stands_twice_is_refused(tmp_path):
    """The last of them counted: a mean of 0.4 was read as 0.9."""
    with pytest.raises(ResultError, match=r"my\.csv: has two columns 'mean'\. Keep one\."):
        table(tmp_path, "quantity,mean,mean,sd,n\ne,0.40,0.90,0.05,8\n")


def test_columns_without_a_name_may_repeat(tmp_path):
    assert table(tmp_path, "quantity,,mean,,sd,n\ne,,0.4,,0.05,8\n").column("mean")[0][1] == "0.4"
