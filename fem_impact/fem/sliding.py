"""The factor of friction at a sliding speed, within compiled loops."""

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import inlined
from fem_impact.scene.sliding import SpeedTable


def speed_table(law: SpeedTable | None) -> Array:
    """Return sliding speeds, m/s, and factors of f as rows (2, n); (2, 0) where f is one number."""
    return np.array(law if law else ((), ()), dtype=np.float64)


@inlined
def factor_at(speed: float, table: Array) -> float:
    """Return the factor of f at a sliding speed, m/s, from a `speed_table`; the last one beyond its end."""
    last = table.shape[1] - 1
    if last < 0:
        return 1.0
    i = 1
    while i < last and table[0, i] < speed:
        i += 1
    share = min((speed - table[0, i - 1]) / (table[0, i] - table[0, i - 1]), 1.0)
    return float(table[1, i - 1] + share * (table[1, i] - table[1, i - 1]))
