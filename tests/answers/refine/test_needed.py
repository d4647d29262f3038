"""Half-widths of levels that are widened as a study found to be needed, and how it finds that."""

from dataclasses import replace

import numpy as np
import pytest
from outcome_maker import altered
from study_fakes import outcome

from fem_impact.answers.refine.extrapolate import MeshRuns, level_limits
from fem_impact.answers.refine.needed import (
    HELD,
    OF_PATCH,
    OPEN,
    PLASTIC,
    known_heat,
    scale_of,
    told_heat,
    unresolved_heat,
    widened,
    widest,
)
from fem_impact.case.measured import needed_half_widths
from fem_impact.evidence.studies.coverage.level_bands import LEAST, needed
from fem_impact.outcome.keys import Unknown
from fem_impact.run.heated import MELTS
from fem_impact.scene.shipped import load

RUN = outcome(effects=["friction", "rod-plasticity"])
HALVES = {"e_edge": 0.05, "mu": 1e-5, "E_vib_over_E_0": 1e-7, "V_n_m_per_s": 0.1, "dent_depth_m": 1e-9}
LIMITS = {"e_edge": 0.3, "mu": 0.2, "E_vib_over_E_0": 0.01, "V_n_m_per_s": 0.4, "dent_depth_m": 1e-5}


def test_a_number_that_agrees_by_chance_is_not_known_better_than_a_share_of_the_widest():
    wide, factors = widened(LIMITS, HALVES, RUN), needed_half_widths()
    for key, scale in (("mu", 1.0), ("E_vib_over_E_0", 0.01)):
        times, share = factors[key]["times"], factors[key]["share"]
        assert wide[key] == pytest.approx(times * HALVES[key] + share * 0.05 * scale)
        assert wide[key] > 100 * HALVES[key]
    assert all(wide[key] >= half for key, half in HALVES.items())
    assert wide["dent_depth_m"] == HALVES["dent_depth_m"]  # lengths have no scale


def test_what_is_zero_by_physics_stays_so_but_not_the_work_of_a_body_that_may_flow():
    zero = {**dict.fromkeys((*PLASTIC, "W_friction_over_E_0"), 0.0), "e_edge": 0.3}
    halves = {**dict.fromkeys(zero, 0.0), "e_edge": 0.1}
    wide = widened(zero, halves, RUN)
    assert wide["E_plastic_rod_over_E_0"] > 0.003
    assert wide["E_plastic_barrier_over_E_0"] == wide["W_friction_over_E_0"] == 0.0
    assert scale_of("mu", 0.0, RUN) is None and scale_of("mu", 0.1, RUN) == 1.0


def test_the_widest_is_over_speeds_and_spins_of_the_approach():
    """Speed and spin are those of all of E_0, here 5 m/s and 25 rad/s."""
    motion = replace(RUN.motion, mass=2.0, k_squared=0.04)
    run = replace(RUN, motion=motion, energy=replace(RUN.energy, E_0=25.0))
    assert widest({"Omega_rad_per_s": 5.0, "e_edge": 0.1}, run) == pytest.approx(0.2)


def test_half_widths_that_the_study_finds_hold_as_many_of_other_scenes():
    """Scenes whose levels agree by chance in one number and not in all."""
    rng = np.random.default_rng(3)
    width, chance = np.exp(rng.normal(-3, 1, 800)), rng.uniform(0, 1, 800) ** 3
    errors, halves, most = width * np.abs(rng.normal(0, 0.5, 800)), width * chance, width
    known, fresh = slice(0, 400), slice(400, 800)
    times, share = needed(errors[known], halves[known], most[known])
    told = np.maximum(halves, times * halves + share * most)[fresh]
    held, own = np.mean(errors[fresh] <= told), np.mean(errors[fresh] <= halves[fresh])
    assert own < 0.5 and HELD - 0.01 < held < HELD + 0.04
    assert np.median(told) < 2.5 * np.quantile(errors, HELD)
    assert needed(errors[: LEAST - 1], halves[: LEAST - 1], most[: LEAST - 1]) is None


