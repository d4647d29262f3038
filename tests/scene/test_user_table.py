"""Tables that users wrote: what they may hold, and what is refused by file, line and column."""

import pytest

from fem_impact.errors import ResultError
from fem_impact.scene.own_tests import read_camera, read_means
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


@pytest.mark.parametrize(
    ("column", "meant"),
    [
        *((name, "systematic") for name in ("Systematic", "sytematic", "systematic_%", "systematic_error")),
        *(("D_c_mm", "d_c"), ("d_d mm", "d_d"), ("R_mu", "r_mu")),
    ],
)
def test_a_misspelt_column_of_means_is_refused(tmp_path, column, meant):
    """It was left out: the tests had no systematic uncertainty, or e other arms."""
    file = tmp_path / "my.csv"
    file.write_text(f"quantity,mean,sd,n,{column}\ne,0.4,0.05,8,0.2\nmu,0.5,0.05,8,0.2\n")
    with pytest.raises(ResultError) as refused:
        read_means(file)
    assert f"column {column!r} is not one that is read. Did you mean {meant}?" in str(refused.value)


@pytest.mark.parametrize("column", ["Test", "tests", "test_no", "D_c_m"])
def test_a_misspelt_column_of_single_tests_is_refused(camera_file, column):
    header = f"v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s,{column}"
    with pytest.raises(ResultError, match=f"column '{column}' is not one that is read. Did you mean"):
        read_camera(camera_file("-1.5,-1.5,0.3,-0.4,5,1", "-1.5,-1.5,0.4,-0.4,5,2", header=header))


@pytest.mark.parametrize("column", ["remark", "median", "note", "systematic_source", "n_rejected"])
def test_columns_of_ones_own_beside_means_are_not_used(tmp_path, column):
    file = tmp_path / "my.csv"
    file.write_text(f"quantity,mean,sd,n,systematic,{column}\ne,0.4,0.05,8,0.02,3\n")
    found = read_means(file)
    assert found.ignored == (column,) and found.means["e"].systematic == 0.02


@pytest.mark.parametrize("mark", ["\t", ";"])
def test_a_comma_between_thousands_is_not_taken_for_a_decimal_one(tmp_path, mark):
    """A mean force of 3,400 N was read as 3.4 N."""
    rows = "quantity mean sd n\npeak_force_N 3,400 200.5 8\n"
    with pytest.raises(ResultError) as refused:
        table(tmp_path, rows.replace(" ", mark))
    assert "a comma, such as 3,400 (line 2), and with a point, such as 200.5 (line 2)" in str(refused.value)
    assert table(tmp_path, rows.replace("200.5", "200").replace(" ", mark)).column("mean")[0][1] == "3.400"


@pytest.mark.parametrize(
    ("labels", "told"),
    [
        (("1", "2", "3", "1", "2", "3"), "line 5, column test: test '1' stands in two lines. Leave one out"),
        (("1", "2", "Mean"), "line 4, column test: 'Mean' is no single test. Leave the line out."),
        (("1", "2", "average"), "line 4, column test: 'average' is no single test."),
    ],
)
def test_a_test_counts_once_and_a_mean_is_none(camera_file, labels, told):
    """Pasted twice, three tests had an interval as narrow as six."""
    with pytest.raises(ResultError) as refused:
        read_camera(camera_file(*(f"{label},-1.5,-1.5,0.3,-0.4,5" for label in labels)))
    assert told in str(refused.value)


def test_tests_may_have_no_labels(camera_file):
    assert read_camera(camera_file(*3 * [",-1.5,-1.5,0.3,-0.4,5"])).tests == ("", "", "")


@pytest.mark.parametrize(
    ("header", "dimension", "symbol"),
    [
        *(("stress [N/mm²]", "stress", "N/mm2"), ("stress (N/mm^2)", "stress", "N/mm2")),
        *(("Omega [°/s]", "angular speed", "deg/s"), ("z [µm]", "length", "um"), ("z_μm", "length", "um")),
    ],
)
def test_units_of_a_header_have_the_spellings_of_a_scene(tmp_path, header, dimension, symbol):
    found = table(tmp_path, f"{header}\n1\n").quantity(header.split()[0].split("_")[0], dimension)
    assert found is not None and (found[0], found[1].symbol) == (header, symbol)
