"""Told errors beside those that finer runs show: how often the truth lies inside, with Wilson intervals."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import pandas

from fem_impact.answers.refine import needed
from fem_impact.evidence.studies.coverage.run import DEFAULT, FINER, FINEST, MODAL, CoverageResult
from fem_impact.evidence.studies.coverage.scenes import DrawnScene
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.run.modal_error import HELD, scale_of, unit_of

KEYS: Mapping[str, str] = {
    "e": "e_edge",
    "mu": "mu",
    "Omega": "Omega_rad_per_s",
    "E_vib": "E_vib_over_E_0",
    "friction": "W_friction_over_E_0",
    "plastic rod": "E_plastic_rod_over_E_0",
    "plastic barrier": "E_plastic_barrier_over_E_0",
}
"""Judged quantities and their keys in an outcome."""
LEVELS, LEVELS_TWO, REDUCED = "levels", "levels, two finer", "reduced model"
"""Told errors: the bands of a default run beside one level more and two, the error of the reduced model
beside finite elements."""
ZERO = 1e-5
"""In the unit of the quantity: what is smaller on both sides is zero by physics, or the round-off of finite
elements (3e-6), and tells nothing."""
KNOWN = 0.1
"""Widest half-width of finite elements, over `unit_of`, that tells an error of the reduced model."""
AIM: Mapping[str, float] = {LEVELS: needed.HELD, LEVELS_TWO: needed.HELD, REDUCED: HELD}
"""Share of truths that each told error is meant to hold."""
Results = Mapping[tuple[str, str], CoverageResult]
"""Results by scene and model."""


@dataclass(frozen=True, slots=True)
class ToldError:
    """One number with its told error beside the truth, in the unit of the quantity.

    Attributes
    ----------
    scene, family, barrier : name of the scene, family of its projectile, kind of barrier
    told, quantity : what told the error, and of what
    value, half : the number and its told half-width
    truth : limit that the finer run's own levels give the number, its value where they give none
    finest : value on the finest mesh of that run
    unit : `unit_of` the number
    """

    scene: str
    family: str
    barrier: str
    told: str
    quantity: str
    value: float
    half: float
    truth: float
    finest: float
    unit: float


def told_errors(scenes: Iterable[DrawnScene], results: Results) -> pandas.DataFrame:
    """Return one row a `ToldError`, with ``error``, whether it is ``inside``, and ``inside_finest``."""
    rows = [row for scene in scenes for row in _of_scene(scene, results)]
    table = pandas.DataFrame(rows, columns=list(ToldError.__dataclass_fields__))
    table["error"] = (table["value"] - table["truth"]).abs()
    table["inside"] = table["error"] <= table["half"]
    table["inside_finest"] = (table["value"] - table["finest"]).abs() <= table["half"]
    return table


def _of_scene(scene: DrawnScene, results: Results) -> Iterator[ToldError]:
    place = scene.name, scene.family, scene.group
    for told, model in ((LEVELS, FINER), (LEVELS_TWO, FINEST)):
        default, run = finer_of(scene, results, model)
        if default and run:
            for name, key in KEYS.items():
                yield from _row((*place, told, name), default.estimate(key), run, key)
    modal, solid = of_reduced(scene, results)
    if modal and solid:
        for name, key in KEYS.items():
            if reduced_error(modal, solid, key) is not None:
                yield from _row((*place, REDUCED, name), modal.estimate(key), solid, key)


def finer_of(scene: DrawnScene, results: Results, model: str) -> tuple[Outcome | None, Outcome | None]:
    """Return a scene by its default run and by a model that came to a finer mesh, None where one did not."""
    default, run = (_known(results.get((scene.name, one))) for one in (DEFAULT, model))
    return (default, run) if default and run and _is_finer(run, default) else (None, None)


def _known(result: CoverageResult | None) -> Outcome | None:
    """Return the outcome of a run that gave its numbers."""
    return result.outcome if result is not None and result.has_numbers else None


def _is_finer(run: Outcome, than: Outcome) -> bool:
    """Say whether a run came to a finer mesh: a budget may have ended it before."""
    sizes = or_none(run.cost.tip_size), or_none(than.cost.tip_size)
    return sizes[0] is not None and sizes[1] is not None and sizes[0] < 0.99 * sizes[1]


def _row(
    place: tuple[str, str, str, str, str], told: tuple[object, float | None], run: Outcome, key: str
) -> Iterator[ToldError]:
    """Yield the row of a number that both runs know and whose error is told."""
    every = (*told, run.estimate(key)[0], KEY_TABLE[key].of(run))
    known = [number for number in every if isinstance(number, float)]
    if len(known) == len(every):
        value, half, truth, finest = known
        if max(abs(value), abs(truth), abs(finest)) > ZERO:
            yield ToldError(*place, value, half, truth, finest, unit_of(key, run))


def of_reduced(scene: DrawnScene, results: Results) -> tuple[Outcome | None, Outcome | None]:
    """Return a scene by the reduced model and by the finest finite elements, None where one lacks its like.

    Alike are those that followed one place of contact to its end: both end before another place strikes.
    """
    known = (_known(results.get((scene.name, model))) for model in (FINEST, FINER, DEFAULT))
    both = _known(results.get((scene.name, MODAL))), next((run for run in known if run is not None), None)
    alike = (run and len(or_none(run.contact.sites) or ()) == 1 for run in both)
    return both if all(alike) else (None, None)


def reduced_error(modal: Outcome, solid: Outcome, key: str) -> float | None:
    """Return by how much the reduced model differs in a number, over its scale.

    None where one does not know it, or finite elements know it only within `KNOWN`.
    """
    (value, _), (truth, half), most = modal.estimate(key), solid.estimate(key), KNOWN * unit_of(key, modal)
    if isinstance(value, Unknown) or isinstance(truth, Unknown) or half is None or half > most:
        return None
    return float(value - truth) / scale_of(key, modal)


def coverage(errors: pandas.DataFrame, by: list[str]) -> pandas.DataFrame:
    """Return by told error, and columns such as quantity, how often the truth lies inside.

    Columns: ``n``, ``inside``, ``inside_finest``, ``share`` with its 95 % Wilson interval ``low`` to
    ``high``, medians ``half`` and ``error``, and ``needed``: by what half-widths had to be multiplied to hold
    as many of the errors as `AIM` says.
    """
    from scipy.stats import binomtest

    rows = []
    for place, group in errors.groupby(by, sort=False):
        n, inside = len(group), int(group["inside"].sum())
        interval = binomtest(inside, n).proportion_ci(method="wilson")
        ratio = (group["error"] / group["half"].where(group["half"] > 0)).fillna(float("inf"))
        rows.append(
            {
                **dict(zip(by, place, strict=True)),
                "n": n,
                "inside": inside,
                "inside_finest": int(group["inside_finest"].sum()),
                "share": inside / n,
                "low": interval.low,
                "high": interval.high,
                "half": group["half"].median(),
                "error": group["error"].median(),
                "needed": ratio.quantile(AIM[group["told"].iloc[0]], interpolation="higher"),
            }
        )
    return pandas.DataFrame(rows)


def ends(scenes: Iterable[DrawnScene], results: Results, model: str) -> pandas.DataFrame:
    """Return how the runs of a model ended, a row a scene: ``end``, ``reason``, ``cpu_s``, and ``bare``.

    Bare is a run with numbers that tells no error of e.
    """
    rows = []
    for scene in scenes:
        result = results.get((scene.name, model))
        if result is None:
            continue
        outcome, reason = _known(result), " ".join(result.why.strip().splitlines()[-1:])
        bare = outcome is not None and outcome.estimate(KEYS["e"])[1] is None
        rows.append((scene.name, scene.family, scene.group, result.end, reason, result.cpu_s, bare))
    return pandas.DataFrame(rows, columns=["scene", "family", "barrier", "end", "reason", "cpu_s", "bare"])


def times(scenes: Iterable[DrawnScene], results: Results) -> pandas.DataFrame:
    """Return told ranges beside the time taken, s: ``told``, ``least``, ``most``, ``taken``, ``inside``.

    Before a run a range of all its processor time is told, after the pilot one of the time that is left. Runs
    that were broken off do not count.
    """
    rows: list[tuple[str, str, float, float, float]] = []
    for scene in scenes:
        result = results.get((scene.name, DEFAULT))
        if result is None or result.outcome is None:
            continue
        if result.planned_s:
            rows.append((scene.name, "range of the time before the run", *result.planned_s, result.cpu_s))
        if result.forecast_s and result.left_s:
            left = "range of the time left after the pilot"
            rows.append((scene.name, left, *result.forecast_s, result.left_s))
    table = pandas.DataFrame(rows, columns=["scene", "told", "least", "most", "taken"])
    return table.assign(inside=table["taken"].between(table["least"], table["most"]))
