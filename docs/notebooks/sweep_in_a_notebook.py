"""
A sweep in a notebook
=====================

How does the rebound depend on the angle, for the three rods of the tests? You compute twelve impacts with
the reduced model, look at them as a table, and draw restitution and vibration over the angle. All of it was
run when this page was built; at its end the same lines can be downloaded as a Jupyter notebook.

The reduced model (``modal``) takes one to six seconds for the modes of each new rod, and milliseconds for
each further impact.
"""

# %%
# One impact
# ----------
# A scene is loaded by its name; an outcome shows itself as a table of all its numbers with their units.
import fem_impact

scene = fem_impact.load("t5b")
outcome = fem_impact.simulate(scene, "rigid")
outcome

# %%
# Twelve impacts
# --------------
# Every combination of three lengths and four angles. A case that cannot run would be a row with its reason.
found = fem_impact.sweep(
    scene,
    {
        "projectile.length": ["80 mm", "120 mm", "240 mm"],
        "impact.angle": ["15 deg", "30 deg", "45 deg", "60 deg"],
    },
    fidelity="modal",
)
table = found.to_dataframe()
table.pivot(index="impact.angle [deg]", columns="projectile.length [mm]", values="e_edge").round(3)

# %%
# Restitution and vibration over the angle
# ----------------------------------------
# The columns of the table have the names of the `outcome's keys <../../reference/outcome.html>`_:
# ``e_edge`` is the restitution with the arms of the edge, ``E_vib_over_E_0`` the share of the energy that
# stays as vibration.
import matplotlib.pyplot as plt

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
for length, rod in table.groupby("projectile.length [mm]"):
    left.plot(rod["impact.angle [deg]"], rod["e_edge"], "o-", label=f"{length:g} mm")
    right.plot(rod["impact.angle [deg]"], 100 * rod["E_vib_over_E_0"], "o-", label=f"{length:g} mm")
left.set(xlabel="angle, degrees", ylabel="restitution e")
right.set(xlabel="angle, degrees", ylabel="vibration, % of the energy")
right.legend(title="length of the rod")

# %%
# How far to trust it
# -------------------
# Every outcome of the reduced model says how far it is known to lie from finite elements. Where the answer
# depends on less than that, run the case with ``fidelity="solid"``.
longest = found.select({"projectile.length": "240 mm", "impact.angle": "45 deg"})[0].outcome
print("\n".join(one.text for one in longest.validity.limitations[:3]))
