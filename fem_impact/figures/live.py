"""Pictures for a page with hover and zoom: traces and layouts in Plotly's format, as plain JSON values."""

import math
from typing import Any

import numpy as np

from fem_impact.figures.panels import (
    LOOKS,
    Panel,
    Picture,
    Series,
    ShadedMap,
    error_bars,
    half_widths,
    numbers,
)
from fem_impact.figures.still import INK, QUIET, colour_of, label_sides
from fem_impact.tables.text import markup, plain, with_band

DIGITS = 5
"""Significant digits of the numbers in a page; those of a shaded map have `SHADED`."""

SHADED = 3
WIDE = 2
"""Most decades of a logarithmic axis that has ticks at 2 and 5 too."""

GRID, SHADE = "#e2e5e9", "#eef2f6"
RED_BLUE = [[0.0, "#053061"], [0.25, "#4393c3"], [0.5, "#f7f7f7"], [0.75, "#d6604d"], [1.0, "#67001f"]]


def live(picture: Picture) -> dict[str, Any]:
    """Return a picture as JSON values.

    ``panels`` holds ``title`` and ``alt``, ``height`` in pixels, and ``data`` and ``layout`` in Plotly's
    format; ``legend`` holds a sign, its colour and a label for each name; ``columns`` and ``caption`` are
    those of the picture. Labels are HTML.
    """
    named = {
        series.label: [LOOKS[series.drawn]["sign"], colour_of(series.colour, at), markup(series.label)]
        for panel in reversed(picture.panels)
        for at, series in reversed([*enumerate(panel.series)])
        if series.label
    }
    return {
        "caption": markup(picture.caption),
        "columns": max(1, min(picture.columns, len(picture.panels))),
        "legend": [*reversed(named.values())] if len(named) > 1 else [],
        "panels": [
            {
                "title": markup(panel.title),
                "alt": ", ".join(words for words in (panel.title, panel.y, panel.x) if words),
                "height": _height(panel),
                "data": [
                    *([_map(panel.shaded, panel)] if panel.shaded else []),
                    *(_trace(series, at, panel) for at, series in enumerate(panel.series)),
                ],
                "layout": _layout(panel),
            }
            for panel in picture.panels
        ],
    }


def _height(panel: Panel) -> int:
    if panel.rows:
        return 28 * len(panel.rows) + (90 if panel.x else 66)
    return 420 if panel.shaded else 340


def _trace(series: Series, at: int, panel: Panel) -> dict[str, Any]:
    colour, label = colour_of(series.colour, at), markup(series.label)
    trace: dict[str, Any] = {"x": numbers(series.x, DIGITS), "y": numbers(series.y, DIGITS), "name": label}
    trace |= {"hovertemplate": _hover(label, series, panel), "showlegend": False}
    if series.drawn == "bars":
        texts = {"text": list(series.texts), "textposition": "outside", "cliponaxis": False}
        bar = {"type": "bar", "orientation": "h", "width": 0.7, "marker": {"color": colour}}
        return trace | bar | (texts if series.texts else {})
    look = LOOKS[series.drawn]
    trace |= {"type": "scatter"} | {
        name: part | {"color": colour} if isinstance(part, dict) else part
        for name, part in look["live"].items()
    }
    if series.texts:
        trace |= {"text": list(map(markup, series.texts))}
    if series.drawn == "area":
        trace |= {"fillcolor": colour}
    if series.band is not None:
        values, halves = series.x if panel.horizontal else series.y, half_widths(series)
        trace["customdata"] = [
            ""
            if value is None
            else plain(value, 4)
            if half is None
            else with_band(value, half, *series.ends).replace("+-", "±")
            for value, half in zip(numbers(values), numbers(halves), strict=True)
        ]
        below, above = (numbers(side, DIGITS) for side in error_bars(series, panel.horizontal))
        band: dict[str, Any] = {"type": "data", "array": above, "color": colour}
        band |= {"symmetric": False, "arrayminus": below} if below != above else {}
        band |= look.get("band", {"thickness": 1.2, "width": 3})
        trace["error_x" if panel.horizontal else "error_y"] = band
    return trace


def _hover(label: str, series: Series, panel: Panel) -> str:
    """Return the words at the pointer: the series, and both values with their labels, units and band."""
    if "curve" in LOOKS[series.drawn] and _curves(panel):
        return "%{y:.4g}"
    x, y = ("%{x:.4g}", "%{y:.4g}")
    if panel.horizontal:
        x = x if series.band is None else "%{customdata}"
        return f"<b>{label or '%{y}'}</b><br>{markup(panel.title or panel.x)}: {x}<extra></extra>"
    y = y if series.band is None else "%{customdata}"
    named = "<br>%{text}" if series.texts else ""
    return f"<b>{label}</b>{named}<br>{markup(panel.x)}: {x}<br>{markup(panel.y)}: {y}<extra></extra>"


def _curves(panel: Panel) -> bool:
    return panel.shaded is None and all("curve" in LOOKS[series.drawn] for series in panel.series)


