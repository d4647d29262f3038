"""The paper's figures 4 to 7 by number, drawn anew: coefficients, impulse ratios and losses of its tests."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from fem_impact.evidence.paper.drawn import Drawn, Statement, canvas
from fem_impact.figures.still import INK, PALETTE, QUIET, write_data
from rigid import Errors, coefficients, critical_ratio, experiments, predicted_losses
from rigid.inputs import Floats

NAMES = {"e": "restitution e", "mu": "impulse ratio μ", "e_m": "moment restitution $e_m$"}
COLUMNS_4 = ("test", "e", "mu", "e_m", "e_printed", "mu_printed", "e_m_printed")
OTHER_ARM = 0.084
"""With this d_c (m) the printed e follow from the velocities; the caption says 0.083."""

FRICTION = 0.57
"""Sliding friction of steel on steel that the paper quotes (its footnote 2)."""

COLUMNS_5 = ("alpha_deg", "mu_mean", "mu_low", "mu_high", "mu_c", "mu_c_low", "mu_c_high")

Pairs = dict[tuple[str, str], experiments.Correlation]


def figure_4(out: Path) -> Drawn:
    """Draw e, mu and e_m of Table 2 against each other, recomputed and as printed."""
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
        f"with the 84 mm that give the printed e they {verdict} (r = {other.r:+.2f}): the arm decides, not "
        "physics."
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
        label = "measured mean μ, 95 % interval"
        axes.errorbar(alpha, mu, yerr=(mu - mu_low, mu_high - mu), **measured, label=label)
        axes.axhline(FRICTION, color=QUIET, linewidth=0.9, linestyle=(0, (5, 3)))
        axes.text(16.2, FRICTION + 0.012, "f = 0.57, handbook", color=QUIET, fontsize=8)
        axes.set(xlabel="inclination α, degrees", ylabel="impulse ratio", xlim=(15, 62), ylim=(0, 1.25))
        axes.grid()
        axes.legend(loc="upper left")
    return Drawn(5, picture, sentence, _statements_5(table))


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
        f"{degrees} degrees: the tip stops and slides back), at 45 and 60 degrees it stays below (μ = "
        f"{mu[3]:.2f} and {mu[4]:.2f}, near f = 0.57)."
    )


def _statements_5(table: Floats) -> tuple[Statement, ...]:
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


MU = np.linspace(0.0, 1.2, 241)
COLOURS = ("blue", "sky", "green", "orange", "vermilion")
LOSS = ("loss_over_E_0", "loss_low_over_E_0", "loss_high_over_E_0", "E_lt_over_E_0")
COLUMNS_6 = ("alpha_deg", "mu", *LOSS, "mu_c")

DEGREES = np.linspace(17.0, 60.0, 173)
LOOKS = {"total": ("blue", "o"), "E_lt": ("vermilion", "^"), "E_ln": ("green", "s")}
LABELS = {"total": "total", "E_lt": "tangential $E_{lt}$", "E_ln": "normal $E_{ln}$"}
ENDS = ("calculated", "low", "high")
COLUMNS_7 = ("kind", "alpha_deg", *(f"{name}_{end}_over_E_0" for name in LOOKS for end in ENDS))


def figure_6(out: Path) -> Drawn:
    """Draw the total loss against mu at the five angles, with the measured e and e_m of each."""
    picture = out / "figure-6.png"
    curves = [_curve(s) for s in experiments.angle_sets()]
    rows = []
    for curve in curves:
        total = curve["total"]
        columns = zip(MU, total[0], total.min(axis=0), total.max(axis=0), curve["tangential"], strict=True)
        rows += [[round(curve["alpha"], 6), *map(float, row), curve["mu_c"]] for row in columns]
    write_data(picture, COLUMNS_6, rows)
    share = [curve["share"] for curve in curves]
    sentence = (
        f"At the critical ratio the predicted total loss is {100 * min(share):.0f} to "
        f"{100 * max(share):.0f} % of the largest for any ratio up to it; beyond it (dotted) the loss falls "
        "and would end in a gain."
    )
    with canvas(picture, 4.6, sentence) as drawn:
        axes = drawn.add_subplot()
        for curve, s, colour in zip(curves, experiments.angle_sets(), COLOURS, strict=True):
            _draw_6(axes, curve, s, PALETTE[colour])
        axes.axhline(0.0, color=QUIET, linewidth=0.7)
        axes.set(xlabel="impulse ratio μ", ylabel="total loss $(E_{ln} + E_{lt})/E_0$")
        axes.set(xlim=(0, 1.2), ylim=(-0.06, 1.0))
        axes.grid()
        axes.plot([], [], "s", color=QUIET, label="critical ratio")
        axes.errorbar([], [], xerr=[], yerr=[], fmt="o", color=QUIET, mec="black", label="measured, 95 %")
        axes.plot([], [], color=QUIET, ls=(0, (1, 1.6)), label=r"beyond $\mu_c$")
        title = "band: 95 % interval of mean e"
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.03), title=title, title_fontsize=8)
    return Drawn(6, picture, sentence, _statements_6(share, curves))


def _curve(s: experiments.MeasuredSet) -> dict[str, Any]:
    """Return loss against mu of one set, with the band of the 95 % interval of its mean e.

    ``share`` is the loss at mu_c over the largest loss at mu <= mu_c.
    """
    mean = s.statistics()
    motion = mean["v_n"].mean, mean["v_t"].mean
    mass = 2.0 / (motion[0] ** 2 + motion[1] ** 2)  # so that losses come as fractions of E_0
    body = {"e_m": mean["e_m"].mean, **s.body}
    restitution = np.array([mean["e"].mean, mean["e"].low, mean["e"].high])
    lost = predicted_losses(*motion, e=restitution[:, None], mu=MU, mass=mass, **body)
    total = lost.E_ln + lost.E_lt
    mu_c = float(critical_ratio(*motion, e=restitution[0], **body))
    there = float(np.interp(mu_c, MU, total[0]))
    share = there / max(there, float(total[0][mu_c >= MU].max()))
    angle = float(np.degrees(s.alpha))
    return {"alpha": angle, "total": total, "tangential": lost.E_lt[0], "mu_c": mu_c, "share": share}


def _draw_6(axes: Axes, curve: dict[str, Any], s: experiments.MeasuredSet, colour: str) -> None:
    total: Floats = curve["total"]
    possible, beyond = curve["mu_c"] >= MU, (curve["mu_c"] <= MU + 0.005) & (total[0] > -0.3)
    axes.fill_between(
        MU[possible], total.min(axis=0)[possible], total.max(axis=0)[possible], color=colour, alpha=0.18, lw=0
    )
    axes.plot(MU[possible], total[0][possible], color=colour, lw=1.6, label=f"{curve['alpha']:.0f}°")
    axes.plot(MU[beyond], total[0][beyond], color=colour, lw=1.0, ls=(0, (1, 1.6)))
    axes.plot(curve["mu_c"], np.interp(curve["mu_c"], MU, total[0]), "s", color=colour, markersize=5)
    mu, remaining = s.statistics()["mu"], s.statistics()["E_r_over_E_0"]
    bars: dict[str, Any] = {"xerr": mu.high - mu.mean, "yerr": remaining.high - remaining.mean}
    axes.errorbar(mu.mean, 1 - remaining.mean, **bars, fmt="o", color=colour, mec="black", mew=0.6, capsize=2)


def _statements_6(share: list[float], curves: list[dict[str, Any]]) -> tuple[Statement, ...]:
    """Check the loss at mu_c, the gain of energy beyond it, and the loss over mu of Table 3's surfaces."""
    gains = [f"{c['alpha']:.0f}" for c in curves if (c["tangential"][c["mu_c"] < MU] < 0).any()]
    low = _loss_of(experiments.measured_set("t3-contaminated"), 0.32)
    high = _loss_of(experiments.measured_set("t3-machined"), 0.72)
    return (
        Statement(
            "the loss at the critical ratio is close to the largest",
            f"{', '.join(f'{100 * x:.1f} %' for x in share)} of it at 17, 25, 37, 45 and 60 degrees",
            min(share) > 0.9,
        ),
        Statement(
            "beyond the critical ratio a tangential gain of energy becomes possible",
            f"so it is at {', '.join(gains)} degrees for ratios up to 1.2",
            bool(gains),
        ),
        Statement(
            "the loss rises from about 50 % to above 90 % of E_0 as mu goes from 0.32 to 0.72 (Table 3)",
            f"{100 * low:.1f} % and {100 * high:.1f} % by Eq 23-25 with each surface's e and e_m",
            abs(low - 0.5) < 0.05 and high > 0.9,
        ),
    )


