"""The studies: what each does, how many runs it takes and how long, its options and its help."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fem_impact.cli.command import (
    add_cluster,
    add_command,
    add_out,
    add_page,
    add_workers,
)

if TYPE_CHECKING:
    from fem_impact.cli.command import Commands

_HANDLER = "fem_impact.cli.study:study"


@dataclass(frozen=True, slots=True)
class Study:
    """What the help of a study tells.

    Attributes
    ----------
    summary : its line in the list of studies
    about : what it computes and concludes
    size, quick : runs and processor time of the whole study, and of the one with ``--quick``
    runs, quick_runs : the same numbers of runs; a test holds them to the study
    sets : the measured sets that it takes when none is named; empty where it takes none
    """

    summary: str
    about: str
    size: str
    quick: str
    runs: int
    quick_runs: int
    sets: str = ""


STUDIES = {
    "sets": Study(
        "the published series of tests beside the model",
        "Each of the thirteen measured sets by finite elements on two meshes, with the grid of the plate at "
        "two places, and again with each uncertain input changed. It compares e, mu, Omega, the velocities "
        "and the energies after impact with the tests, says which agree and what could explain those that do "
        "not, and shows where the energy went. A scene file that names your own tests (the key measured) is "
        "taken like a set.",
        "130 runs, some 10 min",
        "three sets, one place of the grid: 6 runs, under 1 min",
        130,
        6,
        "all thirteen",
    ),
    "convergence": Study(
        "their limits for vanishing elements",
        "Measured sets on three meshes, each at several places of the plate's grid, and what "
        "vanishing elements would give: the limit of each quantity, its order, and the band of two meshes "
        "beside it.",
        "40 runs, some 15 min",
        "a coarser mesh for the finest, one place of the grid: 12 runs, some 2 min",
        40,
        12,
        "t3-machined, t3-contaminated, t5b, t6-17",
    ),
    "gamma": Study(
        "vibration against slenderness",
        "Which share of the energy vibration takes, against the slenderness gamma from 10 to 120: steel rods "
        "of 19 mm at 45 degrees and 2.1 m/s, elastic and yielding, for every state of the surface; then "
        "other diameters, speeds and angles, and strength from hardness. Finite elements on two meshes, "
        "three measured sets and the reduced model beside them. It says what the published limit, gamma = "
        "26.45, means.",
        "1407 runs, most with finite elements, some 50 min; where the band is wide a finer mesh follows, as "
        "at half of the points of the full study, and at a fifth of them a second: some 2.5 h in all",
        "five rods on coarse elements: 61 runs, some 2 min",
        1407,
        61,
    ),
    "criterion": Study(
        "when a rod may be called rigid",
        "Restitution against inclination from 1 to 80 degrees of rods that vibrate and of the same rods that "
        "cannot: by how much rigid theory is wrong, against the slenderness gamma and against the ratio of "
        "bending period to contact time, T1/tau. It says where the published limit and its exponent come "
        "from.",
        "2629 runs, 680 of them finite elements, some 70 min",
        "a few rods and angles: 195 runs, under 1 min",
        2629,
        195,
    ),
    "effects": Study(
        "effects chosen by the scene beside everything on, and what each costs",
        "Scenes with the effects that the program chooses for them, beside the same scenes with all effects "
        "on: how much e and the vibration energy change, and how much computing time each effect takes. The "
        "measured sets, and others that are short and long, slow and fast, hard and soft.",
        "87 runs, some 5 min",
        "three scenes: 17 runs, under 1 min",
        87,
        17,
        "all thirteen and the others",
    ),
    "reduced": Study(
        "the reduced model beside the finite elements",
        "Each scene by both models (fidelity modal and solid): the measured sets, scenes that the reduced "
        "model was made with, and scenes drawn at random. Its table is what every outcome of the reduced "
        "model is judged by.",
        "86 runs, half of them finite elements, some 10 min",
        "four random scenes: 8 runs, under 1 min",
        86,
        8,
    ),
    "causes": Study(
        "what rate, hardness and a hard skin change, one after the other and alone",
        "A measured set without any effect of the strain rate on the flow stress; then with the nominal rate "
        "law, with flow stress from hardness, and with a hardened skin, one after the other and each alone. "
        "It shows e, mu and Omega of every step beside the tests.",
        "12 runs, some 2 min",
        "t5b on coarse elements: 6 runs, under 1 min",
        12,
        6,
        "t5b, t6-17",
    ),
    "tip": Study(
        "what the rows of Table 3 say about the tip of its rods",
        "The caption of Table 3 says tip B. Which arms of the contact point fit the rotation of its rows by "
        "momentum alone, and what finite elements give with either tip, beside the tests. Tip A is shown "
        "beside the measured sets and counted in none of their numbers.",
        "24 runs, some 5 min",
        "the machined rod on coarse elements: 4 runs, under 1 min",
        24,
        4,
    ),
    "validation": Study(
        "errors of the model with every uncertainty (ASME V&V 20), and what causes them",
        "The difference between model and tests of each measured set beside the standard uncertainties of "
        "mesh, inputs and measurement; which input causes how much of it; and the values of the inputs that "
        "would meet all sets at once. All inputs vary together, in 64 runs a set.",
        "884 runs, some 50 min",
        "t5b with 16 runs a set: 18 runs, under 1 min",
        884,
        18,
        "all thirteen",
    ),
}

REPORT = "one page over all studies beside it"
_REPORT_ABOUT = (
    "Read the studies in the directories beside --out, and write one HTML page over them: conclusions with "
    "their figures, comparison with the tests, energy of every run, papers behind the methods. It computes "
    "nothing and takes some ten seconds."
)


def add_study(commands: Commands) -> None:
    """Add ``study`` with a command for each study."""
    summary = "compute many runs and draw conclusions from them"
    parser = add_command(commands, "study", summary, _HANDLER, ("fem-impact study sets --quick",))
    several = parser.add_subparsers(
        title="studies",
        dest="name",
        metavar="NAME",
        required=True,
        description="fem-impact study NAME --help tells what a study does and how long it takes",
    )
    for name, study in STUDIES.items():
        _add_one(several, name, study)
    lines = ("fem-impact study report",)
    report = add_command(several, "report", REPORT, _HANDLER, lines, _REPORT_ABOUT)
    add_out(report, "results/report")


def _add_one(several: Commands, name: str, study: Study) -> None:
    """Add one study: its help, the sets it takes, and the options of many runs."""
    first_look = f"With --quick, which is a first look and no result: {study.quick}."
    times = f"Size and processor time: {study.size}. {first_look}"
    examples = (f"fem-impact study {name} --quick", f"fem-impact study {name} --estimate")
    parser = add_command(several, name, study.summary, _HANDLER, examples, f"{study.about}\n\n{times}")
    if study.sets:
        own = " or scene files with own tests" if name in OWN_TESTS else ""
        taken = f"measured sets, such as t5b{own} (default: {study.sets})"
        parser.add_argument("ids", nargs="*", default=[], metavar="ID", help=taken)
    parser.add_argument("--quick", action="store_true", help="the small version, for a first look")
    add_out(parser, f"results/{name}")
    add_workers(parser)
    add_cluster(parser)
    parser.add_argument(
        "--estimate", action="store_true", help="say how long it takes on 1 to 1000 workers, and stop"
    )
    add_page(parser, "also")


OWN_TESTS = ("sets",)
"""Studies that take scene files with own tests."""
