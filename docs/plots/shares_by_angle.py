"""
Where the energy goes, against angle
====================================

Shares of the energy before the impact that are rigid motion, vibration, friction and plastic work, by the
reduced model.
"""

import matplotlib.pyplot as plt

import fem_impact

base, angles = fem_impact.load("t5b"), range(10, 71, 5)
runs = [fem_impact.simulate(fem_impact.replace(base, "impact.angle", f"{a} deg"), "modal") for a in angles]
names = ("rigid", "vibration", "friction", "plastic_barrier")
words = ("rigid motion", "vibration", "friction", "plastic work in the barrier")
plt.stackplot(angles, [[getattr(run.energy, name) for run in runs] for name in names], labels=words)
plt.gca().set(xlabel="angle, degrees", ylabel="share of E_0", title="energy after the impact, reduced model")
plt.legend(loc="upper left")
plt.show()
