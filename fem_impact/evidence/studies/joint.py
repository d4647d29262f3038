"""Validation of several numbers at once: e, mu and Omega of a set, with the correlations of their errors.

One input, such as friction, moves e, mu and Omega together, so that numbers which agree one by one may
disagree jointly. The distance of Mahalanobis D2 = E' C^-1 E of the three errors E = S - D counts that. By
ASME V&V 20 the covariance C is the sum of those of mesh, inputs and measurement; without an error of the
model D2 follows a chi-square distribution of three degrees of freedom, as V&V 10 takes it for several
quantities at once; Hotelling's as far as the scatter of few tests makes C.

Finite elements give the errors and their standard uncertainties, by the sheet ``validation`` of the study of
that name (a copy stands in ``data/validation.csv``); the reduced model, over the same sample of all inputs,
how their changes belong together, and the tests of a set, how their means do.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from fem_impact import Outcome, load, replace_all
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.v_and_v import COVERAGE, LEVEL, freedom, joint
from fem_impact.arrays import Array
from fem_impact.evidence.data import read_table
from fem_impact.evidence.studies.inputs import sample_jobs
from fem_impact.evidence.studies.report_parts import asked_sets, error_panel, rests_on
from fem_impact.evidence.studies.validated import NAMES, SHOWN, outputs, unit_sample
from fem_impact.figures.panels import Mark, Panel, Picture, Series
from fem_impact.jobs.job import Job, JobResults
from fem_impact.tables.table import Table
from rigid.experiments import measured_set

SIZE, QUICK_SIZE = 64, 8  # runs of a set's sample
FEWEST = 6  # finished runs that tell how changes belong together
AT = [NAMES.index(name) for name in SHOWN]
HEAD = ("set", *SHOWN, "D2", "p", "jointly", "alone", *(f"share of {name}" for name in SHOWN))


@dataclass(frozen=True, slots=True)
class JointError:
    """The errors of a set's numbers at once.

    Attributes
    ----------
    set : str
    E, u : (k,) errors S - D, and their standard uncertainties u_val
    C : (k, k) covariance of E
    dof : its degrees of freedom: the tests of a set are few
    """

    set: str
    E: Array
    u: Array
    C: Array
    dof: float

    @property
    def distance(self) -> float:
        """D2."""
        return joint(self.E, self.C)[0]

    @property
    def p(self) -> float:
        """Probability of a distance as large or larger without an error of the model."""
        return joint(self.E, self.C, self.dof)[1]

    @property
    def shares(self) -> Array:
        """(k,) part of each number in the distance, given the others; their sum is 1."""
        return np.asarray(self.E * np.linalg.solve(self.C, self.E) / self.distance)

    @property
    def alone(self) -> int:
        """How many numbers show an error by themselves, beyond 2 u_val."""
        return int((np.abs(self.E) > COVERAGE * self.u).sum())


def joint_error(name: str, rows: Sequence[dict[str, float]], by_inputs: Array, tests: Array) -> JointError:
    """Return the joint error of a set.

    Parameters
    ----------
    rows : of each number: S, D, u_num, u_input, u_D
    by_inputs : (n, k) changes of the numbers from their nominal values over a sample of the inputs
    tests : (m, k) the numbers of single tests
    """
    of = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    C = np.diag(of["u_num"] ** 2)
    by_tests = np.cov(tests.T)
    C = C + _scaled(by_inputs.T @ by_inputs, of["u_input"]) + _scaled(by_tests, of["u_D"])
    scatter = np.minimum(of["u_D"], np.sqrt(np.diag(by_tests) / len(tests)))  # u_D has that of tracking, too
    dof = freedom(C, _scaled(by_tests, scatter), len(tests) - 1)
    return JointError(name, of["S"] - of["D"], np.sqrt(np.diag(C)), C, dof)


def _scaled(covariance: Array, u: Array) -> Array:
    """Return a covariance (k, k) with the same correlations and standard deviations ``u`` (k,)."""
    by = u / np.sqrt(np.diag(covariance))
    return np.asarray(covariance * np.outer(by, by))


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return runs of the reduced model: each set as stated, and over the sample of its inputs."""
    return [job for name in asked_sets(request) for job in _jobs(name, request)]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: each set's distance, and what it is made of."""
    of_sets = (of_set(name, request, results, stored_rows()[name]) for name in asked_sets(request))
    return report_of([error for error in of_sets if error is not None])


