"""The time that a run still needs follows the impulse of the contact, not the latest time of its end."""

from types import SimpleNamespace

import numpy as np
import pytest

from fem_impact.solid import observers
from fem_impact.solid.contact.book import StepRecord
from fem_impact.solid.observers import QUIET, REBOUND, ProgressObserver

EXPECTED, STOPPING = 200e-6, 0.1  # s, N s


@pytest.fixture
def told(monkeypatch):
    """Report at a time of the run and of the clock; return what was shown. Kernels load until 10 s."""
    shown, clock = [], SimpleNamespace(monotonic=lambda: clock.now, now=0.0)
    monkeypatch.setattr(observers, "clock", clock)
    book = SimpleNamespace(
        step=StepRecord(), intervals=[], touching=True, last_touch=0.0, impulse=np.zeros(3)
    )
    watch = SimpleNamespace(drift=0.0)
    observer = ProgressObserver(shown.append, watch, SimpleNamespace(book=book), EXPECTED, STOPPING, "")

    def at(time, now, share=0.0, **contact):
        """``share`` of the impulse that is expected; the book counts that of half the rod."""
        vars(book).update(contact, impulse=np.array([0.0, 0.5 * share * REBOUND * STOPPING, 0.0]))
        clock.now = now
        observer.observe(SimpleNamespace(time=time, step=1))
        return shown[-1]

    at(0.0, 0.0)
    assert at(1e-6, 10.0).eta_s is None
    return at


def test_it_is_that_to_the_expected_end_while_the_impulse_is_small(told):
    early = told(51e-6, 20.0)
    assert early.eta_s == pytest.approx(10.0 * 149 / 50)
    assert early.end_time_s == EXPECTED


def test_loading_the_kernels_does_not_count_for_the_pace(told):
    assert told(2e-6, 11.0).eta_s == pytest.approx(198.0)


def test_half_the_impulse_is_half_the_contact(told):
    """A half sine wave has given half of its impulse in half of its time."""
    half = told(60e-6, 20.0, share=0.5)
    assert half.end_time_s == pytest.approx(0.5 * EXPECTED + 0.5 * (120e-6 + QUIET))


def test_a_whole_impulse_is_the_end_however_early(told):
    assert told(90e-6, 20.0, share=1.2).end_time_s == pytest.approx(90e-6 + QUIET)


def test_a_contact_longer_than_expected_has_no_remaining_time(told):
    late = told(250e-6, 50.0)
    assert late.eta_s is None and late.end_time_s == 250e-6


def test_after_a_contact_the_run_ends_soon(told):
    apart = told(101e-6, 30.0, intervals=[1], touching=False, last_touch=96e-6)
    assert apart.end_time_s == pytest.approx(96e-6 + QUIET)
    assert apart.eta_s == pytest.approx(20.0 * (QUIET - 5e-6) / 100e-6)
