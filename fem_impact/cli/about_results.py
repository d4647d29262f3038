"""Options and help of the commands about results, own camera data, and the program itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.about_scenes import ROD, add_rod
from fem_impact.cli.command import add_changes, add_command
from fem_impact.cli.options import size

if TYPE_CHECKING:
    from fem_impact.cli.command import Commands

FILMED = ("strain", "stress", "velocity", "plastic")  # what a film can show, the default first
SHELLS = ("bash", "zsh", "tcsh")
_RESULT = "directory that a run or a study wrote"


def add_render(commands: Commands) -> None:
    """Add ``render``."""
    examples = ("fem-impact render results/quick", "fem-impact render results/quick --until '0.1 ms'")
    summary = "make a film of the stress waves"
    parser = add_command(commands, "render", summary, "fem_impact.cli.show:render", examples)
    several = f"{_RESULT}; several make one film side by side"
    film = "film: .mp4, .webp, .gif, .png for a folder, or .html to turn it (default: beside the fields)"
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help=several)
    parser.add_argument("--out", type=Path, metavar="FILE", help=film)
    parser.add_argument(
        "--field",
        choices=FILMED,
        default=FILMED[0],
        help="colours of the film (default: strain along the axis)",
    )
    parser.add_argument("--frames", type=int, metavar="N", help="number of frames (default: 144)")
    for option, name, text in (
        ("--from", "first", "first time, such as '20 us'"),
        ("--until", "last", "last time, such as '0.3 ms'"),
        ("--speed", "speed", "motion in one second of the film, such as '25 us'"),
    ):
        parser.add_argument(option, dest=name, default="", metavar="TIME", help=text)
    pixels = "size of the film in pixels, multiples of 16 (default: 1280x720)"
    parser.add_argument("--size", type=size, default=(1280, 720), metavar="WxH", help=pixels)


def add_report(commands: Commands) -> None:
    """Add ``report``."""
    summary, examples = "write the report as one HTML file", ("fem-impact report results/quick",)
    parser = add_command(commands, "report", summary, "fem_impact.cli.show:report", examples)
    parser.add_argument("result", type=Path, metavar="RESULT", help=_RESULT)


def add_coefficients(commands: Commands) -> None:
    """Add ``coefficients``."""
    summary = "work out e, mu and e_m of your own camera data, with intervals"
    handler = "fem_impact.cli.rigid:coefficients"
    examples = (
        f"fem-impact coefficients tests.csv {ROD}",
        "fem-impact coefficients tests.csv --scene tube",
    )
    parser = add_command(commands, "coefficients", summary, handler, examples)
    columns = "v_n_m_per_s, v_t_m_per_s, V_n_m_per_s, V_t_m_per_s, Omega_rad_per_s"
    parser.add_argument("file", type=Path, metavar="FILE.csv", help=f"one test a row; columns {columns}")
    rod = parser.add_argument_group("a solid steel rod")
    add_rod(rod)
    rod.add_argument("--angle", help='rod axis to barrier normal, such as "45 deg"')
    own = parser.add_argument_group("any other projectile, such as a tube, instead of that rod")
    about = "scene whose projectile was tested at its inclination: id or path of a scene file"
    own.add_argument("--scene", metavar="SCENE", default="", help=about)
    add_changes(own)
    parser.add_argument("--d-c", metavar="LENGTH", help="arm along the slope (default: of the tip's shape)")
    parser.add_argument("--d-d", metavar="LENGTH", help="arm along the normal (default: of the tip's shape)")


def add_schema(commands: Commands) -> None:
    """Add ``schema``."""
    about = (
        "Print the JSON Schema (draft 7) of outcome.json, which `run` writes and `run --json` prints: every "
        "key with its meaning and type."
    )
    summary, handler = "print the JSON Schema of outcome.json", "fem_impact.cli.show:schema"
    add_command(commands, "schema", summary, handler, ("fem-impact schema > outcome.schema.json",), about)


def add_completion(commands: Commands) -> None:
    """Add ``completion``."""
    about = (
        "Print a script by which the shell completes commands and options when you press Tab. It needs the "
        "package shtab: pip install 'fem-impact[completion]'."
    )
    examples = ('eval "$(fem-impact completion bash)"',)
    handler = "fem_impact.cli.completion:completion"
    summary = "print a script that lets the shell complete commands and options"
    parser = add_command(commands, "completion", summary, handler, examples, about)
    parser.add_argument("shell", choices=SHELLS, help="your shell")
