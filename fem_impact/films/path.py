"""Film of a body from its first strike to its last, flights shortened: its outline over the barrier."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from fem_impact.errors import ResultError
from fem_impact.figures.runs import body_line, flies, placed, state_at
from fem_impact.figures.still import PALETTE, new_figure
from fem_impact.films.encode import encode
from fem_impact.films.film import RenderResult, target
from fem_impact.films.movement import FPS
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.strikes import StrikeRecord
from fem_impact.run.common import pull_of
from fem_impact.scene.read import read_toml
from rigid.strikes import FlightState, Outline, outline

FLIGHT, HELD = 1.0, 0.4
"""Seconds of film for the longest flight, and for which a strike stands."""
LEAST = 6
"""Frames of the shortest flight."""
SHOWN = 12
"""Strikes at most: later ones hardly move the body."""
TURNED = "between strikes the body pivots, rolls or slides here: its turn is interpolated"


class _Frame(NamedTuple):
    """A body, the number of strikes before it, and what is told."""

    state: FlightState
    struck: int
    words: str


def render_path(
    result_dir: str | Path, out: str | Path | None = None, size: tuple[int, int] = (1280, 720)
) -> RenderResult:
    """Draw a film of the strikes of a run of any fidelity; see `fem_impact.render` for what it raises.

    Each flight takes at most `FLIGHT` seconds, shorter ones less. Vibration and dents are not shown.
    """
    folder = Path(result_dir)
    outcome = Outcome.read(folder / "outcome.json")
    each = outcome.strikes.each
    if not isinstance(each, tuple):
        raise ResultError(f"{folder}: holds no strikes to film. Run its scene with --until rest.")
    scene = read_toml(folder / "scene.toml")
    shape, pull = outline(scene.projectile.rigid_body), pull_of(scene)
    frames = list(_course(each[:SHOWN], shape, pull))
    path, notes = target(folder, out, "film-path")
    left_out = [f"The film shows {SHOWN} of {len(each)} strikes."] if len(each) > SHOWN else []
    drawn = _drawn(frames, each[:SHOWN], shape, outcome.provenance.scene_title, size)
    return RenderResult(encode(drawn, path, FPS), (*notes, *left_out), len(frames))


def _course(each: Sequence[StrikeRecord], shape: Outline, pull: tuple[float, float]) -> Iterator[_Frame]:
    """Yield the frames from the first strike to the last."""
    states = [state_at(one, shape) for one in each]
    longest = max((b.time - a.time for a, b in pairwise(each)), default=1.0)
    for number, (one, state) in enumerate(zip(each, states, strict=True), 1):
        words = f"strike {number}: {one.part}, {one.approach:.3g} m/s, e = {one.e:.2f} ({one.fidelity})"
        yield from [_Frame(state, number, words)] * round(HELD * FPS)
        if number == len(each):
            return
        begin, end = state._replace(V_n=one.V_n, V_t=one.V_t, Omega=one.Omega), states[number]
        lasts = end.time - begin.time
        free = flies(begin, end, pull, shape)
        for share in np.linspace(0.0, 1.0, max(LEAST, ceil(FLIGHT * FPS * lasts / longest)) + 1)[1:].tolist():
            now = begin.flown(share * lasts, *pull) if free else _between(begin, end, share)
            lies = shape.corners[shape.lowest(now.alpha)].arms(now.alpha)[1]
            height = max(now.height, lies) if free else lies
            yield _Frame(now._replace(height=height), number, "" if free else TURNED)


def _between(begin: FlightState, end: FlightState, share: float) -> FlightState:
    """Return a body a share of the way from one state to another."""
    return FlightState(*((1.0 - share) * one + share * other for one, other in zip(begin, end, strict=True)))


def _drawn(
    frames: Sequence[_Frame], each: Sequence[StrikeRecord], shape: Outline, title: str, size: tuple[int, int]
) -> Iterator[Image.Image]:
    """Yield the pictures."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    line = body_line(shape)
    lines = [1e3 * placed(line, one.state) for one in frames]
    high = max(1e3 * shape.widest, *(float(one[:, 1].max()) for one in lines))
    low, half = -0.2 * high, 0.6 * high * size[0] / size[1]
    figure = new_figure(size[1] / 100, size[0] / 100)
    figure.set_dpi(100)
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.subplots()
    axes.set(aspect="equal", xlim=(-half, half), ylim=(low, high))
    axes.set(xlabel="along the barrier, mm", ylabel="over the barrier, mm")
    axes.set_title(title, fontsize=9, parse_math=False)
    axes.axhspan(low, 0.0, color=PALETTE["sand"], alpha=0.5)
    (body,) = axes.fill(*lines[0].T, facecolor="white", edgecolor=PALETTE["ink"], linewidth=1.5)
    (struck,) = axes.plot([], [], "v", color=PALETTE["vermilion"])
    told = axes.text(0.01, 0.98, "", transform=axes.transAxes, va="top", fontsize=9)
    canvas.draw()
    figure.set_layout_engine("none")  # once is enough, and takes as long as drawing
    for one, now in zip(frames, lines, strict=True):
        body.set_xy(now)
        axes.set_xlim(1e3 * one.state.along - half, 1e3 * one.state.along + half)
        struck.set_data([1e3 * strike.along for strike in each[: one.struck]], [0.0] * one.struck)
        told.set_text(f"{1e3 * one.state.time:.4g} ms\n{one.words}")
        canvas.draw()
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
