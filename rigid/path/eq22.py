"""The impulse ratio of a part of the contact (Eq 22), and the threshold of the Painleve paradox."""

import numpy as np

from ..inputs import ArrayLike, Floats, floats


def interval_ratio(
    change_cn: ArrayLike, change_ct: ArrayLike, *, d_c: ArrayLike, d_d: ArrayLike, k2: ArrayLike
) -> Floats:
    """Tangential over normal impulse between two instants of the contact (Eq 22).

    Parameters
    ----------
    change_cn, change_ct : array_like
        Changes of the contact point's normal and tangential velocity, m/s.
    d_c, d_d : array_like
        Arms, m.
    k2 : array_like
        Squared radius of gyration, m2.

    Returns
    -------
    float64 of the broadcast shape, dimensionless

    Examples
    --------
    While the point sticks only its normal velocity changes, and the ratio is d_c d_d/(k^2 + d_d^2):

    >>> f"{interval_ratio(1.0, 0.0, d_c=0.0226, d_d=0.035, k2=5.56e-4):.4f}"
    '0.4441'
    """
    cn, ct, d_c, d_d, k2 = floats(change_cn, change_ct, d_c, d_d, k2)
    coupling = d_c * d_d
    return ((k2 + d_c**2) * ct + coupling * cn) / ((k2 + d_d**2) * cn + coupling * ct)


def painleve_threshold(*, d_c: ArrayLike, d_d: ArrayLike, k2: ArrayLike) -> Floats:
    """Friction mu_P = (k^2 + d_c^2)/(d_c d_d) above which sliding presses the point into the barrier.

    For sliding down the slope; infinite where d_c d_d <= 0, since such sliding can only relieve it.
    Arms (m) and k2 (m2) as everywhere; the result is dimensionless and of the broadcast shape.

    Examples
    --------
    >>> f"{painleve_threshold(d_c=0.0538, d_d=0.1106, k2=4.8226e-3):.3f}"
    '1.297'
    """
    d_c, d_d, k2 = floats(d_c, d_d, k2)
    coupling = d_c * d_d
    with np.errstate(divide="ignore"):
        return np.where(coupling > 0, (k2 + d_c**2) / coupling, np.inf)[()]
