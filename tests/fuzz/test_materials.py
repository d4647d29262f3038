"""Random and spoiled tables of materials: computed by the rules, or refused with a remedy that mends it.

As in `test_fuzz`, ``FUZZ_SEED`` gives the seed and ``pytest -m slow`` takes some thousands.
"""

import os
from collections import Counter

import pytest
from census import run
from random_materials import random_tree
from remedies import followed, kind

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.options import FIDELITIES
from fem_impact.scene.read import read_dict

SEED = int(os.environ.get("FUZZ_SEED", "1"))
PARTS = [range(60), *(pytest.param(range(a, a + 500), marks=pytest.mark.slow) for a in range(60, 3060, 500))]
FEW = [range(25), *(pytest.param(range(a, a + 200), marks=pytest.mark.slow) for a in range(25, 1025, 200))]
TRIED = Counter()


def refusal(tree, fidelity):
    """Return the refusal of a scene file before any work, None if it is taken."""
    try:
        told = Case.of(read_dict(tree), fidelity).limitations
    except SceneError as refused:
        return refused
    assert all(one.text for one in told)
    return None


@pytest.mark.parametrize("numbers", PARTS)
def test_rigid(numbers, cases):
    """Whatever a file says of materials is refused before the run, or its outcome keeps the rules."""
    for number in numbers:
        tree = random_tree(SEED, number)
        if refusal(tree, "rigid") is None:
            cases.append(run(read_dict(tree), "rigid"))
            assert not cases[-1].faults, (number, cases[-1].faults)
            assert cases[-1].end != "refused", (number, cases[-1].reason)


@pytest.mark.parametrize("numbers", FEW)
def test_a_remedy_mends_what_was_refused(numbers):
    """What a refusal says to write is written; the file is taken then, or something else is refused."""
    for number in numbers:
        tree = random_tree(SEED, number)
        for fidelity in FIDELITIES:
            refused = refusal(tree, fidelity)
            for did, new, with_fidelity in followed(tree, fidelity, refused) if refused else ():
                after = refusal(new, with_fidelity)
                assert after is None or kind(after) != kind(refused), (number, fidelity, did, str(refused))
                TRIED["taken" if after is None else "another refusal"] += 1
    assert TRIED["taken"]
    print(dict(TRIED))
