"""Faults that the tests must notice, each with a test that does.

Run ``python tests/mutants.py docs/evidence/faults.md`` to put each fault into a copy of the sources, run its
test and write the page; ``python -m pytest -m slow tests/test_mutants.py`` does the same one by one.
"""

import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from fem_impact.cli.page import checked_page, write_page

ROOT = Path(__file__).parents[1]
COPIED = ("fem_impact", "meshes", "rigid", "tests", "pyproject.toml", "README.md")
FAILED = 1  # pytest's exit code when a test failed


@dataclass(frozen=True, slots=True)
class Mutant:
    """A fault: ``old`` stands once in ``file`` and becomes ``new``; ``test`` must fail."""

    fault: str
    file: str
    old: str
    new: str
    test: str


FACET = """\
        p0, p1 = barrier.places[barrier.quads[q, 0]], barrier.places[barrier.quads[q, 1]]
        p2, p3 = barrier.places[barrier.quads[q, 2]], barrier.places[barrier.quads[q, 3]]
        u_t, u_b, u_n = x[p2[0]] - x[p0[0]], x[p2[1]] - x[p0[1]], x[p2[2]] - x[p0[2]]
        w_t, w_b, w_n = x[p3[0]] - x[p1[0]], x[p3[1]] - x[p1[1]], x[p3[2]] - x[p1[2]]
        n_t, n_b = u_b * w_n - u_n * w_b, u_n * w_t - u_t * w_n
        n_n = u_t * w_b - u_b * w_t
"""
SPHERE = "tests/evidence/problems/test_verify_oblique_sphere.py"
RUNS, YIELDING = "tests/solid/test_runs.py", "tests/solid/test_yielding.py"
HEATING = "tests/physics/test_heating.py"
LAST = "            n_n += w[a] * normals[node, 2]\n"
UNIT = "        length = np.sqrt(n_t * n_t + n_b * n_b + n_n * n_n)\n"
MUTANTS = (
    Mutant(
        "contact work with velocities after the update, rigid plane",
        "fem_impact/solid/contact/plane.py",
        "closing -= 0.5 * p * (old_n + v[n])",
        "closing -= p * v[n]",
        "tests/solid/test_plane_contact.py::test_booked_work_is_the_energy_that_is_missing",
    ),
    Mutant(
        "contact work with velocities after the update, meshed barrier",
        "fem_impact/solid/contact/points.py",
        "m_t, m_b, m_n = 0.5 * (c.before[k, 0] + t), 0.5 * (c.before[k, 1] + b), 0.5 * (c.before[k, 2] + n)",
        "m_t, m_b, m_n = t, b, n",
        f"{RUNS}::test_ledger_closes",
    ),
    Mutant(
        "vibration from raw strain energy",
        "fem_impact/run/solid.py",
        "rod_stiffness is None, result.flight.energy, result.worst",
        'rod_stiffness is None, 2 * result.accounts["strain_rod"], result.worst',
        f"{RUNS}::test_locked_in_stress_is_not_vibration",
    ),
    Mutant(
        "acceleration of the whole rod taken for strain in the check of the vibration",
        "fem_impact/fem/eigen.py",
        "    pull -= rigid @ (rigid.T @ pull)\n",
        "",
        "tests/fem/test_modes.py::test_released_energy_is_that_of_all_shapes_whoever_knows_them",
    ),
    Mutant(
        "sign of Omega",
        "fem_impact/fem/flight.py",
        "float(V[2]), float(V[0]), spin / inertia)",
        "float(V[2]), float(V[0]), -spin / inertia)",
        "tests/fem/test_modes.py::test_rigid_sums",
    ),
    Mutant(
        "a spin before the impact left out of coefficients and losses",
        "fem_impact/run/common.py",
        '"k2": m.k_squared, "omega": omega}',
        '"k2": m.k_squared, "omega": 0.0}',
        "tests/modal/test_fidelities.py::test_coefficients_and_losses_take_a_spin_before_the_impact",
    ),
    Mutant(
        "friction of the reduced model moved by the last speed of its contact, not by its place",
        "fem_impact/modal/touch.py",
        "of[SITE.depth], of[SITE.place] = depth, place",
        "of[SITE.depth], of[SITE.place] = depth, "
        "before + dt * (now.rigid[AT.V_t] + now.rigid[AT.Omega] * arm_n)",
        "tests/modal/test_modal.py::test_friction_takes_energy_whatever_the_step",
    ),
    Mutant(
        "gravity half a step ahead in the flight of the reduced model",
        "fem_impact/modal/march.py",
        "rigid[AT.height] += dt * (rigid[AT.V_n] + 0.5 * dt * g_n - rigid[AT.V_bn])",
        "rigid[AT.height] += dt * (rigid[AT.V_n] + dt * g_n - rigid[AT.V_bn])",
        "tests/modal/test_modal_limits.py::test_the_ledger_closes_with_gravity",
    ),
    Mutant(
        "a solid run set down above the barrier, falling before it touches",
        "fem_impact/solid/build.py",
        "START_GAP = 1e-10",
        "START_GAP = 2e-6",
        "tests/solid/test_gravity.py::test_the_contact_bears_gravity_and_the_outcome_says_so",
    ),
    Mutant(
        "energies of the half model not doubled",
        "fem_impact/solid/ledger.py",
        "HALVES = 2.0",
        "HALVES = 1.0",
        f"{RUNS}::test_energies_are_those_of_the_whole_rod",
    ),
    Mutant(
        "friction on the quads' own normals",
        "fem_impact/solid/contact/points.py",
        LAST + UNIT,
        LAST + FACET + UNIT,
        f"{SPHERE}::test_a_sphere_that_slides_throughout_has_the_ratio_of_its_friction",
    ),
    Mutant(
        "impulses along the normals of a barrier that lags behind a sliding tip",
        "fem_impact/solid/contact/points.py",
        "flat = flat or rod.bend[node] == 0.0",
        "flat = True",
        "tests/solid/test_contact_round.py::test_a_rod_that_slides_through_its_crater_loses_nothing_but_friction",
    ),
    Mutant(
        "stopping at the first separation",
        "fem_impact/solid/separation.py",
        "not self._stays_away(state, motion, flight, until, alone)",
        "False",
        f"{RUNS}::test_elastic_frictionless_long_rod_touches_twice_and_grazes_between",
    ),
    Mutant(
        "Table 1's right-hand side as printed",
        "rigid/general.py",
        "return table[..., :3], table[..., 3]",
        "return table[..., :3], -table[..., 3]",
        "tests/rigid/test_general.py::test_the_general_system_reduces_to_the_massive_barrier",
    ),
    Mutant(
        "plain full integration where the tip yields",
        "fem_impact/solid/yielding_kernel.py",
        "if full:\n                _update_point",
        "if True:\n                _update_point",
        f"{YIELDING}::test_small_increments_see_the_stiffness_of_their_element",
    ),
    Mutant(
        "a spin that turns the stress before the step",
        "fem_impact/solid/yielding_kernel.py",
        "m0, m1, m2 = s0 + 0.5 * d0, s1 + 0.5 * d1, s2 + 0.5 * d2",
        "m0, m1, m2 = s0, s1, s2",
        f"{YIELDING}::test_an_element_that_rocks_keeps_neither_stress_nor_energy",
    ),
    Mutant(
        "a turn of the stress to first order",
        "fem_impact/solid/yielding_kernel.py",
        "m0, m1, m2 = m0 + 0.5 * a0, m1 + 0.5 * a1, m2 + 0.5 * a2",
        "m0, m1, m2 = m0, m1, m2",
        f"{YIELDING}::test_turning_a_stressed_element_turns_its_stress_with_it",
    ),
    Mutant(
        "a search that drops the nodes on the symmetry plane",
        "fem_impact/solid/contact/patch.py",
        "SLACK = 1e-6",
        "SLACK = -1e-6",
        "tests/solid/test_contact_search.py::test_points_on_the_symmetry_plane_are_found",
    ),
    Mutant(
        "masses at the nodes of a section, its polar moment 5 % too high",
        "fem_impact/fem/layout.py",
        "np.sqrt(round_moment / moment)",
        "np.sqrt(moment / moment)",
        "tests/evidence/problems/test_verify_modes.py::test_modes_of_the_short_rod",
    ),
    Mutant(
        "torsion with masses drawn in along the wrong coordinate",
        "fem_impact/fem/layout.py",
        "(0, 1, 0), (1, 0, 1)",
        "(0, 1, 0), (0, 1, 0)",
        "tests/evidence/problems/test_verify_modes.py::test_modes_of_the_short_rod",
    ),
    Mutant(
        "viscous friction: nodes that should stick creep, rigid plane",
        "fem_impact/solid/contact/plane.py",
        "share = min(1.0, coulomb * p",
        "share = min(0.01, coulomb * p",
        f"{SPHERE}::test_a_sphere_that_sticks_gives_its_tangential_energy_back",
    ),
    Mutant(
        "viscous friction: nodes that should stick creep, meshed barrier",
        "fem_impact/solid/contact/impulses.py",
        "share = min(1.0, f * pressed / size)",
        "share = min(0.9, f * pressed / size)",
        f"{SPHERE}::test_the_reversal_of_steel",
    ),
    Mutant(
        "friction 2 % too strong between two bodies",
        "fem_impact/solid/contact/impulses.py",
        "share = min(1.0, f * pressed / size)",
        "share = min(1.0, 1.02 * f * pressed / size)",
        "tests/evidence/problems/test_verify_oblique_rod.py::test_a_coarse_tip_on_a_block_leans_and_bends",
    ),
    Mutant(
        "friction 0.5 % too strong between a sliding ball and a block",
        "fem_impact/solid/contact/impulses.py",
        "share = min(1.0, f * pressed / size)",
        "share = min(1.0, 1.005 * f * pressed / size)",
        f"{SPHERE}::test_a_sphere_that_slides_throughout_has_the_ratio_of_its_friction",
    ),
    Mutant(
        "nodes leave a rigid plane at a thousandth of the speed with which they came",
        "fem_impact/solid/contact/plane.py",
        "v[n] += inverse_mass[n] * p\n",
        "v[n] += 1.001 * inverse_mass[n] * p\n",
        "tests/evidence/problems/test_verify_bar.py::test_one_strike_and_a_few_bounces",
    ),
    Mutant(
        "steel that flows without hardening",
        "fem_impact/solid/plastic_return.py",
        "        new = flow * _power(growth * dp, n)\n        miss",
        "        new = flow\n        miss",
        "tests/evidence/problems/test_verify_hardness.py::test_both_codes_agree_on_cells_of_one_size",
    ),
    Mutant(
        "shear modulus 0.4 % too low",
        "fem_impact/fem/elements.py",
        "E / (2 * (1 + nu))\n",
        "0.996 * E / (2 * (1 + nu))\n",
        "tests/evidence/problems/test_verify_modes.py::test_modes_of_a_short_bar",
    ),
    Mutant(
        "friction 5 % too strong on a rigid plane",
        "fem_impact/solid/contact/plane.py",
        "share = min(1.0, coulomb * p *",
        "share = min(1.0, 1.05 * coulomb * p *",
        "tests/evidence/problems/test_verify_tilted_bar.py::test_hard_contact_is_the_limit_of_stiff_springs",
    ),
    Mutant(
        "dashpots of the block's boundary 6 % too strong",
        "fem_impact/fem/boundary.py",
        "/ (2 * pi * G * sqrt(G / rho)) / absorbed",
        "* 1.06 / (2 * pi * G * sqrt(G / rho)) / absorbed",
        "tests/evidence/problems/test_verify_tips.py::test_a_coarse_sphere_on_a_block_radiates_as_into_a_half_space",
    ),
    Mutant(
        "cells of a ball counted over its diameter, not where it touches",
        "fem_impact/evidence/problems/spheres.py",
        'edge = meshes.pole_edge(p["radius"], int(p["across"]))',
        'edge = 2 * p["radius"] / p["across"]',
        "tests/evidence/problems/test_verify_tips.py::test_the_fewest_cells_are_enough",
    ),
    Mutant(
        "elements 1 % too stiff",
        "fem_impact/fem/elements.py",
        "lame=lame[0], G=lame[1])",
        "lame=1.01 * lame[0], G=1.01 * lame[1])",
        "tests/evidence/problems/test_verify_tips.py::test_a_coarse_sphere_on_a_plane_is_a_finite_ball",
    ),
    Mutant(
        "elements 1 % too soft",
        "fem_impact/fem/elements.py",
        "lame=lame[0], G=lame[1])",
        "lame=0.99 * lame[0], G=0.99 * lame[1])",
        "tests/evidence/problems/test_verify_tips.py::test_a_coarse_sphere_on_a_plane_is_a_finite_ball",
    ),
    Mutant(
        "cells of a rod's tip taken as asked for, not as they are where it touches",
        "fem_impact/evidence/problems/sears_rod.py",
        'edge = float(np.sort(np.hypot(skin[:, 0], skin[:, 1])[skin[:, 2] < 0.5 * p["length"]])[1])',
        'edge = setups.fine_tip(touch, p["cells"])',
        "tests/evidence/problems/test_verify_sears.py::test_the_cells_are_counted_where_it_touches",
    ),
    Mutant(
        "yield stress of a linear hardening 2 % too high",
        "fem_impact/physics/hardening.py",
        "return Hardening(yield_stress, modulus / yield_stress, 1.0)",
        "return Hardening(1.02 * yield_stress, modulus / yield_stress, 1.0)",
        "tests/evidence/problems/test_verify_taylor.py::test_another_metal_shape_and_speed",
    ),
    Mutant(
        "steps of the reduced model by its modes alone",
        "fem_impact/modal/impact.py",
        "fastest = max([*rod.omega, rate])  # 0 of a rigid rod before it touches",
        "fastest = max([*rod.omega, 1.0])",
        "tests/modal/test_modal_limits.py::test_the_step_follows_the_contact_of_a_thin_rod_too",
    ),
    Mutant(
        "springs of the block's boundary a third as stiff",
        "fem_impact/fem/forms.py",
        "return w.G / r * along_and_across",
        "return w.G / (3 * r) * along_and_across",
        "tests/evidence/problems/test_verify_sears.py::test_a_rod_is_sears",
    ),
    Mutant(
        "rates that soften: sign of the rate term in the radial return",
        "fem_impact/solid/plastic_return.py",
        "(1.0 + rate.C * u, rate.C, 0.0)",
        "(1.0 - rate.C * u, rate.C, 0.0)",
        f"{YIELDING}::test_the_increment_obeys_its_law_however_far_the_trial_is_out",
    ),
    Mutant(
        "rate hardening by the strain of a step, not by its rate, eight lanes together",
        "fem_impact/solid/plastic_return.py",
        "n, slow, count = _exponent(law), _reference(rate) * dt, 0",
        "n, slow, count = _exponent(law), _reference(rate) * 1e-6, 0",
        f"{YIELDING}::test_lanes_together_return_like_one_alone",
    ),
    Mutant(
        "flash temperature with twice the Peclet number",
        "fem_impact/physics/flash.py",
        "V) * a / (2 * body.diffusivity)",
        "V) * a / body.diffusivity",
        f"{HEATING}::test_moving_source_beside_the_exact_one",
    ),
    Mutant(
        "flash temperature as if each body took all the heat",
        "fem_impact/physics/flash.py",
        "np.divide(resting * moving, total,",
        "np.divide(0.5 * total * total, total,",
        f"{HEATING}::test_a_short_flash_is_shared_by_effusivity",
    ),
    Mutant(
        "flash temperature above the melting point of the other body",
        "fem_impact/scene/inputs.py",
        "return min(((limit, name)",
        "return max(((limit, name)",
        f"{HEATING}::test_a_temperature_above_the_melting_point_is_not_resolved",
    ),
    Mutant(
        "work that can heat the contact without the rod's surface",
        "fem_impact/run/solid.py",
        'a["friction"] + sheared["rod"] + sheared["barrier"]',
        'a["friction"] + sheared["barrier"]',
        "tests/solid/test_skinwork.py::test_the_work_of_a_projectile_that_is_softer_than_the_barrier_counts",
    ),
    Mutant(
        "depth in the nose along the barrier's normal",
        "fem_impact/solid/fine_zone.py",
        "(points - points[skin[at]]) * normal).sum(axis=1)",
        "(points - points[skin[at]])[:, 2:] * normal[:, 2:]).sum(axis=1)",
        "tests/solid/test_skinwork.py::test_the_depth_in_a_round_nose_is_that_under_its_outline",
    ),
    Mutant(
        "the impedance of a plate beside its mesh, which bends by itself",
        "fem_impact/case/case.py",
        "slots.plate, slots.bending = None, plate_waves(self.contact)[0]",
        "slots.bending = plate_waves(self.contact)[0]",
        "tests/case/test_plates.py::test_a_plate_bends_by_its_mesh_where_the_half_space_is_told_to_be_wrong",
    ),
    Mutant(
        "dashpots that turn the edge of a plate as if its nodes lay evenly through it",
        "fem_impact/fem/boundary.py",
        " ** 2 / 12 / lumped",
        " ** 0",
        "tests/solid/test_plate_mesh.py::test_edges_push_and_turn_like_the_rest_of_the_plate",
    ),
)


