"""The worst losses that an impulse ratio up to the critical one can bring."""

from typing import NamedTuple

import numpy as np

from .inputs import ArrayLike, Floats, floats, refuse
from .losses import predicted_losses
from .massive import JAM, critical_ratio, phi

GRID = np.linspace(0.0, 1.0, 513)


class WorstCase(NamedTuple):
    """Largest losses over 0 <= mu <= mu_c: total and tangential (J), each with its mu, and mu_c."""

    total: Floats
    mu_total: Floats
    tangential: Floats
    mu_tangential: Floats
    mu_c: Floats


def worst_case(
    v_n: ArrayLike,
    v_t: ArrayLike,
    *,
    e: ArrayLike,
    e_m: ArrayLike = -1.0,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    mass: ArrayLike,
) -> WorstCase:
    """Largest total and largest tangential loss of an impact whose friction is not known.

    Brach's practical rule takes mu_c for the worst; the two maxima are searched for here (512 steps of mu,
    where a flat maximum is good to 1e-5 of itself), because they need not lie there. While the tip slides one
    way, the tangential loss is the friction heat of a point contact and its largest value an upper
    bound; a deformable rod keeps part of it as vibration. Rigid theory cannot say how much.

    Parameters
    ----------
    v_n, v_t, e, e_m, d_c, d_d, k2, mass : array_like
        As in `predicted_losses`.

    Returns
    -------
    WorstCase
        float64 of the broadcast shape.

    Raises
    ------
    ImpactError
        If mu_c is negative (the tip slides up the slope: state the mirror image), or jams before mu_c.

    Examples
    --------
    >>> worst = worst_case(-1.5, -1.5, e=0.33, d_c=0.0226, d_d=0.035, k2=5.56e-4, mass=0.175)
    >>> f"{worst.total:.3f} J at mu = {worst.mu_total:.2f} of at most {worst.mu_c:.2f}"
    '0.369 J at mu = 0.63 of at most 0.67'
    """
    inputs = np.broadcast_arrays(*floats(v_n, v_t, e, e_m, d_c, d_d, k2, mass))
    v_n, v_t, e, e_m, d_c, d_d, k2, mass = (x[..., None] for x in inputs)
    arms = {"e_m": e_m, "d_c": d_c, "d_d": d_d, "k2": k2}
    mu_c = critical_ratio(v_n, v_t, e=e, **arms)
    refuse(~(mu_c >= 0), "the critical ratio is {value} < 0: the tip slides up the slope", mu_c)
    stiffness = 1.0 + phi(mu=mu_c, **arms)
    refuse(~(stiffness > 0), JAM, stiffness)
    mu = mu_c * GRID
    normal, tangential = predicted_losses(v_n, v_t, e=e, mu=mu, mass=mass, **arms)
    return WorstCase(*_largest(normal + tangential, mu), *_largest(tangential, mu), mu_c[..., 0])


def _largest(loss: Floats, mu: Floats) -> tuple[Floats, Floats]:
    """Largest loss along the last axis, and its mu."""
    at = loss.argmax(axis=-1)[..., None]
    best = np.take_along_axis(mu, at, axis=-1)[..., 0]
    return loss.max(axis=-1), best[()]
