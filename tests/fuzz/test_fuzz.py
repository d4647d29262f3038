"""Random scenes of every fidelity keep the rules of `invariants`, for any seed.

The environment variable ``FUZZ_SEED`` gives the seed, 1 without it. ``pytest -m slow tests/fuzz`` runs the
many scenes, ``-k "modal and part3"`` a part of them; a session without ``-m slow`` takes a few cheap ones. It
ends with the number of scenes that finished, were not resolved, refused or left out, by reason.
"""

import os

import numpy as np
import pytest
from census import run
from random_scenes import one_of, random_rod, random_scene

SEED = int(os.environ.get("FUZZ_SEED", "1"))
RODS = 4  # of which a part of the modal scenes takes one: modes take seconds, an impact takes milliseconds


def parts(first, end, size):
    """Return ranges of scenes' numbers, the parameters of a slow test."""
    starts = range(first, end, size)
    ranges = [range(start, min(start + size, end)) for start in starts]
    return [pytest.param(one, marks=pytest.mark.slow, id=f"part{i}") for i, one in enumerate(ranges)]


def held(cases, new):
    """Keep cases for the report, and refuse those that break a rule."""
    cases.extend(new)
    broken = [f"{case.scene.id}: {fault}" for case in new for fault in case.faults]
    assert not broken, "\n".join(broken)


@pytest.mark.parametrize("numbers", [range(150), *parts(150, 1200, 350)])
def test_rigid(numbers, cases):
    held(cases, [run(random_scene(SEED, number), "rigid") for number in numbers])


def test_modal_of_stout_rods(cases):
    """Their modes take a second."""
    random = np.random.default_rng(SEED)
    rods = [rod for rod in (random_rod(random) for _ in range(60)) if rod.length < 2 * rod.diameter][:3]
    held(cases, [run(random_scene(SEED, number, one_of(rods)), "modal") for number in range(40)])


@pytest.mark.parametrize("numbers", parts(40, 600, 56))
def test_modal(numbers, cases):
    random = np.random.default_rng([SEED, numbers.start])
    choice = one_of([random_rod(random) for _ in range(RODS)])
    held(cases, [run(random_scene(SEED, number, choice), "modal") for number in numbers])
