"""
Probe: does a stiffer barrier change the vibration?
===================================================

A touch probe with a ball end, 6 x 50 mm of hardened steel, is driven at 0.2 m/s against four barriers, 30
degrees off the normal. Restitution and vibration of the first strike.
"""

import matplotlib.pyplot as plt

import fem_impact

probe = {"length": "50 mm", "diameter": "6 mm", "tip": "A", "tip_radius": "3 mm", "material": "100cr6"}
scene = fem_impact.load(
    {
        "id": "probe",
        "projectile": probe,
        "barrier": {"material": "brass"},
        "surface": {"state": "custom", "friction": 0.15, "source": "assumed: wiped clean"},
        "impact": {"angle": "30 deg", "v_n": "-0.2 m/s", "v_t": "0 m/s"},
    }
)
barriers = ["aluminium-6061-t6", "brass", "s235", "alumina"]
runs = [
    fem_impact.simulate(fem_impact.replace(scene, "barrier.material", name), "modal") for name in barriers
]
for key, words in {"e_edge": "restitution e", "E_vib_over_E_0": "vibration, share of E_0"}.items():
    values, errors = zip(*(run.estimate(key) for run in runs), strict=True)
    plt.errorbar(barriers, values, errors, fmt="o", capsize=4, label=words)
plt.gca().set(ylim=(0, 1), title="touch probe, 0.2 m/s, 30 degrees")
plt.legend()
plt.show()
