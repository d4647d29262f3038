"""Random scenes of every fidelity keep the rules of `invariants`, for any seed.

The environment variable ``FUZZ_SEED`` gives the seed, 1 without it. ``pytest -m slow tests/fuzz`` runs the
many scenes, ``-k "modal and part3"`` a part of them; a session without ``-m slow`` takes a few cheap ones. It
ends with the number of scenes that finished, were not resolved, refused or left out, by reason. Scenes of the
solid fidelity are computed on the tip size that the program advises, if by its estimate they take at most
``FUZZ_BUDGET`` seconds of computing, 300 without it; all of them then take some three hours.
"""

import os

import numpy as np
import pytest
from census import DEAR, FINISHED, REFUSED, run, run_solid
from random_projectiles import random_own
from random_scenes import one_of, random_rod, random_scene

from fem_impact.errors import SceneError

BUDGET = float(os.environ.get("FUZZ_BUDGET", "300"))
SEED = int(os.environ.get("FUZZ_SEED", "1"))
RODS = 4  # of which a part of the modal scenes takes one: modes take seconds, an impact takes milliseconds


def parts(first, end, size):
    """Return ranges of scenes' numbers, the parameters of a slow test."""
    starts = range(first, end, size)
    ranges = [range(start, min(start + size, end)) for start in starts]
    return [pytest.param(one, marks=pytest.mark.slow, id=f"part{i}") for i, one in enumerate(ranges)]


def check_rules(cases, new):
    """Keep cases for the report, and refuse those that break a rule."""
    cases.extend(new)
    broken = [f"{case.scene.id}: {fault}" for case in new for fault in case.faults]
    assert not broken, "\n".join(broken)


@pytest.mark.parametrize("numbers", [range(150), *parts(150, 1200, 350)])
def test_rigid(numbers, cases):
    check_rules(cases, [run(random_scene(SEED, number), "rigid") for number in numbers])


def test_modal_of_stout_rods(cases):
    """Their modes take a second."""
    random = np.random.default_rng(SEED)
    rods = [rod for rod in (random_rod(random) for _ in range(60)) if rod.length < 2 * rod.diameter][:3]
    check_rules(cases, [run(random_scene(SEED, number, one_of(rods)), "modal") for number in range(40)])


@pytest.mark.parametrize("numbers", parts(40, 600, 56))
def test_modal(numbers, cases):
    random = np.random.default_rng([SEED, numbers.start])
    choice = one_of([random_rod(random) for _ in range(RODS)])
    check_rules(cases, [run(random_scene(SEED, number, choice), "modal") for number in numbers])


@pytest.mark.long
def test_solid_of_cheap_scenes(cases):
    """The first two that take less than a second and a half of computing with three cells over the radius."""
    cheap = []
    for number in range(300):
        scene = random_scene(SEED, number)
        if scene.projectile.length < 5 * scene.projectile.diameter and len(cheap) < 2:
            case = run_solid(scene, 1.5, cells=3.0)
            cheap += [case] if case.end not in (DEAR, REFUSED) else []
    check_rules(cases, cheap)
    assert cheap


@pytest.mark.parametrize("numbers", parts(0, 200, 20))
def test_solid(numbers, cases):
    check_rules(cases, [run_solid(random_scene(SEED, number), BUDGET) for number in numbers])


def own(numbers):
    """Random projectiles and barriers as scene files state them; a bore that leaves no wall is no body."""
    for number in numbers:
        try:
            yield random_own(SEED, number)
        except SceneError as refusal:
            assert "no body" in str(refusal) or "is not a shape" in str(refusal)


@pytest.mark.parametrize("numbers", [range(20), *parts(20, 320, 100)])
def test_rigid_of_own_projectiles(numbers, cases):
    check_rules(cases, [run(scene, "rigid") for scene in own(numbers)])


@pytest.mark.parametrize("numbers", parts(0, 100, 20))
def test_modal_of_own_projectiles(numbers, cases):
    check_rules(cases, [run(scene, "modal") for scene in own(numbers)])


@pytest.mark.parametrize("numbers", parts(0, 200, 20))
def test_solid_of_own_projectiles(numbers, cases):
    check_rules(cases, [run_solid(scene, BUDGET) for scene in own(numbers)])


@pytest.mark.slow
def test_most_slender_scenes_finish_resolved(cases):
    """Of all in this session that are an impact of the tip: refusing for its size is no way to pass."""
    slender = [case for case in cases if case.fidelity == "solid" and case.slender and not case.no_impact]
    if len(slender) < 60:
        pytest.skip("needs the solid scenes of this session")
    done = [case for case in slender if case.end == FINISHED]
    assert len(done) >= 2 / 3 * len(slender)
