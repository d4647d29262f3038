"""What half-widths of levels need to hold a run with one level more, from the runs of the study."""

from collections import defaultdict
from collections.abc import Iterable
from math import ceil, inf, isfinite

import numpy as np

from fem_impact.answers.refine.needed import HELD, scale_of, widest
from fem_impact.answers.report import Sheet
from fem_impact.arrays import Array
from fem_impact.case.measured import tolerance_rank
from fem_impact.evidence.studies.coverage.judge import Results, finer_of
from fem_impact.evidence.studies.coverage.run import DEFAULT, FINER
from fem_impact.evidence.studies.coverage.scenes import DrawnScene
from fem_impact.tables.table import Cell, Table

LEAST = ceil(HELD / (1 - HELD))
"""Scenes from which on their largest difference is a limit that holds `HELD`."""
RATIOS = 0.03, 0.1, 0.3, 1.0, 3.0, 10.0
"""Shares of the widest half-width over multiples of the own one that are tried.

They are few, as a choice flatters, and none is 0, since levels may agree by chance in any number.
"""
ROUND = 1e-6
"""In the unit of a number, below which half-widths are alike in the mean of their logarithms."""


def needed(errors: Array, halves: Array, shares: Array) -> tuple[float, float] | None:
    """Return multiple and share by which half-widths hold `HELD` of errors of scenes like these.

    ``errors`` (n,) and the ``halves`` (n,) that the levels told are over the scale of the number, ``shares``
    (n,) are the widest half-widths of the scenes. A half-width is the own one or, where that is more, the
    multiple of it and the share of the widest. Of those that hold the errors the narrowest in the geometric
    mean are returned; None where there are fewer than `LEAST`.
    """
    if len(errors) < LEAST:
        return None
    best = inf, 0.0, 0.0
    at = tolerance_rank(len(errors), HELD) - 1
    for ratio in RATIOS:
        told = halves + ratio * shares
        missed = np.divide(errors, told, out=np.full_like(errors, inf), where=told > 0.0)
        times = float(np.sort(np.where(errors <= halves, 0.0, missed))[at])
        if isfinite(times):
            width = float(np.log(np.maximum(halves, times * told) + ROUND).mean())
            best = min(best, (width, times, float(times * ratio)))
    return best[1:] if isfinite(best[0]) else None


def level_bands(scenes: Iterable[DrawnScene], results: Results) -> Sheet:
    """Return what half-widths of default runs need, by key, to hold a run with one level more.

    A copy stands in ``fem_impact/case/data/level-bands.csv``: by it half-widths of levels are widened.
    """
    found = defaultdict[str, list[tuple[float, float, float]]](list)
    for scene in scenes:
        default, finer = finer_of(scene, results, FINER)
        if default is None or finer is None:
            continue
        halves = results[scene.name, DEFAULT].own_halves
        most = widest(halves, default)
        for key, half in halves.items():
            value, truth = default.estimate(key)[0], finer.estimate(key)[0]
            if isinstance(value, float) and isinstance(truth, float):
                scale = scale_of(key, value, default)
                if scale:
                    found[key].append((abs(value - truth) / scale, half / scale, most))
    rows: list[tuple[Cell, ...]] = []
    for key, of in found.items():
        if factors := needed(*np.array(of).T):
            rows.append((key, len(of), round(factors[0], 4), round(factors[1], 4)))
    caption = "Half-widths that hold a run with one level more: multiple of the own, share of the widest"
    return Sheet("level-bands", caption, Table.of(("key", "scenes", "times", "share"), rows), shown=False)
