"""
Losses of rigid theory
======================

Normal and tangential energy loss of rigid theory over the impulse ratio.
"""

import matplotlib.pyplot as plt
import numpy as np

from rigid import Projectile, kinetic_energy, predicted_losses

rod, v_n, v_t, mu = Projectile(0.08, 0.019, "B", 0.003, 7850.0), -1.5, -1.5, np.linspace(0, 1, 101)
d_c, d_d = rod.arms(np.radians(45))
lost = predicted_losses(v_n, v_t, e=0.35, mu=mu, d_c=d_c, d_d=d_d, k2=rod.k2, mass=rod.mass)
E_0 = kinetic_energy(v_n, v_t, 0.0, mass=rod.mass, k2=rod.k2)
plt.plot(mu, lost.E_ln / E_0, label="normal loss E_ln")
plt.plot(mu, lost.E_lt / E_0, label="tangential loss E_lt")
plt.gca().set(xlabel="impulse ratio mu", ylabel="share of E_0", title="0.08 m rod at 45 degrees, e = 0.35")
plt.legend()
plt.show()
