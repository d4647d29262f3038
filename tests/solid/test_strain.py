"""The strain along the axis: of known motions, of a wave with a known front, of the flight after it."""

from dataclasses import replace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.fem.flight import FreeVibration
from fem_impact.files.waves import read_waves
from fem_impact.options import RunOptions
from fem_impact.solid.rodview import RodState
from fem_impact.solid.run import solve
from fem_impact.solid.strain import StrainSections, StrainWatch, _held, _in_plane

ELASTIC = ("vibration", "barrier-rigid", "large-rotation")


@pytest.mark.parametrize("angle", [0.0, 0.8])
def test_stretch_and_bending_of_a_known_motion_do_not_see_a_rotation(angle):
    model = scenes.model(*ELASTIC, length=0.06)
    sections, rows = StrainSections.of(model), _in_plane(model, model.start[0])
    (t, n), (axis_t, axis_n) = rows, sections.axis
    z, x = axis_t * t + axis_n * n, axis_n * t - axis_t * n
    strain, curvature = 3e-4, 0.02
    along = (strain + curvature * (x - x[:, 1:].mean())) * (z - z.mean())
    t, n = t + axis_t * along, n + axis_n * along
    moved = np.stack([np.cos(angle) * t - np.sin(angle) * n, np.sin(angle) * t + np.cos(angle) * n])
    stretch, bending = sections.strain(moved)
    assert stretch == pytest.approx(strain, rel=1e-3)
    assert bending == pytest.approx(curvature * sections.radius, rel=1e-3)
    if not angle:
        assert sections.linear(moved - rows) == pytest.approx(np.stack([stretch, bending]), rel=1e-3)


@pytest.fixture(scope="module")
def upright(tmp_path_factory):
    """A blunt rod that falls upright on a rigid plane, until its wave has come back."""
    out = tmp_path_factory.mktemp("wave")
    scene = scenes.scene(
        "vibration", "barrier-rigid", length=0.12, v_n=-2.0, v_t=0.0, angle=0.0, max_time=7.2e-5
    )
    scene = replace(scene, save=replace(scene.save, strain_samples=2, gauge=0.04, gauge_across=0.0))
    return scene, solve(Case.of(scene), RunOptions(out)), read_waves(out / "waves.h5")


def test_the_wave_behind_a_blunt_end_has_the_strain_v_over_c0_and_its_front_runs_with_c0(upright):
    """Impact of a bar on a rigid wall: Goldsmith, Impact (1960), 2.5; exact for a bar, not at its front."""
    scene, _, waves = upright
    steel = scene.projectile.material
    c0 = (steel.E / steel.rho) ** 0.5
    behind = waves.strain(np.array([0.8 * waves.length / c0]))[0][0]
    plateau = behind[waves.position < 0.5 * waves.length]
    assert plateau.mean() == pytest.approx(-2.0 / c0, rel=0.03)
    arrivals = [
        waves.times[np.argmax(waves.stretch[:, at] < -1.0 / c0)]
        for at in (np.searchsorted(waves.position, share * waves.length) for share in (0.3, 0.8))
    ]
    assert 0.5 * waves.length / np.diff(arrivals)[0] == pytest.approx(c0, rel=0.04)
    back = waves.strain(np.array([1.5 * waves.length / c0]))[0][0]
    assert np.abs(back[waves.position > 0.7 * waves.length]).max() < 0.5 * 2.0 / c0
    assert np.abs(waves.bending).max() < 1e-6 * np.abs(waves.stretch).max()


def test_a_strain_gauge_shows_the_wave_that_passes_it(upright):
    scene, result, waves = upright
    steel = scene.projectile.material
    passing = result.strain[result.strain < -1.0 / (steel.E / steel.rho) ** 0.5]
    assert np.median(passing) == pytest.approx(-2.0 / (steel.E / steel.rho) ** 0.5, rel=0.03)
    assert result.strain == pytest.approx(waves.gauge(0.04, 0.0), rel=1e-5, abs=1e-9)