def report_of(errors: Sequence[JointError]) -> StudyReport:
    """Return the study of sets."""
    sentences = _sentences(errors) if errors else ["No set could be compared: see the failed runs."]
    rows = [
        (
            *(error.set, *error.E, error.distance, error.p, "rejected" if error.p < LEVEL else "agrees"),
            *(f"{error.alone} of {len(error.E)}", *error.shares),
        )
        for error in errors
    ]
    return StudyReport(
        "joint",
        "Validation of e, mu and Omega at once",
        sentences,
        [_picture(errors)] if errors else (),
        [Sheet("joint", "Joint error of each set", Table.of(HEAD, rows))],
        rests_on("joint", LEVEL=LEVEL, COVERAGE=COVERAGE),
        conclusions=[("joint", sentence) for sentence in sentences],
    )


def _sentences(sets: Sequence[JointError]) -> list[str]:
    """Return how many sets are rejected, and where to the errors point."""
    rejected = [error.set for error in sets if error.p < LEVEL]
    quiet = [error.set for error in sets if error.p < LEVEL and error.alone == 0]
    errors = np.array([error.E for error in sets])
    ways = ", ".join(
        f"{name} too low in {int((errors[:, at] < 0).sum())}, too high in {int((errors[:, at] > 0).sum())}"
        for at, name in enumerate(SHOWN)
    )
    most = [SHOWN[int(error.shares.argmax())] for error in sets if error.p < LEVEL]
    parts = ", ".join(f"{name} in {most.count(name)}" for name in SHOWN if name in most)
    return [
        f"Taken together, e, mu and Omega of {len(rejected)} of {len(sets)} sets do not agree with the "
        f"tests at {100 * LEVEL:.0f} % ({', '.join(rejected) or 'none'}): no values of the stated inputs, "
        "however combined, are likely to bring all three numbers of such a set to the measured ones. "
        f"{len(quiet)} of them show no error in any number alone.",
        f"Direction: {ways}. The largest part of the distance is that of {parts or 'none'} of the rejected.",
    ]


def _picture(errors: Sequence[JointError]) -> Picture:
    """Return the distances beside the errors of single numbers, over their uncertainties."""
    from scipy.stats import chi2

    sets, at = tuple(error.set for error in errors), np.arange(len(errors), dtype=float)
    limit = float(chi2.isf(LEVEL, len(SHOWN)))
    alone = {
        name: [(i, error.E[k] / error.u[k]) for i, error in enumerate(errors)] for k, name in enumerate(SHOWN)
    }
    together = Series("D2", [error.distance for error in errors], at, "points", 3)
    panels = (
        error_panel("One by one", sets, alone),
        Panel("Together", "D2", "", (together,), (Mark(limit, f"{100 * LEVEL:.0f} %"),), rows=sets),
    )
    caption = (
        "Errors over their uncertainty, one by one (beyond about 2: an error) and together (right of the "
        "line)."
    )
    return Picture("joint", caption, panels, columns=2)


def _jobs(name: str, request: Request) -> list[Job]:
    """Return the run of the reduced model as a set is stated, and those of the sample of its inputs."""
    scene = replace_all(load(name), {"save.frames": 0})
    sample = sample_jobs(name, scene, unit_sample(QUICK_SIZE if request.quick else SIZE), "modal")
    return [Job(f"{name}-nominal", scene, "modal"), *sample]


def of_set(
    name: str, request: Request, results: JobResults, rows: Sequence[dict[str, float]]
) -> JointError | None:
    """Return the joint error of a set from S, D and uncertainties; None where its runs failed."""
    measured = measured_set(name)
    nominal, *sample = (results.get(job.name) for job in _jobs(name, request))
    runs = [run for run in sample if isinstance(run, Outcome)]
    if not isinstance(nominal, Outcome) or len(runs) < FEWEST:
        return None
    at_nominal = np.array(outputs(nominal, measured))[AT]
    moved = np.array([outputs(run, measured) for run in runs])[:, AT] - at_nominal
    columns = measured.recomputed()
    tests = np.column_stack([columns[NAMES[at]] for at in AT])
    return joint_error(name, rows, moved, tests)


@cache
def stored_rows() -> dict[str, list[dict[str, float]]]:
    """Return of each set a row a number of `SHOWN`, by finite elements."""
    rows = {(row["set"], row["quantity"]): row for row in read_table("studies/data/validation.csv")}
    keys = "S", "D", "u_num", "u_input", "u_D"
    return {
        name: [{key: float(rows[name, quantity][key]) for key in keys} for quantity in SHOWN]
        for name, _ in rows
    }
