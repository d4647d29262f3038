"""Options and help of the commands that take one scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.command import add_cluster, add_command, add_out, add_page, add_scene, add_workers
from fem_impact.cli.options import seconds
from fem_impact.options import FIDELITIES

if TYPE_CHECKING:
    import argparse

    from fem_impact.cli.command import Commands

ROD = '\\\n      --length "80 mm" --diameter "19 mm" --angle "45 deg"'


def add_run(commands: Commands) -> None:
    """Add ``run``."""
    examples = ("fem-impact run quick", "fem-impact run t5b --fidelity modal --set impact.angle='30 deg'")
    summary = "compute one scene and write its results"
    parser = add_command(commands, "run", summary, "fem_impact.cli.run:run", examples)
    add_scene(parser)
    parser.add_argument(
        "--fidelity",
        choices=FIDELITIES,
        default="",
        help="rigid: impulses (at once); modal: vibration modes and a contact law (a second); "
        "solid: finite elements (default)",
    )
    parser.add_argument(
        "--budget",
        default="",
        metavar="TIME",
        help="wall time on the cores used, one or two, for a scene that states its error, if no similar "
        "scene was measured (default: 2 min)",
    )
    add_out(parser, "results/SCENE")
    parser.add_argument("--resume", action="store_true", help="go on from the checkpoint of a stopped run")
    parser.add_argument(
        "--checkpoint",
        type=seconds,
        default=30.0,
        metavar="SECONDS",
        help="time between checkpoints (default: 30)",
    )


def add_check(commands: Commands) -> None:
    """Add ``check``."""
    summary = "check a scene and say what it comes to, without computing"
    examples = (
        "fem-impact check t5b --long",
        "fem-impact check t5b --set accuracy.tip_size='0.5 mm'",
        "fem-impact check tube --drawing tube.svg",
    )
    parser = add_command(commands, "check", summary, "fem_impact.cli.check:check", examples)
    add_scene(parser)
    told = "print every value with its source, flow stresses, and what each effect adds"
    parser.add_argument("--long", action="store_true", help=told)
    drawing = "draw the projectile with its materials, first contact and mass centre into a .png or .svg file"
    parser.add_argument("--drawing", type=Path, default=None, metavar="FILE", help=drawing)


def add_scenes(commands: Commands) -> None:
    """Add ``scenes``."""
    handler = "fem_impact.cli.run:scenes"
    examples = "fem-impact scenes", "fem-impact scenes --materials"
    parser = add_command(commands, "scenes", "list the shipped scenes, or the materials", handler, examples)
    parser.add_argument("--materials", action="store_true", help="list the shipped materials instead")


def add_sweep(commands: Commands) -> None:
    """Add ``sweep``."""
    examples = (
        "fem-impact sweep t5b --vary impact.angle=15..60:5deg",
        "fem-impact sweep t5b --vary impact.angle=30,45deg --vary impact.speed=1,2m/s",
    )
    summary = "compute a scene with values varied in all combinations"
    parser = add_command(commands, "sweep", summary, "fem_impact.cli.sweep:sweep", examples)
    add_scene(parser)
    values = (
        "values of one key, such as impact.angle=15..60:5deg or projectile.length=0.2,0.4m; may be repeated"
    )
    parser.add_argument(
        "--vary", action="append", required=True, metavar="KEY=VALUES", default=[], help=values
    )
    parser.add_argument("--fidelity", choices=FIDELITIES, default="", help="of the runs (default: modal)")
    columns = "numbers of the outcome to print and draw, such as e_edge,W_skin_over_E_0; sweep.csv holds all"
    parser.add_argument("--columns", default="", metavar="NAMES", help=columns)
    add_out(parser, "below results")
    add_workers(parser)
    add_cluster(parser)


def add_cost(commands: Commands) -> None:
    """Add ``cost``."""
    examples = ('fem-impact cost t5b --target "5 %" --budget "30 s" --of e,mu',)
    summary = "show what accuracy costs: error and computing time of every setting"
    parser = add_command(commands, "cost", summary, "fem_impact.cli.cost:cost", examples)
    add_scene(parser)
    for option, metavar, text in (
        ("--target", "SHARE", "name the cheapest setting within an error, such as '2 %%'"),
        (
            "--budget",
            "TIME",
            "run no more than fits into so much wall time, such as '30 s', and name the best setting within "
            "it; here one run at a time on one core, where `run` uses two",
        ),
        ("--of", "NAMES", "quantities that count, as --of e,mu (default: e,E_vib)"),
        ("--finest", "SIZE", "smallest element at the tip, such as '0.25 mm' (default: three meshes)"),
    ):
        parser.add_argument(option, default="", metavar=metavar, help=text)
    parser.add_argument("--stored", action="store_true", help="judge what has run so far, and run nothing")
    add_out(parser, "results/cost/SCENE")
    add_page(parser, "with SCENE = paper, also")


def add_assess(commands: Commands) -> None:
    """Add ``assess``."""
    examples = (
        "fem-impact assess t5b",
        f'fem-impact assess --height "0.82 m" --surface machined {ROD}',
    )
    summary = "say whether rigid theory may be used for a scene, and what vibration costs"
    parser = add_command(commands, "assess", summary, "fem_impact.cli.assess:assess", examples)
    add_scene(parser, optional=True)
    parser.add_argument(
        "--fidelity",
        choices=["auto", "modal", "solid"],
        default="auto",
        help="auto (default): modal, and solid where the known error of modal leaves the answer open",
    )
    parser.add_argument("--tolerance", default="", help="change of e that may be neglected (default: 0.05)")
    parser.add_argument(
        "--budget",
        default="",
        metavar="TIME",
        help="wall time of the finite elements on the cores used, one or two (default: 60 s)",
    )
    add_workers(parser, "runs at a time, 1 or 2 (default: one a core)")
    carried = "also carry the measured tests over: losses, worst case, bound of the friction heat"
    parser.add_argument("--heat", action="store_true", help=carried)
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write a page to print and sign, and verdict.json"
    )
    short = parser.add_argument_group("a dropped steel rod, instead of SCENE")
    add_rod(short)
    short.add_argument("--height", help='drop height, such as "0.82 m"')
    short.add_argument("--angle", help='rod axis to barrier normal, such as "45 deg"')
    surfaces = ("machined", "contaminated", "cleaned")
    short.add_argument("--surface", choices=surfaces, help="state of tip and plate")


def add_rod(parser: argparse._ActionsContainer) -> None:
    """Add the options that describe a steel rod."""
    parser.add_argument("--length", help='of the rod, such as "240 mm"')
    parser.add_argument("--diameter", help='such as "19 mm"')
    tips = "A: round nose, B: rounded edge (default), plain: sharp edge, or one added to rigid.SHAPES"
    parser.add_argument("--tip", default="", help=tips)
    radii = "default: 7 mm for A, 3 mm for B; an added tip needs it"
    parser.add_argument("--tip-radius", metavar="LENGTH", help=radii)
