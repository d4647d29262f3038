"""What is certain of strikes: in words, of mirror images, before barriers that move."""

from dataclasses import replace

import pytest

from fem_impact.case.case import Case
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.strikes import told
from fem_impact.run import certain
from fem_impact.run.certain import Doubt
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

ROD = {"impact.slope": "0 deg", "impact.v_t": "0 m/s", "impact.until": "4 strikes"}


def followed(**changes):
    return replace_all(load("quick"), ROD | {key.replace("__", "."): value for key, value in changes.items()})


def test_a_sequence_whose_first_strike_is_not_certain_is_told_without_certain_ones():
    upright = followed(impact__angle="0.5 deg", restitution=0.5, strikes__angle_error="1 deg")
    strikes = simulate(upright, "rigid").strikes
    assert strikes.certain == 0
    words = " ".join(told(strikes))
    assert "Not even the first strike is of the same part of the body in all of 64 sequences" in words
    assert "Hardest by energy: not certain; strike 1, tip at " in words
    assert "of the certain ones" not in words


def test_mirror_images_are_moved_alike_by_what_is_not_known_of_friction():
    """More friction comes with a larger impulse ratio of either sign."""
    runs = []
    for side in (1, -1):
        turned = {"impact__angle": f"{80 * side} deg", "impact__omega": f"{5 * side} rad/s"}
        scene = followed(**turned, impact__v_n="-2 m/s", impact__v_t=f"{-side} m/s")
        case = Case.of(scene, "rigid")
        each = certain._each(case, simulate(scene, "rigid").strikes.each)
        doubtful = [replace(one, doubt=Doubt(mu=0.1, friction=0.02)) for one in each]
        runs.append(certain._run(scene, doubtful, [Doubt(mu=1.0, friction=1.0)] * len(each)))
    for one, other in zip(*runs, strict=True):
        assert (one.part, one.mu, one.Omega) == (
            other.part,
            pytest.approx(-other.mu, rel=1e-9),
            pytest.approx(-other.Omega, rel=1e-9),
        )
        assert one.friction == pytest.approx(other.friction, rel=1e-9)


def test_the_error_of_speed_is_that_of_the_body_as_seen_from_a_barrier_that_moves():
    moving = {"impact__v_n": "0 m/s", "barrier__v_n": "2 m/s"}
    spreads = [
        simulate(followed(**speeds, restitution=0.5, strikes__speed_error=0.2), "rigid").strikes.spread[0]
        for speeds in ({"impact__v_n": "-2 m/s"}, moving)
    ]
    low, high = spreads[0].approach_low, spreads[0].approach_high
    assert low < 1.9 < 2.1 < high
    assert (spreads[1].approach_low, spreads[1].approach_high) == pytest.approx((low, high), rel=1e-9)


def test_nothing_is_certain_of_strikes_where_the_reduced_model_does_not_know_its_error():
    """On a thin weak layer the first impact has no half-widths: nor have the strikes that follow from it."""
    clad = {
        "barrier.layers": [{"thickness": "0.6 mm", "material": "aluminium-1350-h14"}],
        "barrier.material": "42crmo4",
        "impact.slope": "0 deg",
        "impact.until": "2 strikes",
    }
    outcome = simulate(replace_all(load("quick"), clad), "modal")
    assert isinstance(outcome.half_widths, Unknown)
    assert outcome.strikes.certain == outcome.half_widths
    assert outcome.strikes.half_width(1, "E_after_J") == outcome.half_widths
