"""The plain scikit-fem drop of the documentation against the solver, which saves work wherever it can."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from fem_impact.case.case import Case
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load
from fem_impact.solid.build import build
from fem_impact.solid.run import solve

sys.path.append(str(Path(__file__).parents[2] / "docs" / "examples"))
import plain_elastic_drop as plain


@pytest.fixture(scope="module")
def scene():
    """A short rod that slides, then sticks, on cells as coarse at the tip as elsewhere."""
    base = load("t5b")
    accuracy = replace(base.accuracy, tip_size=base.projectile.diameter / 8, across=8, unresolved="report")
    surface = replace(base.surface, state="custom", friction=0.57, friction_low=0.57, friction_high=0.57)
    save = replace(base.save, frames=0)
    return replace(
        base,
        id="test",
        measured=None,
        effects=plain.EFFECTS,
        accuracy=accuracy,
        surface=surface,
        save=save,
    )


def test_the_plain_drop_is_the_solvers_within_what_its_masses_lack(scene):
    """The solver's nose has the mass of the round tip (+.3 %), its sections the moment of a circle (-5 %)."""
    ours = simulate(scene, "solid")
    end = plain.outcome(scene, ours.contact.intervals[-1].end + 20e-6)
    share = {name: end[name] / end["E_0"] for name in ("rigid", "vibration", "friction", "residual")}
    assert end["e"] == pytest.approx(ours.restitution.edge.e, abs=0.002)
    assert end["mu"] == pytest.approx(ours.restitution.mu, abs=0.001)
    assert end["mu"] < 0.56  # it does not slide all the time
    assert end["Omega"] == pytest.approx(ours.motion.Omega, rel=0.02)
    assert share["rigid"] == pytest.approx(ours.energy.rigid, abs=0.004)
    assert share["vibration"] == pytest.approx(ours.energy.vibration_check, rel=0.03)
    assert share["friction"] == pytest.approx(ours.energy.friction, abs=0.004)
    assert abs(share["residual"]) < 1e-12


def test_on_the_solvers_own_masses_the_plain_drop_is_the_solver(scene):
    """Slices, frame, compiled contact and ledger save time and change nothing."""
    model = build(Case.of(scene))
    mesh = model.geometry.rod.mesh
    places, spread = model.layout.rod[~mesh.is_hanging], model.rod_stiffness.spread
    K = (spread.T @ sum(model.rod_stiffness.parts) @ spread).tocsr()
    rows, mass = places.ravel(), model.mass[places[:, :1]]
    free = (model.inverse_mass[places] > 0).astype(float)
    rod = plain.Rod(model.start[0][places], mass, K[rows][:, rows], free, mesh.free_skin)
    ours, impact, dt = solve(Case.of(scene), model=model), scene.impact, model.steps["rod"]
    end = plain.drop(rod, impact.v_n, impact.v_t, scene.surface.friction, dt, ours.steps * dt)
    assert end["E_0"] == pytest.approx(ours.E_0, rel=1e-12)
    assert end["friction"] == pytest.approx(ours.accounts["friction"], rel=1e-9)
    assert end["closing"] == pytest.approx(ours.accounts["contact_dissipation"], rel=1e-9)
    motion = [end["V_n"], end["V_t"], end["Omega"]]
    assert motion == pytest.approx([ours.motion.V_n, ours.motion.V_t, ours.motion.Omega], rel=1e-6)
    assert end["vibration"] == pytest.approx(sum(ours.vibration_check), rel=1e-3)
