"""Half a body that strikes a held plate, in CalculiX: the input deck and what its run says.

Debian's package calculix-ccx holds the program ``ccx``; nothing of this project needs it.
"""

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

PLATE = 0.1  # m, half-width and depth of the held cell under the body
CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]


@dataclass(frozen=True)
class Strike:
    """Nodes (n, 3), cells and nodes that may touch; velocity, m/s; E, nu, rho; contact; end, s.

    The contact is springs of ``stiffness``, N/m3, under nodes; friction sticks with ``stick`` of it.
    """

    points: np.ndarray
    cells: np.ndarray
    touching: np.ndarray
    velocity: tuple
    material: tuple
    friction: float
    stiffness: float
    stick: float
    end: float


def numbered(rows, first=1):
    """Return lines of a number and its row."""
    return [", ".join([str(first + i), *(f"{value:.12g}" for value in row)]) for i, row in enumerate(rows)]


def deck(strike):
    """Return the input deck: the half body, a held plate, contact, explicit dynamics."""
    n, m, (E, nu, rho) = len(strike.points), len(strike.cells), strike.material
    middle = np.flatnonzero(np.abs(strike.points[:, 1]) < 1e-12) + 1
    stick = strike.stick * strike.stiffness
    parts = [
        ["*NODE, NSET=BODY", *numbered(strike.points)],
        ["*NODE, NSET=PLATE", *numbered(PLATE * np.array(CORNERS, float), n + 1)],
        ["*ELEMENT, TYPE=C3D8, ELSET=ALL", *numbered(strike.cells + 1)],
        ["*ELEMENT, TYPE=C3D8, ELSET=HELD", *numbered([n + 1 + np.arange(8)], m + 1)],
        ["*NSET, NSET=END", *map(str, strike.touching + 1), "*NSET, NSET=MIDDLE", *map(str, middle)],
        ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{E:g}, {nu}", "*DENSITY", f"{rho:g}"],
        [f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL" for name in ("ALL", "HELD")],
        ["*BOUNDARY", "PLATE, 1, 3", "MIDDLE, 2, 2"],
        ["*SURFACE, NAME=TIP, TYPE=NODE", "END", "*SURFACE, NAME=TOP", f"{m + 1}, S2"],
        ["*SURFACE INTERACTION, NAME=TOUCH"],
        ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{strike.stiffness:g}"],
        ["*FRICTION", f"{strike.friction:g}, {stick:g}"] if strike.friction else [],
        ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=NODE TO SURFACE", "TIP, TOP"],
        ["*INITIAL CONDITIONS, TYPE=VELOCITY"],
        [f"BODY, {i + 1}, {v:.9g}" for i, v in enumerate(strike.velocity)],
        ["*STEP, NLGEOM, INC=1000000", "*DYNAMIC, EXPLICIT", f"1e-7, {strike.end:g}"],
        ["*NODE PRINT, NSET=BODY, FREQUENCY=50", "U, V", "*END STEP", ""],
    ]
    return "\n".join(line for part in parts for line in part)


def last_table(text, title):
    """Return the last table (n, 3) under a title in CalculiX's output."""
    rows = text.rpartition(title)[2].splitlines()[1:]
    table = []
    for line in rows:
        if line.strip():
            try:
                table.append([float(word) for word in line.split()[1:]])
            except ValueError:
                break
    return np.array(table)


def run(strike):
    """Write the deck; where CalculiX is installed return displacements and velocities (n, 3), else None."""
    folder = Path(mkdtemp(prefix="calculix-"))
    (folder / "body.inp").write_text(deck(strike))
    print(f"deck: {folder / 'body.inp'}")
    if shutil.which("ccx") is None:
        return print("ccx is not installed")
    subprocess.run(["ccx", "-i", "body"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    text = (folder / "body.dat").read_text()
    return last_table(text, "displacements"), last_table(text, "velocities")
