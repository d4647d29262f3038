"""
Three levels of a run
=====================

Elements near the contact on the three meshes of one run, from coarse to fine: those that may yield are
coloured, points that touched are red. `How a run finds its contact <../explanation/contact.html>`_
explains it.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection as Quads

from fem_impact import Case, load
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.fem.geometry import build_geometry, to_barrier_frame

(chain := LevelChain(Case(load("t5b")))).run()
panels = plt.subplots(1, len(chain.done), figsize=(11, 3.6), layout="constrained")[1]
for ax, level in zip(panels, chain.done, strict=True):
    bodies, g = (case := level.cases[0]).bodies, build_geometry(case.bodies, case.zones, 0.0, True)
    rod, barrier = (g.rod.mesh.cells, g.rod_points, "#f6b26b"), (g.barrier.cells, g.barrier.points, "#9fc5e8")
    for name, (cells, x, tone) in {"rod": rod, "barrier": barrier}.items():
        cut = ((on := x[cells, 1] < 1e-9).sum(axis=1) == 4) & (np.abs(x[cells]).max(axis=(1, 2)) < 8e-3)
        faces = 1e3 * x[cells[cut][on[cut]].reshape(-1, 4)][..., [0, 2]]
        t, n = np.moveaxis(faces - faces.mean(axis=1, keepdims=True), 2, 0)
        faces = np.take_along_axis(faces, np.arctan2(n, t).argsort(axis=1)[..., None], axis=1)
        ax.add_collection(Quads(faces, fc=np.where(g.may_yield[name][cut], tone, "w"), ec="0.4", lw=0.5))
    at = (level.record.rod.touched - bodies.lowest_point) @ to_barrier_frame(bodies.mesh_inclination).T
    at = 1e3 * np.vstack([at, level.record.barrier.touched])
    ax.plot(*at[at[:, 1] < 1e-6][:, [0, 2]].T, "r.")
    ax.set(xlim=(-4, 4), ylim=(-3, 3), aspect="equal", xlabel="t, mm", title=f"{1e3 * level.size:.2f} mm")
plt.show()