def test_a_strain_gauge_needs_no_file_and_a_place_on_the_rod():
    scene = scenes.scene(*ELASTIC, length=0.06, max_time=1e-6)
    mid = replace(scene, save=replace(scene.save, strain_samples=0, gauge=0.03))
    assert len(solve(Case.of(mid)).strain) > 0
    told = r"save\.gauge = .59 mm.: lies where .* Give a place between 19.* and 58.* mm from the tip"
    with pytest.raises(SceneError, match=told):
        solve(Case.of(replace(mid, save=replace(mid.save, gauge=0.059))))
    for place in (0.006, 0.061):  # no mesh has slices there
        with pytest.raises(SceneError, match=r"save\.gauge.*between 6\.333 and 60 mm"):
            Case.of(replace(mid, save=replace(mid.save, gauge=place)))


def test_the_mirror_image_of_a_body_has_the_same_strains_on_the_side_that_faces_the_barrier(tmp_path):
    shown, across = [], []
    for side in (1, -1):
        scene = scenes.scene(
            *(*ELASTIC, "friction"),
            length=0.06,
            angle=side * 0.6,
            v_t=side * -1.0,
            omega=side * 20.0,
            max_time=3e-5,
        )
        scene = replace(scene, save=replace(scene.save, strain_samples=1, gauge=0.03))
        shown.append(solve(Case.of(scene), RunOptions(tmp_path / str(side))).strain)
        across.append(read_waves(tmp_path / str(side) / "waves.h5").across)
    assert np.abs(shown[0]).max() > 1e-6
    assert shown[1] == pytest.approx(shown[0], rel=1e-6, abs=1e-6 * np.abs(shown[0]).max())
    # both towards the barrier, whose normal n points up
    assert across[0][2] < -0.5 and across[1] == pytest.approx(across[0] * [-1, 1, 1], abs=1e-9)


def test_samples_resolve_the_wave_and_both_ends_of_the_run_are_known(upright):
    _, result, waves = upright
    assert np.diff(waves.times).max() < 0.75 * np.diff(waves.position)[0] / waves.speed
    assert waves.times[0] == 0.0 and waves.end == pytest.approx(result.time, abs=3e-7)
    assert waves.position[-1] == pytest.approx(waves.length - np.diff(waves.position)[0] / 2)
    assert waves.origin + waves.length * waves.axis == pytest.approx(
        result.model.geometry.rod_points[result.model.geometry.rod.body_nodes[:, -1]].mean(axis=0)
        * [1, 0, 1],
        abs=1e-6,
    )


def test_the_flight_by_modes_goes_on_from_the_last_state(tmp_path):
    """Start from a free rod in two modes: shape and strain at the start, and half a period later."""
    model = scenes.model(*ELASTIC, length=0.06, omega=30.0)
    view, state = RodState.of(model), model.initial_state()
    amplitude = np.zeros(len(view.modes.omega))
    amplitude[[0, 2]] = 2e-6, 1e-6
    state.x[: view.size] += view.modes.shape @ amplitude
    flight = FreeVibration(view.modes, amplitude, 0 * amplitude)
    watch = StrainWatch.of(Case.of(scenes.scene(*ELASTIC, length=0.06)), model, tmp_path / "waves.h5")
    watch.observe(state)
    watch.write(watch.ringing(view, state, flight))
    waves = read_waves(tmp_path / "waves.h5")
    ringing = waves.ringing
    assert len(ringing.omega) == 2
    now = model.geometry.rod_points + model.nodes(state.x - model.start[0])[model.layout.rod]
    assert np.abs(ringing.points(0.0) - now).max() < 1e-9
    for sampled, free in zip(waves.strain(np.zeros(1)), ringing.strain(np.zeros(1)), strict=True):
        assert np.abs(sampled - free).max() < 5e-3 * np.abs(waves.bending).max()
    soon, velocity = 1e-7, model.nodes(state.v)[model.layout.rod]
    assert np.ptp(velocity[:, 0]) * soon > 1e-7  # it turns
    assert np.abs(ringing.points(soon) - now - velocity * soon).max() < 1e-8
    half = np.pi / ringing.omega[0]
    assert np.abs(ringing.strain(np.array([half]))[1] + ringing.strain(np.zeros(1))[1]).max() > 1e-7


def test_the_modes_that_are_kept_hold_the_energy():
    assert _held(np.array([1.0, 0.0, 100.0, 0.05, 50.0])).tolist() == [0, 2, 4]
    assert _held(np.zeros(0)).size == 0
