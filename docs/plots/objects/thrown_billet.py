"""
Thrown billet: where does its energy go?
========================================

A billet of aluminium, 40 x 120 mm, leaves a conveyor and lands on a steel floor at 2 m/s: upright (0 degrees)
to flat on its side (90 degrees). Shares of its energy after the first strike.
"""

import matplotlib.pyplot as plt

import fem_impact

billet = {"length": "120 mm", "diameter": "40 mm", "tip": "B", "tip_radius": "2 mm"}
scene = fem_impact.load(
    {
        "id": "billet",
        "projectile": {**billet, "material": "aluminium-6061-t6"},
        "barrier": {"material": "s235"},
        "surface": {"state": "custom", "friction": 0.4, "source": "assumed: aluminium on steel"},
        "impact": {"angle": "0 deg", "v_n": "-2 m/s", "v_t": "0 m/s"},
    }
)
angles = [0, 15, 30, 45, 60, 75, 85, 90]
turned = [{"impact.angle": f"{a} deg", "impact.v_n": "-2 m/s", "impact.v_t": "0 m/s"} for a in angles]
runs = [fem_impact.simulate(fem_impact.replace_all(scene, one), "modal") for one in turned]
shares = {
    "E_r_over_E_0": "rigid motion",
    "E_vib_over_E_0": "vibration",
    "W_friction_over_E_0": "friction",
}
for place, (key, words) in enumerate(shares.items()):
    values, errors = zip(*(run.estimate(key) for run in runs), strict=True)
    plt.errorbar([a + place for a in angles], values, errors, fmt="o", capsize=4, label=words)
plt.gca().set(xlabel="angle between axis and normal, degrees", ylabel="share of E_0", ylim=(0, 1))
plt.gca().set(title="billet, 40 x 120 mm, 2 m/s (90: on its side)")
plt.legend()
plt.show()