def _loss_of(s: experiments.MeasuredSet, mu: float) -> float:
    """Return the loss fraction at `mu` with the mean e and e_m of a set."""
    mean = s.statistics()
    lost = predicted_losses(-1.0, -1.0, e=mean["e"].mean, mu=mu, e_m=mean["e_m"].mean, mass=1.0, **s.body)
    return float(lost.E_ln + lost.E_lt)


def figure_7(out: Path) -> Drawn:
    """Draw measured mean losses with 95 % intervals, and Eq 23-25 with the band of drawn means."""
    picture = out / "figure-7.png"
    x = np.radians(DEGREES)
    # of the measured means (173,), and of drawn ones (draws, 173)
    curves, repeated = (
        {"total": p.E_ln + p.E_lt, "E_lt": p.E_lt, "E_ln": p.E_ln}
        for p in (experiments.loss_against_angle(x), experiments.drawn_losses(x))
    )
    bands = {name: np.percentile(many, [2.5, 97.5], axis=0) for name, many in repeated.items()}
    measured: list[dict[str, experiments.Statistic]] = []
    for rows_of in (s.recomputed() for s in experiments.angle_sets()):
        # the total is 1 - E_r/E_0, independent of e_m
        lost = {"total": 1.0 - rows_of["E_r_over_E_0"]}
        lost |= {name: rows_of[f"{name}_over_E_0"] for name in ("E_lt", "E_ln")}
        measured.append({name: experiments.statistic(values) for name, values in lost.items()})
    # the rows of `COLUMNS_7`: the calculated ones, then the measured ones
    columns = [column for name in LOOKS for column in (curves[name], *bands[name])]
    rows: list[list[float | str]] = [
        ["curve", *map(float, row)] for row in zip(DEGREES, *columns, strict=True)
    ]
    for s, losses in zip(experiments.angle_sets(), measured, strict=True):
        ends = [x for name in LOOKS for x in (losses[name].mean, losses[name].low, losses[name].high)]
        rows.append(["measured", round(float(np.degrees(s.alpha)), 6), *ends])
    write_data(picture, COLUMNS_7, rows)
    peaks = {}
    for name in ("total", "E_lt"):
        low, high = np.percentile(DEGREES[repeated[name].argmax(axis=1)], [2.5, 97.5])
        peaks[name] = (float(DEGREES[curves[name].argmax()]), float(low), float(high))
    sentence = (
        f"With interpolated coefficients the total loss is largest at {_words(peaks['total'])} degrees and "
        f"the tangential loss at {_words(peaks['E_lt'])} degrees (95 % of drawn means; linear "
        "interpolation between measured angles is a choice)."
    )
    with canvas(picture, 4.4, sentence) as drawn:
        axes = drawn.add_subplot()
        for name in LOOKS:
            _draw_7(axes, name, curves[name], bands[name], [row[name] for row in measured])
        axes.set(
            xlabel="inclination α, degrees", ylabel="loss as a fraction of $E_0$", xlim=(15, 62), ylim=(0, 1)
        )
        axes.grid()
        handles, labels = axes.get_legend_handles_labels()
        order = (0, 3, 1, 4, 2, 5)  # a column of the legend for each loss: curve above measurement
        legend = [handles[i] for i in order], [labels[i] for i in order]
        drawn.legend(*legend, loc="outside lower center", ncols=3)
    return Drawn(7, picture, sentence, _statements_7(peaks))


