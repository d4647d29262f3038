"""A second thread is a matter of speed alone."""

import threading

import numpy as np
import pytest
import solid_scenes as scenes
from numba.core.errors import TypingError

from fem_impact.solid.helper import FIND, Helper
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.signals import make_signals, wait_for_change

YIELD = ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "large-rotation", "gravity")


def _made():
    model = scenes.model(*YIELD, length=0.08, v_n=-4.0, v_t=-4.0, rod_yield=250e6)
    return model, model.initial_state()


def _march(model, state, steps, helper=None):
    for _ in range(steps):
        evaluate(model, state, helper)
        advance(model, state)


def _alike(one, two):
    return [name for name in ("x", "v", "force") if np.array_equal(getattr(one, name), getattr(two, name))]


def test_threads_do_not_change_a_bit():
    (alone, one), (shared, two) = _made(), _made()
    _march(alone, one, 300)
    with Helper(shared, two) as helper:
        _march(shared, two, 300, helper)
    assert alone.book.touching and all(zone.plastic_strain().max() > 0 for zone in alone.zones)
    assert _alike(one, two) == ["x", "v", "force"]
    assert alone.ledger().sample(one) == shared.ledger().sample(two)
    barrier = shared.zones[-1]
    assert barrier.room.any(axis=1).all(), "each thread has advanced blocks"


def test_whoever_takes_the_blocks_finds_the_same():
    """The second thread finds all that is handed over, before the first begins."""
    (alone, one), (shared, two) = _made(), _made()
    _march(alone, one, 20)
    with Helper(shared, two) as helper:
        _march(shared, two, 19)
        helper.begin(FIND, two.dt)
        helper.finish()
        assert all(zone.taken[0] > len(zone.blocks.dof) for zone in shared.zones)
        _march(shared, two, 1)
    assert _alike(one, two) == ["x", "v", "force"]


def test_an_error_of_the_second_thread_comes_out_of_the_first():
    model, state = _made()
    state.v = "no velocities"
    with pytest.raises(TypingError), Helper(model, state):
        pass


def test_the_second_thread_ends_with_its_context():
    before = threading.active_count()
    with pytest.raises(ZeroDivisionError), Helper(*_made()):
        assert threading.active_count() == before + 1
        raise ZeroDivisionError
    assert threading.active_count() == before


def test_waiting_ends():
    signal = make_signals(1)[0]
    assert wait_for_change(signal, 1)
    assert not wait_for_change(signal, 0)
