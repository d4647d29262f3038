"""Friction that depends on sliding speed, pressure and temperature: a grid of factors over f at rest."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isclose, prod
from typing import TYPE_CHECKING, Any, Self

from fem_impact.errors import SceneError
from fem_impact.scene.fields import SLIDING as AXES
from fem_impact.scene.fields import check_text
from fem_impact.scene.tables import Table, check_keys, needed
from fem_impact.scene.units import parse_quantity

if TYPE_CHECKING:
    from fem_impact.arrays import Array


MOST = 1000  # numbers of a grid
LARGEST = 10.0  # factor
SpeedTable = tuple[tuple[float, ...], tuple[float, ...]]
"""Sliding speeds, m/s, and the factor of f at each."""


@dataclass(frozen=True, slots=True)
class SlidingLaw:
    """Friction over that at rest, linear between the points of a grid, and constant beyond its ends.

    Attributes
    ----------
    speed : m/s, growing from 0
    factor : of f, one for each temperature, pressure and speed, the first of all 1; the speed runs fastest
    source : where the factors come from
    pressure, temperature : Pa, K, growing; none where friction does not depend on them
    name : of a law that is shipped or added by a package; empty for that of a scene
    """

    speed: tuple[float, ...]
    factor: tuple[float, ...]
    source: str
    pressure: tuple[float, ...] = ()
    temperature: tuple[float, ...] = ()
    name: str = ""

    def __post_init__(self) -> None:
        for axis in AXES:
            points = tuple(float(axis.checked(value)) for value in getattr(self, axis.key))
            object.__setattr__(self, axis.key, points)
            if any(after <= before for before, after in pairwise(points)):
                raise SceneError("must grow from point to point.", key=axis.key)
        check_text(self.source, "source", 1000)
        if len(self.speed) < 2 or self.speed[0] != 0:
            raise SceneError("must have two speeds or more, from 0 on.", key="speed", value=list(self.speed))
        if len(self.factor) != prod(self.shape) or len(self.factor) > MOST:
            wanted = " x ".join(map(str, self.shape))
            problem = f"has {len(self.factor)} numbers, not {wanted} (temperatures, pressures, speeds)."
            raise SceneError(problem, key="factor", remedy=f"Give at most {MOST}.")
        if not all(0 <= value <= LARGEST for value in self.factor):
            raise SceneError(f"must lie from 0 to {LARGEST:g}.", key="factor", value=list(self.factor))
        if not isclose(self.factor[0], 1.0, rel_tol=1e-6):
            raise SceneError(
                "must begin with 1: it is a factor of the surface's f, which holds at the first speed, "
                "pressure and temperature.",
                key="factor",
                value=self.factor[0],
                remedy="Of values of f itself, divide each by the first one.",
            )

    @classmethod
    def of(
        cls,
        friction: Callable[[Array, float, float], Array],
        speed: Sequence[float],
        pressure: Sequence[float] = (),
        temperature: Sequence[float] = (),
        *,
        source: str,
    ) -> Self:
        """Return the law of a function of speeds (n,), m/s, pressure, Pa, and temperature, K.

        Its values (n,) are taken over that at rest, at the first pressure and temperature. Without pressures
        or temperatures the function is given NaN.

        Examples
        --------
        >>> law = SlidingLaw.of(lambda v, p, T: 0.6 / (1 + v), (0.0, 1.0, 3.0), source="an example")
        >>> law.over_speed(1e9, 293.0)
        ((0.0, 1.0, 3.0), (1.0, 0.5, 0.25))
        """
        import numpy as np

        speeds, nan = np.asarray(speed, dtype=np.float64), float("nan")
        rows = [friction(speeds, p, T) for T in temperature or (nan,) for p in pressure or (nan,)]
        values = np.concatenate(rows)
        axes = (tuple(pressure), tuple(temperature))
        return cls(tuple(speed), tuple((values / values[0]).tolist()), source, *axes)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Return the numbers of temperatures, pressures and speeds of the grid."""
        return max(len(self.temperature), 1), max(len(self.pressure), 1), len(self.speed)

    def over_speed(self, pressure: float, temperature: float) -> SpeedTable:
        """Return the factor over the speed at a pressure, Pa, and a temperature, K."""
        import numpy as np

        values: Array = np.reshape(np.array(self.factor), self.shape)
        for points, at in ((self.temperature, temperature), (self.pressure, pressure)):
            place = float(np.interp(at, points, np.arange(len(points)))) if points else 0.0
            low, high = int(place), min(int(place) + 1, len(values) - 1)
            values = values[low] + (place - low) * (values[high] - values[low])
        return self.speed, tuple(values.tolist())


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
