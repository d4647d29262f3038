"""Oblique drops of an elastic rod beside modes, Hertz and friction."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.verify.catalogue import verify


def checks(found):
    return {c.name: c for c in found.checks}


def test_a_coarse_tip_on_a_rigid_plane():
    found = verify("oblique-rod", {"elastic_barrier": 0, "tip_size": "0.8 mm", "across": 6})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    assert 0.10 < values["bending energy / E_0"] < 0.13
    assert values["impulse ratio mu"] == pytest.approx(0.34, abs=1e-3)


@pytest.mark.validation
@pytest.mark.parametrize(("f", "e"), [(0.0, 0.853), (0.34, 0.396), (0.55, 0.733)])
def test_the_long_rod_on_an_elastic_block(f, e):
    """Printed are the numbers of the sharp corner, whose arm of friction the rounded edge has not."""
    found = verify("oblique-rod", {"f": f})
    assert found.passed
    shown = checks(found)["restitution e, sharp corner"]
    assert shown.reference == pytest.approx(e, abs=5e-3)


SHORT = {"length": "80 mm", "v_n": 2.97, "v_t": 2.97}


@pytest.mark.validation
@pytest.mark.parametrize(
    ("f", "e", "bending"), [(0.0, 0.975, 0.014), (0.34, 1.001, 0.0001), (0.55, 1.009, 0.0065)]
)
def test_the_short_rod_on_an_elastic_block(f, e, bending):
    found = verify("oblique-rod", SHORT | {"f": f})
    assert found.passed
    values = {c.name: c.computed for c in found.checks}
    assert values["restitution e"] == pytest.approx(e, abs=0.04)
    assert values["bending energy / E_0"] == pytest.approx(bending, rel=0.25, abs=1e-3)


@pytest.mark.validation
def test_the_short_rod_comes_nearer_with_smaller_cells():
    """It ends 5 % beside the reference, whose contact is that of half-spaces; coarse cells hardly bend it."""
    errors = [
        checks(verify("oblique-rod", SHORT | {"f": 0.0, "tip_size": h}))["bending energy / E_0"].error
        for h in (1.2e-3, 6e-4, 3e-4)
    ]
    assert abs(errors[0]) > 10 * max(abs(error) for error in errors[1:])


@pytest.mark.validation
@pytest.mark.parametrize(
    "changes",
    [
        {"length": "120 mm", "f": 0.0, "angle": "30 deg"},
        {"length": "80 mm", "f": 0.2, "angle": "20 deg"},
    ],
)
def test_other_lengths_and_angles(changes):
    assert verify("oblique-rod", changes).passed


@pytest.mark.validation
def test_a_release_of_a_moment_may_be_missed():
    """The reference lets go for 12 us after 159; with a sharp corner, and in the solver, it does not."""
    found = checks(verify("oblique-rod", {"f": 0.1, "angle": "60 deg"}))
    assert found.pop("contacts").computed in (2, 3)
    assert all(check.passed for check in found.values())


@pytest.mark.validation
def test_a_graze_between_two_contacts_with_a_rigid_plane():
    """Cells of 0.6 mm miss the graze, 2 % of the impulse, that modes and small cells have: e .86, not .83."""
    found = verify("oblique-rod", {"f": 0.0, "elastic_barrier": 0})
    assert found.passed
    assert checks(found)["contacts"].computed == 3


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"length": "25 mm"}, "2.5 to 100 times the diameter"),
        ({"max_time": 2e-5, "f": 0.0, "elastic_barrier": 0, "tip_size": "1 mm"}, "ends in mid contact"),
    ],
)
def test_what_the_reference_is_not_for_is_refused(changes, words):
    with pytest.raises(SceneError, match=words):
        verify("oblique-rod", changes)
