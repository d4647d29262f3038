"""
Tips
====

Outlines of the three tips that the tests had.
"""

import matplotlib.pyplot as plt

from rigid import Projectile

plt.figure(figsize=(6.4, 2.4), layout="constrained")
for at, (tip, radius) in enumerate((("A", 0.007), ("B", 0.003), ("plain", 0.0))):
    rho, z = Projectile(0.08, 0.019, tip, radius, 7850.0).meridian(40).T * 1e3
    half, heights = [*rho, 9.5], [*z, 12.0]  # with a part of the shank
    left, right = [25 * at - r for r in half[::-1]], [25 * at + r for r in half]
    plt.fill([*right, *left], [*heights, *heights[::-1]], alpha=0.5)
    plt.text(25 * at, 6, tip, ha="center")
plt.gca().set(xlabel="mm", ylabel="mm", aspect="equal", title="the three tips of a 19 mm rod")
plt.show()
