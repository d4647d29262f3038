"""How kernels are compiled is a matter of speed alone."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numba.core import event

from fem_impact.fem import kernels
from fem_impact.solid.watchers import Stopwatch

TURNED = """
import numpy as np
from fem_impact.solid.frame import TurningFrame
from fem_impact.fem import kernels
from fem_impact.fem.kernels import SETTINGS
x, y, mass = np.random.default_rng(1).normal(size=(3, 300))
frame, d = TurningFrame.at(x, abs(mass), np.arange(300).reshape(-1, 3)), np.zeros(300)
frame.localise(y, d)
print(SETTINGS.CPU_FEATURES, d.tobytes().hex(), sep="\\n")
"""


def _turned(**asked):
    others = {name: value for name, value in os.environ.items() if name != "NUMBA_CPU_FEATURES"}
    words = [sys.executable, "-c", TURNED]
    done = subprocess.run(words, env=others | asked, capture_output=True, text=True, check=True)
    return done.stdout.split()


@pytest.mark.long
def test_the_width_of_registers_does_not_change_a_bit():
    features, d = _turned(NUMBA_CPU_FEATURES="+prefer-128-bit")
    assert features == "+prefer-128-bit"  # the environment comes first
    assert _turned()[1] == d


def test_compiling_is_taken_from_each_clock_by_itself():
    """A compilation that waits for others takes wall time, and hardly any of the processor's."""
    clock = Stopwatch()
    with event.trigger_event("numba:compile"), event.trigger_event("numba:compile"):
        time.sleep(0.1)
    wall, cpu = clock.read()
    assert 0.0 <= cpu < 0.05 and 0.0 <= wall < 0.05


@pytest.mark.parametrize("helper", ["plastic_return.py", "patch.py", "hexmodes.py", "groove.py"])
def test_a_changed_helper_of_any_room_has_its_own_cache(helper, monkeypatch):
    """A kernel that inlines a helper of another file is compiled anew when that file changes."""
    before, read = kernels._cache_folder(), Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: read(path) + b"#" * (path.name == helper))
    assert kernels._cache_folder() != before
