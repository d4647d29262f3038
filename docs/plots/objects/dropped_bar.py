"""
Dropped bar: can the contact ignite a gas?
==========================================

A bar of stainless steel, 25 x 150 mm, falls onto a steel deck, 45 degrees to its normal, with a high
friction. Flash temperature of the contact over the height of the fall. Dashed: 430 degC, which it must not
reach.
"""

import matplotlib.pyplot as plt

import fem_impact
from fem_impact.answers.verdict.criteria import LIMITED

scene = fem_impact.load(
    {
        "id": "dropped-bar",
        "projectile": {
            "length": "150 mm",
            "diameter": "25 mm",
            "tip": "B",
            "tip_radius": "2 mm",
            "material": "stainless-304",
        },
        "barrier": {"material": "s355"},
        "surface": {"state": "custom", "friction": 0.6, "source": "assumed, high"},
        "impact": {"angle": "45 deg", "height": "2 m"},
    }
)
heights = [0.01, 0.03, 0.1, 0.3, 1]
hot = [LIMITED["heat"].reduced(fem_impact.replace(scene, "impact.height", f"{h} m")) for h in heights]
kelvin = 273.15  # of 0 degC
high = [min(one.high, one.ceiling) - one.value for one in hot]  # no more than where steel melts
errors = [[one.value - one.low for one in hot], high]
plt.errorbar(heights, [one.value - kelvin for one in hot], errors, fmt="o", capsize=4)
plt.axhline(430.0, color="grey", linestyle="--")
plt.gca().set(xscale="log", xlabel="height of the fall, m", ylabel="flash temperature, degC")
plt.gca().set(title="bar, 25 x 150 mm; dashed: what the contact must not reach")
plt.show()
