"""Two-mesh bands: how far a quantity may be from its limit for vanishing elements."""

from __future__ import annotations

from fem_impact.compare import BANDED
from fem_impact.outcome import Outcome

EXTRA = ("e_edge", "e_impulse")


def bands(fine: Outcome, coarse: Outcome) -> dict[str, float]:
    """Return |fine - coarse| / (r - 1) for each banded quantity, r the ratio of tip sizes.

    This is Richardson's estimate of the fine mesh's error for first-order convergence, the order that
    contact and yielding show; for higher orders it is too wide, never too narrow.
    """
    return {key: abs(limit - fine[key]) for key, limit in limits(fine, coarse).items()}


def limits(fine: Outcome, coarse: Outcome) -> dict[str, float]:
    """Return the limit for vanishing elements of each banded quantity, if it converges to first order."""
    r = coarse["tip_size_m"] / fine["tip_size_m"]
    keys = [k for k in (*BANDED, *EXTRA) if fine[k] is not None and coarse[k] is not None]
    return {key: fine[key] + (fine[key] - coarse[key]) / (r - 1) for key in keys}
