"""Measure the memory of the modes of users' meshes beside what is planned for their runs.

Each half box of cells of 1 mm is meshed, assembled and solved in a process of its own, whose largest resident
memory (VmHWM, Linux) is printed: ``python tests/benchmarks/own_mesh_memory.py``, some minutes in all.
"""

import multiprocessing
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from own_bodies import box, write

BOXES = ((24, 12, 24), (32, 16, 32), (40, 20, 40), (16, 8, 64), (20, 10, 100), (12, 6, 60))


def half_box(folder, nx, ny, nz):
    """Return a scene whose projectile is a half box of cells of 1 mm."""
    from fem_impact.scene.read import read_dict

    points, cells = box(nx, ny, nz, (-0.5e-3 * nx, 0.0, 0.0), (0.5e-3 * nx, 1e-3 * ny, 1e-3 * nz))
    path = write(Path(folder) / f"{nx}-{ny}-{nz}.vtu", points, cells)
    return read_dict(
        {
            "id": "box",
            "projectile": {"mesh": str(path), "material": "rod-steel"},
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": "5 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
            "effects": ["vibration", "friction", "barrier-rigid"],
            "accuracy": {"tip_size": "2 mm", "unresolved": "report"},
        }
    )


def measure(folder, sizes):
    """Print the memory of one box, measured and planned, MB."""
    from fem_impact.case.case import Case
    from fem_impact.fem.body import MeshedBodies

    planned = Case.of(half_box(folder, *sizes))
    MeshedBodies(planned).rod_modes()
    status = Path("/proc/self/status").read_text()
    peak = float(status.partition("VmHWM:")[2].split()[0]) * 1024
    print(f"{sizes}: {peak / 1e6:.0f} MB, planned {planned.size.memory / 1e6:.0f} MB", flush=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        for one in BOXES:
            alone = multiprocessing.get_context("spawn").Process(target=measure, args=(place, one))
            alone.start()
            alone.join()
