"""The elastic drop of a rod on a rigid plane, written plainly with scikit-fem: to read, and to check against.

    python docs/examples/plain_elastic_drop.py [SCENE]

Half a rod (b >= 0) of trilinear hexahedra with incompatible modes, lumped masses, central differences,
contact of nodes with the plane n = 0 and Coulomb friction by impulses, and an energy ledger. Every step
multiplies with the whole sparse stiffness matrix. Rotations are small: the stiffness is that of the first
position. Components are (t, b, n): up the slope, across it, out of the plane.
"""

import sys
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh
from skfem import ElementHex1, ElementVector
from skfem.models.elasticity import lame_parameters

import rigid
from fem_impact.case.case import Case
from fem_impact.fem import forms
from fem_impact.fem.geometry import build_geometry
from fem_impact.scene.shipped import load

EFFECTS = ("vibration", "friction", "barrier-rigid")  # what this file computes
START_GAP = 2e-6  # m between the lowest node and the plane at time 0


@dataclass
class Rod:
    """The half rod: positions X (k, 3), m; masses (k, 1), kg; stiffness K (3 k, 3 k), N/m.

    ``free`` (k, 3) is 0 where the symmetry plane holds a node; ``skin`` are the nodes that may touch.
    """

    X: np.ndarray
    mass: np.ndarray
    K: sp.csr_matrix
    free: np.ndarray
    skin: np.ndarray

    @classmethod
    def of(cls, mesh, points, material):
        """Assemble over the master nodes; hanging nodes of a refined mesh follow them: u = T u_master."""
        masters = np.flatnonzero(~mesh.is_hanging)
        tie = mesh.tie[:, masters]
        T = sp.kron(tie, np.eye(3), format="csr")
        body, element = forms.hex_mesh(points, mesh.cells), ElementVector(forms.ElementHexModes())
        lame, G = lame_parameters(material.E, material.nu)
        Ke = forms.element_matrices(forms.stiffness, body, element, lame=lame, G=G)
        dofs = (3 * mesh.cells[:, :, None] + np.arange(3)).reshape(-1, 24)
        rows, columns = np.repeat(dofs, 24, axis=1).ravel(), np.tile(dofs, 24).ravel()
        K = T.T @ sp.csr_matrix((Ke.ravel(), (rows, columns))) @ T
        Me = forms.element_matrices(forms.mass, body, ElementHex1(), rho=material.rho).sum(axis=2)
        mass = tie.T @ np.bincount(mesh.cells.ravel(), Me.ravel())
        free = np.ones((len(masters), 3))
        free[abs(points[masters, 1]) < 1e-12, 1] = 0
        return cls(points[masters], mass[:, None], K, free, np.searchsorted(masters, mesh.free_skin))

    def stable_step(self):
        """Return 0.9 of the longest stable step, s: 2 over the highest circular frequency."""
        root = sp.diags((self.free / np.sqrt(self.mass)).ravel())
        return 1.8 / np.sqrt(eigsh(root @ self.K @ root, k=1, return_eigenvectors=False)[0])

    def force(self, x):
        """Return the elastic forces (k, 3), N, at positions x."""
        return -self.free * (self.K @ (x - self.X).ravel()).reshape(-1, 3)

    def rigid_motion(self, x, v):
        """Return V_n, V_t, m/s, and Omega, rad/s from n to t, at positions x; their energy, J."""
        m, arm = self.mass.sum(), x - (self.mass * x).sum(axis=0) / self.mass.sum()
        V_t, _, V_n = (self.mass * v).sum(axis=0) / m
        inertia = (self.mass * arm[:, [0, 2]] ** 2).sum()
        Omega = (self.mass[:, 0] * (arm[:, 2] * v[:, 0] - arm[:, 0] * v[:, 2])).sum() / inertia
        return V_n, V_t, Omega, 0.5 * (m * (V_n**2 + V_t**2) + inertia * Omega**2)


