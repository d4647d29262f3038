"""Forces, motion and energies over time of the reduced model, in the file that finite elements write."""

import numpy as np
import pytest

from fem_impact.figures.runs import force_picture, ledger_picture
from fem_impact.modal.motion import MOST_ROWS
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import known
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.tables.history import read_history


def run(path, name="t5b", **changes):
    outcome = simulate(replace_all(load(name), changes), "modal", RunOptions(out=path))
    return outcome, read_history(path / "history.csv")


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("t5b", {}),
        ("t5b", {"effects": ["vibration", "friction", "barrier-elastic"]}),
        ("t3-machined", {}),
        ("plate-10mm", {}),
        ("free-barrier-5kg", {"barrier.inertia": "0.01 kg m2", "barrier.centre_depth": "40 mm"}),
    ],
)
def test_energies_add_up_at_every_time_and_forces_give_the_impulses(tmp_path, name, changes):
    outcome, history = run(tmp_path, name, **changes)
    time, force = history.numbers("time_s"), history.numbers("force_n_N")
    E_0 = outcome.energy.E_0
    assert np.abs(history.numbers("residual_J")).max() < 2e-4 * E_0
    impulse = sum(one.impulse_n for one in outcome.contact.intervals)
    assert np.trapezoid(force, time) == pytest.approx(impulse, rel=5e-3)
    assert force.max() == pytest.approx(outcome.contact.peak_force, rel=1e-3)
    last = {name: history.numbers(name)[-1] for name in history.names}
    assert last["W_friction_J"] == pytest.approx(
        known(outcome.energy.friction) * E_0, rel=1e-3, abs=1e-6 * E_0
    )
    assert history.numbers("E_kinetic_rod_J")[0] == pytest.approx(E_0, rel=1e-3)


def test_its_plastic_work_is_that_of_the_outcome_where_the_barriers_surface_takes_most(tmp_path):
    weak = {"barrier.material.yield_stress": "500 MPa", "barrier.material.ultimate_stress": "650 MPa"}
    outcome, history = run(tmp_path, **{"impact.angle": "70 deg", "surface.friction": 0.6}, **weak)
    E = outcome.energy
    for body, part in (("rod", E.plastic_rod), ("barrier", E.plastic_barrier)):
        assert history.numbers(f"E_plastic_{body}_J")[-1] == pytest.approx(known(part) * E.E_0, rel=2e-3)


def test_the_history_ends_with_the_motion_of_the_outcome(tmp_path):
    outcome, history = run(tmp_path, effects=["vibration", "friction", "barrier-elastic"])
    for column, value in (("V_n_m_per_s", outcome.motion.V_n), ("Omega_rad_per_s", outcome.motion.Omega)):
        assert history.numbers(column)[-1] == pytest.approx(value, rel=2e-3)


def test_a_long_run_keeps_every_second_row(tmp_path):
    outcome, history = run(tmp_path, "t3-contaminated")
    assert outcome.cost.steps > MOST_ROWS
    assert MOST_ROWS // 2 <= len(history.rows) < MOST_ROWS
    steps = np.diff(history.numbers("time_s"))
    assert steps.max() < 1.6 * np.median(steps) and steps.min() > 0.4 * np.median(steps)


def test_recording_changes_no_number(tmp_path):
    plain, recorded = simulate(load("t5b"), "modal"), run(tmp_path)[0]
    assert plain.motion == recorded.motion and plain.energy == recorded.energy


def test_the_pictures_of_a_report_are_drawn_from_it(tmp_path):
    outcome, history = run(tmp_path)
    ledger = ledger_picture(history, outcome.energy.E_0)
    (panel,) = ledger.panels
    assert any("held by the contact" in series.label for series in panel.series)
    force = force_picture(history, known(outcome.contact.intervals))
    assert max(force.panels[0].series[0].y) == pytest.approx(outcome.contact.peak_force / 1e3, rel=1e-3)
