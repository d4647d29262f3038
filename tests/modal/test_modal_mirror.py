"""A chamfered body in its mirror image: which straight part of it lands flat is no matter of its number."""

import pytest

from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace, replace_all

PUNCH = load(
    {
        "id": "punch",
        "projectile": {
            "profile": [
                ["0 mm", "1.7 mm"],
                ["0.3 mm", "2 mm"],
                ["25 mm", "2 mm"],
                ["25 mm", "4 mm"],
                ["70 mm", "4 mm"],
            ],
            "material": {"name": "WC-10Co", "E": "580 GPa", "nu": 0.22, "rho": "14500 kg/m3"},
        },
        "barrier": {"material": "aluminium-6082-t6"},
        "surface": {"state": "custom", "friction": 0.25, "source": "a guess"},
        "impact": {"angle": "30 deg", "speed": "2 m/s"},
    }
)


def tilted(angle):
    return simulate(replace(PUNCH, "impact.angle", f"{angle} deg"), "modal")


@pytest.mark.long
@pytest.mark.parametrize("angle", [3, 8, 40])
def test_a_mirrored_scene_gives_mirrored_numbers(angle):
    one, other = tilted(angle), tilted(-angle)
    assert other.restitution.edge.e == pytest.approx(one.restitution.edge.e, rel=1e-9)
    assert other.restitution.mu == pytest.approx(-one.restitution.mu, rel=1e-9)
    assert other.motion.Omega == pytest.approx(-one.motion.Omega, rel=1e-9)


def test_a_chamfer_that_leans_by_37_degrees_does_not_land_flat():
    """Finite elements on two levels: e .516 +- .095, mu .080 +- .003, Omega 12.8 +- 1.8 rad/s."""
    run = tilted(8)
    assert run.restitution.edge.e == pytest.approx(0.516, abs=0.05)
    assert run.restitution.mu == pytest.approx(0.080, abs=0.02)
    assert run.motion.Omega == pytest.approx(12.8, abs=1.8)


@pytest.mark.parametrize(("angle", "solid"), [(22, (0.24, 0.077, 0.055)), (26, (0.20, 0.052, 0.069))])
def test_a_chamfer_that_leans_by_20_degrees_does_not_land_flat(angle, solid):
    """It had e .495 and .484, and no friction; `assess` said YES by it, finite elements +.049 +- .016."""
    chamfered = {"profile": [["0 mm", "8 mm"], ["1.5 mm", "9.5 mm"], ["80 mm", "9.5 mm"]]}
    surface = {"state": "custom", "friction": 0.3, "source": "a guess"}
    tables = {"id": "chamfered", "projectile": {**chamfered, "material": "steel-4340"}, "surface": surface}
    impact = {"angle": f"{angle} deg", "v_n": "-2.8 m/s", "v_t": "-1.3 m/s"}
    run = simulate(load({**tables, "barrier": {"material": "s355"}, "impact": impact}), "modal")
    told = run.restitution.edge.e, run.energy.rigid, run.energy.friction
    assert told == pytest.approx(solid, abs=0.06)
    assert run.half_widths["e_edge"] < 0.15


def test_all_impulse_beyond_friction_that_no_stored_scene_comes_near_counts_as_error():
    """Finite elements on two levels at 65 degrees: mu .43 +- .25; at 70 they rise from .26 to .35."""
    run = tilted(70)
    mu, half = run.estimate("mu")
    assert half >= mu - 0.25 > 0.25
    assert run.estimate("V_t_m_per_s")[1] >= half * (run.motion.V_n - run.motion.v_n)
    assert any("how an edge digs in" in one.text for one in run.validity.limitations)


ROD = {
    "projectile.length": "80 mm",
    "projectile.diameter": "19 mm",
    "impact.v_n": "-5 m/s",
    "impact.v_t": "0 m/s",
}
PLAIN = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}


def flat_landing(tip, angle, omega):
    """What a quick rod that lands flat with spin keeps in its mirror image, and what that turns round."""
    landing = {"impact.angle": f"{angle} deg", "impact.omega": f"{omega} rad/s"}
    run = simulate(replace_all(load("quick"), ROD | tip | landing), "modal")
    return (run.motion.V_n, run.energy.plastic_rod, run.energy.plastic_barrier), (
        run.motion.V_t,
        run.motion.Omega,
    )


@pytest.mark.parametrize(("angle", "omega"), [(90, 60), (90, -60), (0, 60)])
@pytest.mark.parametrize("tip", [{}, PLAIN], ids=["round edge", "sharp edge"])
def test_a_flat_landing_with_spin_is_its_own_mirror_image(tip, angle, omega):
    (kept, turned), (same, back) = (flat_landing(tip, side * angle, side * omega) for side in (1, -1))
    assert same == pytest.approx(kept, rel=1e-7)
    assert back == pytest.approx([-value for value in turned], rel=1e-6)
    assert min(kept) > 0.0 and abs(turned[1] - omega) > 5.0
