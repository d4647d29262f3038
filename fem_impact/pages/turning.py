"""A run in three dimensions, to be turned and played in a browser: one page that needs nothing else."""

import base64
from pathlib import Path
from typing import Any

import numpy as np

from fem_impact.errors import UsageError
from fem_impact.figures.live import RED_BLUE
from fem_impact.files.atomic import write_text
from fem_impact.films.film import RenderResult, context
from fem_impact.films.motion import FIELDS, FilmData, prepare, to_points
from fem_impact.films.movement import Span, film_times, read_movement
from fem_impact.films.views import on_symmetry, outer_quads
from fem_impact.pages.html import live_figure, page, sources

FRAMES = 24
"""Moments without a number of frames."""

MOST = 200
"""Moments at most: more make a page too large for a browser."""

HEIGHT = 620  # px
EYE = {"x": -0.8, "y": -2.2, "z": 0.5}
"""Where the camera stands at first: in front of the plane of motion, a little up the slope and above."""
LIGHT = {
    "hovertemplate": "t %{x:.4g}, b %{y:.4g}, n %{z:.4g} mm<extra></extra>",
    "lighting": {"ambient": 0.7, "diffuse": 0.5, "specular": 0.03},
    "lightposition": {"x": -2000, "y": -10000, "z": 6000},
}
COMPACT = 1.6
"""Longest side of what is shown over the mean of the three that this place shows whole."""


def write_view(folder: Path, out: Path, span: Span, field: str) -> RenderResult:
    """Write the page of a run: the whole rod on the barrier, its deformation magnified, at several moments.

    Parameters
    ----------
    folder : Path
        A run with fields.vtkhdf.
    out : Path
        The page.
    span : Span
        Times; 24 moments where it states no number of frames and no speed.
    field : str
        One of `fem_impact.films.motion.FIELDS`.

    Raises
    ------
    ResultError
        The folder holds no readable fields.
    UsageError
        The span cannot be drawn, or has more than 200 moments.
    OutputPathError
        The page cannot be written.
    """
    frames = FRAMES if span.frames is None and span.speed is None else span.frames
    movement, notes = read_movement(folder)
    times = film_times(movement, field, Span(span.first, span.last, frames, span.speed))
    if len(times) > MOST:
        raise UsageError(
            "are too many moments for a page.", key="frames=", value=len(times), remedy=f"Up to {MOST}."
        )
    motion = prepare(movement, field, times)
    (title, made, _, _), style = context(folder), FIELDS[field]
    lead = (
        f"The whole projectile, its deformation magnified {motion.peak:g} times, fading to true size at the "
        f"contact; colours: {style.name}, {style.unit}. Drag to turn, turn the wheel or pinch to come "
        "nearer, drag the slider to move in time."
    )
    body = (live_figure(_shown(motion, times)), sources(["film"]))
    text = page(title, "Run in three dimensions", lead, f"Fields of {folder.name}. {made}", body)
    return RenderResult(write_text(out, text), tuple(notes), len(times))


