"""Numbers for readers: significant digits without an exponent, in sentences and in tables."""

import pytest

from fem_impact.tables.table import Table
from fem_impact.tables.text import plain


@pytest.mark.parametrize(
    ("value", "digits", "words"),
    [(102.4, 2, "100"), (123.4, 3, "123"), (-123.4, 2, "-120"), (0.00012, 2, "0.00012"), (0.0, 2, "0")],
)
def test_numbers_have_no_exponent(value, digits, words):
    assert plain(value, digits) == words


def test_very_small_and_large_numbers_keep_it():
    assert (plain(3.2e-7, 2), plain(1.24e9, 2)) == ("3.2e-07", "1.2e+09")


def test_a_table_shows_plain_digits():
    table = Table.of(("set", "peak force, N"), [["t5b", 12345.678]])
    assert "12350" in table.terminal() and "12350" in table.markdown() and "12345.678" in table.csv()
