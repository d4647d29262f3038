"""Sensitivity of any formula to its inputs, by central differences."""

from collections.abc import Callable, Mapping

import numpy as np

from ..arrays import Floats

STEP = float(np.finfo(np.float64).eps) ** (1 / 3)


def sensitivities(
    formula: Callable[..., Mapping[str, Floats]], at: Mapping[str, Floats]
) -> dict[str, dict[str, Floats]]:
    """Return the derivatives d(output)/d(input) of every output of `formula`.

    Parameters
    ----------
    formula : callable
        Takes the inputs by keyword and gives outputs by name.
    at : mapping of str to float64
        Inputs; arrays are differentiated entry by entry.

    Returns
    -------
    dict of dict of float64
        ``result[output][input]``, exact to about ten digits for smooth formulas.

    Examples
    --------
    >>> slope = sensitivities(lambda x, y: {"z": x * y**2}, {"x": np.array(2.0), "y": np.array(3.0)})
    >>> f"{slope['z']['x']:.6f} {slope['z']['y']:.6f}"
    '9.000000 12.000000'
    """
    result: dict[str, dict[str, Floats]] = {}
    for name, value in at.items():
        step = STEP * np.maximum(np.abs(value), 1e-3)
        high, low = (formula(**{**at, name: value + sign * step}) for sign in (1, -1))
        for output in high:
            result.setdefault(output, {})[name] = (high[output] - low[output]) / (2 * step)
    return result
