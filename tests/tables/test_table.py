"""One table, four writers, and read back from CSV."""

import json

import numpy as np
import pytest

from fem_impact.errors import ResultError
from fem_impact.tables.table import Column, Marked, Missing, Table, number, read_csv

COLUMNS = (
    Column("name", left=True),
    Column("length_m", "length", "m", digits=3),
    Column("runs"),
    Column("why", left=True),
)
TABLE = Table(
    COLUMNS,
    (
        ("`bar` & **all**", -0.123456, 12345, Marked("inside", "inside")),
        ("a|b", None, Missing("no mesh"), "two words"),
    ),
)


def test_markdown_has_titles_marks_and_no_stray_bars():
    assert TABLE.markdown().splitlines() == [
        "| name | length, m | runs | why |",
        "| --- | ---: | ---: | --- |",
        "| `bar` & **all** | -0.123 | 12345 | inside |",
        "| a\\|b | – | – | two words |",
    ]


def test_a_terminal_sees_aligned_columns_without_marks():
    assert TABLE.terminal().splitlines() == [
        "name       length, m   runs  why",
        "bar & all     -0.123  12345  inside",
        "a|b                –      –  two words",
    ]
    assert TABLE.terminal(indent="  ").splitlines()[1].startswith("  bar & all")


def test_a_narrow_terminal_breaks_the_widest_text():
    table = Table.of(("id", "words"), [("a", "one two three four five six")], left=(0, 1))
    lines = table.terminal(18).splitlines()
    assert max(map(len, lines)) <= 18
    assert lines[1:] == ["a   one two three", "    four five six"]


def test_a_page_has_tags_classes_reasons_and_escapes():
    html = TABLE.html("A < B", compact=True)
    assert "<caption>A &lt; B</caption>" in html and '<table class="compact">' in html
    assert "<td><code>bar</code> &amp; <strong>all</strong></td>" in html
    assert '<td class="number">−0.123</td><td class="number">12\u202f345</td>' in html
    assert '<td class="inside">inside</td>' in html
    assert '<td class="number" title="no mesh">–</td>' in html
    assert Table.of(("a",), []).html() == ""
    assert "<script" not in Table.of(("<script>",), [("<script>",)]).html("<script>")


def test_csv_keeps_every_digit_and_reads_back(tmp_path):
    table = Table.of(
        ("a_m", "n", "ok", "text"), [(0.1 + 0.2, 3, True, "a,b"), (None, Missing("x"), False, "")]
    )
    assert table.csv() == 'a_m,n,ok,text\n0.30000000000000004,3,true,"a,b"\n,,false,\n'
    (tmp_path / "t.csv").write_text(table.csv())
    again = read_csv(tmp_path / "t.csv")
    assert again.names == table.names and len(again) == 2
    assert again.numbers("a_m")[0] == 0.1 + 0.2 and np.isnan(again.numbers("n")[1])
    assert again.texts("text") == ["a,b", ""]
    assert again.csv() == table.csv()


def test_rows_come_in_order_or_by_name_and_must_fit():
    assert Table.of(("a", "b"), [{"b": 2, "a": 1}]).rows == ((1, 2),)
    for row in [(1,), {"a": 1}, {"a": 1, "c": 2}]:
        with pytest.raises(ValueError, match="row"):
            Table.of(("a", "b"), [row])
    with pytest.raises(ValueError, match="row"):
        Table(COLUMNS, (("a",),))


def test_a_column_that_is_not_there_is_named():
    with pytest.raises(ResultError, match='"z" is missing'):
        TABLE.texts("z")


@pytest.mark.parametrize(
    ("value", "text"), [(None, "–"), (True, "yes"), (40000, "40\u202f000"), (-2e-6, "−2e−06")]
)
def test_numbers_of_a_page(value, text):
    assert number(value) == text


def test_cells_that_a_study_stores_are_plain_json():
    assert json.loads(json.dumps(Table.of(("a",), [(1.5,), ("x",), (None,)]).rows)) == [[1.5], ["x"], [None]]
