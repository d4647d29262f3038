"""The estimated size of a run beside meshes that are built and runs that were measured."""

import re
from math import exp, log

import pytest
from benchmarks.own_mesh_memory import half_box

from fem_impact.case import size as sizes
from fem_impact.case.case import Case
from fem_impact.case.measured import summary
from fem_impact.errors import SceneError
from fem_impact.fem.geometry import build_geometry
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all

UPRIGHT = {"impact.angle": "0 deg", "impact.v_t": "0 m/s"}
WIDE = {"projectile.diameter": "40 mm", "projectile.length": "0.4 m", "projectile.tip_radius": "6 mm"}
PLANE = {"effects": ["vibration", "friction", "barrier-rigid", "rod-plasticity"]}
STIFF = {"effects": ["friction", "barrier-elastic"]}


def off(estimate, true):
    """The factor between two numbers, at least one."""
    return exp(abs(log(estimate / true)))


@pytest.mark.parametrize("changes", [{}, UPRIGHT, WIDE, PLANE, STIFF, {"accuracy.tip_size": "0.12 mm"}])
def test_elements_of_changed_scenes(changes):
    check_elements(replace_all(load("t5b"), changes))


@pytest.mark.parametrize("bore", ["6 mm", "8 mm"])
@pytest.mark.parametrize("begin", ["0 mm", "60 mm"])
def test_elements_of_hollow_bodies(bore, begin):
    tube = {"projectile.tip_radius": "1 mm", "projectile.bore": [[begin, bore], ["200 mm", bore]]}
    check_elements(replace_all(load("tube"), tube))


@pytest.mark.parametrize("name", ["quick", "t6-17", "t3-machined", "t2", "elastic-frictionless"])
def test_elements_of_shipped_scenes(name):
    check_elements(load(name))


def check_elements(scene):
    planned = Case.of(scene)
    size, slots = planned.size, planned.slots
    built = build_geometry(planned.bodies, planned.zones, 2e-6, slots.meshed_barrier, slots.vibrating)
    rod, barrier = len(built.rod.mesh.cells), len(built.barrier.cells) if built.barrier else 0
    assert off(size.rod + size.barrier, rod + barrier) < 1.25
    assert off(size.rod, rod) < 1.5 and (size.barrier == 0) == (barrier == 0)
    laws = {"rod": slots.rod_law, "barrier": slots.barrier_law}
    yielding = sum(int(cells.sum()) for body, cells in built.may_yield.items() if laws[body])
    assert size.yielding == yielding == 0 or off(size.yielding, yielding) < 1.6


def default_runs():
    for name, entry in summary()["scenes"].items():
        yield pytest.param(entry["scene"], next(one for one in entry["settings"] if one["default"]), id=name)


@pytest.mark.parametrize("data, setting", list(default_runs()))
def test_elements_and_memory_of_the_stored_runs(data, setting):
    cells = {"accuracy.tip_size": f"{setting['tip_size_m']:.9g} m"}
    size = Case.of(replace_all(read_dict(data), cells)).size
    assert off(size.rod + size.barrier, setting["elements"]) < 1.5  # a record needs fewer than an estimate
    if setting["peak_memory_MB"] is not None:  # where another process held more, it is not known
        assert off(size.memory, setting["peak_memory_MB"] * 1e6) < 1.33


@pytest.mark.parametrize(
    "changes",
    [
        {"accuracy.tip_size": "0.01 mm"},
        {
            "projectile.length": "10 m",
            "projectile.diameter": "1 m",
            "projectile.tip_radius": "0.1 m",
            "accuracy.tip_size": "0.35 mm",
        },
    ],
)
def test_what_needs_more_memory_than_there_is_is_refused_with_a_size_that_fits(changes, monkeypatch):
    monkeypatch.setattr(sizes, "machine_memory", lambda: 16e9)
    scene = replace_all(load("t5b"), changes)
    with pytest.raises(SceneError, match=r"elements, which take some .* GB of memory") as refused:
        Case.of(scene)
    fits = refused.value.remedy.removeprefix("Give at least ").removesuffix(".")
    assert Case.of(replace_all(scene, {"accuracy.tip_size": fits})).size.memory <= 16e9
    finer = f"{float(fits.removesuffix(' mm')) / 2} mm"
    with pytest.raises(SceneError, match="GB of memory"):
        Case.of(replace_all(scene, {"accuracy.tip_size": finer}))
    Case.of(scene, "modal")  # needs no block


