"""
Chamfered pin: may rigid theory be used?
========================================

A dowel pin, 12 x 60 mm with chamfers of 1 mm, is dropped 0.5 m onto a table of cast iron. By how much is the
restitution off if the pin counts as rigid? Dashed: the 0.05 that may be neglected.
"""

import matplotlib.pyplot as plt

import fem_impact
from fem_impact.answers.verdict.criteria import Rigidity

outline = [["0 mm", "5 mm"], ["1 mm", "6 mm"], ["59 mm", "6 mm"], ["60 mm", "5 mm"]]
scene = fem_impact.load(
    {
        "id": "dowel-pin",
        "projectile": {"profile": outline, "material": "100cr6"},
        "barrier": {"material": "grey-cast-iron"},
        "surface": {"state": "custom", "friction": 0.2, "source": "assumed: oiled steel on cast iron"},
        "impact": {"angle": "20 deg", "height": "0.5 m"},
    }
)
angles = [5, 10, 15, 20, 25]
found = [Rigidity("e").reduced(fem_impact.replace(scene, "impact.angle", f"{a} deg")) for a in angles]
errors = [[one.value - one.low for one in found], [one.high - one.value for one in found]]
plt.errorbar(angles, [one.value for one in found], errors, fmt="o", capsize=4)
plt.axhline(0.05, color="grey", linestyle="--")
plt.gca().set(xlabel="angle between axis and normal, degrees", ylabel="change of e by vibration")
plt.gca().set(title="dowel pin, 12 x 60 mm, fall of 0.5 m; dashed: may be neglected")
plt.show()
