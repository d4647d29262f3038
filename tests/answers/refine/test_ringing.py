"""Bands of a blow that is too short for the cells: they hold what the cells held back."""

from dataclasses import replace

import pytest
from own_bodies import box, write

from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.extrapolate import held_back, level_limits
from fem_impact.case.case import Case
from fem_impact.outcome.keys import Unknown
from fem_impact.scene.read import read_toml

BODY = 'material = { name = "no-nu", E = "200 GPa", nu = 0.0, rho = "7800 kg/m3" }'
SCENE = """
id = "flat"
projectile = {{ {body}, {material} }}
barrier = {{ material = "plate-steel" }}
surface = {{ state = "custom", friction = 0.0, source = "none" }}
impact = {{ angle = "0 deg", speed = "1 m/s" }}
effects = ["vibration", "barrier-rigid"]
save = {{ frames = 0 }}
"""


@pytest.fixture(scope="module")
def bar(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bar")
    write(folder / "bar.vtk", *box(4, 2, 14, (-2e-3, 0.0, 0.0), (2e-3, 2e-3, 14e-3)))
    (folder / "bar.toml").write_text(
        SCENE.format(body='mesh = "bar.vtk", mesh_unit = "m"', material=BODY), encoding="utf-8"
    )
    chain = LevelChain(Case(read_toml(folder / "bar.toml")))
    return chain, chain.run()


@pytest.fixture(scope="module")
def pin(tmp_path_factory):
    path = tmp_path_factory.mktemp("pin") / "pin.toml"
    body = 'shape = "flat", length = "16 mm", diameter = "8 mm"'
    coarse = "accuracy = { across = 6 }"
    path.write_text(SCENE.format(body=body, material=BODY) + coarse, encoding="utf-8")
    chain = LevelChain(Case(read_toml(path)))
    return chain, chain.run()


@pytest.mark.parametrize("body", ["bar", pytest.param("pin", marks=pytest.mark.long)])
def test_flat_landing_without_poisson_effect_has_e_of_one_in_its_band(body, request):
    chain, outcome = request.getfixturevalue(body)
    last = chain.done[-1].outcome
    assert abs(last.energy.residual) < 1e-5
    for name, exact in (("e_edge", 1.0), ("V_n_m_per_s", 1.0), ("E_r_over_E_0", 1.0)):
        value, band = outcome.estimate(name)
        assert value < 0.99
        assert value + band == pytest.approx(exact, abs=2e-3) or value + band > exact
    value, band = outcome.estimate("E_ln_edge_over_E_0")
    assert value - band < 2e-3


def test_band_of_the_levels_alone_would_miss_it(bar, monkeypatch):
    chain, outcome = bar
    monkeypatch.setattr("fem_impact.answers.refine.extrapolate.held_back", lambda run: {})
    limits, bands = level_limits([level.runs for level in chain.done])
    assert limits["e_edge"] + bands["e_edge"] < 0.99
    assert bands["e_edge"] < outcome.estimate("e_edge")[1]


def test_all_that_the_cells_took_is_the_loss_of_a_straight_elastic_blow(bar):
    run = bar[0].done[-1].outcome
    changes = held_back(run)
    assert run.restitution.edge.e + changes["e_edge"] == pytest.approx(1.0, abs=1e-3)
    assert run.motion.V_n + changes["V_n_m_per_s"] == pytest.approx(-run.motion.v_n, abs=1e-3)
    assert changes["E_r_over_E_0"] == pytest.approx(1.0 - run.energy.rigid, abs=1e-4)


def test_nothing_is_held_back_where_the_modes_hold_the_vibration(bar):
    run = bar[0].done[-1].outcome
    modes = run.energy.vibration_check
    assert held_back(replace(run, energy=replace(run.energy, vibration=0.9 * modes))) == {}
    assert held_back(replace(run, energy=replace(run.energy, vibration_check=Unknown("none")))) == {}
