"""A second thread is a matter of speed alone."""

from threading import Barrier, current_thread

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.solid.helper import Helper, share
from fem_impact.solid.march import advance, evaluate

YIELD = ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "large-rotation", "gravity")


def _after(steps, helper):
    model = scenes.model(*YIELD, length=0.08, v_n=-4.0, v_t=-4.0, rod_yield=250e6)
    state = model.initial_state()
    for _ in range(steps):
        evaluate(model, state, helper)
        advance(model, state)
    return model, state


def test_threads_do_not_change_a_bit():
    alone, one = _after(300, None)
    with Helper() as helper:
        shared, two = _after(300, helper)
    assert len(alone.parts) > len(alone.forces) and alone.book.touching
    assert all(zone.plastic_strain().max() > 0 for zone in alone.zones)
    for name in ("x", "v", "force"):
        assert np.array_equal(getattr(one, name), getattr(two, name)), name
    assert alone.ledger().sample(one) == shared.ledger().sample(two)


def test_both_threads_take_parts_and_each_is_done_once():
    meet, done = Barrier(2), []

    def part(state):
        meet.wait(10)
        done.append(current_thread().name)

    with Helper() as helper:
        share([part] * 6, None, helper)
    assert len(done) == 6 and len(set(done)) == 2


def test_an_error_of_the_second_thread_comes_out_of_the_first():
    meet, here = Barrier(2), current_thread()

    def part(state):
        meet.wait(10)
        if current_thread() is not here:
            raise ZeroDivisionError

    with Helper() as helper:
        with pytest.raises(ZeroDivisionError):
            share([part, part], None, helper)
        share([lambda state: None], None, helper)  # and it works on
