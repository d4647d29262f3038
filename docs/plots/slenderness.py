"""
Slenderness of a steel rod
==========================

Length and diameter that have one gamma; 26.45 is the published limit of rigid behaviour.
"""

import matplotlib.pyplot as plt
import numpy as np

from rigid import LIMIT, slenderness

length, diameter = np.meshgrid(np.linspace(0.02, 0.5, 97), np.linspace(0.005, 0.05, 91))
gamma = slenderness(length, diameter)
lines = plt.contour(length * 1e3, diameter * 1e3, gamma, levels=[10, 20, LIMIT, 50, 100, 200], colors="C0")
plt.clabel(lines)
plt.gca().set(xlabel="length, mm", ylabel="diameter, mm", title="slenderness gamma; published limit 26.45")
plt.show()
