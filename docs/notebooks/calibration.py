"""
Which constants would meet the tests?
=====================================

No constant of this program is fitted to the tests that it is compared with
(`choice of inputs <../../explanation/inputs.html>`_). Here you ask all the same which constants inside their
intervals would meet several sets at once, and what even those would leave over. Nothing on this page is a
default of the program or enters a result.

It stands on response surfaces, polynomials of the uncertain inputs through runs of the finite elements, as
``fem-impact study validation`` writes them to ``surfaces.csv``. The file beside this page holds the sets t5b
and t6-17; name the file of a whole study instead, and the same lines calibrate all thirteen sets.
"""

# %%
# The surfaces
# ------------
# A row holds the surface of one quantity of one set: measured mean ``D`` with its uncertainty ``u_D``, the
# uncertainty ``u_num`` by the mesh, the error of the surface, the ``shift`` from the surface to the limit for
# vanishing elements, and the coefficients.
import numpy as np
import pandas

from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS
from fem_impact.evidence.studies.validated import DRAWN, FRICTION, SEED, ResponseSurface, scaled, unit_sample
from rigid.experiments import measured_set

table = pandas.read_csv("surfaces.csv")
columns = [name for name in table if name.startswith("c")]
table.drop(columns=columns).set_index(["set", "quantity"]).round(4)

# %%
# Shared constants
# ----------------
# The sets share the friction of their surface state, and the inputs that cannot differ from test to test.
# Angle, contact point and speed belong to each set: they stay at the middle of their intervals, and their
# scatter counts as uncertainty.
inputs = [one.name for one in UNCERTAIN_INPUTS]


def of_set(name, source):
    """Return the name of a set's input among the shared constants."""
    return f"{FRICTION}, {measured_set(name).surface}" if source == FRICTION else source


shared = [one.name for one in UNCERTAIN_INPUTS if not one.varies]
constants = [*dict.fromkeys(of_set(name, FRICTION) for name in table["set"]), *shared]
constants


# %%
# How far a choice of constants is from the tests
# -----------------------------------------------
# Each quantity adds ((S - D) / u)\ :sup:`2` with its computed value S, its measured mean D and its
# uncertainty u. Constants run from 0 to 1 over their intervals.
class Judged:
    """One set: its rows, its surface over the shared constants, and the uncertainties (quantities,)."""

    def __init__(self, name, rows):
        self.rows = rows
        self.surface = ResponseSurface(rows[columns].to_numpy().T, 2, rows["surface_error"].to_numpy())
        named = [of_set(name, one) for one in inputs]
        self.pairs = [(i, constants.index(one)) for i, one in enumerate(named) if one in constants]
        own = scaled(name, unit_sample(DRAWN))
        own[:, [column for column, _ in self.pairs]] = 0.5
        parts = rows[["u_num", "u_D", "surface_error"]].to_numpy()
        self.u = np.sqrt((parts**2).sum(axis=1) + self.surface(own).var(axis=0))

    def __call__(self, draws):
        """Return S (n, quantities) at constants (n, constants)."""
        unit = np.full((len(draws), len(inputs)), 0.5)
        for column, source in self.pairs:
            unit[:, column] = draws[:, source]
        return self.surface(unit) + self.rows["shift"].to_numpy()


sets = [Judged(name, rows) for name, rows in table.groupby("set", sort=False)]


def chi2(draws):
    """Return the sum over all quantities (n,)."""
    return sum(np.sum(((one(draws) - one.rows["D"].to_numpy()) / one.u) ** 2, axis=1) for one in sets)


# %%
# Draws from the posterior
# ------------------------
# It is narrow and lies in corners of the intervals, where hardly a draw of a plain sample would fall. So the
# power of the likelihood rises from 0 to 1, each time so far that half of the draws carries the weight (Kish
# 1965); these are drawn again by their weights and moved by Metropolis' rule, with steps as wide as they
# scatter, reflected at the faces of the cube (sequential Monte Carlo: Del Moral, Doucet and Jasra 2006,
# doi:10.1111/j.1467-9868.2006.00553.x).
from scipy.optimize import brentq
from scipy.stats import qmc

DRAWS, MOVES, KEPT = 2048, 12, 0.5


def posterior(chi2, size):
    """Return draws (n, size) from exp(-chi2 / 2) over the unit cube."""
    rng, power = np.random.default_rng(SEED), 0.0
    draws = qmc.Sobol(size, rng=rng).random(DRAWS)
    cost = chi2(draws)
    while power < 1:
        step = rise(cost, 1 - power)
        power += step
        weights = np.exp(-0.5 * step * (cost - cost.min()))
        again = rng.choice(DRAWS, DRAWS, p=weights / weights.sum())
        draws, cost = draws[again], cost[again]
        wide = np.linalg.cholesky(2.38**2 / size * np.atleast_2d(np.cov(draws.T)) + 1e-12 * np.eye(size))
        for _ in range(MOVES):
            moved = 1 - np.abs(1 - np.abs(draws + rng.standard_normal(draws.shape) @ wide.T) % 2)
            other = chi2(moved)
            taken = rng.random(DRAWS) < np.exp(np.minimum(0.5 * power * (cost - other), 0.0))
            draws[taken], cost[taken] = moved[taken], other[taken]
    return draws


def rise(cost, most):
    """Return the rise of the power, at most ``most``, after which `KEPT` of the draws carries the weight."""

    def left(step):
        weights = np.exp(-0.5 * step * (cost - cost.min()))
        return weights.sum() ** 2 / np.sum(weights**2) / len(cost) - KEPT

    return most if left(most) >= 0 else brentq(left, 0.0, most)


# %%
# Where it meets known answers: two narrow bells, one in the middle and one cut off by a face of the cube.
known = posterior(lambda x: ((x[:, 0] - 0.3) / 0.002) ** 2 + ((x[:, 1] - 1) / 0.01) ** 2, 4)
assert abs(known[:, 0].mean() - 0.3) < 2e-4 and abs(known[:, 0].std() - 0.002) < 2e-4
assert abs(known[:, 1].mean() - (1 - 0.01 * np.sqrt(2 / np.pi))) < 1e-3

# %%
# The constants
# -------------
# Mean and standard deviation of each constant over its interval, and the best of the draws.
draws = posterior(chi2, len(constants))
best = draws[chi2(draws).argmin()]
pandas.DataFrame({"mean": draws.mean(axis=0), "sd": draws.std(axis=0), "best": best}, constants).round(3)

# %%
# What even the best constants leave over
# ---------------------------------------
# A quantity is met where measured and computed value differ by less than two uncertainties.
left = pandas.concat(one.rows[["set", "quantity", "D"]].assign(S=one(best[None])[0], u=one.u) for one in sets)
left["met"] = (left["S"] - left["D"]).abs() <= 2 * left["u"]
left.set_index(["set", "quantity"]).round(4)

# %%
# Constants that would be pushed to an end of their interval, and quantities that stay unmet, say that
# something is missing that is no constant of this list.
print(f"{left['met'].sum()} of {len(left)} quantities are met by one choice of constants.")
