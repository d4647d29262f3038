"""Numbers for readers: significant digits without an exponent, in sentences and in tables."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fem_impact.tables.table import Table
from fem_impact.tables.text import plain, plain_bound


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


@given(st.floats(1e-6, 1e6), st.integers(1, 8))
def test_a_number_from_above_is_never_below_its_value_and_less_than_a_digit_above_it(value, digits):
    told = float(plain_bound(value, digits, "ROUND_CEILING"))
    nearest = float(f"{value:.{digits}g}")
    unit = float(f"1{f'{nearest:.{digits - 1}e}'[-4:]}") * 10.0 ** (1 - digits)
    assert value <= told < value + unit * (1 + 1e-6)
    assert told == float(f"{told:.{digits}g}")