def _map(shaded: ShadedMap, panel: Panel) -> dict[str, Any]:
    return {
        "type": "heatmap",
        "x": numbers(shaded.x, DIGITS),
        "y": numbers(shaded.y, DIGITS),
        "z": [numbers(row, SHADED) for row in np.asarray(shaded.values, float)],
        "zmin": -shaded.limit,
        "zmax": shaded.limit,
        "colorscale": RED_BLUE,
        "colorbar": {
            "title": {"text": markup(shaded.label), "side": "right"},
            "thickness": 12,
            "outlinewidth": 0,
        },
        "hovertemplate": f"{markup(panel.x)}: %{{x:.4g}}<br>{markup(panel.y)}: %{{y:.4g}}<br>%{{z}}"
        "<extra></extra>",
    }


def _layout(panel: Panel) -> dict[str, Any]:
    # the least and the largest x that the panel shows
    at_marks = np.array([mark.at for mark in panel.marks])
    x = np.concatenate([*(np.asarray(series.x, float) for series in panel.series), at_marks])
    x = x[np.isfinite(x)]
    low, high = (float(x.min()), float(x.max())) if len(x) else (0.0, 1.0)
    shapes = [_line("x", mark.at) for mark in panel.marks] + [_line("y", level.at) for level in panel.levels]
    shade = {"fillcolor": SHADE, "line": {"width": 0}, "layer": "below"}
    shapes += [
        {"type": "rect", "x0": part.start, "x1": part.end, "y0": 0, "y1": 1, "yref": "paper", **shade}
        for part in panel.intervals
    ]
    return {
        "font": {"size": 12, "color": INK},
        "margin": {"l": 10, "r": 10, "t": 34, "b": 10},  # the buttons of a figure stand above it
        "paper_bgcolor": "#fff",
        "plot_bgcolor": "#fff",
        "barmode": "stack",
        "hovermode": "x unified" if _curves(panel) else "closest",
        "xaxis": _axis("x", panel),
        "yaxis": _axis("y", panel) | ({"scaleanchor": "x"} if panel.equal else {}),
        "shapes": shapes,
        "annotations": [
            *(
                _note(mark.label, x=mark.at, xanchor=side, textangle=-90, y=1, yref="paper", yanchor="top")
                for mark, side in label_sides(panel.marks, low, high)
            ),
            *(
                _note(level.label, x=0.99, xref="paper", xanchor="right", y=level.at, yanchor="bottom")
                for level in panel.levels
                if level.label
            ),
            *(
                _note(part.label, x=(part.start + part.end) / 2, y=1, yref="paper", yanchor="bottom")
                for part in panel.intervals
            ),
        ],
    }


def _axis(of: str, panel: Panel) -> dict[str, Any]:
    """Return the axis ``of`` x or y."""
    axis: dict[str, Any] = {
        "title": {"text": markup(getattr(panel, of)), "font": {"color": INK}},
        "automargin": True,
        "gridcolor": GRID,
        "linecolor": QUIET,
        "ticks": "outside",
        "tickcolor": QUIET,
        "zeroline": False,
        "exponentformat": "power",
    }
    if ends := getattr(panel, f"{of}_range"):
        axis["range"] = list(ends)
    axis |= {"type": "log"} if panel.logarithmic else {}
    return axis | _names(of, panel) | _decades(of, panel)


def _decades(of: str, panel: Panel) -> dict[str, Any]:
    """Return the ticks of a logarithmic axis in plain digits: powers of ten, with 2 and 5 where few fit."""
    if not panel.logarithmic:
        return {}
    values = np.concatenate([np.asarray(getattr(series, of), float) for series in panel.series])
    values = values[np.isfinite(values) & (values > 0)]
    if not len(values):
        return {}
    low, high = math.floor(math.log10(values.min())), math.ceil(math.log10(values.max()))
    steps = (1,) if high - low > WIDE else (1, 2, 5)
    ticks = [step * 10.0**power for power in range(low, high + 1) for step in steps]
    words = [np.format_float_positional(tick, 1, fractional=False, trim="-") for tick in ticks]
    return {"tickvals": ticks, "ticktext": words}


def _names(of: str, panel: Panel) -> dict[str, Any]:
    """Return the names of an axis's places 0, 1, 2 ...; rows stand from the top."""
    names = panel.names if of == "x" else panel.rows
    if not names:
        return {}
    ticks: dict[str, Any] = {"tickvals": list(range(len(names))), "ticktext": list(map(markup, names))}
    if of == "x":
        return ticks | {"tickangle": -35}
    return ticks | {"range": [len(names) - 0.5, -0.5], "ticks": "", "gridcolor": "#fff"}


def _line(across: str, at: float) -> dict[str, Any]:
    look = {"color": QUIET, "width": 1, "dash": "dot" if across == "x" else "dash"}
    ends = {"x0": at, "x1": at, "y0": 0, "y1": 1} if across == "x" else {"x0": 0, "x1": 1, "y0": at, "y1": at}
    domain = {"yref": "paper"} if across == "x" else {"xref": "paper"}
    return {"type": "line", **ends, **domain, "line": look}


def _note(text: str, **place: Any) -> dict[str, Any]:
    look = {"font": {"size": 10.5, "color": QUIET}, "bgcolor": "rgba(255,255,255,0.8)"}
    return {"text": markup(text), "showarrow": False, **look, **place}
