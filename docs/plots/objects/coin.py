"""
Disc: how does it leave after it lands on its rim?
==================================================

A disc of brass, 24 x 2 mm, falls at 2 m/s on a steel plate, from nearly flat (5 degrees) to upright on its
rim (90 degrees). Spin after the first strike, by rigid theory and by the reduced model.
"""

import matplotlib.pyplot as plt

import fem_impact

disc = {"length": "2 mm", "diameter": "24 mm", "tip": "B", "tip_radius": "0.3 mm", "material": "brass"}
scene = fem_impact.load(
    {
        "id": "disc",
        "projectile": disc,
        "barrier": {"material": "42crmo4"},
        "surface": {"state": "custom", "friction": 0.3, "source": "assumed: brass on steel"},
        "impact": {"angle": "60 deg", "v_n": "-2 m/s", "v_t": "0 m/s"},
    }
)
angles = range(10, 90, 10)
for fidelity, look in (("rigid", "--"), ("modal", "o")):
    runs = [
        fem_impact.simulate(fem_impact.replace(scene, "impact.angle", f"{a} deg"), fidelity) for a in angles
    ]
    spins, errors = zip(*(run.estimate("Omega_rad_per_s") for run in runs), strict=True)
    plt.errorbar(angles, spins, errors if fidelity == "modal" else None, fmt=look, capsize=4, label=fidelity)
plt.gca().set(
    xlabel="angle between axis and normal, degrees", ylabel="spin, rad/s", title="disc, 24 x 2 mm, 2 m/s"
)
plt.legend()
plt.show()
