"""Whole scene files with values changed or spoilt: refused with a remedy that works, or computed.

As in `test_fuzz`, ``FUZZ_SEED`` gives the seed; ``pytest -m slow`` tries 20 000.
"""

import os

import pytest
from census import run
from random_trees import spoilt_tree
from remedies import followed, kind

from fem_impact.answers.simulate import compiled
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.scene.read import read_dict

SEED = int(os.environ.get("FUZZ_SEED", "1"))
FIRST, END, PART = 300, 20_000, 2000
PARTS = [
    range(FIRST),
    *(pytest.param(range(a, min(a + PART, END)), marks=pytest.mark.slow) for a in range(FIRST, END, PART)),
]
OTHERS = 10  # of so many files one is checked for finite elements and the reduced model, too
TRIED_AT_LEAST = 0.9  # of the refusals name something that can be written


def refusal(tree, fidelity):
    """Return the refusal of a scene file before any work, None if it is taken."""
    try:
        scene = read_dict(tree)
        compiled(scene, fidelity) if fidelity == "solid" else Case.of(scene, fidelity)
    except SceneError as refused:
        return refused
    return None


@pytest.mark.long
@pytest.mark.parametrize("numbers", PARTS)
def test_each_remedy_works_and_what_is_taken_keeps_the_rules(numbers, cases):
    refused, tried = 0, 0
    for number in numbers:
        tree = spoilt_tree(SEED, number)
        for fidelity in ("rigid", "modal", "solid") if number % OTHERS == 0 else ("rigid",):
            why = refusal(tree, fidelity)
            if why is None:
                if fidelity == "rigid" and read_dict(tree).accuracy.target is None:
                    cases.append(run(read_dict(tree), "rigid"))
                    assert not cases[-1].faults, (number, cases[-1].faults)
                    assert cases[-1].end != "refused", (number, cases[-1].reason)
                continue
            remedies = list(followed(tree, fidelity, why))
            refused, tried = refused + 1, tried + bool(remedies)
            for did, new, with_fidelity in remedies:
                after = refusal(new, with_fidelity)
                assert after is None or kind(after) != kind(why), (number, fidelity, did, str(why))
    assert refused > 0.4 * len(numbers)
    assert tried > TRIED_AT_LEAST * refused
