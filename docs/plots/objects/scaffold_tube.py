"""
Scaffold tube: does it dent the vessel?
=======================================

An offcut of scaffold tube of S355, 0.5 m long, falls 1 m onto the wall of a vessel: 25 mm of S235. How deep
is the dent, at the angles at which a tube may come down? The allowance is that of the vessel's owner.
"""

import matplotlib.pyplot as plt

import fem_impact
from fem_impact.answers.verdict.criteria import LIMITED

scene = fem_impact.load(
    {
        "id": "scaffold-tube",
        "projectile": {
            "length": "0.5 m",
            "diameter": "48.3 mm",
            "inner_diameter": "41.9 mm",
            "tip": "B",
            "tip_radius": "1 mm",
            "material": "s355",
        },
        "barrier": {"material": "s235", "thickness": "25 mm", "support": "infinite"},
        "surface": {"state": "custom", "friction": 0.3, "source": "assumed: painted steel on steel"},
        "impact": {"angle": "20 deg", "height": "1 m"},
    }
)
angles = range(10, 61, 10)
dents = [LIMITED["dent"].reduced(fem_impact.replace(scene, "impact.angle", f"{a} deg")) for a in angles]
depth = [1e3 * dent.value for dent in dents]
errors = [[1e3 * (d.value - d.low) for d in dents], [1e3 * (d.high - d.value) for d in dents]]
plt.errorbar(angles, depth, errors, fmt="o", capsize=4)
plt.axhline(1.0, color="grey", linestyle="--")
plt.gca().set(xlabel="angle between axis and normal, degrees", ylabel="depth, mm", yscale="log")
plt.gca().set(title="deepest indentation of the plate; dashed: allowed")
plt.show()
