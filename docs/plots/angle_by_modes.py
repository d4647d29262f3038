"""
Vibration against angle, two lengths
====================================

Share of the energy that a rod keeps as vibration, by the reduced model: 13 angles, two lengths.
"""

import matplotlib.pyplot as plt

import fem_impact

angles = range(10, 71, 5)
for length in ("80 mm", "120 mm"):
    base = fem_impact.replace(fem_impact.load("t5b"), "projectile.length", length)
    runs = [
        fem_impact.simulate(fem_impact.replace(base, "impact.angle", f"{a} deg"), "modal") for a in angles
    ]
    plt.plot(angles, [run.energy.vibration for run in runs], "o-", label=length)
plt.gca().set(xlabel="angle, degrees", ylabel="vibration, share of E_0", title="free modes, machined steel")
plt.legend()
plt.show()
