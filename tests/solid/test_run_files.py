"""The files of one run: histories, contacts, fields and the outcome tell the same story."""

import subprocess
import sys

import numpy as np
import pytest

from fem_impact.fem.elements import lame_constants
from fem_impact.files.fields import read_fields
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest
from fem_impact.solid.rodview import centre_gradients, elastic_stress, mises
from fem_impact.tables.history import HISTORY
from fem_impact.tables.table import read_csv

ACCOUNTS = [name for name in HISTORY if name.startswith(("E_", "W_", "residual"))]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A coarse run that ends in mid-contact: short, and everything is in motion."""
    out = tmp_path_factory.mktemp("run")
    changes = {
        "accuracy.tip_size": "0.8 mm",
        "accuracy.across": 6,
        "accuracy.max_time": "0.1 ms",
        "accuracy.unresolved": "report",
        "save.frames": 60,
        "save.fields": "all",
    }
    told = []
    outcome = simulate(replace_all(load("t5b"), changes), options=RunOptions(out, told.append))
    return out, outcome, told


@pytest.mark.long
def test_the_run_says_that_it_was_cut_off(run):
    _, outcome, told = run
    assert outcome.validity.finished is False
    assert outcome.validity.stopped_because.startswith("Reached max_time = 0.1 ms")
    assert isinstance(outcome.energy.vibration_check, Unknown)
    assert told[-1].contact.endswith("nodes touch") and abs(told[-1].energy_drift) < 1e-5


NOT_REACHED = ("mu", "mu_c", "V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s", "strikes_again")
COEFFICIENTS = [f"{name}_edge{over}" for name, over in (("e", ""), ("e_m", ""), ("E_ln", "_over_E_0"))]
MARKERS = ("marker_V_n_m_per_s", "marker_Omega_rad_per_s")


def test_what_rests_on_the_last_separation_is_null_with_the_reason(run):
    """The energies at the stop stay, and sum to what the rod brought."""
    _, outcome, _ = run
    stated = outcome.to_dict()
    for name in (*NOT_REACHED, *COEFFICIENTS, "E_lt_edge_over_E_0", *MARKERS):
        assert stated[name] is None
        assert "before the last separation was certain" in stated["reasons"][name]
    for name in ("mu", "Omega_rad_per_s", "e_edge"):
        assert stated["reasons"][name].startswith("the run did not finish: Reached max_time = 0.1 ms")
    assert outcome.restitution.edge.d_c > 0
    energy = outcome.energy
    parts = (energy.rigid, energy.vibration, energy.friction, energy.plastic_rod, energy.plastic_barrier)
    more = (
        energy.locked_rod,
        energy.locked_barrier,
        energy.radiated,
        energy.contact_dissipation,
        energy.residual,
    )
    assert sum((*parts, *more)) == pytest.approx(1.0, abs=1e-4)  # less what vibrates above the modes
    assert not any(told.startswith(("e =", "mu =")) for told in texts(outcome.validity.limitations))
    assert "e=not known, mu=not known, Omega=not known" in repr(outcome)


@pytest.mark.long
def test_what_gravity_adds_closes_the_sum():
    slow = {
        "impact.v_n": "-0.1 m/s",
        "impact.v_t": "-0.1 m/s",
        "accuracy.tip_size": "0.8 mm",
        "accuracy.unresolved": "report",
        "save.frames": 0,
    }
    outcome = simulate(replace_all(load("quick"), slow))
    parts = ("E_r", "E_vib_check", "W_friction", "E_plastic_rod", "E_plastic_barrier", "E_locked_rod")
    parts += ("E_locked_barrier", "W_contact_dissipation", "residual")
    total = sum(outcome.to_dict()[f"{part}_over_E_0"] for part in parts)
    assert outcome.energy.gravity > 0.01
    assert total == pytest.approx(1 + outcome.energy.gravity, abs=1e-10)


def test_the_outcome_reads_back(run):
    out, outcome, _ = run
    assert Outcome.read(out / "outcome.json") == outcome
    assert digest(load(out / "scene.toml")) == outcome.provenance.scene_digest


def test_accounts_add_up_to_E_0_in_every_row(run):
    out, outcome, _ = run
    table = read_csv(out / "history.csv")
    total = sum(table.numbers(name) for name in ACCOUNTS)
    assert len(total) > 50
    assert total == pytest.approx(outcome.energy.E_0, rel=1e-12)
    assert np.abs(table.numbers("residual_J")).max() < 1e-5 * outcome.energy.E_0
    for name in ("W_friction_J", "E_plastic_rod_J", "E_plastic_barrier_J", "W_radiated_J"):
        assert (np.diff(table.numbers(name)) > -1e-9 * outcome.energy.E_0).all(), name


def test_the_last_row_is_the_outcome(run):
    out, outcome, _ = run
    table = read_csv(out / "history.csv")
    for column, key in (("W_friction_J", "W_friction"), ("E_plastic_barrier_J", "E_plastic_barrier")):
        share = table.numbers(column)[-1] / outcome.energy.E_0
        assert share == pytest.approx(outcome.to_dict()[f"{key}_over_E_0"], rel=0.02), column


def test_force_and_contacts_carry_the_same_impulse(run):
    out, outcome, _ = run
    table = read_csv(out / "history.csv")
    t = table.numbers("time_s")
    (contact,) = outcome.contact.intervals
    assert read_csv(out / "contacts.csv").numbers("impulse_n_Ns") == pytest.approx([contact.impulse_n])
    for axis in "nt":
        impulse = (table.numbers(f"force_{axis}_N")[1:] * np.diff(t)).sum()
        assert impulse == pytest.approx(getattr(contact, f"impulse_{axis}"), rel=0.02)


def test_fields_hold_both_bodies_in_motion(run):
    out, outcome, _ = run
    fields = read_fields(out / "fields.vtkhdf")
    last = len(fields.times) - 1
    assert len(fields.times) >= 8 and (np.diff(fields.times) > 0).all()
    body = np.asarray(fields.static["body"])
    counts = [(body == which).sum() for which in (0, 1)]
    assert counts == [outcome.cost.elements_rod, outcome.cost.elements_barrier]
    assert np.abs(fields.point_data("displacement", 0)).max() == 0.0
    rod = np.unique(fields.cells[body == 0])
    start = fields.point_data("velocity", 0)[rod]
    assert start[:, 2] == pytest.approx(outcome.motion.v_n, rel=1e-6)
    assert start[:, 0] == pytest.approx(outcome.motion.v_t, rel=1e-6)
    strain, stress = fields.cell_data("plastic_strain", last), fields.cell_data("mises", last)
    assert 0 < strain[body == 0].max() < 0.01  # the harder rod hardly yields
    assert strain[body == 1].max() > 0.01
    assert stress[(body == 1) & (strain > 0.01)].max() > 0.9 * 320e6
    assert (strain[np.linalg.norm(fields.points[fields.cells].mean(axis=1), axis=1) > 0.02] == 0).all()


def test_mises_of_a_uniform_strain():
    """Uniaxial strain e: sigma_1 - sigma_2 = 2 G e, which is the von Mises stress."""
    rng = np.random.default_rng(3)
    corners = np.array([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    x = corners + rng.uniform(-0.1, 0.1, corners.shape)
    cells = np.arange(8)[None]
    E, nu, e = 200e9, 0.3, 1e-4
    u = np.zeros((1, 8, 3))
    u[0, :, 1] = e * x[:, 1] + 7.0
    stress = elastic_stress(centre_gradients(x, cells), u, np.array([lame_constants(E, nu)]))
    assert mises(stress) == pytest.approx([E / (1 + nu) * e])
    c = E * e / ((1 + nu) * (1 - 2 * nu))
    assert np.diag(stress[0]) == pytest.approx([c * nu, c * (1 - nu), c * nu])


def test_stress_tensors_are_those_of_the_displacements_where_nothing_has_yielded(run):
    """The zone that may yield keeps its own stresses; both bodies."""
    out, _, _ = run
    fields = read_fields(out / "fields.vtkhdf")
    last = len(fields.times) - 1
    still = (fields.cell_data("plastic_strain", last) == 0) & (fields.cell_data("mises", last) > 50e6)
    gradient = centre_gradients(fields.points, fields.cells)
    u = fields.point_data("displacement", last).astype(float)[fields.cells]
    moduli = [lame_constants(E, 0.29) for E in (219e9, 206e9)]
    wanted = elastic_stress(gradient, u, np.array(moduli)[fields.static["body"]])[still]
    found = fields.cell_data("stress", last)[still]
    assert len(found) > 30
    for at, (i, j) in enumerate([(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]):
        assert np.median(np.abs(found[:, at] - wanted[:, i, j])) < 5e6, (i, j)
        assert np.abs(found[:, at]).max() > 3e7, (i, j)


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="the other count is that of Linux")
def test_peak_memory_is_that_of_the_process_alone():
    """A child starts with the largest memory of its parent in what getrusage counts."""
    held = b"x" * 400_000_000
    code = "from fem_impact.solid.run import _peak_memory; print(_peak_memory())"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert 20 < float(told) < 300 < len(held) / 1e6
