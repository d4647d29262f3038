"""Figure 4: the coefficients of repeated tests against each other."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.figures.style import INK, PALETTE, QUIET
from fem_impact.paper.drawn import Drawn, Statement, canvas, paths, write_data
from rigid import coefficients
from rigid.arrays import Floats
from rigid.experiments import Correlation, correlation, correlations, measured_set, statistic

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["figure_4"]

NAMES = {"e": "restitution e", "mu": "impulse ratio μ", "e_m": "moment restitution $e_m$"}
COLUMNS = ("test", "e", "mu", "e_m", "e_printed", "mu_printed", "e_m_printed")
OTHER_ARM = 0.084
"""With this d_c (m) the printed e follow from the velocities; the caption says 0.083."""

Pairs = dict[tuple[str, str], Correlation]


def figure_4(out: Path) -> Drawn:
    """Draw e, mu and e_m of Table 2 against each other, recomputed and as printed.

    Parameters
    ----------
    out : Path
        Directory for picture and data.
    """
    picture, data = paths(out, 4)
    s = measured_set("t2")
    found = {name: s.recomputed()[name] for name in NAMES}
    printed = {name: s.printed[name] for name in NAMES}
    r_found, r_printed = correlations(found), correlations(printed)
    tests = s.printed["test"].astype(int)
    write_data(data, COLUMNS, zip(tests, *found.values(), *printed.values(), strict=True))
    sentence = _sentence(r_found, r_printed)
    with canvas(picture, 3.5, sentence) as drawn:
        panels = drawn.subplots(1, 3)
        for axes, (x, y) in zip(panels, combinations(NAMES, 2), strict=True):
            _panel(axes, found, printed, (x, y), r_found[x, y])
        handles, labels = panels[0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=3, labelcolor=QUIET)
    return Drawn(4, picture, data, sentence, (_statement(r_printed),))


def _panel(
    axes: Axes, found: dict[str, Floats], printed: dict[str, Floats], pair: tuple[str, str], r: Correlation
) -> None:
    x, y = pair
    axes.plot(
        printed[x], printed[y], "o", color=PALETTE["grey"], mfc="none", markersize=5, label="test, as printed"
    )
    axes.plot(
        found[x],
        found[y],
        "o",
        color=PALETTE["blue"],
        markersize=3.2,
        label="test, from velocities with $d_c$ = 83 mm",
    )
    a, b = statistic(found[x]), statistic(found[y])
    bars: dict[str, Any] = {"xerr": a.high - a.mean, "yerr": b.high - b.mean}
    axes.errorbar(a.mean, b.mean, **bars, color=PALETTE["vermilion"], lw=1.8, label="mean, 95 % interval")
    axes.set(xlabel=NAMES[x], ylabel=NAMES[y])
    words = f"r = {r.r:+.2f}   (95 %: {r.low:+.2f} to {r.high:+.2f})"
    axes.set_title(words, fontsize=8.2, weight="normal", color=INK)
    axes.grid()


def _sentence(found: Pairs, printed: Pairs) -> str:
    largest = max(abs(c.r) for c in printed.values())
    first = (
        f"Table 2, 30 tests: as printed, no two coefficients correlate (r at most {largest:.2f} in size); "
    )
    real = [pair for pair, c in found.items() if c.is_significant]
    if not real:
        return f"{first}nor do they when recomputed from the velocities."
    pair = real[0]
    other = _with_the_other_arm()
    verdict = "still do" if other.is_significant else "do not"
    return (
        f"{first}from the velocities {' and '.join(pair)} do weakly (r = {found[pair].r:+.2f}), yet "
        "with the 84 mm "
        f"that give the printed e they {verdict} (r = {other.r:+.2f}): the arm decides, not physics."
    )


def _with_the_other_arm() -> Correlation:
    """Correlate mu and e_m worked out with the d_c that reproduces the printed e."""
    s = measured_set("t2")
    found = coefficients(**s.motion, d_c=OTHER_ARM, d_d=s.arms.d_d, k2=s.k2)
    return correlation(found.mu, found.e_m)


def _statement(printed: Pairs) -> Statement:
    words = ", ".join(f"{x}-{y} {c.r:+.2f} (p = {c.p:.2f})" for (x, y), c in printed.items())
    holds = not any(c.is_significant for c in printed.values())
    return Statement("no significant correlation between the coefficients", words, holds)
