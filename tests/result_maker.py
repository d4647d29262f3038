"""A made-up but plausible result directory: a bending, ringing half rod that strikes a block twice."""

import json
from pathlib import Path

import numpy as np
import outcome_maker

from fem_impact.files.atomic import signed, write_text
from fem_impact.files.fields_write import FieldWriter
from fem_impact.files.waves import Ringing, Waves
from fem_impact.files.waves import write_waves as write_waves_file
from fem_impact.outcome.record import Outcome
from fem_impact.tables.history import CONTACTS, HISTORY
from fem_impact.tables.table import COMPARISON, Table

LENGTH, RADIUS, ALPHA, SPEED = 0.08, 9.5e-3, np.radians(45.0), 2.1
MASS, E_0 = 0.1766, 0.1766 * SPEED**2 / 2
CONTACT_TIMES = ((4e-6, 240e-6), (610e-6, 790e-6))
PEAKS = (9500.0, 3200.0)
T_END = 1.0e-3


def grid(shape):
    """Nodes on [0,1]^3 as (n, 3) and hexahedra in VTK order as (m, 8)."""
    nx, ny, nz = shape
    axes = [np.linspace(0.0, 1.0, n + 1) for n in shape]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange((nx + 1) * (ny + 1) * (nz + 1)).reshape(nx + 1, ny + 1, nz + 1)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [number[i : nx + i, j : ny + j, k : nz + k].ravel() for i, j, k in corners]
    return points, np.stack(cells, axis=1)


