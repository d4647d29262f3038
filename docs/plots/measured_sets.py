"""
Every published test
====================

Restitution over impulse ratio of each test of the thirteen measured sets.
"""

import matplotlib.pyplot as plt

from rigid.experiments import measured_sets

for one in measured_sets():
    plt.scatter(one.printed["mu"], one.printed["e"], s=12, label=one.id)
plt.gca().set(xlabel="impulse ratio mu", ylabel="restitution e", title="every published test")
plt.legend(ncols=2, fontsize="small")
plt.show()
