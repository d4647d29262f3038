"""
Critical impulse ratio of three tips
====================================

Impulse ratio above which a rod would stick, at e = 0.4: it follows from where the tip touches.
"""

import matplotlib.pyplot as plt
import numpy as np

from rigid import Projectile, critical_ratio

angle = np.radians(np.arange(1, 89))
for tip, radius in (("A", 0.007), ("B", 0.003), ("plain", 0.0)):
    rod = Projectile(0.08, 0.019, tip, radius, 7850.0)
    d_c, d_d = np.transpose([rod.arms(a) for a in angle])
    v_n, v_t = -4 * np.sin(angle), -4 * np.cos(angle)
    plt.plot(
        np.degrees(angle), critical_ratio(v_n, v_t, e=0.4, d_c=d_c, d_d=d_d, k2=rod.k2), label=f"tip {tip}"
    )
plt.gca().set(xlabel="angle, degrees", ylabel="critical impulse ratio mu_c", ylim=(0, 2))
plt.legend()
plt.show()
