"""The bar of ``fem-impact verify tilted-bar`` in CalculiX, on the project's own mesh (optional).

Debian's package calculix-ccx holds the program ``ccx``; nothing of this project needs it. Without ``ccx`` the
input deck alone is written.

    python tests/benchmarks/calculix_tilted_bar.py [CELLS] [FRICTION] [STIFFNESS] [STICK]

Its contacts are springs under nodes: with a STIFFNESS of 2.6e13 N/m3 the rebound on 4 cells is 1.38 m/s, and
with friction 0.2 it is 1.93 m/s at a tangential stiffness of STICK = 0.1 of that and 2.09 m/s at 1. So what
it prints is an answer for its springs.
"""

import shutil
import subprocess
import sys
from math import cos, sin
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from fem_impact.solid.elements import lumped_mass
from fem_impact.verify import verify
from fem_impact.verify.bodies import placed
from fem_impact.verify.square_bar import NU, RHO, E, square_bar
from fem_impact.verify.tilted_bar import ANGLE, SPEED

END = 3e-4  # s
PLATE = 0.1  # m, half-width and depth of the held cell under the bar
CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]


def numbered(rows, first=1):
    """Return lines of a number and its row."""
    return [", ".join([str(first + i), *(f"{value:.12g}" for value in row)]) for i, row in enumerate(rows)]


def deck(mesh, points, friction, stiffness, stick):
    """Return the input deck: the half bar, a held plate, contact of the lower end, explicit dynamics."""
    n, m = len(points), len(mesh.cells)
    plate = PLATE * np.array(CORNERS, float)
    end = np.flatnonzero(mesh.points[:, 2] == 0.0) + 1
    middle = np.flatnonzero(mesh.points[:, 1] == 0.0) + 1
    parts = [
        ["*NODE, NSET=BAR", *numbered(points)],
        ["*NODE, NSET=PLATE", *numbered(plate, n + 1)],
        ["*ELEMENT, TYPE=C3D8, ELSET=ALL", *numbered(mesh.cells + 1)],
        ["*ELEMENT, TYPE=C3D8, ELSET=HELD", *numbered([n + 1 + np.arange(8)], m + 1)],
        ["*NSET, NSET=END", *map(str, end), "*NSET, NSET=MIDDLE", *map(str, middle)],
        ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{E:g}, {NU}", "*DENSITY", f"{RHO:g}"],
        [f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL" for name in ("ALL", "HELD")],
        ["*BOUNDARY", "PLATE, 1, 3", "MIDDLE, 2, 2"],
        ["*SURFACE, NAME=TIP, TYPE=NODE", "END", "*SURFACE, NAME=TOP", f"{m + 1}, S2"],
        [
            "*SURFACE INTERACTION, NAME=TOUCH",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
            f"{stiffness:g}",
        ],
        ["*FRICTION", f"{friction:g}, {stick * stiffness:g}"] if friction else [],
        ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=NODE TO SURFACE", "TIP, TOP"],
        [
            "*INITIAL CONDITIONS, TYPE=VELOCITY",
            f"BAR, 1, {-SPEED * sin(ANGLE)}",
            f"BAR, 3, {-SPEED * cos(ANGLE)}",
        ],
        ["*STEP, NLGEOM, INC=1000000", "*DYNAMIC, EXPLICIT", f"1e-7, {END:g}"],
        ["*NODE PRINT, NSET=BAR, FREQUENCY=50", "V", "*END STEP", ""],
    ]
    return "\n".join(line for part in parts for line in part)


def last_velocities(path):
    """Return the last table (n, 3) of velocities in CalculiX's output."""
    text = path.read_text().rpartition("velocities")[2]
    return np.array([line.split()[1:] for line in text.splitlines()[1:] if line.strip()], dtype=float)


def main(cells=4, friction=0.0, stiffness=2.6e13, stick=0.1):
    """Write the deck, run it where CalculiX is installed, print both rebounds."""
    mesh = square_bar(int(cells), 12 * int(cells))
    points = placed(mesh.points, ANGLE, 1e-7)
    folder = Path(mkdtemp(prefix="tilted-bar-"))
    (folder / "bar.inp").write_text(deck(mesh, points, friction, stiffness, stick))
    print(f"deck: {folder / 'bar.inp'}")
    if shutil.which("ccx") is None:
        return print("ccx is not installed")
    subprocess.run(["ccx", "-i", "bar"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    mass = np.bincount(mesh.cells.ravel(), lumped_mass(points, mesh.cells, RHO).ravel())
    theirs = mass @ last_velocities(folder / "bar.dat") / mass.sum()
    ours = verify("tilted-bar", {"cells": cells, "f": friction, "element": 0})
    print(f"CalculiX: V_n {theirs[2]:.4f} m/s, V_t {theirs[0]:.4f} m/s")
    return print(*(f"{c.name}: {c.computed:.4f} {c.unit}" for c in ours.checks), sep="\n")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
