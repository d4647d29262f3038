"""A scene beside its own tests by ASME V&V 20, and which input is worth measuring better.

Each measured number has the error E = S - D of the model and its standard uncertainty u_val, made of the
model (the band of its meshes, or the half-width of the reduced model), the inputs and the tests. Sobol's
indices (Saltelli 2010, as SciPy computes them) share what the inputs cause out among them. The inputs are
varied in the reduced or the rigid model, which takes milliseconds, or in the finite elements themselves; S is
that of the fidelity asked for.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, product
from math import inf
from statistics import NormalDist
from typing import Any

import numpy as np

from fem_impact.answers.compare import MEASURED, measured_value
from fem_impact.answers.simulate import simulate
from fem_impact.answers.v_and_v import (
    COVERAGE,
    ERRORS,
    TERMS,
    Comparison,
    compared_with,
    independent,
    joint_or_why,
)
from fem_impact.answers.vary import in_unit, measure
from fem_impact.arrays import Array
from fem_impact.errors import SceneError, UsageError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Num, Unknown, known
from fem_impact.progress import CaseProgress, silent, watched
from fem_impact.run.modal_error import HELD
from fem_impact.run.tests import NUMBERS, tests_freedom, tests_of
from fem_impact.scene.shipped import bare, named, replace_all, value_at
from fem_impact.scene.types import Scene, to_dict
from fem_impact.tables.table import Table

SAMPLES = 64  # of each of the two samples that Sobol's indices are made of
SEED = 20260101
WIDTHS = {"solid": COVERAGE, "modal": NormalDist().inv_cdf(0.5 + 0.5 * HELD)}
"""Standard uncertainties in a half-width: that of levels holds 95 of 100, that of the reduced model 90."""
KEYS = {q.measured: q.key.name for q in MEASURED if q.measured}
"""Keys of an outcome by the names of measured numbers."""
FRICTION = "surface.friction"
RESTING = {"barrier.v_n": "0 m/s", "barrier.v_t": "0 m/s", "impact.omega": "0 rad/s"}
CORNERS = 256  # of the intervals, tried before any run
Ends = tuple[Any, Any] | str
Interval = tuple[str, float, float, str]
"""Key, lowest and highest value, and their unit."""


@dataclass(frozen=True, slots=True)
class Validation:
    """What the tests of a scene say of its model.

    Attributes
    ----------
    comparisons : one a measured number that the model knows
    unknown : measured numbers that it does not know, with the reason
    inputs : keys of the uncertain inputs
    total : (inputs, numbers) Sobol's total indices
    joined : numbers of the joint statement
    distance, p : Mahalanobis' distance squared of their errors, and the probability of a larger one if the
        model has no error, or why there are none
    varied : fidelity in which the inputs were varied
    doubtful : numbers in which that one is off the compared one by more than `COVERAGE` u_val
    runs : of that
    """

    comparisons: tuple[Comparison, ...]
    unknown: Mapping[str, str]
    inputs: tuple[str, ...]
    total: Array
    joined: tuple[str, ...]
    distance: Num
    p: Num
    varied: str
    doubtful: tuple[str, ...]
    runs: int

    def __repr__(self) -> str:
        """Return the table of errors, and the input to measure better."""
        return f"{self.table().markdown()}\n\n{self._jointly}"

    def _repr_html_(self) -> str:
        return self.table().html(self._jointly)

    @property
    def _jointly(self) -> str:
        better, part = self.better
        p = f"not known: {self.p.reason}" if isinstance(self.p, Unknown) else f"p = {self.p:.2g}"
        return (
            f"jointly ({', '.join(self.joined)}) {p}; "
            f"measure better: {better}, {100 * part:.0f} % of u_val squared"
        )

    def table(self) -> Table:
        """Return the errors of the model and their uncertainties, one row a number, as texts."""
        rows = [
            (one.quantity, *(f"{getattr(one, name):.3g}" for name in TERMS), one.verdict)
            for one in self.comparisons
        ]
        return Table.of(ERRORS, rows, left=(0, 7))

    @property
    def shares(self) -> Array:
        """(inputs + 2, numbers) parts of u_val squared: of each input, of the tests, of the model (u_num)."""
        total = np.maximum(self.total, 0.0)
        of_inputs = total / np.maximum(total.sum(axis=0), 1e-300)
        u = np.array([(c.u_input, c.u_D, c.u_num) for c in self.comparisons]).T ** 2
        parts = np.vstack([of_inputs * u[0], u[1:]])
        return np.asarray(parts / np.maximum(parts.sum(axis=0), 1e-300))

    @property
    def better(self) -> tuple[str, float]:
        """What to know better, an input, ``tests`` or ``model``, and its mean part of u_val squared."""
        parts = self.shares.mean(axis=1)
        return (*self.inputs, "tests", "model")[int(np.argmax(parts))], float(parts.max())


def validate(
    scene: Scene,
    uncertain: Mapping[str, Ends] | None = None,
    fidelity: str = "modal",
    samples: int = SAMPLES,
    options: RunOptions = RunOptions(),
    inputs_by: str = "",
) -> Validation:
    """Compare a scene with its tests by ASME V&V 20, and find which input is worth measuring better.

    Parameters
    ----------
    uncertain : lowest and highest value of each uncertain input by its key, such as
        ``{"impact.angle": ("44 deg", "46 deg")}``, or how far it may lie from the scene's value,
        ``{"impact.v_n": "+-2 %"}`` or ``"+-0.1 m/s"``; each is uniform between. Friction over the interval
        that the scene states is one of them unless it stands there
    fidelity : of the compared run
    samples : a power of two; (inputs + 2) times as many runs are made
    inputs_by : fidelity in which the inputs are varied; by default rigid for "rigid", else modal, which takes
        milliseconds. "solid" takes (inputs + 2) times ``samples`` runs of finite elements

    Raises
    ------
    SceneError
        The scene names no tests, or is refused somewhere in the intervals, which are named.
    UsageError
        The ends of an interval are no numbers of one unit, or there is no interval.

    Examples
    --------
    >>> import fem_impact
    >>> found = fem_impact.validate(fem_impact.load("t5b"), fidelity="rigid", samples=2)
    >>> found.inputs, found.joined
    (('surface.friction',), ('Omega', 'e', 'mu'))
    """
    if samples < 2 or samples & (samples - 1):
        raise UsageError("is no power of two.", key="samples=", value=samples, remedy="Write 16, 32 or 64.")
    tests = tests_of(scene)
    if tests is None:
        raise SceneError("is missing: there is nothing to compare with.", key="measured", remedy=_TESTS)
    intervals = _intervals(scene, uncertain or {})
    quick = inputs_by or ("rigid" if fidelity == "rigid" else "modal")
    plain = {by: scene if by == "solid" else scene.untargeted for by in (fidelity, quick)}
    names = [name for name in tests.statistics() if name in KEYS or name in NUMBERS]
    keys = [KEYS.get(name, name) for name in names]
    with watched(options.progress) as meter:
        heard = replace(options, progress=meter)
        nominal, compared = (simulate(plain[by], by, heard) for by in (quick, fidelity))
        computed = [measured_value(compared, key) for key in keys]
        varied = [measured_value(nominal, key)[0] for key in keys]
        unknown = {
            name: why
            for name, one, moved in zip(names, computed, varied, strict=True)
            if (why := _not_compared(*one, fidelity) or _not_varied(moved, quick))
        }
        seen = [i for i, name in enumerate(names) if name not in unknown]
        if not seen:
            raise SceneError("state nothing that the model knows.", key="measured", remedy=_TESTS)

        def numbers(place: Array) -> list[float]:
            outcome = simulate(at_place(plain[quick], intervals, place), quick, RunOptions(progress=silent))
            return [known(measured_value(outcome, keys[i])[0]) for i in seen]

        total, drawn = sobol(numbers, len(intervals), samples, meter)
    moved = drawn - np.array([known(varied[i]) for i in seen])[:, None]
    u_num = [(computed[i][1] or 0.0) / WIDTHS.get(fidelity, inf) for i in seen]
    u_input = np.sqrt(np.mean(moved**2, axis=1)).tolist()
    comparisons = tuple(
        compared_with(tests, names[i], known(computed[i][0]), num, by, scene.id)
        for i, num, by in zip(seen, u_num, u_input, strict=True)
    )
    free = independent([names[i] for i in seen])
    joined = [names[seen[j]] for j in free]
    C = np.diag(np.square(u_num)[free]) + tests.covariance(joined)
    C += moved[free] @ moved[free].T / moved.shape[1]
    E = np.array([one.E for one in comparisons])
    distance, p = joint_or_why(E[free], C, tests.scatter(joined), tests_freedom(tests, joined))
    return Validation(
        comparisons=comparisons,
        unknown=unknown,
        inputs=tuple(key for key, *_ in intervals),
        total=total,
        joined=tuple(joined),
        distance=distance,
        p=p,
        varied=quick,
        doubtful=tuple(
            one.quantity
            for one, i in zip(comparisons, seen, strict=True)
            if abs(known(varied[i]) - one.S) > COVERAGE * one.u_val
        ),
        runs=(len(intervals) + 2) * samples + 1,
    )


def _intervals(scene: Scene, uncertain: Mapping[str, Ends]) -> list[Interval]:
    """Return the stated intervals, at corners of which the scene can be computed."""
    uncertain = {**friction_of(scene), **uncertain}
    if not uncertain:
        remedy = "State one, such as impact.angle=44,46deg."
        raise UsageError("is missing: no input of the scene is uncertain.", key="uncertain=", remedy=remedy)
    intervals = [interval_of(scene, key, ends) for key, ends in uncertain.items()]
    for key, own in left_out(scene, intervals).items():
        problem = f"does not hold the scene's own value, {own}."
        remedy = f"The model is computed at that value: give it one in the interval, --set {key}=VALUE."
        raise UsageError(problem, key=f"uncertain {key}", remedy=remedy)
    for corner in islice(product((0.0, 1.0), repeat=len(intervals)), CORNERS):
        at_place(scene, intervals, np.array(corner))
    return intervals


def sobol(
    numbers: Callable[[Array], Sequence[float]], inputs: int, samples: int, meter: Callable[..., None]
) -> tuple[Array, Array]:
    """Return Sobol's total indices (inputs, numbers), and the numbers (numbers, n) at both samples.

    ``numbers`` of a place (inputs,), each from 0 to 1, are computed (inputs + 2) times ``samples`` times, and
    ``meter`` is told how long the rest takes.
    """
    from scipy import stats

    drawn: list[Array] = []
    begun, done, count = time.monotonic(), 0, (inputs + 2) * samples

    def of_units(x: Array) -> Array:
        """Return the numbers (numbers, n) of inputs (inputs, n)."""
        nonlocal done
        rows = []
        for place in x.T:
            rows.append(numbers(place))
            done += 1
            left = (time.monotonic() - begun) / done * (count - done)
            meter(CaseProgress("of the uncertain inputs", done, count, left))
        drawn.append(np.array(rows).T)
        return np.concatenate([drawn[-1]] * 2)  # SciPy fails on one number of one input

    rng, uniform = np.random.default_rng(SEED), [stats.uniform()] * inputs
    indices = stats.sobol_indices(func=of_units, n=samples, dists=uniform, rng=rng)
    total = np.reshape(indices.total_order, (-1, inputs))[: len(drawn[0])]
    return np.nan_to_num(total).T, np.concatenate(drawn[:2], axis=1)


_TESTS = 'Name a file of tests in the scene: measured = "my_tests.csv".'


def _not_compared(value: Num, band: float | None, fidelity: str) -> str:
    """Return why a number cannot be compared, empty where it can."""
    if isinstance(value, Unknown):
        return value.reason
    if band is None and fidelity == "modal":
        return "how far the reduced model is off in it is not known; use fidelity solid."
    if band is None and fidelity == "solid":
        return "how far the mesh is off in it is not known; accuracy.levels above 1 tells it of most numbers."
    return ""


def _not_varied(value: Num, quick: str) -> str:
    """Return why the inputs cannot be varied for a number, empty where they can."""
    if not isinstance(value, Unknown):
        return ""
    remedy = "--inputs-by solid varies them by finite elements."
    return f"the inputs are varied in the {quick} model, which does not know it: {value.reason}. {remedy}"


def friction_of(scene: Scene) -> dict[str, Ends]:
    """Return the interval of friction that a scene states, by its key; none where it states none."""
    low, high = scene.surface.friction_low, scene.surface.friction_high
    return {FRICTION: (low, high)} if low < high else {}


def interval_of(scene: Scene, key: str, ends: Ends) -> Interval:
    """Return an interval by its ends, or by ``+-`` how far they lie from the scene's value.

    Raises
    ------
    UsageError
        The ends are no two numbers of one unit, or the scene states no number that they could lie about.
    """
    given = [ends] if isinstance(ends, str) else list(ends)
    if len(given) == 1 and isinstance(given[0], str) and given[0].strip().startswith(("+-", "\u00b1")):
        return _about(scene, bare(key), given[0])
    read = [measure(end) for end in given]
    numbers, units = [number for number, _ in read if not isinstance(number, str)], {unit for _, unit in read}
    if len(read) != 2 or len(numbers) != 2 or len(units) != 1:
        remedy = f"Write {key}=LOW,HIGH with one unit, such as impact.angle=44,46deg, or {key}=+-2%."
        raise UsageError("needs two numbers of one unit.", key=key, value=given, remedy=remedy)
    return key, min(numbers), max(numbers), units.pop()


def _about(scene: Scene, key: str, text: str) -> Interval:
    """Return the interval of a text such as ``+-2 %`` or ``+-0.1 m/s`` about the scene's value of a key."""
    value_there = _own(scene, key)
    value, unit = measure(value_there)
    half, of = measure(text.strip().lstrip("+-\u00b1"))
    if of == "%" and not isinstance(half, str) and not isinstance(value, str):
        half = abs(value) * half / 100
    elif of or unit:
        half, none = (in_unit(f"{number} {of}", unit) for number in (half, 0))  # 5 degC are 5 K
        half = half - none if not isinstance(half, str) and not isinstance(none, str) else half
    if isinstance(value, str) or isinstance(half, str) or not half > 0:
        where = f"value, {named(value_there)}" if value_there != "" else "value: it states none"
        problem = f"gives no interval about the scene's {where}."
        remedy = f"Write {key}=LOW,HIGH with one unit, if the scene takes that key."
        raise UsageError(problem, key=key, value=text, remedy=remedy)
    return key, value - half, value + half, unit


