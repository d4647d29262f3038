"""Parameters that many problems share, with the rod steel of the study as default."""

from __future__ import annotations

from fem_impact.verify.problem import Parameter, Values, within

__all__ = ["across", "diameter", "elastic", "friction", "length", "slender", "speed"]


def length(default: float = 0.24) -> Parameter:
    """Return the rod's length."""
    return Parameter("length", "length of the rod", default, 0.02, 2.0, "length")


def diameter() -> Parameter:
    """Return the rod's diameter."""
    return Parameter("diameter", "diameter of the rod", 0.019, 1e-3, 0.2, "length")


def elastic(E: float = 219e9, nu: float = 0.29, rho: float = 7850.0) -> tuple[Parameter, ...]:
    """Return Young's modulus, Poisson's ratio and density."""
    return (
        Parameter("E", "Young's modulus", E, 1e6, 2e12, "stress"),
        Parameter("nu", "Poisson's ratio", nu, 0.0, 0.49),
        Parameter("rho", "density", rho, 10.0, 3e4, "density"),
    )


def across(default: int = 8, low: int = 6) -> Parameter:
    """Return the number of cells over the diameter, even."""
    return Parameter("across", "cells over the diameter, even", default, low, 24, multiple=2)


def speed(name: str, words: str, default: float, high: float = 1e3) -> Parameter:
    """Return a speed, above 0."""
    return Parameter(name, words, default, 1e-4, high, "speed")


def friction(default: float) -> Parameter:
    """Return Coulomb's coefficient."""
    return Parameter("f", "Coulomb friction", default, 0.0, 5.0)


def slender(p: Values, across: str, low: float, high: float) -> None:
    """Refuse a length that is not ``low`` to ``high`` times a size across the body.

    Raises
    ------
    SceneError
        If the body is too stubby or too slender.
    """
    within(p, "length", low * p[across], high * p[across], "m", f"{low:g} to {high:g} times the {across}.")
