"""Where the energy of a dropped rod goes: explicit finite elements beside rigid theory.

The names that users need; each is imported from its module when it is first asked for, so that
``import fem_impact`` costs nothing. The submodules hold the rest.

Examples
--------
>>> import fem_impact
>>> scene = fem_impact.replace(fem_impact.load("t5b"), "accuracy.tip_size", "0.5 mm")
>>> outcome = fem_impact.simulate(scene, "rigid")
>>> round(outcome.motion.v_n, 4)
-1.5024
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from fem_impact.version import __version__ as __version__

if TYPE_CHECKING:
    from fem_impact.answers.simulate import simulate
    from fem_impact.answers.sweep import sweep
    from fem_impact.answers.sweep_results import Results
    from fem_impact.answers.validate import Validation, validate
    from fem_impact.answers.verdict.assess import Verdict, assess
    from fem_impact.answers.verdict.limit import judge
    from fem_impact.answers.verdict.limit_verdict import LimitVerdict
    from fem_impact.case.case import Case
    from fem_impact.fem.exchange import to_meshio, to_pyvista, to_skfem
    from fem_impact.figures.runs import draw_waves
    from fem_impact.files.fields import read_fields
    from fem_impact.files.waves import read_waves
    from fem_impact.films.film import render
    from fem_impact.modal.rod import modes
    from fem_impact.options import RunOptions
    from fem_impact.outcome.keys import Unknown, known
    from fem_impact.outcome.record import Outcome
    from fem_impact.pages.write import write_report
    from fem_impact.progress import silent
    from fem_impact.scene import units
    from fem_impact.scene.shipped import load, replace, replace_all
    from fem_impact.scene.types import Scene
    from fem_impact.scene.units import format_quantity, parse_quantity
    from fem_impact.tables.history import read_history

__all__ = [
    "Case",
    "LimitVerdict",
    "Outcome",
    "Results",
    "RunOptions",
    "Scene",
    "Unknown",
    "Validation",
    "Verdict",
    "assess",
    "draw_waves",
    "format_quantity",
    "judge",
    "known",
    "load",
    "modes",
    "parse_quantity",
    "read_fields",
    "read_history",
    "read_waves",
    "render",
    "replace",
    "replace_all",
    "silent",
    "simulate",
    "sweep",
    "to_meshio",
    "to_pyvista",
    "to_skfem",
    "units",
    "validate",
    "write_report",
]

_PLACES = {
    "Case": "case.case:Case",
    "LimitVerdict": "answers.verdict.limit_verdict:LimitVerdict",
    "Outcome": "outcome.record:Outcome",
    "Results": "answers.sweep_results:Results",
    "RunOptions": "options:RunOptions",
    "Scene": "scene.types:Scene",
    "Unknown": "outcome.keys:Unknown",
    "Validation": "answers.validate:Validation",
    "Verdict": "answers.verdict.assess:Verdict",
    "assess": "answers.verdict.assess:assess",
    "draw_waves": "figures.runs:draw_waves",
    "format_quantity": "scene.units:format_quantity",
    "judge": "answers.verdict.limit:judge",
    "known": "outcome.keys:known",
    "load": "scene.shipped:load",
    "modes": "modal.rod:modes",
    "parse_quantity": "scene.units:parse_quantity",
    "read_fields": "files.fields:read_fields",
    "read_history": "tables.history:read_history",
    "read_waves": "files.waves:read_waves",
    "render": "films.film:render",
    "replace": "scene.shipped:replace",
    "replace_all": "scene.shipped:replace_all",
    "silent": "progress:silent",
    "simulate": "answers.simulate:simulate",
    "sweep": "answers.sweep:sweep",
    "to_meshio": "fem.exchange:to_meshio",
    "to_pyvista": "fem.exchange:to_pyvista",
    "to_skfem": "fem.exchange:to_skfem",
    "units": "scene.units:",  # the module itself
    "validate": "answers.validate:validate",
    "write_report": "pages.write:write_report",
}


def __getattr__(name: str) -> object:
    """Import what the menu names, and keep it."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, _, attribute = _PLACES[name].partition(":")
    home = import_module(f"{__name__}.{module}")
    value: object = getattr(home, attribute) if attribute else home
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
