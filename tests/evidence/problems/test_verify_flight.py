"""Conservation laws through whole runs."""

import pytest

from fem_impact.errors import SceneError
from fem_impact.evidence.problems.problem import verify


def test_a_free_spin_costs_nothing():
    found = verify("free-spin", {"time": "0.4 ms", "length": "60 mm"})
    assert found.passed
    assert found.cost.steps >= 3000


def test_a_fast_spin_stretches_the_rod_as_a_slender_one():
    """It rings about its stretch: s^2 / 10 of the energy at rest, and at most four times that."""
    found = verify("free-spin", {"time": "0.4 ms", "length": "0.24 m", "omega": 200.0, "tip_size": "2 mm"})
    assert found.passed
    strain = found.checks[0]
    assert strain.computed == pytest.approx(strain.reference, rel=0.1)
    assert strain.reference > 1e-5


def test_a_rod_at_rest_and_one_without_slip():
    assert verify("free-spin", {"time": "0.1 ms", "length": "60 mm", "omega": 0.0}).passed
    assert verify("momentum", {"length": "50 mm", "v_t": 0.0, "omega": 0.0}).passed


@pytest.mark.parametrize(
    ("problem", "change", "words"),
    [
        ("free-spin", {"omega": 1000.0, "length": "0.5 m"}, "stretches the rod"),
        ("momentum", {"omega": 100.0, "v_n": 1.0}, "must close in"),
        ("momentum", {"v_n": 30.0}, "must close in"),
        ("bar", {"speed": 500.0}, "small strains"),
    ],
)
def test_motions_that_a_law_does_not_cover_are_refused(problem, change, words):
    with pytest.raises(SceneError, match=words):
        verify(problem, change)


def test_momentum_of_a_spinning_rod():
    found = verify("momentum", {"length": "50 mm"})
    assert found.passed
    gained = {c.name: c.computed for c in found.checks}
    assert gained["normal momentum gained"] > 0.05
    assert abs(gained["angular momentum gained"]) > 1e-6


@pytest.mark.validation
@pytest.mark.parametrize("changes", [{}, {"angle": "30 deg", "omega": -60.0, "v_n": 3.0, "length": "0.12 m"}])
def test_momentum_at_other_angles_and_spins(changes):
    assert verify("momentum", changes).passed
