"""Meters: a bar and a live line on a terminal, plain lines elsewhere, nothing when quiet."""

import io
import sys
from functools import partial
from types import SimpleNamespace

import pytest

import fem_impact
from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import LiveMeter, chosen_meter
from fem_impact.progress import (
    CaseProgress,
    CellMeter,
    LineMeter,
    Notice,
    NullMeter,
    Progress,
    compiling,
    describe,
    silent,
)


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def on_screen(monkeypatch):
    """Make a meter where standard error is a terminal of 100 columns; return both."""
    for name, value in {"TERM": "xterm", "COLUMNS": "100"}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.delenv("NO_COLOR", raising=False)

    def made(**options):
        with monkeypatch.context() as change:
            change.setattr(sys, "stderr", Terminal())
            return chosen_meter(Options(**options)), sys.stderr

    return made


def report(step, note=""):
    return Progress(step * 1e-7, 1e-3, step, -2e-7, "free flight", None, note)


def test_a_terminal_gets_a_live_line_and_a_log_gets_lines(on_screen, monkeypatch):
    assert isinstance(on_screen()[0], LiveMeter)
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert isinstance(chosen_meter(Options()), LineMeter)


@pytest.mark.parametrize(("name", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_a_terminal_that_asks_for_plain_text_gets_lines(on_screen, monkeypatch, name, value):
    monkeypatch.setenv(name, value)
    assert isinstance(on_screen()[0], LineMeter)


def test_quiet_shows_nothing(on_screen):
    meter, screen = on_screen(quiet=True)
    assert isinstance(meter, NullMeter)
    assert meter(report(1)) is None
    assert meter.close() is None
    assert screen.getvalue() == ""


def test_the_live_line_is_rewritten_ten_times_a_second_and_left_standing(on_screen, monkeypatch):
    times = iter([0.0, 0.05, 0.2])
    meter, screen = on_screen()
    monkeypatch.setattr(meter, "_clock", lambda: next(times))
    for step in (1, 2, 3):
        meter(report(step))
    meter.close()
    shown = screen.getvalue()
    assert ["step 1 " in shown, "step 2 " in shown, "step 3 " in shown] == [True, False, True]
    assert shown.count("━") > 20
    assert shown.rpartition("step 3")[2].count("\n") == 1


def test_a_notice_and_a_study_are_shown_live_too(on_screen):
    meter, screen = on_screen()
    meter(Notice("t4 is computed again"))
    meter(CaseProgress("t5b", 3, 8, 61.0))
    meter.close()
    assert "t4 is computed again\n" in screen.getvalue()
    assert "3 of 8 runs done, about 1 min 01 s left, last t5b" in screen.getvalue()


def test_a_log_gets_a_line_of_each_work_every_few_seconds():
    times = iter([0.0, 1.0, 1.0, 6.0])
    stream = io.StringIO()
    meter = LineMeter(stream, every_s=5.0, clock=lambda: next(times))
    for step, note in ((1, "t4"), (2, "t4"), (1, "t5b"), (3, "t4")):
        meter(report(step, note))
    meter.close()
    assert [line.split("  ")[0::2][:2] for line in stream.getvalue().splitlines()] == [
        ["t4", "step 1"],
        ["t5b", "step 1"],
        ["t4", "step 3"],
    ]


@pytest.mark.parametrize(
    ("eta", "words"), [(None, ""), (5.4, "about 5 s left"), (125.0, "about 2 min 05 s left")]
)
def test_the_time_still_needed_is_told_when_it_is_known(eta, words):
    line = describe(Progress(0.0, 1e-3, 1, 0.0, "free", eta))
    assert line.startswith(f"t 0/1000 us  {words}") and ("left" in line) == bool(words)


def test_a_terminal_of_80_columns_shows_the_time_still_needed_and_what_compiles():
    long = Progress(2.5e-3, 2.5e-3, 99999, -1e-9, "120 nodes touch", 3599.0, "t3-contaminated")
    assert "59 min 59 s left" in describe(long)[: 79 - 21]
    assert describe(compiling(2.5e-3, 20)) == "t 0/2500 us  compiling the kernels, once, about 20 s"


@pytest.mark.parametrize(("shell", "chosen"), [(object(), None), (None, None), (object(), silent)])
def test_a_notebook_shows_the_time_left_unless_told_otherwise(monkeypatch, capsys, shell, chosen):
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setattr("fem_impact.progress.CellMeter", partial(CellMeter, first_s=0.0))
    fem_impact.sweep(fem_impact.load("t5b"), {"impact.angle": ["15 deg", "30 deg"]}, "rigid", progress=chosen)
    shown = capsys.readouterr().out
    if shell is None or chosen is silent:
        assert shown == ""
        return
    assert "of 2 runs done, about 0 s left" in shown
    assert shown.split("\r")[-1] == ""


def test_a_short_call_shows_nothing_in_a_notebook_and_a_long_one_clears_its_line():
    times, screen = iter([0.0, 0.5, 1.5, 1.5, 1.6, 2.0, 2.0]), io.StringIO()
    meter = CellMeter(screen, clock=lambda: next(times))
    meter(report(1))
    assert screen.getvalue() == ""
    meter(report(2))
    meter(report(3))
    meter(CaseProgress("a", 1, 2, 3.0))
    longest = len(describe(report(2)))
    assert (
        screen.getvalue() == f"\r{describe(report(2))}\r{describe(CaseProgress('a', 1, 2, 3.0)):<{longest}}"
    )
    meter.close()
    assert screen.getvalue().split("\r")[-2:] == [" " * len(describe(CaseProgress("a", 1, 2, 3.0))), ""]


def test_a_notice_in_a_notebook_leaves_nothing_of_the_line_before():
    screen = io.StringIO()
    meter = CellMeter(screen, first_s=0.0, clock=lambda: 1.0)
    meter(CaseProgress("a long name", 1, 2, 100.0))
    shown = screen.getvalue()
    meter(Notice("hi"))
    assert screen.getvalue()[len(shown) :] == f"\r{'hi':<{len(shown) - 1}}\n"
