"""Meters: a live line on a terminal, plain lines elsewhere, nothing when quiet."""

import io

import pytest

from fem_impact.progress import LineMeter, NullMeter, Progress, TerminalMeter, compiling, describe, meter_for


class Terminal(io.StringIO):
    def isatty(self):
        return True


def report(step, note=""):
    return Progress(step * 1e-7, 1e-3, step, -2e-7, "free flight", None, note)


def test_a_terminal_gets_a_live_line_and_a_log_gets_lines():
    assert isinstance(meter_for(Terminal()), TerminalMeter)
    assert isinstance(meter_for(io.StringIO()), LineMeter)


def test_the_live_line_is_rewritten_ten_times_a_second_and_left_standing():
    times = iter([0.0, 0.05, 0.2])
    stream = Terminal()
    meter = TerminalMeter(stream, clock=lambda: next(times), width=60)
    for step in (1, 2, 3):
        meter(report(step))
    meter.close()
    lines = stream.getvalue().split("\r")[1:]
    assert ["step 1 " in lines[0], "step 3 " in lines[1], len(lines)] == [True, True, 2]
    assert all(len(line.rstrip("\n")) == 60 for line in lines)
    assert stream.getvalue().endswith("\n")


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


@pytest.mark.parametrize(("eta", "words"), [(None, ""), (5.4, "ETA 5 s"), (125.0, "ETA 2 min 05 s")])
def test_the_time_still_needed_is_told_when_it_is_known(eta, words):
    line = describe(Progress(0.0, 1e-3, 1, 0.0, "free", eta))
    assert line.startswith(f"t 0/1000 us  {words}") and ("ETA" in line) == bool(words)


def test_a_terminal_of_80_columns_shows_the_time_still_needed_and_what_compiles():
    long = Progress(2.5e-3, 2.5e-3, 99999, -1e-9, "120 nodes touch", 3599.0, "t3-contaminated")
    assert "ETA 59 min 59 s" in describe(long)[:79]
    assert describe(compiling(2.5e-3, 20)) == "t 0/2500 us  compiling the kernels, once, about 20 s"


def test_quiet_is_quiet():
    meter = NullMeter()
    assert meter(report(1)) is None
    assert meter.close() is None
