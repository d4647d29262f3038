"""Pictures of a body that strikes on: its path with the strikes, and where its energy went."""

from collections.abc import Sequence
from itertools import pairwise
from math import ceil

import numpy as np

from fem_impact.arrays import Array
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.outcome.strikes import StrikeRecord
from rigid.strikes import Outline, State

SHOWN = 3
"""Strikes that the path shows at most: later ones lie on each other."""
FRAMES = 3  # between two strikes
ARC = 0.1  # rad between points of an arc
FREE = 0.02
"""Height, over the width of the body, by which a flight may miss the next strike; more is no free flight."""


def path_picture(each: Sequence[StrikeRecord], shape: Outline, gravity: tuple[float, float]) -> Picture:
    """Return the body at its strikes and in the flights between them, as a stroboscope shows it.

    Parameters
    ----------
    each : strikes from the first on
    shape : outline of the body about its mass centre
    gravity : accelerations out of -n and -t, m/s2
    """
    shown, line = each[:SHOWN], body_line(shape)
    states = [state_at(one, shape) for one in shown]
    flights = [
        before.flown(share * (after.time - before.time), *gravity)
        for before, after in pairwise(
            state._replace(V_n=one.V_n, V_t=one.V_t, Omega=one.Omega)
            for state, one in zip(states, shown, strict=True)
        )
        if flies(before, after, gravity, shape)
        for share in np.linspace(0.0, 1.0, FRAMES + 2)[1:-1].tolist()
    ]
    struck, flown = _bodies(line, states), _bodies(line, flights)
    places = Series(
        "place of the strike",
        [1e3 * one.along for one in shown],
        [0.0] * len(shown),
        "triangles",
        "vermilion",
        texts=tuple(f"strike {k}: {one.part}, {one.approach:.3g} m/s" for k, one in enumerate(shown, 1)),
    )
    bodies = (Series("in flight", *flown, "thin", "grey"), Series("at a strike", *struck, "line", "ink"))
    title = f"first {len(shown)} of {len(each)} strikes" if len(each) > len(shown) else ""
    panel = Panel(title, "along the barrier, mm", "over the barrier, mm", (*bodies, places), equal=True)
    caption = "The body at its strikes and at even times between them; flights alone are shown in between."
    return Picture("path", caption, (panel,), 1)


def tail_picture(curve: tuple[Sequence[float], Sequence[float]], own: tuple[float, float]) -> Picture:
    """Return how many times as fast as the first the other end strikes over the inclination, rad.

    ``curve`` is that of a rigid body, ``own`` the place of a run.
    """
    lines = (
        Series("rigid theory, other values as stated", np.degrees(curve[0]), curve[1], "line", "ink"),
        Series("this run", [np.degrees(own[0])], [own[1]], "triangles", "vermilion"),
    )
    panel = Panel(
        "", "angle between axis and normal, degrees", "speed of the other end over the first", lines
    )
    caption = (
        "The hardest strike of the other end beside the first strike; above 1 the other end comes faster."
    )
    return Picture("other-end", caption, (panel,), 1)


def accounts_picture(each: Sequence[StrikeRecord]) -> Picture:
    """Return where the energy is after each strike, J, stacked."""
    number = np.arange(1, len(each) + 1)
    sums = {
        "friction": ("green", np.cumsum([one.friction for one in each])),
        "plastic": ("vermilion", np.cumsum([one.plastic for one in each])),
        "damping and other": ("sand", np.cumsum([one.damping + one.other for one in each])),
        "vibration": ("night", np.array([one.vibration for one in each])),
        "motion": ("blue", np.array([one.after for one in each])),
    }
    areas = tuple(Series(name, number, values, "area", colour) for name, (colour, values) in sums.items())
    panel = Panel("", "strike", "energy, J", areas)
    caption = "Energy after each strike; its sum grows by what gravity gives, less friction between strikes."
    return Picture("strikes", caption, (panel,), 1)


def state_at(one: StrikeRecord, shape: Outline) -> State:
    """Return the body at a strike; ways count from the first place of contact."""
    d_c, d_d = shape.corners[shape.lowest(one.alpha, one.omega)].arms(one.alpha)
    return State(one.time, d_d, one.along + d_c, one.alpha, one.v_n, one.v_t, one.omega)


def flies(before: State, after: State, gravity: tuple[float, float], shape: Outline) -> bool:
    """Return whether a body flew freely from one strike to the next, rather than pivot or slide."""
    end = before.flown(after.time - before.time, *gravity)
    near = FREE * shape.widest
    return abs(end.height - after.height) < near and abs(end.along - after.along) < near


def body_line(shape: Outline) -> Array:
    """Return the closed outline (k, 2), (x, z), m, about the mass centre."""
    places = [
        one.place(angle)
        for one in shape.corners
        for angle in (
            np.linspace(one.low, one.high, 2 + ceil((one.high - one.low) / ARC)).tolist()
            if one.radius
            else [one.low]
        )
    ]
    return np.array([*places, places[0]])


def placed(line: Array, state: State) -> Array:
    """Return an outline (k, 2), (x, z), m, about the mass centre as it lies along and over the barrier, m."""
    c, s = np.cos(state.alpha), np.sin(state.alpha)
    return np.column_stack([state.along + line @ (c, s), state.height + line @ (-s, c)])


def _bodies(line: Array, states: Sequence[State]) -> tuple[Array, Array]:
    """Return all bodies as one line with gaps, along and over the barrier, mm."""
    gap = np.full((1, 2), np.nan)
    rows = [part for state in states for part in (1e3 * placed(line, state), gap)]
    along, over = np.concatenate(rows or [gap[:0]]).T
    return along, over
