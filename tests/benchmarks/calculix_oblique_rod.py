"""Vibration of an elastic oblique rod in CalculiX, beside this solver and the modal reference (optional).

    python tests/benchmarks/calculix_oblique_rod.py [FRICTION] [ACROSS] [END] [STIFFNESS]

The rod of ``fem-impact verify oblique-rod`` on a rigid plane, plain 8-point hexahedra, one mesh for both
codes, and one reduction: positions and velocities of either give e by the contact point's velocities and
E_vib by projection on the modes of the mesh. CalculiX' contact is springs under nodes, which the solver
runs as well; END, s, must lie after the last contact (230 us with friction 0.55, 700 us without friction).

With 0.55 8 2.3e-4 3e14, a coarse mesh on which one node touches (a minute of CPU): e 0.573 and E_vib 0.073 of
E_0 by CalculiX, 0.532 and 0.075 by the solver on springs, 0.620 and 0.084 on hard contact; with 12 cells
across hard contact gives 0.676 and 0.054, the modal reference 0.692 and 0.049.
"""

import sys
from dataclasses import replace
from math import sqrt

import numpy as np
from calculix import Strike, run

import meshes
from fem_impact.evidence.problems.bars import NodeSprings, node_areas
from fem_impact.evidence.problems.bodies import FreeBody, body_model, placed
from fem_impact.evidence.problems.oblique_rod import ReferenceChange, RodDrop
from fem_impact.evidence.problems.problem import problem
from fem_impact.evidence.problems.setups import Until, rigid_of, rod_scene
from fem_impact.fem.eigen import rod_modes
from fem_impact.fem.flight import flight
from fem_impact.solid.march import evaluate, march

STICK, GAP = 0.1, 1e-7


def models(p, stiffness):
    """Return the rod over a rigid plane with hard contact, with springs, and which nodes may touch."""
    rod = rod_scene(p, ("vibration", "barrier-rigid")).projectile.rigid_body
    mesh = meshes.rod(rod.meridian(), p["length"], int(p["across"]), slice_length=2.5e-3).mesh
    points = placed(mesh.points, p["angle"], GAP)
    velocity = np.tile([-p["v_t"], 0.0, -p["v_n"]], (len(points), 1))
    body = FreeBody(
        meshes.RodMesh.plain(mesh), points, velocity, p["E"], p["nu"], p["rho"], kind="full", turning=True
    )
    hard = body_model(replace(body, friction=p["f"]))
    low = np.intersect1d(mesh.free_skin, np.flatnonzero(points[:, 2] < 2e-3))
    area = node_areas(mesh, np.isin(mesh.faces, low).all(axis=1))
    touching = np.flatnonzero(area > 0)
    nodes = hard.layout.rod[touching]
    springs = NodeSprings(nodes, stiffness * area[touching], STICK, p["f"])
    step = 1 / sqrt((2 / hard.step) ** 2 + max(springs.stiffness * hard.inverse_mass[nodes[:, 2]]))
    forces = [*hard.forces, springs]
    return rod, hard, replace(hard, forces=forces, impulses=[], steps={"rod": step}), touching


def outcome(name, model, state, rod, p):
    """Print restitution and the energy of vibration over E_0."""
    n, motion = model.layout.rod_size, rigid_of(model, state)
    evaluate(model, state)
    modes = rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0)
    energy = flight(modes, state.v[:n], state.force[:n]).energy
    E_0 = 0.5 * motion.mass * (p["v_n"] ** 2 + p["v_t"] ** 2)
    e = (motion.V_n + float(rod.arms(p["angle"])[0]) * motion.Omega) / p["v_n"]
    print(f"{name}: e {e:.4f}, E_vib / E_0 {energy / E_0:.4f}, Omega {motion.Omega:.3f} rad/s")


def main(friction=0.55, across=8, end=2.3e-4, stiffness=3e14):
    """Run the modal reference, the solver with both contacts, and CalculiX where it is installed."""
    p = problem("oblique-rod").values({"f": friction, "across": int(across), "elastic_barrier": 0})
    rod, hard, sprung, touching = models(p, stiffness)
    exact = RodDrop(p, rod).rebound(ReferenceChange())
    vibration = (exact.bending + exact.stretching) / exact.E_0
    print(f"modes: e {exact.restitution:.4f}, E_vib / E_0 {vibration:.4f}, Omega {exact.Omega:.3f} rad/s")
    for name, model in (("solver, hard contact", hard), ("solver, springs", sprung)):
        march(model, state := model.initial_state(), [Until(model.ledger(), end)])
        outcome(name, model, state, rod, p)
    mesh, points = hard.geometry.rod.mesh, hard.geometry.rod_points
    velocity, steel = (-p["v_t"], 0.0, -p["v_n"]), (p["E"], p["nu"], p["rho"])
    found = run(Strike(points, mesh.cells, touching, velocity, steel, friction, stiffness, STICK, end))
    if found is not None:
        state = hard.initial_state()
        state.x[hard.layout.rod], state.v[hard.layout.rod] = points + found[0], found[1]
        outcome("CalculiX", hard, state, rod, p)


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