def survives(mutant: Mutant, folder: Path) -> str:
    """Return what pytest said if the fault went unnoticed in a copy at ``folder``, else nothing."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, folder / name)
    target = folder / mutant.file
    text = target.read_text(encoding="utf-8")
    if text.count(mutant.old) != 1:
        return f"{mutant.file} holds the text to change {text.count(mutant.old)} times, not once"
    target.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
    line = [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", "-m", "", mutant.test]
    done = subprocess.run(line, cwd=folder, capture_output=True, text=True, check=False)
    return "" if done.returncode == FAILED else done.stdout[-2000:] + done.stderr[-2000:]


TITLE = "Faults that the tests notice"
ABOUT = "Wrong formulas, put into a copy of the sources one by one, and the test that fails for each."


def table() -> str:
    """Return the faults and the tests that notice them as a Markdown table."""
    rows = [f"| {m.fault} | `{m.test.partition('::')[2]}` |" for m in MUTANTS]
    return "\n".join(["| fault | noticed by |", "| --- | --- |", *rows])


def main(page: Path) -> int:
    """Try every fault; write the page if all were noticed, and return how many were not."""
    alive = 0
    for one in MUTANTS:
        with TemporaryDirectory() as place:
            left = survives(one, Path(place))
        sys.stderr.write(f"{'SURVIVES' if left else 'dies    '} {one.fault}\n{left}")
        alive += bool(left)
    if not alive:
        write_page(page, TITLE, ABOUT, f"python tests/mutants.py {page}", table())
    return alive


if __name__ == "__main__":
    sys.exit(main(checked_page(sys.argv[1])))
