"""What the scatter study says: sentences, tables and pictures of its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np

from fem_impact.figures.lines import Panel, Series
from fem_impact.study.document import Paper, Picture, Sheet
from fem_impact.study.scatter_inputs import Input
from rigid.experiments import correlation

__all__ = ["paper"]

MEASURED = ("e", "mu", "Omega")
OUTPUTS = (*MEASURED, "E_vib/E_0")
UNITS = {"e": "e", "mu": "mu", "Omega": "Omega, rad/s"}
Told = dict[str, Any]


def paper(told: Sequence[Told], inputs: Sequence[Input], fidelity: str) -> Paper:
    """Return the study for what every set says (see `fem_impact.study.scatter`)."""
    names = [i.name for i in inputs]
    sentences = [(f"cloud-{t['set']}", sentence) for t in told for sentence in _sentences(t, names)]
    return Paper(
        "scatter",
        f"Scatter of the measured sets and what causes it ({fidelity})",
        [sentence for _, sentence in sentences],
        [*(_cloud(t) for t in told), *(_ranks(t, names) for t in told if t["indices"])],
        [_spread_sheet(told), _correlation_sheet(told), _index_sheet(told, names), _sample_sheet(told)],
        [f"{i.name}: {i.words}" + ("" if i.varies else "; one value for all tests of a set") for i in inputs],
        ["sobol", "qmc"],
        sentences,
    )


def _sentences(t: Told, names: Sequence[str]) -> list[str]:
    sd, measured = t["tests"].std(axis=0, ddof=1), t["measured"].std(axis=0, ddof=1)
    parts = [f"{q} {sd[i]:.2g} against {measured[i]:.2g} measured" for i, q in enumerate(MEASURED)]
    lines = [
        f"{t['set']}: inputs that vary from test to test give a standard deviation of {', '.join(parts)}."
    ]
    if t["indices"]:
        total = t["indices"]["total"]
        first = [
            f"{q} by {names[int(total[i].argmax())]} ({total[i].max():.0%})" for i, q in enumerate(OUTPUTS)
        ]
        lines.append(
            f"{t['set']}: the largest total share of the variance over all inputs is, for {', '.join(first)}."
        )
    return lines


def _cloud(t: Told) -> Picture:
    panels = []
    for a, b in combinations(range(3), 2):
        x, y = MEASURED[a], MEASURED[b]
        model = Series("model, all inputs", t["every"][:, a], t["every"][:, b], "points", 5)
        tests = Series("model, test to test", t["tests"][:, a], t["tests"][:, b], "points", 0)
        seen = Series("measured tests", t["measured"][:, a], t["measured"][:, b], "rings", 1)
        panels.append(Panel(f"{x} and {y}", UNITS[x], UNITS[y], (model, tests, seen)))
    caption = f"{t['set']}: sampled inputs and the single tests."
    return Picture(f"cloud-{t['set']}", caption, tuple(panels), 3)


def _ranks(t: Told, names: Sequence[str]) -> Picture:
    found, at = t["indices"], np.arange(len(names))
    panels = tuple(
        Panel(
            output,
            "input",
            "Sobol index",
            (
                Series("first order", at - 0.08, found["first"][i], "points"),
                Series("total", at + 0.08, found["total"][i], "rings"),
            ),
            levels=(0.0, 1.0),
            names=tuple(names),
        )
        for i, output in enumerate(OUTPUTS)
    )
    return Picture(f"sobol-{t['set']}", f"{t['set']}: share of each input in the variance.", panels)


def _spread_sheet(told: Sequence[Told]) -> Sheet:
    rows = []
    for t in told:
        for i, quantity in enumerate(OUTPUTS):
            seen = t["measured"][:, i] if i < 3 else None
            measured = [None, None] if seen is None else [float(seen.mean()), float(seen.std(ddof=1))]
            model = [
                float(f)
                for name in ("tests", "every")
                for f in (t[name][:, i].mean(), t[name][:, i].std(ddof=1))
            ]
            rows.append([t["set"], quantity, *model, *measured])
    head = ("set", "quantity", "mean_tests", "sd_tests", "mean_all", "sd_all", "measured_mean", "measured_sd")
    return Sheet(
        "spread",
        "Mean and standard deviation: inputs that vary from test to test, all inputs, measured",
        head,
        rows,
    )


def _correlation_sheet(told: Sequence[Told]) -> Sheet:
    rows = []
    for t in told:
        for a, b in combinations(range(3), 2):
            model = correlation(t["tests"][:, a], t["tests"][:, b])
            seen = correlation(t["measured"][:, a], t["measured"][:, b])
            rows.append(
                [t["set"], f"{MEASURED[a]}, {MEASURED[b]}", model.r, seen.r, seen.low, seen.high, seen.n]
            )
    head = ("set", "pair", "model_r", "measured_r", "measured_low", "measured_high", "tests")
    return Sheet(
        "correlations",
        "Correlation within a set, with Fisher's 95 % interval of the measured one",
        head,
        rows,
    )


def _index_sheet(told: Sequence[Told], names: Sequence[str]) -> Sheet:
    rows = []
    for t in told:
        found = t["indices"]
        for i, output in enumerate(OUTPUTS if found else ()):
            for k, name in enumerate(names):
                keys = ("first", "first_half", "total", "total_half")
                rows.append([t["set"], output, name, *(float(found[key][i, k]) for key in keys)])
    head = ("set", "quantity", "input", "first_order", "first_half_95", "total", "total_half_95")
    return Sheet("sobol", "Sobol indices with the half-widths of their bootstrap intervals", head, rows)


def _sample_sheet(told: Sequence[Told]) -> Sheet:
    rows = [
        [t["set"], kind, *map(float, row)] for t in told for kind in ("tests", "every") for row in t[kind]
    ]
    head = ("set", "inputs", "e", "mu", "Omega_rad_per_s", "E_vib_over_E_0")
    return Sheet("sample", "Every sampled run", head, rows, shown=False)
