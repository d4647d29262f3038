"""The report of one run."""

from __future__ import annotations

from functools import partial
from html import escape
from pathlib import Path

from fem_impact.figures import partition_figure
from fem_impact.figures.style import percent
from fem_impact.heating import ASSUMPTIONS
from fem_impact.outcome import ARMS, Outcome
from fem_impact.outcome.keys import HEATING
from fem_impact.output import make_directory, read_text
from fem_impact.report.effects import effects_section
from fem_impact.report.embed import picture
from fem_impact.report.html import (
    Markup,
    bullets,
    details,
    join,
    number,
    paragraph,
    section,
    table,
    with_band,
)
from fem_impact.report.page import page, sources
from fem_impact.report.sections import film_section, has_film, history_figures, notices, strangers
from fem_impact.report.tables import all_keys, card, contacts_table, key_table, unknown

__all__ = ["run_page"]

MOTION = (
    "friction_f", "alpha_rad", "mass_kg", "k_squared_m2", "gamma_per_m0_3815", "v_n_m_per_s", "v_t_m_per_s",
    "V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s", "mu", "mu_c", "marker_V_n_m_per_s", "marker_V_t_m_per_s",
    "marker_Omega_rad_per_s", "marker_V_cn_m_per_s", "marker_V_ct_m_per_s",
)  # fmt: skip
ENERGY = (
    "E_0_J", "E_r_over_E_0", "E_vib_over_E_0", "E_vib_check_over_E_0", "E_vib_floor_over_E_0",
    "W_friction_over_E_0", "W_skin_over_E_0", "E_plastic_rod_over_E_0", "E_plastic_barrier_over_E_0",
    "E_locked_rod_over_E_0", "E_locked_barrier_over_E_0", "W_radiated_over_E_0", "W_closing_over_E_0",
    "W_damping_over_E_0", "W_gravity_over_E_0", "E_hourglass_over_E_0", "residual_over_E_0",
)  # fmt: skip
COST = (
    "steps", "element_steps", "elements_rod", "elements_barrier", "elements_yielding",
    "wall_s", "cpu_s", "setup_wall_s", "setup_cpu_s", "peak_memory_MB", "min_step_s", "tip_size_m",
)  # fmt: skip


def run_page(folder: Path) -> str:
    """Return the HTML of the run in ``folder``; figures with their data stay in ``folder/figures``.

    Raises
    ------
    ResultError
        outcome.json is missing or damaged.
    """
    outcome = Outcome.read(folder / "outcome.json")
    body = (
        _cards(outcome),
        notices([outcome], strangers(outcome, folder)),
        section("Where the energy went", _partition(outcome, folder), key_table(outcome, ENERGY)),
        effects_section(outcome),
        history_figures(outcome, folder),
        section("Contacts", contacts_table(outcome)),
        film_section(folder),
        section("Heat of the contact", _heat(outcome)),
        section("Motion", key_table(outcome, MOTION)),
        section("Coefficients and losses with three sets of arms", _arms(outcome)),
        unknown([outcome]),
        section("Range of validity", bullets(outcome["validity"])),
        section("Cost", key_table(outcome, COST)),
        sources([*outcome["effects"], *(["film"] if has_film(folder) else [])]),
        section("Record", _scene_text(folder), all_keys(outcome)),
    )
    return page(
        outcome["scene_title"], f"Run · {outcome['scene_id']}", _lead(outcome), _footer(outcome), body
    )


def _partition(outcome: Outcome, folder: Path) -> Markup:
    return picture(
        partial(partition_figure, outcome),
        make_directory(folder / "figures") / "partition",
        "Bars of the shares of the energy after the last separation",
        "Shares of E₀ after the last separation.",
    )


def _heat(outcome: Outcome) -> Markup:
    """Return peaks, time above ignition and the bound with its assumptions; nothing where heat was off."""
    if outcome["flash_bound_K"] is None:
        return Markup("")
    shares = ("W_friction_over_E_0", "W_skin_over_E_0", "E_lt_edge_over_E_0", "E_lt_less_vibration_over_E_0")
    told = key_table(outcome, (*shares, *(key.name for key in HEATING[:-1])))
    bound = paragraph("The bound for a safety case holds under these assumptions:")
    return join([told, bound, bullets(ASSUMPTIONS)])


def _cards(outcome: Outcome) -> Markup:
    bands = outcome["bands"] or {}
    missing = outcome.reason("bands") or ""
    edge = ("e, the tip's arms", "e_edge", "")  # only a measured set has arms of the paper
    shown = [
        edge if outcome["e_paper"] is None else ("e, paper's arms", "e_paper", ""),
        ("impulse ratio µ", "mu", ""),
        ("Ω", "Omega_rad_per_s", " rad/s"),
    ]
    cards = [
        card(label, with_band(outcome[key], bands.get(key)) + unit, "" if key in bands else missing)
        for label, key, unit in shown
    ]
    inner = join([*cards, _vibration_card(outcome), _residual_card(outcome)])
    return Markup(f'<div class="cards">{inner.text}</div>')


def _vibration_card(outcome: Outcome) -> Markup:
    share, floor = outcome["E_vib_over_E_0"], outcome["E_vib_floor_over_E_0"]
    note = "" if floor is None else f"floor {percent(floor)}"
    if outcome["E_vib_below_floor"]:
        return card("vibration, of E₀", "below floor", note)
    return card("vibration, of E₀", "–" if share is None else percent(share), note)


def _residual_card(outcome: Outcome) -> Markup:
    residual = outcome["residual_over_E_0"]
    return card(
        "ledger residual", "–" if residual is None else f"{residual:.1e}", "of E₀; a run must stay below 1e-4"
    )


def _arms(outcome: Outcome) -> Markup:
    head = ("arms", "d_c, mm", "d_d, mm", "e", "e_m", "E_ln / E₀", "E_lt / E₀")
    return table(head, [_arms_row(outcome, name) for name in ARMS], numbers=range(1, 7))


def _arms_row(outcome: Outcome, name: str) -> list[str]:
    titles = {
        "paper": "the paper's",
        "edge": "contact on the edge radius",
        "impulse": "centre of the impulse",
    }
    arms = [outcome[f"{arm}_{name}_m"] for arm in ("d_c", "d_d")]
    keys = (f"e_{name}", f"e_m_{name}", f"E_ln_{name}_over_E_0", f"E_lt_{name}_over_E_0")
    bands = outcome["bands"] or {}
    lengths = [number(None if arm is None else 1e3 * arm) for arm in arms]
    return [titles[name], *lengths, *(with_band(outcome[key], bands.get(key)) for key in keys)]


def _scene_text(folder: Path) -> Markup:
    path = folder / "scene.toml"
    if not path.is_file():
        return Markup("")
    return details("The scene", Markup(f"<pre>{escape(read_text(path))}</pre>"))


def _lead(outcome: Outcome) -> str:
    effects = ", ".join(outcome["effects"]) or "none"
    return f"{outcome['stopped_because']} Fidelity: {outcome['fidelity']}. Effects in the model: {effects}."


def _footer(outcome: Outcome) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in outcome["versions"].items())
    return f"Computed {outcome['created_utc']} with {versions}. Scene {outcome['scene_digest']}."
