"""What the kernels use of numba beyond its documented interface: what a new version breaks is named here."""

import tomllib
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]


def _first_of_rows(rows):
    total = 0.0
    for row in rows:
        total += row[0]
    return total


def _code(function, *arguments, **options):
    """LLVM's text of a function compiled with ``options`` for some arguments."""
    compiled = numba.njit(**options)(function)
    compiled(*arguments)
    return compiled.inspect_llvm(compiled.signatures[0])


def _counts():
    from fem_impact.fem.kernels import COUNTLESS

    assert "NRT_" in _code(_first_of_rows, np.ones((3, 3)))
    assert "NRT_" not in _code(_first_of_rows, np.ones((3, 3)), **COUNTLESS)


def _inlining():
    from fem_impact.fem.kernels import inlined

    # so long that no compiler chooses to inline it, on whatever processor
    steps = "".join(f"    x = x / (x * x + {n}.5)\n" for n in range(300))
    made = dict[str, Any]()
    exec(f"def absorbed(x):\n{steps}    return x\n", made)
    absorbed = made["absorbed"]

    def called(helper):
        code = _code(lambda x: helper(x) * helper(x + 1.0) * helper(x + 2.0), 1.0)
        return any("call" in line and "absorbed" in line for line in code.splitlines())

    assert called(numba.njit(absorbed)) and not called(inlined(absorbed))
    assert inlined(absorbed)(1.0) == absorbed(1.0)


def _events():
    from fem_impact.fem.kernels import COMPILING

    before = COMPILING.wall, COMPILING.cpu
    numba.njit(lambda x: x - 1.0)(1.0)
    assert COMPILING.wall > before[0] and COMPILING.cpu > before[1]


def _vectors():
    from fem_impact.fem.kernels import kernel
    from fem_impact.fem.vectors import load, spread, store

    out = np.zeros((2, 4))
    kernel(lambda a: store(a, 4, spread(2.0)))(out)
    assert (out == [[0.0] * 4, [2.0] * 4]).all()
    kernel(lambda a: store(a, 0, load(a, 2)))(out)
    assert (out[0] == [0.0, 0.0, 2.0, 2.0]).all()


def _settings():
    from fem_impact.fem.kernels import SETTINGS

    assert {"CACHE_DIR", "CPU_FEATURES"} <= set(dir(SETTINGS))


def _cached_names():
    from fem_impact.fem.kernels import compiled_before
    from fem_impact.solid.march import drift

    drift(np.zeros(3), 1.0, np.zeros(3))
    assert compiled_before("march.drift") and not compiled_before("march.nothing")


LONG = "helpers that every caller absorbs (the option forceinline)"
PARTS = {
    "kernels without counts of references (the option _nrt)": _counts,
    LONG: _inlining,
    "the time that compiling takes (numba.core.event)": _events,
    "vectors of four numbers (data models and addresses of arrays in numba.extending)": _vectors,
    "the settings of the compiler (numba.config)": _settings,
    "the names of kernels that are kept on disk (*.nbi)": _cached_names,
}


@pytest.mark.parametrize(
    "part", [pytest.param(part, marks=pytest.mark.long) if part == LONG else part for part in PARTS]
)
def test_numba_has_what_the_kernels_use(part):
    try:
        PARTS[part]()
    except Exception as error:
        pytest.fail(f"numba {numba.__version__} changed {part}: {error!r}", pytrace=False)


def test_kernels_of_other_sources_have_another_folder_where_a_user_states_it_too(monkeypatch, tmp_path):
    from fem_impact.fem import kernels

    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "stated"))
    copy = tmp_path / "package" / "fem" / "kernels.py"
    copy.parent.mkdir(parents=True)
    monkeypatch.setattr(kernels, "__file__", str(copy))
    folders = []
    for source in ("import numba", "import numba  # changed"):
        copy.write_text(source, encoding="utf-8")
        folders.append(kernels._cache_folder())
    assert folders[0] != folders[1] and {one.parent for one in folders} == {tmp_path / "stated"}


def test_the_locked_and_the_present_numba_are_in_the_tested_range():
    listed = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]
    asked = {one.name: one.specifier for one in map(Requirement, listed)}
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()
    locked = dict(line.split()[0].split("==") for line in lock if "==" in line)
    assert {one.operator for one in asked["numba"]} == {">=", "<"}
    assert numba.__version__ in asked["numba"]
    assert all(locked[name] in asked[name] for name in ("numba", "llvmlite"))
