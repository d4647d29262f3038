"""
Elements of a rod
=================

The hexahedra of a rod with tip B on its plane of symmetry.
"""

import matplotlib.pyplot as plt
import numpy as np

from meshes import rod
from rigid import Projectile

mesh = rod(Projectile(0.04, 0.019, "B", 0.003, 7850.0).meridian(20), 0.04).mesh
on_plane = np.isclose(mesh.points[:, 1], 0)
for face in mesh.faces[on_plane[mesh.faces].all(axis=1)]:
    x, _, z = mesh.points[[*face, face[0]]].T * 1e3
    plt.plot(z, x, color="tab:blue", linewidth=0.6)
plt.gca().set(
    xlabel="along the axis, mm", ylabel="mm", aspect="equal", title="elements on the plane of symmetry"
)
plt.show()
