"""The time that a run still needs follows the contact, not the latest time at which it may end."""

from types import SimpleNamespace

import numpy as np
import pytest

from fem_impact.solid import observers
from fem_impact.solid.observers import QUIET, ProgressObserver


@pytest.fixture
def told(monkeypatch):
    """Report at a time of the run and of the clock; return what was shown."""
    shown, clock = [], SimpleNamespace(monotonic=lambda: clock.now, now=0.0)
    monkeypatch.setattr(observers, "clock", clock)
    book = SimpleNamespace(step=np.zeros(9), intervals=[], touching=True, last_touch=0.0)
    watch = SimpleNamespace(drift=0.0)
    observer = ProgressObserver(shown.append, watch, SimpleNamespace(book=book), 200e-6, "")

    def at(time, now, **contact):
        vars(book).update(contact)
        clock.now = now
        observer.observe(SimpleNamespace(time=time, step=1))
        return shown[-1]

    at(0.0, 0.0)
    return at


def test_it_is_that_to_the_expected_end_of_the_contact(told):
    assert told(1e-6, 1.0).eta_s is None
    assert told(50e-6, 10.0).eta_s == pytest.approx(30.0)
    assert told(50e-6, 10.0).end_time_s == 200e-6


def test_a_contact_longer_than_expected_has_no_remaining_time(told):
    late = told(250e-6, 50.0)
    assert late.eta_s is None and late.end_time_s == 250e-6


def test_after_a_contact_the_run_ends_soon(told):
    apart = told(100e-6, 20.0, intervals=[1], touching=False, last_touch=95e-6)
    assert apart.end_time_s == pytest.approx(95e-6 + QUIET)
    assert apart.eta_s == pytest.approx(20.0 * (QUIET - 5e-6) / 100e-6)
