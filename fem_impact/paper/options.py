"""Rods and quantities as the command line states them."""

from __future__ import annotations

from fem_impact.errors import SceneError, UsageError, did_you_mean
from fem_impact.scene import parse_quantity
from rigid import SHAPES, Projectile, RigidError

__all__ = ["DENSITY", "TIP_RADII", "quantity", "rod_from_options"]

DENSITY = 7850.0
"""Of the measured steel rods, kg/m3."""

TIP_RADII = {"A": 0.007, "B": 0.003, "plain": 0.0}
"""Radius of each measured tip, m (a plain tip has a sharp edge); an added tip has none by default."""

_EXAMPLES = {
    "--diameter": "19 mm",
    "--height": "0.82 m",
    "--angle": "45 deg",
    "--tip-radius": "3 mm",
    "--budget": "30 s",
    "--finest": "0.25 mm",
}


def quantity(text: str, dimension: str, option: str) -> float:
    """Read an option that carries a unit, such as ``--length "240 mm"``; return its SI value."""
    try:
        return parse_quantity(text, dimension, option)
    except SceneError as error:
        example = _EXAMPLES.get(option, "240 mm")
        remedy = f'Write it with its unit, such as {option} "{example}".'
        raise UsageError(error.problem, key=option, value=text, remedy=remedy) from None


def rod_from_options(length: str, diameter: str, tip: str, tip_radius: str | None) -> Projectile:
    """Make the steel rod that ``--length --diameter --tip --tip-radius`` describe.

    Raises
    ------
    UsageError
        A quantity has no unit, the tip is unknown, or it is an added one and has no radius.
    SceneError
        No such rod can be turned.
    """
    radius = _tip_radius(tip, tip_radius)
    size = quantity(length, "length", "--length"), quantity(diameter, "length", "--diameter")
    try:
        return Projectile(*size, tip, radius, DENSITY)
    except RigidError as error:
        remedy = "Change --length, --diameter, --tip or --tip-radius."
        raise SceneError(f"{error}.", key="rod", remedy=remedy) from None


def _tip_radius(tip: str, stated: str | None) -> float:
    """Return the radius of a tip of `SHAPES`, m: the stated one, or that of a measured tip."""
    if tip not in SHAPES:
        remedy = did_you_mean(tip, SHAPES, f"Known are: {', '.join(SHAPES)}.")
        raise UsageError("is no tip.", key="--tip", value=tip, remedy=remedy)
    if stated is not None:
        return quantity(stated, "length", "--tip-radius")
    if tip not in TIP_RADII:
        remedy = 'Give its radius, such as --tip-radius "3 mm".'
        raise UsageError("has no default radius.", key="--tip", value=tip, remedy=remedy)
    return TIP_RADII[tip]
