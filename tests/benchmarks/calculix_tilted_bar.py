"""The bar of ``fem-impact verify tilted-bar`` in CalculiX, on the project's own mesh (optional).

    python tests/benchmarks/calculix_tilted_bar.py [CELLS] [FRICTION] [STIFFNESS] [STICK]

Its contacts are springs under nodes: with a STIFFNESS of 2.6e13 N/m3 the rebound on 4 cells is 1.38 m/s, and
with friction 0.2 it is 1.93 m/s at a tangential stiffness of STICK = 0.1 of that and 2.09 m/s at 1. So what
it prints is an answer for its springs.
"""

import sys
from math import cos, sin

import numpy as np
from calculix import Strike, run

from fem_impact.evidence.problems.bars import ANGLE, SPEED, square_bar
from fem_impact.evidence.problems.bodies import placed
from fem_impact.evidence.problems.problem import problem, verify
from fem_impact.fem.elements import lumped_mass

END = 3e-4  # s


def main(cells=4, friction=0.0, stiffness=2.6e13, stick=0.1):
    """Write the deck, run it where CalculiX is installed, print both rebounds."""
    p = problem("tilted-bar").values({"cells": cells, "f": friction, "element": 0})
    mesh, metal = square_bar(p), (p["E"], p["nu"], p["rho"])
    points, end = placed(mesh.points, ANGLE, 1e-7), np.flatnonzero(mesh.points[:, 2] == 0.0)
    velocity = (-SPEED * sin(ANGLE), 0.0, -SPEED * cos(ANGLE))
    contact = (friction, stiffness, stick)
    found = run(Strike(points, mesh.cells, end, velocity, metal, *contact, END))
    if found is None:
        return
    mass = np.bincount(mesh.cells.ravel(), lumped_mass(points, mesh.cells, p["rho"]).ravel())
    theirs = mass @ found[1] / mass.sum()
    ours = verify("tilted-bar", p)
    print(f"CalculiX: V_n {theirs[2]:.4f} m/s, V_t {theirs[0]:.4f} m/s")
    print(*(f"{c.name}: {c.computed:.4f} {c.unit}" for c in ours.checks), sep="\n")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
