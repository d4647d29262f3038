"""Figure 5: critical and measured impulse ratio against the angle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.figures.style import PALETTE, QUIET
from fem_impact.paper.drawn import Drawn, Statement, canvas, paths, write_data
from rigid import critical_ratio
from rigid.arrays import Floats
from rigid.experiments import MeasuredSet, angle_sets, at_angle, critical_ratio_against_angle

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["figure_5"]

FRICTION = 0.57
"""Sliding friction of steel on steel that the paper quotes (its footnote 2)."""

CONTACT = 0.5e-3
"""Error of the contact point, m."""

COLUMNS = ("alpha_deg", "mu_mean", "mu_low", "mu_high", "mu_c", "mu_c_low", "mu_c_high")


def figure_5(out: Path) -> Drawn:
    """Draw mean mu with its 95 % interval, and mu_c with the range that e and the contact point leave."""
    picture, data = paths(out, 5)
    sets = angle_sets()
    rows = [_row(s, mu_c) for s, mu_c in zip(sets, critical_ratio_against_angle()[0], strict=True)]
    write_data(data, COLUMNS, rows)
    table = np.array(rows)
    sentence = _sentence(table)
    with canvas(picture, 4.2, sentence) as drawn:
        axes = drawn.add_subplot()
        _curve(axes, sets[0].k2)
        _points(axes, table)
        axes.axhline(FRICTION, color=QUIET, linewidth=0.9, linestyle=(0, (5, 3)))
        axes.text(16.2, FRICTION + 0.012, "f = 0.57, handbook", color=QUIET, fontsize=8)
        axes.set(xlabel="inclination α, degrees", ylabel="impulse ratio", xlim=(15, 62), ylim=(0, 1.25))
        axes.grid()
        axes.legend(loc="upper left")
    return Drawn(5, picture, data, sentence, _statements(table))


def _row(s: MeasuredSet, mu_c: float) -> list[float]:
    """Give one line of the data."""
    mu, e = s.statistics()["mu"], s.statistics()["e"]
    low, high = _critical_range(s, e.low, e.high)
    return [round(float(np.degrees(s.alpha)), 6), mu.mean, mu.low, mu.high, float(mu_c), low, high]


def _critical_range(s: MeasuredSet, e_low: float, e_high: float) -> tuple[float, float]:
    """Give the least and largest mu_c over the interval of e and the error of the contact point."""
    mean = s.statistics()
    shift = CONTACT * np.array([-1.0, 1.0])
    given: dict[str, Any] = {"d_c": s.arms.d_c + shift, "d_d": (s.arms.d_d + shift)[:, None], "k2": s.k2}
    e = np.array([e_low, e_high])[:, None, None]
    values = critical_ratio(mean["v_n"].mean, mean["v_t"].mean, e=e, **given)
    return float(values.min()), float(values.max())


def _curve(axes: Axes, k2: float) -> None:
    """Draw mu_c between the measured angles, with interpolated e and arms."""
    degrees = np.linspace(17, 60, 173)
    x = np.radians(degrees)
    at = at_angle(x)
    mu_c = critical_ratio(-np.cos(x), -np.sin(x), e=at.e, d_c=at.d_c, d_d=at.d_d, k2=k2)
    axes.plot(
        degrees, mu_c, color=PALETTE["orange"], linewidth=1.3, label="between them, e and arms interpolated"
    )


def _points(axes: Axes, table: Floats) -> None:
    alpha, mu, mu_low, mu_high, mu_c, c_low, c_high = table.T
    critical: dict[str, Any] = {"fmt": "s", "color": PALETTE["orange"], "markersize": 4.5, "capsize": 3}
    words = r"critical ratio $\mu_c$: e within its 95 % interval, contact point ± 0.5 mm"
    axes.errorbar(alpha, mu_c, yerr=(mu_c - c_low, c_high - mu_c), **critical, label=words)
    measured: dict[str, Any] = {"fmt": "o", "color": PALETTE["blue"], "markersize": 5, "capsize": 3}
    axes.errorbar(
        alpha, mu, yerr=(mu - mu_low, mu_high - mu), **measured, label="measured mean μ, 95 % interval"
    )


def _sentence(table: Floats) -> str:
    alpha, mu, _, _, mu_c, _, _ = table.T
    ratios = ", ".join(f"{r:.2f}" for r in (mu / mu_c)[:3])
    degrees = ", ".join(f"{a:.0f}" for a in alpha[:3])
    return (
        f"Up to 37 degrees the measured ratio is at the critical one or above it ({ratios} of it at "
        f"{degrees} "
        f"degrees: the tip stops and slides back), at 45 and 60 degrees it stays below (μ = {mu[3]:.2f} and "
        f"{mu[4]:.2f}, near f = 0.57)."
    )


def _statements(table: Floats) -> tuple[Statement, ...]:
    _, mu, mu_low, mu_high, mu_c, c_low, c_high = table.T
    ratio = mu[:3] / mu_c[:3]
    near = Statement(
        "below 45 degrees the ratio follows the critical one",
        f"{', '.join(f'{r:.2f}' for r in ratio)} of it; the tip reverses, so it may exceed it",
        bool(np.all(np.abs(ratio - 1) < 0.25)),
    )
    limit = Statement(
        "the ratio can never exceed the critical one (Brach)",
        f"at 17 and 25 degrees its whole 95 % interval lies above: from {mu_low[0]:.3f} against at most "
        f"{c_high[0]:.3f}, from {mu_low[1]:.3f} against at most {c_high[1]:.3f}",
        not bool(np.any(mu_low[:2] > c_high[:2])),
    )
    sliding = Statement(
        "at 45 and 60 degrees it is the sliding friction, f = 0.57",
        ", ".join(
            f"μ = {m:.3f} ({lo:.3f} to {hi:.3f})"
            for m, lo, hi in zip(mu[3:], mu_low[3:], mu_high[3:], strict=True)
        ),
        bool(np.all((mu_low[3:] <= FRICTION) & (mu_high[3:] >= FRICTION) & (mu[3:] < c_low[3:]))),
    )
    return near, limit, sliding
