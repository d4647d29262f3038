"""From the table of a law of friction over speed to the law, and back."""

from __future__ import annotations

from typing import Any

from fem_impact.errors import SceneError
from fem_impact.scene.sliding import AXES, SlidingLaw
from fem_impact.scene.tables import Table, check_keys, needed
from fem_impact.scene.units import parse_quantity

EXAMPLE = '{ speed = ["0 m/s", "1 m/s", "5 m/s"], factor = [1, 0.8, 0.6], source = "own tests" }'


def law_of(table: Table, name: str = "") -> SlidingLaw:
    """Return the law of a table: axes with their units, factors in as many levels of lists (SceneError)."""
    check_keys(table, (*(axis.key for axis in AXES), "factor", "source"))
    axes = {}
    for axis in AXES:
        stated = (
            needed(table, axis.key, f"a list, as in {EXAMPLE}")
            if axis.key == "speed"
            else table.get(axis.key, [])
        )
        if not isinstance(stated, list | tuple):
            raise SceneError("must be a list.", key=axis.key, value=stated, remedy=f"As in {EXAMPLE}.")
        axes[axis.key] = tuple(parse_quantity(one, axis.dimension, axis.key) for one in stated)
    import numpy as np

    try:
        factor = np.array(needed(table, "factor", "a number for each speed"), dtype=np.float64)
    except (ValueError, TypeError):
        remedy = "Write a list of numbers for each speed, one such list for each pressure."
        raise SceneError("must be numbers, in rows of one length.", key="factor", remedy=remedy) from None
    lengths = tuple(len(axes[axis.key]) for axis in reversed(AXES) if axes[axis.key])
    if factor.shape != lengths:
        wanted = " lists of ".join(map(str, lengths))
        raise SceneError(
            f"is not {wanted} numbers.", key="factor", remedy="Rows are pressures, then temperatures."
        )
    source = needed(table, "source", '"our own tests", where the factors come from')
    return SlidingLaw(factor=tuple(factor.ravel().tolist()), source=source, name=name, **axes)


def written(law: SlidingLaw) -> str | dict[str, Any]:
    """Return the name of a law, or its table."""
    if law.name:
        return law.name
    import numpy as np

    axes = {axis.key: [axis.write(value) for value in getattr(law, axis.key)] for axis in AXES}
    axes = {key: values for key, values in axes.items() if values}
    shape = [len(axes[axis.key]) for axis in reversed(AXES) if axis.key in axes]
    return {**axes, "factor": np.reshape(law.factor, shape).tolist(), "source": law.source}
