"""A second thread is a matter of speed alone."""

import threading

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.solid import helper
from fem_impact.solid.helper import Helper
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.signals import make_signals, wait_for
from fem_impact.solid.sparse import Hanging

YIELD = ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "large-rotation", "gravity")


def _made():
    model = scenes.model(*YIELD, length=0.08, v_n=-4.0, v_t=-4.0)
    return model, model.initial_state()


def _march(model, state, steps, second=None):
    """March to where observers look: the forces are known, and nothing of the next step is begun."""
    for _ in range(steps - 1):
        evaluate(model, state, second)
        advance(model, state, second)
    evaluate(model, state, second)


def _alike(one, two):
    return [name for name in ("x", "v", "force") if np.array_equal(getattr(one, name), getattr(two, name))]


def test_threads_do_not_change_a_bit():
    (alone, one), (shared, two) = _made(), _made()
    _march(alone, one, 300)
    with Helper(shared, two) as second:
        _march(shared, two, 300, second)
    assert alone.book.touching and all(zone.plastic_strain().max() > 0 for zone in alone.zones)
    assert _alike(one, two) == ["x", "v", "force"]
    assert alone.ledger().sample(one) == shared.ledger().sample(two)
    barrier = shared.zones[-1]
    assert barrier.room.any(axis=1).all(), "each thread has advanced blocks"


def test_whoever_takes_the_blocks_finds_the_same():
    """The second thread finds all that is handed over, before the first begins."""
    (alone, one), (shared, two) = _made(), _made()
    _march(alone, one, 20)
    with Helper(shared, two) as second:
        _march(shared, two, 19, second)
        advance(shared, two, second)
        second.find(two)
        second.finish()
        assert all(zone.taken[0] >= len(zone.blocks.dof) for zone in shared.zones)
        evaluate(shared, two, second)
    assert _alike(one, two) == ["x", "v", "force"]


def test_the_first_thread_waits_for_what_the_second_moves(monkeypatch):
    """To follow the ties takes the second thread longer than the first needs for contact and rod."""
    again = 2000
    (alone, one), (shared, two) = _made(), _made()
    _march(alone, one, 20)
    monkeypatch.setattr(Hanging, "expansion", _expand_again(again))
    with Helper(shared, two) as second:
        monkeypatch.undo()
        _march(shared, two, 20, second)
    assert _alike(one, two) == ["x", "v", "force"]


def _expand_again(times):
    expansion = Hanging.expansion

    def slow(self, x):
        entries = np.diff(self.start)
        start = np.concatenate([[0], np.cumsum(np.tile(entries, times))])
        many = np.tile(self.slaves, (times, 1)), start, np.tile(self.masters, (times, 1))
        return expansion(Hanging(*many, np.tile(self.weights, times)), x)

    return slow


def test_an_error_of_the_second_thread_comes_out_of_the_first(monkeypatch):
    monkeypatch.setattr(helper, "serve", lambda *arguments: 1 / 0)
    with pytest.raises(ZeroDivisionError), Helper(*_made()):
        pass


def test_the_second_thread_ends_with_its_context():
    before = threading.active_count()
    with pytest.raises(ZeroDivisionError), Helper(*_made()):
        assert threading.active_count() == before + 1
        raise ZeroDivisionError
    assert threading.active_count() == before


def test_waiting_ends():
    signal = make_signals(1)[0]
    assert wait_for(signal, 0)
    assert not wait_for(signal, 1)
