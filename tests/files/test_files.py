import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.files.atomic import atomic_path, make_directory, write_text
from fem_impact.tables.history import HISTORY, HistoryWriter
from fem_impact.tables.table import Table, read_csv


def test_failing_block_leaves_the_old_file_and_nothing_else(tmp_path):
    target = write_text(tmp_path / "film.gif", "old")
    with pytest.raises(RuntimeError, match="stop"), atomic_path(target) as draft:
        assert draft.suffix == ".gif"
        draft.write_text("new, half wri")
        raise RuntimeError("stop")
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["film.gif"]


def test_write_replaces_and_makes_folders(tmp_path):
    write_text(tmp_path / "a" / "b" / "note.txt", "one")
    write_text(tmp_path / "a" / "b" / "note.txt", "two")
    assert (tmp_path / "a" / "b" / "note.txt").read_text() == "two"


def test_file_in_the_way_is_named(tmp_path):
    (tmp_path / "results").write_text("a file")
    with pytest.raises(OutputPathError, match="results/run: cannot be written"):
        make_directory(tmp_path / "results" / "run")
    with pytest.raises(OutputPathError, match="cannot be written"):
        write_text(tmp_path / "results" / "run" / "x.json", "")


FULL = """
import resource, signal, sys
from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import write_text
from fem_impact.tables.history import HistoryWriter
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
folder = sys.argv[1]
write_text(folder + "/note.txt", "old")
history = HistoryWriter(folder + "/table.csv", ("time_s", "text"), batch=10)
resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))
for job in (lambda: write_text(folder + "/note.txt", "x" * 9000),
            lambda: [history.append((0.5, "y" * 40)) for _ in range(400)]):
    try:
        job()
    except OutputPathError as error:
        print("refused:", error)
"""


def test_write_that_runs_out_of_room_leaves_nothing_half_written(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(tmp_path)], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.count("refused:") == 2
    assert (tmp_path / "note.txt").read_text() == "old"
    assert sorted(os.listdir(tmp_path)) == ["note.txt", "table.csv"]
    kept = (tmp_path / "table.csv").read_text()
    assert kept.endswith("\n")
    assert len(read_csv(tmp_path / "table.csv")) % 10 == 0 < len(read_csv(tmp_path / "table.csv"))


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.tuples(
            st.floats(allow_nan=False, allow_infinity=False),
            st.text(st.characters(codec="ascii"), max_size=8),
        )
    )
)
def test_table_reads_back_exactly(tmp_path_factory, rows):
    path = tmp_path_factory.mktemp("table") / "t.csv"
    write_text(path, Table.of(("time_s", "name"), rows).csv())
    table = read_csv(path)
    assert table.numbers("time_s").tolist() == [row[0] for row in rows]
    assert table.texts("name") == [row[1].replace("\r", " ").replace("\n", " ") for row in rows]


def test_unknown_cell_reads_as_nan_and_mappings_are_ordered(tmp_path):
    write_text(tmp_path / "t.csv", Table.of(("a_m", "b_s"), [{"b_s": np.float64(2.5), "a_m": None}]).csv())
    assert (tmp_path / "t.csv").read_text() == "a_m,b_s\n,2.5\n"
    assert np.isnan(read_csv(tmp_path / "t.csv").numbers("a_m")).all()


@pytest.mark.parametrize("row", [(1.0,), (1.0, 2.0, 3.0), {"a_m": 1.0}, {"a_m": 1.0, "c": 2.0}])
def test_row_that_does_not_fit_is_refused(tmp_path, row):
    with pytest.raises(ValueError, match="a row"):
        write_text(tmp_path / "t.csv", Table.of(("a_m", "b_s"), [row]).csv())
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no header"),
        ("a,b\n1\n", "row 1 has 1 cells"),
        ('a,b\n"1,2\n', "CSV"),
        ("a,b\nx,1\n", '"x" is not'),
    ],
)
def test_damaged_table_is_refused(tmp_path, text, message):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(ResultError, match=message):
        read_csv(tmp_path / "t.csv").numbers("a")
    with pytest.raises(ResultError):
        read_csv(tmp_path / "t.csv").numbers("z")


def test_history_comes_in_batches_and_by_time(tmp_path):
    history = HistoryWriter(tmp_path / "history.csv", batch=5, seconds=1000.0)
    for step in range(7):
        history.append(np.full(len(HISTORY), float(step)))
    assert len(read_csv(history.path)) == 5
    history.flush()
    assert read_csv(history.path).numbers("residual_J").tolist() == [0, 1, 2, 3, 4, 5, 6]
    prompt = HistoryWriter(tmp_path / "prompt.csv", batch=1000, seconds=0.0)
    prompt.append(dict.fromkeys(HISTORY, 1.0))
    assert len(read_csv(prompt.path)) == 1


def test_last_line_cut_off_by_a_kill_is_not_counted(tmp_path):
    (tmp_path / "history.csv").write_text("time_s,force_n_N\n0.0,1.0\n0.1,2.")
    assert read_csv(tmp_path / "history.csv").numbers("time_s").tolist() == [0.0]


ENDLESS = """
import itertools, sys
from fem_impact.tables.history import HistoryWriter
history = HistoryWriter(sys.argv[1], ("time_s", "step"), batch=3)
for step in itertools.count():
    history.append((step * 1e-8, step))
"""


def test_killed_run_leaves_a_readable_history(tmp_path):
    path = tmp_path / "history.csv"
    child = subprocess.Popen([sys.executable, "-c", ENDLESS, str(path)])
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline and (not path.exists() or path.stat().st_size < 2000):
        time.sleep(0.01)
    child.send_signal(signal.SIGKILL)
    child.wait()
    steps = read_csv(path).numbers("step")
    assert steps.tolist() == list(range(len(steps)))
    assert len(steps) > 50
