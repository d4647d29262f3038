"""Help and checks start fast because nothing heavy is imported for them."""

import subprocess
import sys

import pytest

HEAVY = ("numpy", "scipy", "numba", "skfem", "matplotlib", "pyvista", "vtkmodules", "meshio", "h5py", "PIL")
PROBE = """
import sys
from fem_impact.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit:
    pass
print(",".join(sorted(name for name in sys.modules if "." not in name)))
"""


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"], ["run", "no-such-scene"]])
def test_no_heavy_module_is_imported(words):
    done = subprocess.run([sys.executable, "-c", PROBE, *words], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split(","))
    assert "fem_impact" in loaded
    assert not loaded & set(HEAVY)


def test_help_imports_no_scene_either():
    probe = "import sys, fem_impact.cli.main; print('fem_impact.scene' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_the_module_runs_as_the_command():
    done = subprocess.run(
        [sys.executable, "-m", "fem_impact", "scenes"], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[0].split() == ["id", "speed", "title"]
