"""The report of one run."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from html import escape
from pathlib import Path

from fem_impact.errors import ResultError, RunError, SceneError, UsageError
from fem_impact.figures.runs import partition_picture
from fem_impact.figures.style import percent
from fem_impact.files.atomic import make_directory, read_text
from fem_impact.outcome.keys import Key, Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome
from fem_impact.pages.page import (
    Markup,
    bullets,
    details,
    figure,
    join,
    page,
    paragraph,
    section,
    sources,
    table,
)
from fem_impact.pages.sections import (
    all_keys,
    beside_tests,
    card,
    contacts_table,
    effects_section,
    estimated,
    film_section,
    has_film,
    history_figures,
    key_table,
    notices,
    strangers,
    unknown,
    waves_section,
)
from fem_impact.pages.verdict_page import screening_box
from fem_impact.physics.flash import ASSUMPTIONS
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_toml
from fem_impact.scene.types import Scene
from fem_impact.tables.table import Cell, Table, number


def _keys(*path: str) -> list[Key]:
    """Return the keys of a group of the outcome, given by its attribute path."""
    return [key for key in KEYS if key.path[: len(path)] == path]


RATIOS = (KEY_TABLE["mu"], KEY_TABLE["mu_c"])
MOTION = (*_keys("motion"), *RATIOS, *_keys("contact", "markers"))
ENERGY = tuple(key for key in _keys("energy") if key.kind == "number")
HEATED = tuple(
    KEY_TABLE[name]
    for name in (
        "W_friction_over_E_0",
        "W_skin_over_E_0",
        "W_skin_rod_over_E_0",
        "W_skin_barrier_over_E_0",
        "E_lt_edge_over_E_0",
        "E_lt_less_vibration_over_E_0",
    )
)
HEAT = (*HEATED, *(key for key in _keys("heat") if key not in HEATED))


def run_page(folder: Path) -> str:
    """Return the HTML of the run in ``folder``; figures with their data stay in ``folder/figures``.

    Raises
    ------
    ResultError
        outcome.json is missing or damaged.
    """
    outcome = Outcome.read(folder / "outcome.json")
    scene = _stated(folder)
    rigid = rigid_theory(outcome, scene)
    shares = figure(partition_picture(outcome), make_directory(folder / "figures"))
    body = (
        *([screening_box(scene, str(folder / "scene.toml"))] if scene else ()),
        _cards(outcome, rigid),
        film_section(folder),
        notices([outcome], strangers(outcome, folder)),
        beside_tests(outcome, scene, folder),
        section(f"Where the energy went{_stop(outcome)}", shares, _folded(outcome, "shares", ENERGY, rigid)),
        section("Motion", _folded(outcome, "velocities and impulse ratios", MOTION, rigid)),
        waves_section(folder),
        history_figures(outcome, folder),
        section("Contacts", details("Times and impulses", contacts_table(outcome))),
        section("Heat of the contact", _heat(outcome, rigid)),
        section("Coefficients and losses", details("With three sets of arms", _arms(outcome))),
        effects_section(outcome),
        unknown([outcome]),
        section("Range of validity", bullets(outcome.validity.outside)),
        section("Cost", details("Time, memory and elements", key_table(outcome, _keys("cost")))),
        sources([*outcome.provenance.effects, *(["film"] if has_film(folder) else [])]),
        section("Record", _scene_text(folder), all_keys(outcome)),
    )
    origin = outcome.provenance
    return page(origin.scene_title, f"Run · {origin.scene_id}", _lead(outcome), _footer(outcome), body)


def _stated(folder: Path) -> Scene | None:
    """Return the scene of a run; None where its file is missing or not a scene."""
    try:
        return read_toml(folder / "scene.toml")
    except (SceneError, UsageError):
        return None


def rigid_theory(outcome: Outcome, scene: Scene | None) -> Outcome | None:
    """Return what rigid theory predicts for the scene of a run; None where it is the run, or cannot tell."""
    if outcome.provenance.fidelity == "rigid" or scene is None:
        return None
    try:
        stated = replace(scene, accuracy=replace(scene.accuracy, target=None))
        return simulate(stated, "rigid")
    except (SceneError, RunError, ResultError):  # own tests that can no longer be read are told elsewhere
        return None


def _stop(outcome: Outcome) -> str:
    return "" if outcome.validity.finished else ": at the stop of this unfinished run"


def _folded(outcome: Outcome, what: str, keys: Iterable[Key], rigid: Outcome | None) -> Markup:
    beside = " beside rigid theory" if rigid else ""
    return details(f"All {what}{beside}", key_table(outcome, keys, rigid=rigid))


def _heat(outcome: Outcome, rigid: Outcome | None) -> Markup:
    """Return peaks, time above ignition and the bound with its assumptions; nothing where heat was off."""
    if isinstance(outcome.heat.power, Unknown):
        return Markup("")
    bound = paragraph("The bound for a safety case holds under these assumptions:")
    told = join([key_table(outcome, HEAT, rigid=rigid), bound, bullets(ASSUMPTIONS)])
    return details("Work, power and temperatures, and the bound for a safety case", told)


def _cards(outcome: Outcome, rigid: Outcome | None) -> Markup:
    stated = outcome.restitution.tests_state_arms
    restitution = ("e, the tests' arms", "e_paper", "") if stated else ("e, the tip's arms", "e_edge", "")
    shown = [restitution, ("impulse ratio µ", "mu", ""), ("Ω", "Omega_rad_per_s", " rad/s")]
    cards = [_card(outcome, rigid, label, KEY_TABLE[name], unit) for label, name, unit in shown]
    residual = number(outcome.energy.residual, 2)
    last = card("ledger residual", residual, "of E₀; a run must stay below 1e-4")
    inner = join([*cards, _vibration_card(outcome, rigid), last])
    return Markup(f'<div class="cards">{inner.text}</div>')


def _card(outcome: Outcome, rigid: Outcome | None, label: str, key: Key, unit: str) -> Markup:
    """Return a number with its band, or why it has none, and what rigid theory predicts."""
    bands = outcome.validity.mesh_band
    missing = bands.reason if isinstance(bands, Unknown) else ""
    predicted = None if rigid is None else or_none(key.of(rigid))
    theory = "" if predicted is None else f"rigid theory: {number(predicted)}{unit}"
    return card(label, estimated(outcome, key) + unit, ". ".join(note for note in (theory, missing) if note))


def _vibration_card(outcome: Outcome, rigid: Outcome | None) -> Markup:
    energy = outcome.energy
    share, floor = or_none(outcome.estimate(KEY_TABLE["E_vib_over_E_0"])[0]), or_none(energy.vibration_floor)
    notes = (
        *(["rigid theory: none"] if rigid else []),
        *([] if floor is None else [f"less than {percent(floor)} is not resolved"]),
    )
    note = ". ".join(notes)
    if or_none(energy.below_floor):
        return card("vibration, of E₀", "below floor", note)
    return card("vibration, of E₀", "–" if share is None else percent(share), note)


def _arms(outcome: Outcome) -> Markup:
    head = ("arms", "d_c, mm", "d_d, mm", "e", "e_m", "E_ln / E₀", "E_lt / E₀")
    titles = {
        "paper": "of the measured tests",
        "edge": "contact on the edge radius",
        "impulse": "centre of the impulse",
    }
    rows = [[title, *_arms_row(outcome, name)] for name, title in titles.items()]
    return table(Table.of(head, rows))


def _arms_row(outcome: Outcome, name: str) -> list[Cell]:
    d_c, d_d, *others = _keys("restitution", name)
    arms = [or_none(key.of(outcome)) for key in (d_c, d_d)]
    lengths = [None if arm is None else 1e3 * arm for arm in arms]
    return [*lengths, *(estimated(outcome, key) for key in others)]


def _scene_text(folder: Path) -> Markup:
    path = folder / "scene.toml"
    if not path.is_file():
        return Markup("")
    return details("The scene", Markup(f"<pre>{escape(read_text(path))}</pre>"))


def _lead(outcome: Outcome) -> str:
    origin = outcome.provenance
    effects = ", ".join(origin.effects) or "none"
    ended = f"Why the run ended: {outcome.validity.stopped_because}"
    return f"{ended} Fidelity: {origin.fidelity}. Effects in the model: {effects}."


def _footer(outcome: Outcome) -> str:
    origin = outcome.provenance
    versions = ", ".join(f"{name} {version}" for name, version in origin.versions.items())
    return f"Computed {origin.created_utc} with {versions}. Scene {origin.scene_digest}."
