"""The words of the commands that need no finite elements: audit, coefficients, figure, assess."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]
    Command = Callable[[Commands, str, str, str], argparse.ArgumentParser]

__all__ = ["add_rigid_commands"]

_MODULE = "fem_impact.cli_rigid"


def add_rigid_commands(commands: Commands, command: Command) -> None:
    """Add the four commands; `command` adds one with the options that all share."""
    for add in (_add_audit, _add_coefficients, _add_figure, _add_assess):
        add(commands, command)


def _add_audit(commands: Commands, command: Command) -> None:
    words = "recompute every printed column of the paper's tables"
    parser = command(commands, "audit", words, f"{_MODULE}:audit")
    parser.add_argument("--set", dest="set_id", metavar="ID", help="one measured set, such as t5b")
    parser.add_argument("--out", type=Path, metavar="CSV", help="write every number with its recomputation")


def _add_coefficients(commands: Commands, command: Command) -> None:
    words = "work out e, mu and e_m of your own camera data, with intervals"
    parser = command(commands, "coefficients", words, f"{_MODULE}:coefficients")
    columns = "v_n_m_per_s, v_t_m_per_s, V_n_m_per_s, V_t_m_per_s, Omega_rad_per_s"
    parser.add_argument("file", type=Path, metavar="FILE.csv", help=f"one test a row; columns {columns}")
    _add_rod(parser)
    parser.add_argument("--angle", required=True, help='rod axis to barrier normal, such as "45 deg"')
    parser.add_argument("--d-c", metavar="LENGTH", help="arm along the slope (default: of the tip's shape)")
    parser.add_argument("--d-d", metavar="LENGTH", help="arm along the normal (default: of the tip's shape)")


def _add_figure(commands: Commands, command: Command) -> None:
    words = "draw a figure of the paper, with intervals and its data"
    parser = command(commands, "figure", words, f"{_MODULE}:figure")
    parser.add_argument("number", type=int, choices=(4, 5, 6, 7), help="of the paper")
    parser.add_argument("--out", type=Path, metavar="DIR", help="where to write (default: results/paper)")


def _add_assess(commands: Commands, command: Command) -> None:
    words = "assess a dropped rod: losses, worst case, bound of the friction heat"
    parser = command(commands, "assess", words, f"{_MODULE}:assess")
    _add_rod(parser)
    parser.add_argument("--height", required=True, help='drop height, such as "0.82 m"')
    parser.add_argument("--angle", required=True, help='rod axis to barrier normal, such as "45 deg"')
    surfaces = ("machined", "contaminated", "cleaned")
    parser.add_argument("--surface", required=True, choices=surfaces, help="state of tip and plate")
    words = "of the answer whether rigid theory may be used: modal (default, seconds) or solid (minutes)"
    parser.add_argument("--fidelity", choices=["modal", "solid"], default="modal", help=words)


def _add_rod(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--length", required=True, help='of the rod, such as "240 mm"')
    parser.add_argument("--diameter", required=True, help='such as "19 mm"')
    tips = "A: round nose, B: rounded edge (default), plain: sharp edge, or one added to rigid.SHAPES"
    parser.add_argument("--tip", default="B", help=tips)
    radii = "default: 7 mm for A, 3 mm for B; an added tip needs it"
    parser.add_argument("--tip-radius", metavar="LENGTH", help=radii)