def rod_local(across=6, along=36):
    """Half rod (y >= 0) in its own frame: square section mapped onto the half disc."""
    unit, cells = grid((across, across // 2, along))
    x, y = 2.0 * unit[:, 0] - 1.0, unit[:, 1]
    disc_x, disc_y = x * np.sqrt(1.0 - y**2 / 2.0), y * np.sqrt(1.0 - x**2 / 2.0)
    return np.column_stack([RADIUS * disc_x, RADIUS * disc_y, LENGTH * unit[:, 2] ** 1.3]), cells


def to_barrier(local):
    """Rod frame (x, y, z) to barrier frame (t, b, n)."""
    sine, cosine = np.sin(ALPHA), np.cos(ALPHA)
    x, y, z = local.T
    return np.column_stack([cosine * x + sine * z, y, -sine * x + cosine * z])


def mesh(across=6, along=36):
    """Rod above a barrier block: points (n, 3), cells (m, 8), body (m,), rod node count."""
    rod, rod_cells = rod_local(across, along)
    touching = np.array([[RADIUS, 0.0, 0.0]])
    block, block_cells = grid((10, 5, 5))
    block = (block - [0.5, 0.0, 1.0]) * [0.016, 0.008, 0.008]
    points = np.vstack([to_barrier(rod - touching), block])
    cells = np.vstack([rod_cells, block_cells + len(rod)])
    return (
        points,
        cells,
        np.r_[np.zeros(len(rod_cells)), np.ones(len(block_cells))].astype(np.int32),
        len(rod),
    )


def force(time):
    """Normal contact force in N: two half sines."""
    total = np.zeros_like(time)
    for (start, end), peak in zip(CONTACT_TIMES, PEAKS, strict=True):
        inside = (time > start) & (time < end)
        total += np.where(inside, peak * np.sin(np.pi * (time - start) / (end - start)), 0.0)
    return total


def progress(time):
    """Share of the whole impulse that has been given, 0 to 1."""
    fine = np.linspace(0.0, T_END, 4001)
    run = np.cumsum(force(fine))
    return np.interp(time, fine, run / run[-1])


def motion(time, local, points, rod_nodes):
    """Displacement (n, 3) m and velocity (n, 3) m/s of rod and block at one time."""
    share = progress(np.array([time]))[0]
    normal, tangential = -1.48 * (1 - 1.3 * share), -1.48 * (1 - 0.55 * share)
    spin = 30.0 * share
    bend = 12e-6 * share * np.sin(2 * np.pi * 12340 * time) * np.cos(2 * np.pi * local[:, 2] / LENGTH)
    rate = 12e-6 * share * 2 * np.pi * 12340 * np.cos(2 * np.pi * 12340 * time)
    centre = points[:rod_nodes].mean(axis=0)
    arm = points[:rod_nodes] - centre
    turn = np.column_stack([-arm[:, 2], np.zeros(rod_nodes), arm[:, 0]]) * -spin
    velocity = np.zeros((len(points), 3))
    velocity[:rod_nodes] = turn + np.array([tangential, 0.0, normal])
    velocity[:rod_nodes, 0] += rate * np.cos(2 * np.pi * local[:, 2] / LENGTH) * np.cos(ALPHA)
    moved = np.zeros((len(points), 3))
    moved[:rod_nodes] = velocity[:rod_nodes] * 0.3 * time
    moved[:rod_nodes, 0] += bend * np.cos(ALPHA)
    near = np.exp(-np.linalg.norm(points[rod_nodes:], axis=1) / 2e-3)
    moved[rod_nodes:, 2] = -30e-6 * near * (share > 0) - 25e-6 * near * force(np.array([time]))[0] / PEAKS[0]
    return moved, velocity


def stress(time, centres):
    """Von Mises stress (m,) Pa: a pulse running up and down the rod and the contact's own field."""
    travelled = (5282.0 * time) % (2 * LENGTH)
    front = min(travelled, 2 * LENGTH - travelled)
    height = np.abs(centres @ [np.sin(ALPHA), 0.0, np.cos(ALPHA)])
    pulse = 60e6 * np.exp(-(((height - front) / 0.012) ** 2)) * (time > CONTACT_TIMES[0][0])
    near = np.exp(-np.linalg.norm(centres, axis=1) / 2.5e-3)
    return pulse * (centres[:, 2] > 0) + 600e6 * near * force(np.array([time]))[0] / PEAKS[0] + 40e6 * near


def write_fields(path, frames=12, across=6, along=36):
    """Write a field file with evenly spaced frames; return the writer."""
    points, cells, body, rod_nodes = mesh(across, along)
    local = rod_local(across, along)[0]
    centres = points[cells].mean(axis=1)
    writer = FieldWriter(path, points, cells, {"body": body})
    for time in np.linspace(0.0, T_END, frames):
        moved, velocity = motion(time, local, points, rod_nodes)
        strain = 0.08 * np.exp(-np.linalg.norm(centres, axis=1) / 1.5e-3) * progress(np.array([time]))[0]
        fields = {"mises": stress(time, centres), "plastic_strain": strain}
        writer.append(time, {"displacement": moved, "velocity": velocity}, fields)
    return writer


def write_waves(path, across=6, along=36, rows=200):
    """Write strains of a pulse that runs up and down the rod, and one ringing mode after `T_END`."""
    points, _, _, count = mesh(across, along)
    axis = np.array([np.sin(ALPHA), 0.0, np.cos(ALPHA)])
    origin = to_barrier(np.array([[-RADIUS, 0.0, 0.0]]))[0]
    times, position = np.linspace(0.0, T_END, rows), np.linspace(0.2, 0.98, 24) * LENGTH
    travelled = (5282.0 * times) % (2 * LENGTH)
    front = np.minimum(travelled, 2 * LENGTH - travelled)
    stretch = -3e-4 * np.exp(-(((position - front[:, None]) / 0.012) ** 2))
    centre = points[:count].mean(axis=0) * [1.0, 0.0, 1.0]
    wave = np.cos(2 * np.pi * (points[:count] - origin) @ axis / LENGTH)
    shape = (wave[:, None] * [np.cos(ALPHA), 0.0, -np.sin(ALPHA)])[None]
    one, rest = np.ones(1), points[:count] - centre
    bent = np.cos(2 * np.pi * position / LENGTH)[None]
    flight = (centre, np.array([0.4, 0.0, 0.4]), 0.0, -30.0, 2 * np.pi * 12340 * one, 1e-5 * one, 0 * one)
    ringing = Ringing(T_END, *flight, shape, rest, 0 * bent, 10.0 * bent)
    strain = (stretch, -0.2 * stretch, LENGTH, RADIUS, 5282.0, 3325.0)
    write_waves_file(path, Waves(times, position, *strain, origin, axis, ringing))


def history(rows=600):
    """Columns of history.csv: accounts that close on E_0 by construction."""
    time = np.linspace(0.0, T_END, rows)
    normal, share = force(time), progress(time)
    parts = {
        "E_strain_rod_J": 0.02 * E_0 * share + 0.05 * E_0 * normal / PEAKS[0],
        "E_plastic_rod_J": 0.03 * E_0 * share**2,
        "E_kinetic_barrier_J": 0.002 * E_0 * normal / PEAKS[0],
        "E_strain_barrier_J": 0.02 * E_0 * share + 0.08 * E_0 * normal / PEAKS[0],
        "E_plastic_barrier_J": 0.40 * E_0 * share**1.5,
        "W_friction_J": 0.29 * E_0 * share**0.8,
        "W_contact_dissipation_J": 0.001 * E_0 * share,
        "W_radiated_J": 0.004 * E_0 * share,
    }
    table = dict.fromkeys(HISTORY, np.zeros(rows))
    table |= {"time_s": time, "force_n_N": normal, "force_t_N": 0.58 * normal} | parts
    table["residual_J"] = 2e-6 * E_0 * np.sin(8 * share)
    table["E_kinetic_rod_J"] = E_0 - sum(parts.values()) - table["residual_J"]
    table["contact_nodes"] = (normal > 0) * 14
    table["V_n_m_per_s"], table["V_t_m_per_s"] = -1.48 * (1 - 1.3 * share), -1.48 * (1 - 0.55 * share)
    table["Omega_rad_per_s"] = 30.0 * share
    return table


NUMBERS = {
    "friction_f": 0.57, "alpha_rad": float(ALPHA), "mass_kg": MASS, "k_squared_m2": 5.56e-4,
    "gamma_per_m0_3815": 19.1, "v_n_m_per_s": -1.485, "v_t_m_per_s": -1.485, "V_n_m_per_s": 0.312,
    "V_t_m_per_s": -0.412, "Omega_rad_per_s": 5.1, "mu": 0.597, "mu_c": 0.665, "E_0_J": E_0,
    "E_r_over_E_0": 0.06, "E_vib_over_E_0": 0.0004, "E_vib_check_over_E_0": 0.00043,
    "E_vib_floor_over_E_0": 0.00002, "W_friction_over_E_0": 0.29, "W_skin_over_E_0": 0.41,
    "W_skin_rod_over_E_0": 0.01, "W_skin_barrier_over_E_0": 0.11,
    "E_plastic_rod_over_E_0": 0.03,
    "E_plastic_barrier_over_E_0": 0.57, "E_locked_rod_over_E_0": 0.021, "E_locked_barrier_over_E_0": 0.0236,
    "W_radiated_over_E_0": 0.004, "W_contact_dissipation_over_E_0": 0.001, "residual_over_E_0": 2e-6,
    "marker_V_n_m_per_s": 0.315, "marker_V_t_m_per_s": -0.409, "marker_Omega_rad_per_s": 5.2,
    "marker_V_cn_m_per_s": 0.47, "marker_V_ct_m_per_s": -0.31, "wall_s": 81.5, "cpu_s": 84.2,
    "setup_wall_s": 9.1, "setup_cpu_s": 9.0,
    "peak_memory_MB": 512.0, "min_step_s": 1.8e-8, "tip_size_m": 0.35e-3,
}  # fmt: skip

REASONS = {
    "W_damping_over_E_0": "no damping effect was in the model",
    "effect_choices": "made by hand",
    "mesh_limit": "one mesh only; a study at two tip sizes fills it",
    "mesh_band": "one mesh only; a study at two tip sizes fills it",
    "model_band": "no reduced model",
}


def limited(**sentences):
    """Limitations as plain JSON, from one sentence a kind."""
    return [{"kind": kind, "text": text} for kind, text in sentences.items()]


def values(**changes):
    """Every key of a whole, valid record."""
    plain = NUMBERS | {
        "scene_id": "t5b", "created_utc": "2026-01-05T10:20:30+00:00",
        "scene_title": "0.08 m rod, tip B, machined plate, 45 deg, 2.1 m/s", "scene_digest": "ab" * 32,
        "versions": {"python": "3.11.7", "numpy": "2.4.6", "fem-impact": "0.1.0"},
        "stopped_because": "The drift of the tip exceeds every later vibration amplitude.",
        "effects": ["vibration", "friction", "rod-plasticity", "barrier-elastoplastic"],
        "limitations": limited(
            range="The impact speed lies inside the measured range, 1.3 to 6.1 m/s.",
            input="Yield stress is uncertain by a factor up to 1.5 (hardness and tensile data disagree).",
        ),
        "contacts": contacts(), "E_vib_below_floor": False, "reasons": REASONS,
        "W_damping_over_E_0": None, "steps": 40000,
        "element_steps": 320_000_000, "elements_rod": 5200, "elements_barrier": 2600,
        "elements_yielding": 2400,
    }  # fmt: skip
    return outcome_maker.values(**plain | changes)


def contacts():
    """The two contact intervals with their impulses."""
    impulses = [
        2 / np.pi * peak * (end - start) for (start, end), peak in zip(CONTACT_TIMES, PEAKS, strict=True)
    ]
    return [
        dict(zip(CONTACTS, (start, end, float(total), 0.58 * float(total)), strict=True))
        for (start, end), total in zip(CONTACT_TIMES, impulses, strict=True)
    ]


def write_result(folder, frames=0, across=6, along=36, **changes):
    """Write the files of a run, fields.vtkhdf and waves.h5 only with frames; return the folder."""
    folder = Path(folder)
    table = history()
    write_text(
        folder / "history.csv", Table.of(HISTORY, zip(*(table[name] for name in HISTORY), strict=True)).csv()
    )
    write_text(folder / "contacts.csv", Table.of(CONTACTS, contacts()).csv())
    Outcome.from_dict(values(**changes)).write(folder / "outcome.json")
    if frames:
        write_fields(folder / "fields.vtkhdf", frames, across, along)
        write_waves(folder / "waves.h5", across, along)
    return folder


SETS = ("t3-machined", "t3-contaminated", "t4", "t5a", "t5b", "t5c", "t6-17", "t6-25", "t6-60")
QUANTITIES = (("e", "-", 0.35), ("mu", "-", 0.55), ("Omega", "rad/s", 8.0), ("V_n", "m/s", 0.5),
              ("V_t", "m/s", -0.4), ("E_ln/E_0", "-", 0.45), ("E_lt/E_0", "-", 0.44),
              ("E_r/E_0", "-", 0.1))  # fmt: skip


def comparison(sets=SETS):
    """Rows of a comparison: scattered around plausible values, some unknown."""
    chance = np.random.default_rng(7)
    rows = []
    for name in sets:
        for quantity, unit, value in QUANTITIES:
            mean = value * (1 + 0.25 * chance.standard_normal())
            spread = abs(value) * 0.12
            half = 2.26 * spread / np.sqrt(10)
            model = mean + spread * chance.standard_normal()
            inside = "inside" if abs(model - mean) <= half else "outside"
            rows.append({
                "set": name, "quantity": quantity, "unit": unit, "model": model,
                "band": abs(value) * 0.05 if quantity in ("e", "mu", "Omega") else None,
                "measured_mean": mean, "measured_sd": spread, "measured_low": mean - half,
                "measured_high": mean + half, "n": 10, "verdict": f"{inside} the 95 % interval",
            })  # fmt: skip
    return rows


def study_rows(sets=SETS):
    """Outcomes of a study as plain records, the shares of E_0 varied."""
    chance = np.random.default_rng(3)
    rows = []
    for name in sets:
        friction = float(0.2 + 0.2 * chance.random())
        rest = 1.0 - friction - 0.06 - 0.0004 - 0.03 - 0.021 - 0.0236 - 0.004 - 0.001
        changes = {"W_friction_over_E_0": friction, "E_plastic_barrier_over_E_0": rest, "scene_id": name}
        rows.append(values(**changes))
    return rows


STUDY = {
    "schema": "fem-impact/study/3",
    "study": "sets",
    "title": "Model beside measurement",
    "command": "fem-impact study sets",
    "runs": 2,
    **{name: [] for name in ("findings", "assumptions", "sources", "conclusions")},
    **{name: [] for name in ("figures", "sheets", "failures")},
}


def write_study(folder, sets=SETS):
    """Write study.json and comparison.csv; return the folder."""
    study = STUDY | {"rows": study_rows(sets), "comparison": comparison(sets)}
    write_text(Path(folder) / "study.json", json.dumps(signed(study)))
    write_text(Path(folder) / "comparison.csv", Table.of(COMPARISON, study["comparison"]).csv())
    return Path(folder)