def _own(scene: Scene, key: str) -> Any:
    """Return the value that a scene states of a key, as it writes it; empty where it states none.

    A barrier that is not said to move stands still.
    """
    value = value_at(to_dict(scene), key)
    return RESTING.get(key, "") if value is None else value


def left_out(scene: Scene, intervals: Sequence[Interval]) -> dict[str, str]:
    """Return the scene's own values, by key, that intervals do not hold; "none" where it states none."""
    ends = [at_place(scene, intervals, np.full(len(intervals), end)) for end in (0.0, 1.0)]
    left = {}
    for key, *_ in intervals:
        own, low, high = (_own(one, bare(key)) for one in (scene, *ends))
        unit = measure(low)[1]
        least, value, most = (in_unit(one, unit) for one in (low, own, high))
        if isinstance(least, str) or isinstance(most, str):
            continue  # not written as one value
        if isinstance(value, str) or not least <= value <= most:
            left[key] = str(own or "none")
    return left


def at_place(scene: Scene, intervals: Sequence[Interval], place: Array) -> Scene:
    """Return the scene with its uncertain inputs at places (inputs,), each from 0 to 1 of its interval.

    Raises
    ------
    SceneError
        It is refused there; the intervals that it is refused for are named.
    """
    changes: dict[str, Any] = {}
    for (key, low, high, unit), share in zip(intervals, place.tolist(), strict=True):
        value = low + share * (high - low)
        changes[key] = f"{value!r} {unit}" if unit else value
    try:
        return replace(replace_all(scene, changes), measured=scene.measured)  # its tests are of this impact
    except SceneError as error:
        refused = error
    for key in [*changes]:  # the intervals but for which the scene would not be refused are left
        others = {other: value for other, value in changes.items() if other != key}
        try:
            replace_all(scene, others)
        except SceneError:
            changes = others
    where = " and ".join(
        f"{key} = {low:.6g} to {high:.6g} {unit}".rstrip()
        for key, low, high, unit in intervals
        if key in changes
    )
    remedy = f"{refused.remedy} (Within the stated {where}.)".strip()
    key, value = refused.key, refused.value
    raise SceneError(refused.problem, key=key, value=value, remedy=remedy, source="uncertain=")
