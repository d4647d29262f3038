"""
Tips
====

Outlines of the three tips that the tests had.
"""

import matplotlib.pyplot as plt

from rigid import Projectile

for at, (tip, radius) in enumerate((("A", 0.007), ("B", 0.003), ("plain", 0.0))):
    rho, z = Projectile(0.08, 0.019, tip, radius, 7850.0).meridian(40).T * 1e3
    plt.fill([*(at * 25 + rho), *(at * 25 - rho[::-1])], [*z, *z[::-1]], alpha=0.5, label=f"tip {tip}")
plt.gca().set(xlabel="mm", ylabel="mm", aspect="equal", title="the three tips of a 19 mm rod")
plt.legend()
plt.show()
