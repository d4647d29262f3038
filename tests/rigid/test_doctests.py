import doctest
import importlib
import pkgutil

import pytest

import rigid

MODULES = [m.name for m in pkgutil.walk_packages(rigid.__path__, "rigid.")]


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples_hold(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0


def test_examples_are_found():
    finder = doctest.DocTestFinder()
    found = [t for name in MODULES for t in finder.find(importlib.import_module(name)) if t.examples]
    assert len(found) >= 10
