"""Figures 4 and 5: coefficients of repeated tests against each other; mu and mu_c against the angle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_impact.evidence.paper.drawn import Drawn, Statement, canvas
from fem_impact.figures.style import INK, PALETTE, QUIET, write_data
from rigid import Errors, coefficients, critical_ratio, experiments
from rigid.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes


NAMES = {"e": "restitution e", "mu": "impulse ratio μ", "e_m": "moment restitution $e_m$"}
COLUMNS_4 = ("test", "e", "mu", "e_m", "e_printed", "mu_printed", "e_m_printed")
OTHER_ARM = 0.084
"""With this d_c (m) the printed e follow from the velocities; the caption says 0.083."""

FRICTION = 0.57
"""Sliding friction of steel on steel that the paper quotes (its footnote 2)."""

COLUMNS_5 = ("alpha_deg", "mu_mean", "mu_low", "mu_high", "mu_c", "mu_c_low", "mu_c_high")

Pairs = dict[tuple[str, str], experiments.Correlation]


def figure_4(out: Path) -> Drawn:
    """Draw e, mu and e_m of Table 2 against each other, recomputed and as printed.

    Parameters
    ----------
    out : Path
        Directory for picture and data.
    """
    picture = out / "figure-4.png"
    s = experiments.measured_set("t2")
    recomputed = {name: s.recomputed()[name] for name in NAMES}
    printed = {name: s.printed[name] for name in NAMES}
    r_recomputed, r_printed = experiments.correlations(recomputed), experiments.correlations(printed)
    tests = s.printed["test"].astype(int)
    write_data(picture, COLUMNS_4, zip(tests, *recomputed.values(), *printed.values(), strict=True))
    sentence = _sentence_4(s, r_recomputed, r_printed)
    with canvas(picture, 3.5, sentence) as drawn:
        panels = drawn.subplots(1, 3)
        for axes, (pair, r) in zip(panels, r_recomputed.items(), strict=True):
            _panel(axes, recomputed, printed, pair, r)
        handles, labels = panels[0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=3, labelcolor=QUIET)
    values = ", ".join(f"{x}-{y} {c.r:+.2f} (p = {c.p:.2f})" for (x, y), c in r_printed.items())
    holds = not any(c.is_significant for c in r_printed.values())
    statement = Statement("no significant correlation between the coefficients", values, holds)
    return Drawn(4, picture, sentence, (statement,))


def _panel(
    axes: Axes,
    recomputed: dict[str, Floats],
    printed: dict[str, Floats],
    pair: tuple[str, str],
    r: experiments.Correlation,
) -> None:
    x, y = pair
    dots: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    rings = {**dots, "color": PALETTE["grey"], "mfc": "none", "markersize": 5}
    axes.plot(printed[x], printed[y], **rings, label="test, as printed")
    label = "test, from velocities with $d_c$ = 83 mm"
    axes.plot(recomputed[x], recomputed[y], **dots, color=PALETTE["blue"], markersize=3.2, label=label)
    a, b = experiments.statistic(recomputed[x]), experiments.statistic(recomputed[y])
    bars: dict[str, Any] = {"xerr": a.high - a.mean, "yerr": b.high - b.mean}
    axes.errorbar(a.mean, b.mean, **bars, color=PALETTE["vermilion"], lw=1.8, label="mean, 95 % interval")
    axes.set(xlabel=NAMES[x], ylabel=NAMES[y])
    title = f"r = {r.r:+.2f}   (95 %: {r.low:+.2f} to {r.high:+.2f})"
    axes.set_title(title, fontsize=8.2, weight="normal", color=INK)
    axes.grid()


def _sentence_4(s: experiments.MeasuredSet, recomputed: Pairs, printed: Pairs) -> str:
    largest = max(abs(c.r) for c in printed.values())
    first = (
        f"Table 2, 30 tests: as printed, no two coefficients correlate (r at most {largest:.2f} in size); "
    )
    real = [pair for pair, c in recomputed.items() if c.is_significant]
    if not real:
        return f"{first}nor do they when recomputed from the velocities."
    pair = real[0]
    ratios = coefficients(**s.motion, **{**s.body, "d_c": OTHER_ARM})
    other = experiments.correlation(ratios.mu, ratios.e_m)
    verdict = "still do" if other.is_significant else "do not"
    return (
        f"{first}from the velocities {' and '.join(pair)} do weakly (r = {recomputed[pair].r:+.2f}), yet "
        "with the 84 mm "
        f"that give the printed e they {verdict} (r = {other.r:+.2f}): the arm decides, not physics."
    )


def figure_5(out: Path) -> Drawn:
    """Draw mean mu with its 95 % interval, and mu_c with the range that e and the contact point leave."""
    picture = out / "figure-5.png"
    sets = experiments.angle_sets()
    rows = [
        _row(s, mu_c) for s, mu_c in zip(sets, experiments.critical_ratio_against_angle()[0], strict=True)
    ]
    write_data(picture, COLUMNS_5, rows)
    table = np.array(rows)
    sentence = _sentence_5(table)
    with canvas(picture, 4.2, sentence) as drawn:
        axes = drawn.add_subplot()
        # draw mu_c between the measured angles, with interpolated e and arms
        degrees = np.linspace(17, 60, 173)
        x = np.radians(degrees)
        at = experiments.at_angle(x)
        mu_c = critical_ratio(-np.cos(x), -np.sin(x), e=at.e, d_c=at.d_c, d_d=at.d_d, k2=sets[0].k2)
        between = "between them, e and arms interpolated"
        axes.plot(degrees, mu_c, color=PALETTE["orange"], linewidth=1.3, label=between)
        alpha, mu, mu_low, mu_high, mu_c, c_low, c_high = table.T
        critical: dict[str, Any] = {"fmt": "s", "color": PALETTE["orange"], "markersize": 4.5, "capsize": 3}
        label = r"critical ratio $\mu_c$: e within its 95 % interval, contact point ± 0.5 mm"
        axes.errorbar(alpha, mu_c, yerr=(mu_c - c_low, c_high - mu_c), **critical, label=label)
        measured: dict[str, Any] = {"fmt": "o", "color": PALETTE["blue"], "markersize": 5, "capsize": 3}
        axes.errorbar(
            alpha, mu, yerr=(mu - mu_low, mu_high - mu), **measured, label="measured mean μ, 95 % interval"
        )
        axes.axhline(FRICTION, color=QUIET, linewidth=0.9, linestyle=(0, (5, 3)))
        axes.text(16.2, FRICTION + 0.012, "f = 0.57, handbook", color=QUIET, fontsize=8)
        axes.set(xlabel="inclination α, degrees", ylabel="impulse ratio", xlim=(15, 62), ylim=(0, 1.25))
        axes.grid()
        axes.legend(loc="upper left")
    return Drawn(5, picture, sentence, _statements(table))


def _row(s: experiments.MeasuredSet, mu_c: float) -> list[float]:
    """Return one row of `COLUMNS_5`."""
    mean = s.statistics()
    mu, e = mean["mu"], np.array([mean["e"].low, mean["e"].high])[:, None, None]
    # least and largest mu_c over the interval of e and the error of the contact point
    shift = Errors().contact * np.array([-1.0, 1.0])
    given: dict[str, Any] = {"d_c": s.arms.d_c + shift, "d_d": (s.arms.d_d + shift)[:, None], "k2": s.k2}
    critical = critical_ratio(mean["v_n"].mean, mean["v_t"].mean, e=e, **given)
    ends = float(critical.min()), float(critical.max())
    return [round(float(np.degrees(s.alpha)), 6), mu.mean, mu.low, mu.high, float(mu_c), *ends]


def _sentence_5(table: Floats) -> str:
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