def _draw_7(
    axes: Axes, name: str, curve: Floats, band: Floats, measured: list[experiments.Statistic]
) -> None:
    colour, mark = PALETTE[LOOKS[name][0]], LOOKS[name][1]
    axes.fill_between(DEGREES, *band, color=colour, alpha=0.18, lw=0)
    axes.plot(DEGREES, curve, color=colour, lw=1.5, label=f"{LABELS[name]} by Eq 23-25, 95 % band")
    angles = [float(np.degrees(s.alpha)) for s in experiments.angle_sets()]
    means, half = [m.mean for m in measured], [m.high - m.mean for m in measured]
    look: dict[str, Any] = {"fmt": mark, "color": colour, "mec": "black", "mew": 0.5, "capsize": 3}
    axes.errorbar(angles, means, yerr=half, **look, label=f"{LABELS[name]}, measured mean, 95 %")


def _words(peak: tuple[float, float, float]) -> str:
    return f"{peak[0]:.1f} ({peak[1]:.1f} to {peak[2]:.1f})"


def _statements_7(peaks: dict[str, tuple[float, float, float]]) -> tuple[Statement, ...]:
    claims = {
        "total": ("the total loss is largest near 45 degrees", 45.0),
        "E_lt": ("the tangential loss is largest near 50 degrees", 50.0),
    }
    return tuple(
        Statement(claim, f"at {_words(peaks[name])} degrees", abs(peaks[name][0] - near) < 5.0)
        for name, (claim, near) in claims.items()
    )


FIGURES: dict[int, Callable[[Path], Drawn]] = {4: figure_4, 5: figure_5, 6: figure_6, 7: figure_7}
"""Figures by number, each drawn into a directory, data beside it; OutputPathError where it cannot be."""
