"""Figure 7: losses against the angle, measured and by Eq 23-25."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.figures.style import PALETTE
from fem_impact.paper.drawn import Drawn, Statement, canvas, paths, write_data
from rigid.arrays import Floats
from rigid.experiments import Statistic, angle_sets, drawn_losses, loss_against_angle, statistic

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["figure_7"]

DEGREES = np.linspace(17.0, 60.0, 173)
LOOKS = {"total": ("blue", "o"), "E_lt": ("vermilion", "^"), "E_ln": ("green", "s")}
WORDS = {"total": "total", "E_lt": "tangential $E_{lt}$", "E_ln": "normal $E_{ln}$"}
ENDS = ("calculated", "low", "high")
COLUMNS = ("kind", "alpha_deg", *(f"{name}_{end}_over_E_0" for name in LOOKS for end in ENDS))


def figure_7(out: Path) -> Drawn:
    """Draw measured mean losses with 95 % intervals, and Eq 23-25 with the band of resampled tests."""
    picture, data = paths(out, 7)
    curves, drawn_curves = _curves()
    measured = [_measured(s.recomputed()) for s in angle_sets()]
    write_data(data, COLUMNS, [*_curve_rows(curves, drawn_curves), *_measured_rows(measured)])
    peaks = {name: _peak(curves[name], drawn_curves[name]) for name in ("total", "E_lt")}
    sentence = (
        f"With interpolated coefficients the total loss is largest at {_words(peaks['total'])} degrees and "
        f"the tangential loss at {_words(peaks['E_lt'])} degrees (95 % by resampling the tests; linear "
        "interpolation between measured angles is a choice)."
    )
    with canvas(picture, 4.4, sentence) as drawn:
        axes = drawn.add_subplot()
        for name in LOOKS:
            _draw(axes, name, curves[name], drawn_curves[name], [row[name] for row in measured])
        axes.set(
            xlabel="inclination α, degrees", ylabel="loss as a fraction of $E_0$", xlim=(15, 62), ylim=(0, 1)
        )
        axes.grid()
        handles, labels = axes.get_legend_handles_labels()
        order = (0, 3, 1, 4, 2, 5)  # a column of the legend for each loss: curve above measurement
        legend = [handles[i] for i in order], [labels[i] for i in order]
        drawn.legend(*legend, loc="outside lower center", ncols=3)
    return Drawn(7, picture, data, sentence, _statements(peaks))


def _curves() -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Give the calculated losses and those of imagined repetitions."""
    x = np.radians(DEGREES)
    best, many = loss_against_angle(x), drawn_losses(x)
    return tuple({"total": p.E_ln + p.E_lt, "E_lt": p.E_lt, "E_ln": p.E_ln} for p in (best, many))  # type: ignore[return-value]


def _measured(rows: dict[str, Floats]) -> dict[str, Statistic]:
    """Give the measured losses of one set; the total is what is not kept, so that it assumes no e_m."""
    found = {"total": 1.0 - rows["E_r_over_E_0"], **{k: rows[f"{k}_over_E_0"] for k in ("E_lt", "E_ln")}}
    return {name: statistic(values) for name, values in found.items()}


def _band(many: Floats) -> Floats:
    return np.percentile(many, [2.5, 97.5], axis=0)


def _curve_rows(curves: dict[str, Floats], many: dict[str, Floats]) -> list[list[float | str]]:
    columns = [column for name in LOOKS for column in (curves[name], *_band(many[name]))]
    return [["curve", *map(float, row)] for row in zip(DEGREES, *columns, strict=True)]


def _measured_rows(measured: list[dict[str, Statistic]]) -> list[list[float | str]]:
    rows: list[list[float | str]] = []
    for s, found in zip(angle_sets(), measured, strict=True):
        ends = [x for name in LOOKS for x in (found[name].mean, found[name].low, found[name].high)]
        rows.append(["measured", round(float(np.degrees(s.alpha)), 6), *ends])
    return rows


def _peak(best: Floats, many: Floats) -> tuple[float, float, float]:
    """Give the angle of the largest loss, with its 95 % interval, in degrees."""
    low, high = np.percentile(DEGREES[many.argmax(axis=1)], [2.5, 97.5])
    return float(DEGREES[best.argmax()]), float(low), float(high)


def _draw(axes: Axes, name: str, curve: Floats, many: Floats, measured: list[Statistic]) -> None:
    colour, mark = PALETTE[LOOKS[name][0]], LOOKS[name][1]
    axes.fill_between(DEGREES, *_band(many), color=colour, alpha=0.18, lw=0)
    axes.plot(DEGREES, curve, color=colour, lw=1.5, label=f"{WORDS[name]} by Eq 23-25, 95 % band")
    angles = [float(np.degrees(s.alpha)) for s in angle_sets()]
    means, half = [m.mean for m in measured], [m.high - m.mean for m in measured]
    axes.errorbar(
        angles, means, yerr=half, fmt=mark, color=colour, mec="black", mew=0.5, capsize=3,
        label=f"{WORDS[name]}, measured mean, 95 %",
    )  # fmt: skip


def _words(peak: tuple[float, float, float]) -> str:
    return f"{peak[0]:.1f} ({peak[1]:.1f} to {peak[2]:.1f})"


def _statements(peaks: dict[str, tuple[float, float, float]]) -> tuple[Statement, ...]:
    claims = {
        "total": ("the total loss is largest near 45 degrees", 45.0),
        "E_lt": ("the tangential loss is largest near 50 degrees", 50.0),
    }
    return tuple(
        Statement(claim, f"at {_words(peaks[name])} degrees", abs(peaks[name][0] - near) < 5.0)
        for name, (claim, near) in claims.items()
    )
