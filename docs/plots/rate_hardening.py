"""
Rate hardening of metals
========================

Gain of the flow stress with the plastic strain rate, of four metals of the library.
"""

import matplotlib.pyplot as plt
import numpy as np

from fem_impact.physics.hardening import rate_gain
from fem_impact.scene.library import materials

rate = np.logspace(-2, 5, 71)
for name in ("rod-steel", "plate-steel", "stainless-304", "copper"):
    plt.semilogx(rate, [rate_gain(materials()[name], one) for one in rate], label=name)
plt.gca().set(xlabel="plastic strain rate, 1/s", ylabel="gain of the flow stress")
plt.legend()
plt.show()
