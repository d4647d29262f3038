"""Stand-ins for the solver and its siblings, so that the command line is tested by itself."""

import importlib
import sys
import types
from dataclasses import dataclass, field

import outcome_maker
import pytest

import fem_impact.study
from fem_impact.outcome.record import KEYS
from fem_impact.progress import Progress


def an_outcome(**changed):
    """Return a complete outcome; what a test does not set is a plausible value of its kind, or not known."""
    nulls = {key.name: None for key in KEYS if key.nullable}
    plain = {"scene_id": "t5b", "E_vib_below_floor": False, "E_0_J": 0.39, "mu": 0.5}
    limits = {"mesh_limit": {"mu": 0.5}, "mesh_band": {"mu": 0.01}, "contacts": []}
    why = {"reasons": dict.fromkeys(nulls, "not in the stand-in")}
    return outcome_maker.outcome(**nulls | plain | limits | why | changed)


@dataclass
class Stand:
    """What the stand-ins were called with, and what they do."""

    an_outcome = staticmethod(an_outcome)
    calls: list = field(default_factory=list)
    outcome: object = None
    error: BaseException | None = None


def _module(monkeypatch, name, **contents):
    module = types.ModuleType(name)
    module.__dict__.update(contents)
    monkeypatch.setitem(sys.modules, name, module)
    parent, _, last = name.rpartition(".")
    monkeypatch.setattr(importlib.import_module(parent), last, module, raising=False)


@pytest.fixture
def stand(monkeypatch):
    """Replace simulate, run_study, render and write_report."""
    stand = Stand()

    def work(name, result):
        def called(*args, **kwargs):
            stand.calls.append((name, args, kwargs))
            progress = kwargs.get("progress") or next((a for a in args if callable(a)), None)
            if progress:
                progress(Progress(1e-4, 2.5e-3, 4000, 1e-6, "touching, 12 nodes", 61.0))
            if stand.error:
                raise stand.error
            return result()

        return called

    document = {"rows": [{"id": "t4", "e": 0.2}], "comparison": [], "failures": [], "notes": ["f matters"]}
    table = types.SimpleNamespace(document=document, text="the table", notes=["no film: no GL"])
    film = types.SimpleNamespace(path=None, notes=["install libegl1"])
    _module(
        monkeypatch,
        "fem_impact.run.simulate",
        simulate=work("simulate", lambda: stand.outcome or an_outcome()),
    )
    monkeypatch.setattr(fem_impact.study, "run_study", work("run_study", lambda: table))
    films = {name: work(name, lambda: film) for name in ("render", "render_side_by_side")}
    _module(monkeypatch, "fem_impact.render", **films)
    _module(monkeypatch, "fem_impact.report", write_report=work("report", lambda: "report.html"))
    return stand
