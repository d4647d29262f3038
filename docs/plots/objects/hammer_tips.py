"""
Hammer: which tip keeps the force low?
======================================

A striker of tool steel, 20 x 150 mm, hits a plate of mild steel, 10 degrees off its normal, at 1 to 4 m/s.
Largest normal force with a round and with a blunt tip. Dashed: what the clamps of the plate bear.
"""

import matplotlib.pyplot as plt

import fem_impact
from fem_impact.answers.verdict.criteria import LIMITED

scene = fem_impact.load(
    {
        "id": "striker",
        "projectile": {
            "length": "150 mm",
            "diameter": "20 mm",
            "tip": "A",
            "tip_radius": "10 mm",
            "material": "42crmo4",
        },
        "barrier": {"material": "s235"},
        "surface": {"state": "machined"},
        "impact": {"angle": "10 deg", "v_n": "-2 m/s", "v_t": "0 m/s"},
    }
)
tips = {
    "round, 10 mm": {"projectile.tip": "A", "projectile.tip_radius": "10 mm"},
    "blunt, edge of 2 mm": {"projectile.tip": "B", "projectile.tip_radius": "2 mm"},
}
speeds = [1, 2, 3, 4]
for place, (words, tip) in enumerate(tips.items()):
    hits = [fem_impact.replace_all(scene, {**tip, "impact.v_n": f"{-v} m/s"}) for v in speeds]
    forces = [LIMITED["force"].reduced(hit) for hit in hits]
    errors = [[1e-3 * (f.value - f.low) for f in forces], [1e-3 * (f.high - f.value) for f in forces]]
    at = [v + 0.05 * place for v in speeds]
    plt.errorbar(at, [1e-3 * f.value for f in forces], errors, fmt="o", capsize=4, label=words)
plt.axhline(20.0, color="grey", linestyle="--")
plt.gca().set(xlabel="speed, m/s", ylabel="largest normal force, kN", ylim=(0, None))
plt.gca().set(title="striker, 20 x 150 mm, 10 degrees; dashed: what the clamps bear")
plt.legend()
plt.show()
