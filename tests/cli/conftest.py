"""Stand-ins for the solver and its siblings, so that the command line is tested by itself."""

import types
from dataclasses import dataclass, field

import outcome_maker
import pytest

from fem_impact.options import RunOptions
from fem_impact.outcome.record import KEYS
from fem_impact.progress import Progress

SUMMARY = "# Sets\n\n- The answer.\n\n`fem-impact study sets --quick`: 3 runs, 0 failed.\n"


def an_outcome(**changed):
    """Return a complete outcome; what a test does not set is a plausible value of its kind, or not known."""
    nulls = {key.name: None for key in KEYS if key.nullable}
    plain = {"scene_id": "t5b", "E_vib_below_floor": False, "E_0_J": 0.39, "mu": 0.5}
    plain |= {"v_bn_m_per_s": 0.0, "v_bt_m_per_s": 0.0}
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


@pytest.fixture
def stand(monkeypatch):
    """Replace simulate, run_study, present, render, render_side_by_side and write_report."""
    stand = Stand()

    def work(name, result):
        def called(*args, **_):
            stand.calls.append((name, args))
            options = [arg.progress for arg in args if isinstance(arg, RunOptions)]
            progress = next((arg for arg in [*options, *args] if callable(arg)), None)
            if progress:
                progress(Progress(1e-4, 2.5e-3, 4000, 1e-6, "touching, 12 nodes", 61.0))
            if stand.error:
                raise stand.error
            return result()

        return called

    document = {"rows": [{"id": "t4", "e": 0.2}], "comparison": [], "failures": [], "notes": ["f matters"]}
    table = types.SimpleNamespace(document=document, text=SUMMARY, runs=("sets/t4",))
    film = types.SimpleNamespace(path=None, notes=["install libegl1"])
    for place, result in {
        "fem_impact.answers.simulate.simulate": lambda: stand.outcome or an_outcome(),
        "fem_impact.evidence.runner.run_study": lambda: table,
        "fem_impact.films.film.render": lambda: film,
        "fem_impact.films.film.render_side_by_side": lambda: film,
        "fem_impact.pages.write.write_report": lambda: "report.html",
    }.items():
        monkeypatch.setattr(place, work(place.rpartition(".")[2], result))
    monkeypatch.setattr("fem_impact.answers.friction_spread.friction_spread", lambda *_: None)
    monkeypatch.setattr("fem_impact.pages.write.present", lambda *_: ["no film: no GL"])
    return stand
