"""What a run waits for and averages over in a scene of another size, whose times are all as much shorter."""

import pytest

from fem_impact.case.case import Case
from fem_impact.fem.eigen import no_modes
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.rodview import RodState
from fem_impact.solid.watchers import Watchers

ELASTIC = {"name": "elastic", "E": "210 GPa", "nu": 0.3, "rho": "7850 kg/m3"}


def sized(size, **changes):
    """The scene quick, t5b on a coarse mesh, in a size of its own."""
    rod = {"length": 80.0, "diameter": 19.0, "tip_radius": 3.0}
    lengths = {f"projectile.{key}": f"{value * size} mm" for key, value in rod.items()}
    accuracy = {"accuracy.levels": 1, "accuracy.tip_size": f"{size} mm", "accuracy.unresolved": "report"}
    return replace_all(load("quick"), lengths | accuracy | changes)


def windows(scene):
    """The gap of one contact, the quiet time and the windows of forces and heat, s, and the whole case."""
    case = Case.of(scene, "solid")
    model = build(case)
    view = RodState.of(model, no_modes(model.mass[: model.layout.rod_size]))
    watchers = Watchers.of(case, model, view, None, False)
    made = watchers.stop.quiet, watchers.peak.window, watchers.heat.window
    return case, (model.book.gap, *made)


def test_a_rod_as_long_as_the_measured_ones_has_the_longest_windows():
    effects = ["vibration", "friction", "barrier-rigid", "contact-heating"]
    _, found = windows(sized(1.0, effects=effects, **{"projectile.length": "240 mm"}))
    assert found == (10e-6, 20e-6, 2e-6, 0.5e-6)


def test_a_scene_ten_times_smaller_has_windows_in_its_own_time():
    effects = ["vibration", "friction", "barrier-rigid", "contact-heating"]
    (_, whole), (case, small) = (windows(sized(size, effects=effects)) for size in (1.0, 0.1))
    assert all(short <= 0.7 * long for short, long in zip(small, whole, strict=True))
    gap, quiet, force, heat = small
    assert max(gap, quiet) <= 0.1 * case.one_impact * (1 + 1e-12)
    assert max(force, heat) <= case.estimate.duration / 30 * (1 + 1e-12)
    _, smaller = windows(sized(0.05, effects=effects))
    assert smaller == pytest.approx([0.5 * time for time in small], rel=1e-6)


@pytest.mark.long
def test_an_elastic_impact_is_the_same_in_any_size():
    """Lying by 1.5 degrees the rod strikes once and turns; the other end comes down much later."""
    fall = {"impact.angle": "88.5 deg", "impact.v_n": "-5 m/s", "impact.v_t": "0 m/s"}
    metals = {"projectile.material": ELASTIC, "barrier.material": ELASTIC}
    effects = {"effects": ["vibration", "friction", "barrier-rigid"]}
    whole, small = (simulate(sized(size, **fall, **metals, **effects), "solid") for size in (1.0, 0.1))
    assert small.motion.V_n == pytest.approx(whole.motion.V_n, rel=1e-4)
    assert small.restitution.mu == pytest.approx(whole.restitution.mu, rel=1e-3)
    assert small.motion.Omega * 0.1 == pytest.approx(whole.motion.Omega, rel=1e-4)
    assert len(small.contact.intervals) == len(whole.contact.intervals) == 1
