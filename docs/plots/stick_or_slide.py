"""
Where the tip slides and where it sticks
========================================

Impulse ratio that comes out of rigid theory for three coefficients of friction. Where a curve leaves its
own f, the tip sticks or turns back before the end.
"""

import matplotlib.pyplot as plt
import numpy as np

from rigid import Projectile, sliding_path

rod, angle = Projectile(0.08, 0.019, "B", 0.003, 7850.0), np.radians(np.arange(5, 86))
d_c, d_d = np.transpose([rod.arms(a) for a in angle])
for f in (0.1, 0.3, 0.57):
    v_n, v_t = -2 * np.sin(angle), -2 * np.cos(angle)
    path = sliding_path(v_n, v_t, e=0.4, f=f, d_c=d_c, d_d=d_d, k2=rod.k2)
    plt.plot(np.degrees(angle), path.mu, label=f"f = {f}")
plt.gca().set(xlabel="angle, degrees", ylabel="impulse ratio mu that comes out")
plt.legend()
plt.show()
