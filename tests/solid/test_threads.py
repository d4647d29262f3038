"""A second thread is a matter of speed alone."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import solid_scenes as scenes

from fem_impact.solid.march import advance, evaluate

YIELD = ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "large-rotation", "gravity")


def _after(steps, helper):
    model = scenes.model(*YIELD, length=0.08, v_n=-4.0, v_t=-4.0)
    state = model.initial_state()
    for _ in range(steps):
        evaluate(model, state, helper)
        advance(model, state)
    return model, state


def test_threads_do_not_change_a_bit():
    alone, one = _after(300, None)
    with ThreadPoolExecutor(1) as helper:
        shared, two = _after(300, helper)
    assert len(alone.parts) > len(alone.forces) and alone.book.touching
    assert all(zone.plastic_strain().max() > 0 for zone in alone.zones)
    for name in ("x", "v", "force"):
        assert np.array_equal(getattr(one, name), getattr(two, name)), name
    assert alone.ledger().sample(one) == shared.ledger().sample(two)
