"""Help and checks start fast because nothing heavy is imported for them."""

import subprocess
import sys

import pytest

from fem_impact.cli.parser import COMMANDS

HEAVY = (
    "numpy",
    "scipy",
    "pandas",
    "numba",
    "skfem",
    "matplotlib",
    "pyvista",
    "vtkmodules",
    "meshio",
    "h5py",
    "PIL",
)
PROBE = """
import sys
from fem_impact.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit:
    pass
print(",".join(sorted(name for name in sys.modules if "." not in name)))
"""


HELPS = [[name, "--help"] for name in COMMANDS]


@pytest.mark.parametrize(
    "words",
    [
        ["--help"],
        *HELPS,
        ["study", "gamma", "--help"],
        *([name, "no-such-scene"] for name in ("run", "assess")),
    ],
)
def test_no_heavy_module_is_imported(words):
    done = subprocess.run([sys.executable, "-c", PROBE, *words], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split(","))
    assert "fem_impact" in loaded
    assert not loaded & set(HEAVY)


def test_the_list_of_commands_imports_no_command_and_no_scene():
    probe = (
        "import sys\nfrom fem_impact.cli.parser import COMMANDS, build_parser\nbuild_parser(['--help'])\n"
        "rooms = [f'fem_impact.cli.{name}' for name in COMMANDS]\n"
        "print([name for name in ['fem_impact.scene', *rooms] if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_module_runs_as_the_command():
    done = subprocess.run(
        [sys.executable, "-m", "fem_impact", "scenes"], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[0].split() == ["id", "speed", "title"]
