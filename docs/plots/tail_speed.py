"""
How fast the tail strikes
=========================

A rod falls onto a level floor with its nose first and slaps down: the hardest strike of its tail over the
speed of the fall, through three strikes.
"""

import matplotlib.pyplot as plt

import fem_impact

fall = {"impact.slope": "0 deg", "impact.v_n": "-2 m/s", "impact.v_t": "0 m/s", "impact.until": "3 strikes"}
rod = fem_impact.replace_all(fem_impact.load("t4"), fall)
angles = [*range(10, 71, 15), 80, 88]
for fidelity, look in (("rigid", "o--"), ("modal", "s-")):
    ratios = []
    for angle in angles:
        run = fem_impact.simulate(fem_impact.replace(rod, "impact.angle", f"{angle} deg"), fidelity)
        tails = [one.approach for one in run.strikes.each if one.part == "tail"]
        ratios.append(max(tails, default=float("nan")) / 2.0)
    plt.plot(angles, ratios, look, label=fidelity)
plt.axhline(1.0, color="grey", linewidth=0.7)
plt.gca().set(xlabel="angle between axis and normal, degrees", ylabel="tail's speed over nose's")
plt.gca().set(title="0.12 m rod, level floor, 2 m/s: hardest strike of the tail")
plt.legend()
plt.show()