def touch(rod, x, v, before, dt, f):
    """Stop the nodes that would pass the plane, with friction; return friction and closing loss, J.

    Such a node gets the impulse along n with which it arrives at the plane, and along the plane what stops
    it or f times as much. Work is impulse times the mean of the velocities ``before`` the step and after it.
    """
    arrive = -np.maximum(x[rod.skin, 2], 0) / dt
    hit, arrive = rod.skin[v[rod.skin, 2] < arrive], arrive[v[rod.skin, 2] < arrive]
    p = -rod.mass[hit] * v[hit]  # along the plane what stops a node
    p[:, 2] += rod.mass[hit, 0] * arrive
    slip = np.maximum(np.hypot(p[:, 0], p[:, 1]), 1e-300)
    p[:, :2] *= np.minimum(1, f * p[:, 2] / slip)[:, None]
    v[hit] += p / rod.mass[hit]
    taken = -0.5 * (p * (before[hit] + v[hit])).sum(axis=0)
    return np.array([taken[0] + taken[1], taken[2]])


def drop(rod, v_n, v_t, f, dt, time):
    """March from a velocity, m/s, for a time, s; return motion and energies, J, of the whole rod."""
    x, v = rod.X.copy(), np.tile([v_t, 0.0, v_n], (len(rod.X), 1))
    start, lost, kick, last_touch = 0.5 * (rod.mass * v**2).sum(), np.zeros(2), dt / 2, 0.0
    for step in range(round(time / dt)):
        before, v = v, v + kick * rod.force(x) / rod.mass
        loss = touch(rod, x, v, before, dt, f)
        lost, last_touch = lost + loss, step * dt if loss.any() else last_touch
        x, kick = x + dt * v, dt  # from now on velocities stand half a step behind positions
    force = rod.force(x)
    now, after = v + 0.5 * dt * force / rod.mass, v + dt * force / rod.mass
    strain, kinetic = -0.5 * ((x - rod.X) * force).sum(), 0.5 * (rod.mass * v * after).sum()
    V_n, V_t, Omega, kept = rod.rigid_motion(x, now)
    vibration = 0.5 * (rod.mass * now**2).sum() - kept + strain
    half = {"E_0": start, "rigid": kept, "vibration": vibration, "friction": lost[0], "closing": lost[1]}
    half["residual"] = (
        start - kinetic - strain - lost.sum()
    )  # what leapfrog keeps exactly is v . M v_after / 2
    motion = {"V_n": V_n, "V_t": V_t, "Omega": Omega, "last_touch": last_touch}
    return motion | {name: 2 * energy for name, energy in half.items()}


def outcome(scene, time):
    """Return what `drop` does of a scene on its own mesh, with restitution e and impulse ratio mu."""
    impact, case = scene.impact, Case.of(scene)
    geometry = build_geometry(case.bodies, case.zones, START_GAP, meshed_barrier=False)
    rod = Rod.of(geometry.rod.mesh, geometry.rod_points, scene.projectile.material)
    end = drop(rod, impact.v_n, impact.v_t, scene.surface.friction, rod.stable_step(), time)
    d_c = scene.projectile.rigid_body.arms(impact.angle)[0]
    end["e"] = rigid.restitution(impact.v_n, end["V_n"], end["Omega"], d_c)
    end["mu"] = rigid.impulse_ratio(impact.v_n, impact.v_t, end["V_n"], end["V_t"])
    return end


def main(name="elastic-frictionless", time=600e-6):
    """Print coefficients and energy shares."""
    end = outcome(replace(load(name), effects=EFFECTS), time)
    print(f"last touch at {end['last_touch'] * 1e6:.0f} of {time * 1e6:.0f} us")
    print(f"e {end['e']:.4f}, mu {end['mu']:.4f}, Omega {end['Omega']:.2f} rad/s, E_0 {end['E_0']:.4f} J")
    for share in ("rigid", "vibration", "friction", "closing", "residual"):
        print(f"{share:9} {end[share] / end['E_0']:9.2e} of E_0")


if __name__ == "__main__":
    main(*sys.argv[1:])
