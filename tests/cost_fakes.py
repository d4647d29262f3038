"""Runs with a known limit and order, at a known price, so that settings can be judged without a solver."""

from concurrent.futures import Executor, Future
from dataclasses import replace
from math import cos, pi

from outcome_maker import outcome

from fem_impact.case.case import Case
from fem_impact.case.record import Site
from fem_impact.scene.types import digest

LIMIT, ORDER = {"e_edge": 0.3, "mu": 0.5, "E_vib_over_E_0": 0.02}, 1.0
SLOPE = {"e_edge": 0.03, "mu": -0.02, "E_vib_over_E_0": 0.002}  # at a tip of 0.4 mm
WIGGLE = 0.001  # of e with the place of the grid, at that tip
TIP = 0.4e-3
OFF = {"rigid": 0.15, "modal": 0.1}  # relative error of the reduced fidelities


def run(scene, fidelity="solid", options=None):
    """A record as if it had been computed; leaving friction out doubles mu."""
    values = {"scene_id": scene.id, "fidelity": fidelity, "scene_digest": digest(scene)}
    values |= {"v_n_m_per_s": -1.5, "v_t_m_per_s": -1.5, "k_squared_m2": 5e-4, "mu": 0.25}
    h = scene.accuracy.tip_size or TIP
    part = OFF.get(fidelity)
    values |= {
        key: limit * (1 + part) if part else limit + SLOPE[key] * (h / TIP) ** ORDER
        for key, limit in LIMIT.items()
    }
    values["e_edge"] += 0 if part else WIGGLE * (h / TIP) * cos(2 * pi * scene.accuracy.grid_shift)
    if "friction" not in Case(scene).active:
        values["mu"] += 0.5
    values |= {
        "tip_size_m": None if part else h,
        "mass_scaling": None if part else scene.accuracy.mass_scaling,
        "element_steps": None if part else int(1e6 * (TIP / h) ** 4),
    }
    values["cpu_s"] = {"rigid": 1e-3, "modal": 1e-2}.get(fidelity, 8 * (TIP / h) ** 4)
    values["wall_s"] = 2 * values["cpu_s"] if fidelity == "solid" else 3.0  # a busy machine
    values |= {f"setup_{key}": None if part else values[key] / 4 for key in ("cpu_s", "wall_s")}
    values |= {"E_vib_check_over_E_0": values["E_vib_over_E_0"], "E_vib_floor_over_E_0": 1e-9}
    if fidelity == "rigid" or "vibration" not in Case(scene).active:
        values["E_vib_over_E_0"] = None
    if part:
        values |= {"peak_memory_MB": None}
    return outcome(**values)


def pressed(record):
    """The record of a run that presses eight cells across: its contact is resolved."""
    half = 4 * record.rod.edge
    site = Site(0.0, 1e-4, 0.3, 0.1, (-half, 0.0), (half, half), 1e-5)
    return replace(record, sites=(site,), resolved=True)


def fake_levels(scene, fidelity, options, case):
    """A run of a level: the pilot, whose cells are the largest, resolves nothing."""
    record = pressed(case.record)
    return run(scene), replace(record, resolved=case.record.sites != ()) if not case.record.sites else record


class Here(Executor):
    """Runs every job at once in this process and remembers it."""

    def __init__(self):
        self.names = []

    def submit(self, work, job):
        self.names.append(job.name)
        future = Future()
        future.set_result(work(job))
        return future
