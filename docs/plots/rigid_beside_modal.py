"""
Rotation: rigid theory beside free modes
========================================

Spin of the rod after the impact, by rigid theory and by the reduced model, which has the modes of the
rod.
"""

import matplotlib.pyplot as plt

import fem_impact

base, angles = fem_impact.load("t5b"), range(10, 71, 5)
for fidelity, look in (("rigid", "o--"), ("modal", "s-")):
    runs = [
        fem_impact.simulate(fem_impact.replace(base, "impact.angle", f"{a} deg"), fidelity) for a in angles
    ]
    plt.plot(angles, [run.motion.Omega for run in runs], look, label=fidelity)
plt.gca().set(xlabel="angle, degrees", ylabel="Omega after the impact, rad/s", title="0.08 m rod")
plt.legend()
plt.show()
