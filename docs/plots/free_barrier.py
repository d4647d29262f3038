"""
A barrier that moves
====================

Velocities after an impact on a barrier that is free to move, over its mass.
"""

import matplotlib.pyplot as plt
import numpy as np

from rigid import Projectile, solve_free

rod, ratio = Projectile(0.08, 0.019, "B", 0.003, 7850.0), np.logspace(-1, 3, 81)
d_c, d_d = rod.arms(np.radians(45))
free = solve_free(-1.5, -1.5, e=0.35, mu=0.4, d_c=d_c, d_d=d_d, k2=rod.k2, mass_ratio=1 / ratio)
plt.semilogx(ratio, free.V_n, label="rod V_n")
plt.semilogx(ratio, free.V_bn, label="barrier W_n")
plt.gca().set(xlabel="mass of the barrier over that of the rod", ylabel="after the impact, m/s")
plt.legend()
plt.show()