def test_a_barrier_size_that_is_stated_grows_with_the_size_that_fits(monkeypatch):
    """No size was found that fits, as the block kept its own cells."""
    fine = {"accuracy.tip_size": "0.005 mm", "accuracy.barrier_size": "0.001 mm"}
    monkeypatch.setattr(sizes, "machine_memory", lambda: 16e9)
    with pytest.raises(SceneError, match="GB of memory") as refused:
        Case.of(replace_all(load("t5b"), fine))
    tip, barrier = re.findall(r"[\d.]+ mm", refused.value.remedy)
    assert Case.of(replace_all(load("t5b"), {"accuracy.tip_size": tip, "accuracy.barrier_size": barrier}))


# largest resident memory, MB, of a process that computed the modes of a half box of cells of 1 mm
OWN = [
    ((24, 12, 24), 427),
    ((32, 16, 32), 1001),
    pytest.param((40, 20, 40), 2223, marks=pytest.mark.long),
    ((16, 8, 64), 441),
    ((20, 10, 100), 986),
]


@pytest.mark.long
@pytest.mark.parametrize(("cells", "measured"), OWN)
def test_memory_of_the_modes_of_a_users_mesh(cells, measured, tmp_path):
    planned = Case.of(half_box(tmp_path, *cells))
    assert off(planned.size.memory, measured * 1e6) < 1.2


def test_the_time_of_a_users_mesh_holds_that_of_its_modes(tmp_path):
    """They took 9.5 s of a busy core."""
    size = Case.of(half_box(tmp_path, 18, 9, 90)).size
    rest = sizes.run_time(size.rod + size.barrier, size.yielding, size.steps)
    assert off(size.time - rest, 9.5) < 2


@pytest.mark.long
def test_a_users_mesh_that_does_not_fit_is_refused_before_any_work(tmp_path, monkeypatch):
    monkeypatch.setattr(sizes, "machine_memory", lambda: 8e8)
    scene = half_box(tmp_path, 32, 16, 32)
    words = r"projectile\.mesh = .*GB of memory.*a mesh of larger cells, or let it not vibrate"
    with pytest.raises(SceneError, match=words):
        Case.of(scene)
    stiff = replace_all(scene, {"effects": ["auto", "-vibration"], "accuracy.tip_size": "0.6 mm"})
    assert Case.of(stiff).size.memory < 8e8
    assert Case.of(half_box(tmp_path, 24, 12, 24)).size.memory < 8e8


def test_a_users_mesh_whose_modes_the_solver_cannot_number_is_refused(tmp_path, monkeypatch):
    """However much memory there is: the lower factor of 24 x 12 x 24 cells has 14 782 579 entries."""
    scene = half_box(tmp_path, 24, 12, 24)
    monkeypatch.setattr(sizes, "MOST_ENTRIES", 1.1 * 14_782_579)
    assert Case.of(scene).size.rod == 6912
    monkeypatch.setattr(sizes, "MOST_ENTRIES", 0.9 * 14_782_579)
    with pytest.raises(
        SceneError, match=r"projectile\.mesh = .*needs? a factor of some .* entries.*larger cells"
    ):
        Case.of(scene)
    still = {"effects": ["auto", "-vibration"], "accuracy.tip_size": "0.6 mm"}
    assert not Case.of(replace_all(scene, still)).slots.vibrating


def test_a_rod_that_never_fits_is_told_so(monkeypatch):
    monkeypatch.setattr(sizes, "machine_memory", lambda: 1e8)
    with pytest.raises(SceneError, match="No tip size fits"):
        Case.of(load("t5b"))


def test_a_longer_time_or_step_changes_the_number_of_steps_alone():
    size, base = Case.of(replace_all(load("t5b"), {"accuracy.step": 0.45})).size, Case.of(load("t5b")).size
    assert size.steps == pytest.approx(2 * base.steps, rel=1e-3) and size.rod == base.rod
    assert base.most_steps == pytest.approx(2.5e-3 / base.step, abs=1)
