"""The latest time of a run: stated, or as rod and contact ask for."""

import pytest

from fem_impact.case.case import Case
from fem_impact.modal.impact import solve
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS, to_dict

TUNGSTEN = {
    "projectile.length": "1.2 m",
    "projectile.material.E": "400 GPa",
    "projectile.material.rho": "19250 kg/m3",
}


@pytest.mark.parametrize("name", MEASURED_SETS)
def test_the_measured_sets_run_for_2_5_ms_at_most(name):
    assert Case.of(load(name)).max_time == 2.5e-3


@pytest.mark.slow
def test_a_long_heavy_rod_is_followed_to_its_end():
    """It touches for several milliseconds: at 2.5 ms it was cut off."""
    planned = Case.of(replace_all(load("t3-machined"), TUNGSTEN), "modal")
    result = solve(planned)
    assert result.contacts[-1, 1] > 2.5e-3
    assert result.contacts[-1, 1] < planned.max_time
    assert result.finished


def test_a_slow_rod_is_given_the_time_of_its_contact():
    slow = {"projectile.diameter": "60 mm", "impact.v_n": "-1e-5 m/s", "impact.v_t": "0 m/s"}
    planned = Case.of(replace_all(load("t5b"), {**slow, "projectile.length": "0.5 m"}), "modal")
    result = solve(planned)
    assert result.contacts[-1, 1] > 2.5e-3
    assert result.finished


def test_a_stated_time_stays_and_an_unstated_one_is_not_written():
    scene = load("t5b")
    stated = replace_all(scene, {"accuracy.max_time": "1 ms"})
    assert Case.of(stated).max_time == 1e-3
    assert to_dict(stated)["accuracy"]["max_time"] == "1 ms"
    assert "max_time" not in to_dict(scene)["accuracy"]
    assert read_dict(to_dict(scene), "test") == scene
