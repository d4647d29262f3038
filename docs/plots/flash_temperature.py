"""
Flash temperature of a sliding contact
======================================

Steady rise over the sliding speed for three sizes of the patch, by the moving source of heat.
"""

import matplotlib.pyplot as plt
import numpy as np

from fem_impact.physics.flash import Half, moving_rise

speed, steel = np.logspace(-2, 2, 81), Half(53.0, 440.0 * 7850.0)
for radius in (0.1e-3, 0.3e-3, 1e-3):
    heat = 0.57 * 1e9 * speed / 2  # friction of 0.57 under 1 GPa, half of it into each body
    plt.loglog(speed, moving_rise(heat, radius, speed, steel), label=f"patch of {1e3 * radius:g} mm")
plt.gca().set(xlabel="sliding speed, m/s", ylabel="steady flash temperature rise, K")
plt.legend()
plt.show()