def test_the_arms_of_the_paper_have_the_half_width_of_the_tip_s_own():
    limits, halves = ({key: number for key in ("e_paper", "e_edge", "mu")} for number in (0.3, 1e-4))
    wide = widened(limits, {**halves, "mu": 0.1}, RUN)
    assert wide["e_paper"] == wide["e_edge"] > 0.002


def test_a_time_above_ignition_is_not_told_where_the_flash_temperature_leaves_it_open():
    """A default run told 2 of 11 such times right."""
    hot = [
        outcome(tip_size_m=size, flash_temperature_K=of, flash_rise_K=of - 293, time_above_ignition_s=1e-5)
        for size, of in ((2e-4, 620.0), (1e-4, 640.0))
    ]
    levels = [MeshRuns(run.cost.tip_size, [altered(run, ignition_temperature_K=700.0)]) for run in hot]
    limits, halves = level_limits(levels)
    assert "time_above_ignition_s" not in limits and "time_above_ignition_s" not in halves
    lost = unresolved_heat(limits, halves, levels[1].runs[0], levels[1].across)
    assert known_heat(levels[1].runs[0], lost).time_above_ignition == OPEN
    far = [replace(level, runs=[altered(level.runs[0], ignition_temperature_K=5e3)]) for level in levels]
    assert "time_above_ignition_s" in level_limits(far)[0]
    lost = unresolved_heat(*level_limits(far), far[1].runs[0], far[1].across)
    assert known_heat(far[1].runs[0], lost).time_above_ignition == 1e-5


def test_heat_over_a_patch_that_is_hardly_wider_than_a_cell_is_not_told():
    """A line of contact: one level more told 6.5 times the temperature."""
    hot = [
        outcome(
            tip_size_m=size,
            flash_temperature_K=of,
            flash_rise_K=of - 293,
            friction_flux_W_per_m2=1e9,
            contact_patch_m2=1e-8,
            friction_power_W=10.0,
        )
        for size, of in ((2e-4, 620.0), (1e-4, 640.0))
    ]
    levels = [MeshRuns(run.cost.tip_size, [run], wide=False, rows=2) for run in hot]
    limits, halves = level_limits(levels)
    assert "friction_power_W" in limits and not {*OF_PATCH} & ({*limits} | {*halves})
    heat = known_heat(hot[1], unresolved_heat(limits, halves, hot[1], levels[1].across))
    assert (
        "4 nodes, and has 2" in heat.rise.reason and heat.flux == heat.patch == heat.temperature == heat.rise
    )
    assert heat.power == 10.0
    assert {*OF_PATCH} <= {*level_limits([replace(level, wide=True, rows=4) for level in levels])[0]}


@pytest.mark.parametrize(
    ("rise", "lost", "begins"),
    [
        (Unknown(f"at least 855 K; it begins to {MELTS}"), {}, "at least 855 K; it"),
        (400.0, {}, "it begins to"),
        (Unknown(f"at least 855 K; it begins to {MELTS}"), {"flash_temperature_K": OPEN}, "not resolved"),
    ],
)
def test_a_body_surely_melts_where_it_does_on_two_levels_and_the_patch_is_resolved(rise, lost, begins):
    """Reported: at least 855 K of one level, where the others or the width of the patch leave it open."""
    melts = Unknown(f"at least 855 K; it begins to {MELTS}")
    run = outcome(friction_power_W=10.0)
    last = replace(run, heat=replace(run.heat, rise=melts, temperature=melts))
    before = replace(run, heat=replace(run.heat, rise=rise))
    assert known_heat(last, lost, before).temperature.reason.startswith(begins)


@pytest.mark.parametrize(("limit", "known"), [(1600.0, True), (1800.0, False)])
def test_levels_that_lead_beyond_a_melting_point_tell_no_temperature(limit, known):
    """Reported: 900 (300 to 2800) K of aluminium that melts at 855 K, from levels that stayed below it."""
    told = {"flash_temperature_K": limit, "flash_rise_K": limit - 293.15, "mu": 0.2}
    limits, bands, lost = told_heat((told, dict.fromkeys(told, 10.0)), RUN, 4, load("t5b"))
    assert ("flash_temperature_K" in limits) is ("flash_rise_K" in bands) is known and "mu" in limits
    assert known or "gives 1800 K, above 1700 K" in lost["flash_temperature_K"].reason
