"""What the interval of friction changes, beside the numbers of a run."""

import outcome_maker
import pytest

from fem_impact.answers.friction_spread import friction_spread
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

FRICTION, E_R, E = (KEY_TABLE[name] for name in ("W_friction_over_E_0", "E_r_over_E_0", "e_edge"))


@pytest.fixture(scope="module")
def scene():
    interval = {
        "state": "custom",
        "friction": 0.3,
        "friction_low": 0.05,
        "friction_high": 0.6,
        "source": "assumed",
    }
    return replace_all(load("t5b"), {f"surface.{key}": value for key, value in interval.items()})


def test_changes_leave_a_share_within_0_and_1_and_are_those_of_known_numbers(scene):
    """Of 31.2 % of finite elements the change was told to take 33 by the reduced model."""
    modal = simulate(scene, "modal")
    low, high = friction_spread(scene, "modal", modal).changes[FRICTION]
    assert low < -0.05 and high == 0.0
    meshed = outcome_maker.altered(
        modal,
        W_friction_over_E_0=0.5 * -low,
        E_r_over_E_0=1.0,
        e_edge=None,
        reasons={**modal.to_dict()["reasons"], "e_edge": "not resolved"},
        fidelity="solid",
    )
    changes = friction_spread(scene, "solid", meshed).changes
    assert changes[FRICTION] == pytest.approx((0.5 * low, 0.0))
    assert changes[E_R][1] == 0.0 > changes[E_R][0]
    assert E not in changes
