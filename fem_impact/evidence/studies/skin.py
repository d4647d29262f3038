"""The measured sets with what their printed hardness says of a hardened layer, and with friction over speed.

Every layer is derived: the tensile tests of both steels and their printed hardness leave a curve of factors
and depths (`fem_impact.physics.indentation`), of which two points are run at a load that is assumed, since
none is printed. No impact enters. Which point agrees best is shown; to take it would be a calibration.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fem_impact import Outcome, RunOptions, Scene, known, load, replace_all, simulate
from fem_impact.answers.compare import MEASURED
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.answers.v_and_v import LEVEL
from fem_impact.evidence.studies import joint
from fem_impact.evidence.studies.report_parts import asked_sets, error_panel, rests_on
from fem_impact.evidence.studies.validated import SHOWN
from fem_impact.figures.panels import Picture
from fem_impact.jobs.job import Job, JobResults
from fem_impact.tables.table import Table

LOAD = 30  # kgf, assumed: the paper prints none


LAW = {"surface.sliding_law": "dry-rail"}
SKIN_2, SKIN_1_5 = (
    {f"{body}.material.skin": {"factor": factor, "load": LOAD} for body in ("projectile", "barrier")}
    for factor in (2.0, 1.5)
)
RESOLVED = {"accuracy.fine_zone": "skin", "accuracy.tip_size": "0.14 mm"}  # three rows of cells in each layer
BUDGET = 3600.0  # s of wall time: the last level of the long rods takes some 5 min
INPUTS: Mapping[str, dict[str, Any]] = {
    "skin 2": SKIN_2 | RESOLVED,
    "skin 1.5": SKIN_1_5,
    "skin 2, dry-rail": SKIN_2 | RESOLVED | LAW,
    "dry-rail": LAW,
}
"""Changed keys of the scenes by the name of the inputs."""
DEFAULT, EFFECT = "default", "machined-skin"
KEYS = [quantity.key for quantity in MEASURED if quantity.name in SHOWN]
ERRORS = [f"{part} {name}" for name in SHOWN for part in ("S", "E", "u_val")]
HEAD = ("set", "inputs", *ERRORS, "D2", "p", "jointly")


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return a run by finite elements a set and inputs, and those of the reduced model by the study joint."""
    runs = [_job(name, inputs) for inputs in INPUTS for name in asked_sets(request)]
    first = len(asked_sets(request))
    return [*runs[:first], *joint.plan(request, results), *runs[first:]]


def _job(name: str, inputs: str) -> Job:
    scene: Scene = replace_all(load(name), INPUTS[inputs] | {"save.frames": 0})
    return Job(f"{name}, {inputs}", scene, way=_unhurried)


def _unhurried(scene: Scene, fidelity: str, options: RunOptions) -> Outcome:
    return simulate(scene, fidelity, options, budget_s=BUDGET)


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study: each set's errors with every inputs, and how many sets they reject."""
    errors = {
        name: {
            inputs: error
            for inputs in (DEFAULT, *INPUTS)
            if (error := _joint(name, inputs, request, results))
        }
        for name in asked_sets(request)
    }
    rows = [
        (
            *(name, inputs),
            *(
                number
                for at in range(len(SHOWN))
                for number in (error.E[at] + D[at], error.E[at], error.u[at])
            ),
            *(error.distance, error.p, "rejected" if error.p < LEVEL else "agrees"),
        )
        for name, of_inputs in errors.items()
        for D in [[row["D"] for row in joint.stored_rows()[name]]]
        for inputs, error in of_inputs.items()
    ]
    sentences = _sentences(errors)
    return StudyReport(
        "skin",
        "The measured sets with a hardened skin from their hardness",
        sentences,
        [_picture(errors)],
        [Sheet("skin", "Errors of each set with each of the inputs", Table.of(HEAD, rows))],
        [*rests_on("skin", LOAD=LOAD), *_left_out(results)],
        conclusions=[("skin", sentence) for sentence in sentences],
    )


def _left_out(results: JobResults) -> list[str]:
    """Say of which runs the layer is too thin beside the contact to count as an effect."""
    none = [
        name
        for name, run in results.items()
        if ", skin" in name and isinstance(run, Outcome) and EFFECT not in run.provenance.effects
    ]
    sentence = (
        f"The layer is too thin beside the contact to be an effect, and left out, in: {'; '.join(none)}."
    )
    return [sentence] if none else []


def _joint(name: str, inputs: str, request: Request, results: JobResults) -> joint.JointError | None:
    """Return the joint error of a set with some inputs; None where a run failed or has no band."""
    stored = joint.stored_rows()[name]
    if inputs == DEFAULT:
        return joint.of_set(name, request, results, stored)
    run = results.get(_job(name, inputs).name)
    if not isinstance(run, Outcome):
        return None
    rows = [
        row | {"S": known(S), "u_num": band / 2}
        for row, (S, band) in zip(stored, map(run.estimate, KEYS), strict=True)
        if band is not None
    ]
    return joint.of_set(name, request, results, rows) if len(rows) == len(stored) else None


def _sentences(errors: Mapping[str, Mapping[str, joint.JointError]]) -> list[str]:
    """Return of every inputs how many sets are rejected, and the mean distance of the numbers."""
    sentences = []
    for inputs in (DEFAULT, *INPUTS):
        of = [error[inputs] for error in errors.values() if inputs in error]
        if not of:
            continue
        rejected = [error.set for error in of if error.p < LEVEL]
        away = np.sqrt(np.mean([(error.E / error.u) ** 2 for error in of], axis=0))
        parts = ", ".join(f"{name} {far:.2g}" for name, far in zip(SHOWN, away, strict=True))
        sentences.append(
            f"{inputs}: {len(rejected)} of {len(of)} sets are rejected ({', '.join(rejected) or 'none'}); "
            f"root mean square of E / u_val: {parts}."
        )
    return sentences


def _picture(by_set: Mapping[str, Mapping[str, joint.JointError]]) -> Picture:
    """Return E / u_val of each number, a panel each, of every inputs by sets."""
    panels = []
    for at, name in enumerate(SHOWN):
        errors = {
            inputs: [
                (k, error[inputs].E[at] / error[inputs].u[at])
                for k, error in enumerate(by_set.values())
                if inputs in error
            ]
            for inputs in (DEFAULT, *INPUTS)
        }
        panels.append(error_panel(name, tuple(by_set), errors))
    caption = (
        "Errors over their uncertainty with each of the inputs; beyond about 2 a number shows an error alone."
    )
    return Picture("skin", caption, tuple(panels), columns=3)