def _shown(motion: FilmData, times: np.ndarray) -> dict[str, Any]:
    """Return the figure in the form of `fem_impact.figures.live.live`, with its frames."""
    # the points on the outside of the half model, those of the mirrored half after them, and the triangles of
    # both; faces on the plane of motion lie inside
    quads, _ = outer_quads(motion)
    faces = quads[~on_symmetry(motion, quads)][:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    nodes, flat = np.unique(faces, return_inverse=True)
    half = flat.reshape(-1, 3)
    triangles = np.concatenate([half, half[:, ::-1] + len(nodes)])
    states = [_state(motion, time, nodes) for time in times.tolist()]
    names = [f"{1e6 * time:.4g} µs" for time in times.tolist()]
    skin = {name: _packed(triangles[:, at], "i4") for at, name in enumerate("ijk")}
    first = len(states) // 3  # after some waves, so that colours are seen
    style, (low, high) = FIELDS[motion.field], motion.far
    colours = {
        "colorscale": RED_BLUE if style.signed else style.colours,
        "reversescale": not style.signed,  # Plotly's scales of these names run from dark to light
        "cmin": low,
        "cmax": high,
        "colorbar": {"orientation": "h", "y": 1.0, "yanchor": "bottom", "thickness": 10, "len": 0.6},
    }
    panel = {
        "title": "",
        "alt": "the projectile on the barrier, to be turned",
        "height": HEIGHT,
        "data": [{**skin, **states[first], **colours, **LIGHT}],
        "layout": _layout(names, first, _eye(motion, times, nodes)),
        "frames": [{"name": name, "data": [state]} for name, state in zip(names, states, strict=True)],
    }
    return {"caption": "", "columns": 1, "legend": [], "panels": [panel]}


def _state(motion: FilmData, time: float, nodes: np.ndarray) -> dict[str, Any]:
    """Return places, mm, and colours of both halves at a time."""
    _, shown = motion.positions(time)
    colours = motion.colours(time)
    if len(colours) == len(motion.fields.cells):
        colours = to_points(motion.fields.cells, colours, len(shown))
    half = 1e3 * shown[nodes]
    both = np.concatenate([half, half * [1.0, -1.0, 1.0]])
    places = {name: _packed(both[:, at], "f4") for at, name in enumerate("xyz")}
    return {"type": "mesh3d", **places, "intensity": _packed(np.tile(colours[nodes], 2), "f4")}


def _eye(motion: FilmData, times: np.ndarray, nodes: np.ndarray) -> dict[str, float]:
    """Return where the camera sees all: Plotly draws a long body larger."""
    places = np.concatenate([motion.positions(time)[1][nodes] for time in (times[0], times[-1])])
    sides = np.ptp(places, axis=0) * [1.0, 2.0, 1.0]  # both halves
    away = max(1.0, float(sides.max() / np.prod(sides) ** (1 / 3)) / COMPACT)
    return {axis: place * away for axis, place in EYE.items()}


def _packed(values: np.ndarray, kind: str) -> dict[str, str]:
    """Return an array as Plotly reads it: little-endian numbers in base64."""
    return {"dtype": kind, "bdata": base64.b64encode(values.astype(f"<{kind}").tobytes()).decode()}


def _layout(names: list[str], first: int, eye: dict[str, float]) -> dict[str, Any]:
    at_once = {"mode": "immediate", "frame": {"duration": 0, "redraw": True}, "transition": {"duration": 0}}
    steps = [{"label": name, "method": "animate", "args": [[name], at_once]} for name in names]
    play = {"frame": {"duration": 120, "redraw": True}, "transition": {"duration": 0}, "fromcurrent": True}
    buttons = [
        {"label": "play", "method": "animate", "args": [None, play]},
        {"label": "stop", "method": "animate", "args": [[None], at_once]},
    ]
    axes = {
        f"{axis}axis": {"title": {"text": f"{name}, mm"}, "nticks": ticks}
        for axis, name, ticks in zip("xyz", "tbn", (0, 3, 0), strict=True)  # across a rod there is no room
    }
    slider = {"currentvalue": {"prefix": "time "}, "x": 0.0, "len": 1.0, "pad": {"t": 45, "l": 10, "r": 10}}
    place = {"x": 0.0, "y": 0.0, "xanchor": "left", "yanchor": "top", "pad": {"t": 8}}
    return {
        "margin": {"l": 0, "r": 0, "t": 40, "b": 130},
        "scene": {**axes, "aspectmode": "data", "camera": {"eye": eye}, "dragmode": "orbit"},
        "sliders": [{**slider, "steps": steps, "active": first, "font": {"size": 10}}],
        "updatemenus": [{**place, "type": "buttons", "direction": "left", "buttons": buttons}],
    }
