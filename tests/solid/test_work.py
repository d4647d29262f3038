"""A step is split so that all of it is done once, and nothing before what it needs."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import solid_scenes as scenes
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fem_impact.solid.work import runs, split, touched

BOTH = ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "radiation", "gravity")


def _mask(found, size):
    mask = np.zeros(size, dtype=int)
    for first, last in found:
        mask[first:last] += 1
    return mask


@given(arrays(bool, st.integers(0, 30)))
def test_runs_are_the_true_ones(mask):
    assert (_mask(runs(mask), len(mask)) == mask).all()
    assert (np.diff(runs(mask).ravel()) > 0).all()


def test_all_is_done_once():
    model = scenes.model(*BOTH, length=0.08)
    works, size = split(model), len(model.mass)
    for name in ("cleared", "kicked", "drifted"):
        assert (sum(_mask(getattr(work, name), size) for work in works) == 1).all(), name
    for name in ("gathered", "expanded"):
        slaves = np.concatenate([getattr(work, name).slaves for work in works])
        assert sorted(slaves[:, 0]) == sorted(model.hanging.slaves[:, 0]), name
    assert sorted(map(id, works[0].collects + works[1].collects)) == sorted(map(id, model.forces))
    for zone in model.zones:
        assert all(any(force is zone for force in work.finds) for work in works)


def test_what_the_contact_may_change_is_left_to_it():
    model = scenes.model(*BOTH, length=0.08)
    first, second = split(model)
    moved, (pots, contact), size = _mask(second.drifted, len(model.mass)), model.impulses, len(model.mass)
    assert moved.any() and moved[pots.places].all() and not moved[contact.places].any()
    assert not _mask(second.kicked, size)[pots.places].any()
    assert not moved[model.layout.rod].any() and not moved[first.expanded.slaves].any()


def test_a_hanging_node_waits_for_its_masters():
    model = scenes.model(*BOTH, length=0.08)
    ties, last = model.hanging, len(model.hanging.slaves) - 1
    masters = ties.masters[ties.start[last] :]
    struck = replace(model, impulses=[SimpleNamespace(places=masters[0])])
    assert touched(struck)[ties.slaves[last]].all() and not touched(model)[ties.slaves[last]].any()
    first, second = split(struck)
    assert (
        ties.slaves[last, 0] in first.expanded.slaves and ties.slaves[last, 0] not in second.expanded.slaves
    )
    assert _mask(first.kicked, len(model.mass))[masters].all()
