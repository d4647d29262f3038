"""`import fem_impact` offers the names that users need, and loads what they stand for only when asked."""

import doctest
import subprocess
import sys

import pytest

import fem_impact


def test_all_names_of_the_menu_exist_and_are_listed():
    assert all(getattr(fem_impact, name) is not None for name in fem_impact.__all__)
    assert set(fem_impact.__all__) <= set(dir(fem_impact))
    assert set(fem_impact.__all__) == set(fem_impact._PLACES)


@pytest.mark.parametrize("names", ["load", "load, replace, Scene, RunOptions, Case"])
def test_the_menu_itself_loads_no_heavy_module(names):
    first = names.split(",")[0]
    code = f"import sys, fem_impact; before = 'numpy' in sys.modules; fem_impact.{first}; print(before)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
    exec(f"from fem_impact import {names}", {})


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        _ = fem_impact.simulat


def test_simulate_of_the_menu_takes_a_target_error_too():
    from fem_impact.answers.simulate import simulate

    assert fem_impact.simulate is simulate


def test_the_example_of_the_docstring():
    assert doctest.testmod(fem_impact).failed == 0
