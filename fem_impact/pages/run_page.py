"""The report of one run, and the verdict on a scene as a page to print and sign."""

import json
from collections.abc import Iterable, Sequence
from contextlib import suppress
from html import escape
from pathlib import Path
from typing import Any

from fem_impact.answers.friction_spread import FrictionSpread, friction_spread
from fem_impact.answers.verdict.screening import screening
from fem_impact.answers.verdict.sentences import Line, screening_lines
from fem_impact.case.case import Case
from fem_impact.errors import ResultError, RunError, SceneError, UsageError
from fem_impact.figures.panels import Picture
from fem_impact.figures.runs import accounts_picture, partition_picture, path_picture, tail_picture
from fem_impact.figures.still import draw, percent
from fem_impact.files.atomic import make_directory, read_signed, read_text, signed, write_text
from fem_impact.outcome.keys import Key, Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome, utc_now
from fem_impact.outcome.said import heat_said
from fem_impact.outcome.strikes import spread_table, strikes_table, told
from fem_impact.pages import html, sections
from fem_impact.physics.flash import ASSUMPTIONS
from fem_impact.run.certain import other_end_curve
from fem_impact.run.common import pull_of
from fem_impact.run.simulate import simulate
from fem_impact.scene.inputs import inputs
from fem_impact.scene.read import read_toml
from fem_impact.scene.types import Scene, digest, to_toml
from fem_impact.tables.table import DASH, Cell, Table, number
from fem_impact.tables.text import markup
from rigid.strikes import outline

SIGNATURES = "Assessed by, date: ______________________    Checked by, date: ______________________"


def verdict_box(lines: Sequence[Line], answer: str = "") -> html.Markup:
    """Return titled sentences as the box that heads a page; ``answer`` gives its colour."""
    rows = "\n".join(
        f"<p><strong>{markup(title)}</strong> {markup(sentence)}</p>" for title, sentence in lines
    )
    return html.Markup(f'<div class="verdict {escape(answer)}">\n{rows}\n</div>')


def verdict_of(folder: Path, scene: Scene) -> tuple[str, html.Markup]:
    """Return the criterion of the verdict that lies beside a run, and its box; else those of an estimate.

    Raises
    ------
    ResultError
        The verdict is damaged, or on another scene.
    """
    stored = folder / "verdict.json"
    if not stored.is_file():
        lines = screening_lines(screening(Case(scene).bodies), str(folder / "scene.toml"))
        criterion = "the published limit of rigid behaviour, as an estimate. No verdict computed."
        return f"Criterion: {criterion}", verdict_box(lines)
    told = read_signed(read_text(stored), str(stored))
    if told["scene_digest"] != digest(scene):
        raise ResultError(f"{stored}: is the verdict on another scene: assess {folder / 'scene.toml'} again.")
    if "within" in told:
        criterion = "vibration changes {of} by at most {change:g}.".format(**told["within"])
    else:
        criterion = told["box"][0][0]  # the question of a limit
    said = f"Criterion: {criterion} Answer: {told['answer'].upper()}."
    return said, verdict_box(told["box"], told["answer"])


def write_verdict(scene: Scene, document: dict[str, Any], out: Path, picture: Picture | None) -> Path:
    """Write ``verdict.html``, ``verdict.json``, ``scene.toml`` and a chart, if any; return the page's path.

    Raises
    ------
    MissingLibraryError
        matplotlib or plotly is not installed.
    """
    make_directory(out)
    write_text(out / "scene.toml", to_toml(scene))
    write_text(out / "verdict.json", json.dumps(signed(document), indent=1, allow_nan=False) + "\n")
    charted: tuple[html.Markup, ...] = ()
    if picture is not None:
        figures = make_directory(out / "figures")
        draw(picture, figures / f"{picture.name}.png")
        charted = (html.section("This scene among other rods", html.figure(picture, figures)),)
    basis = (
        html.Markup(f"<strong>{markup(title)}</strong>: {markup(sentence)}")
        for title, sentence in document["basis"]
    )
    following = [("Missing:", document["missing"]), ("Next step:", document["next_step"])]
    body = (
        verdict_box([*document["box"], *(line for line in following if line[1])], document["answer"]),
        html.section("What the verdict rests on", html.bullets(basis)),
        *charted,
        html.section("Inputs and their sources", html.table(inputs(scene))),
        html.section("What the verdict does not cover", html.bullets(document["not_covered"])),
        html.section("Statement of the scene", html.Markup(f"<pre>{escape(to_toml(scene))}</pre>")),
        html.section("Signatures", html.paragraph(SIGNATURES)),
        html.sources(Case(scene).active),
    )
    versions = html.versions_text(document["versions"])
    footer = f"Computed {utc_now()} with {versions}. Digest of the scene {document['scene_digest']}."
    text = html.page(f"{document['box'][0][0]} {scene.id}", "verdict", f"{scene.title}.", footer, body)
    return write_text(out / "verdict.html", text)


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
    try:
        scene = read_toml(folder / "scene.toml")
    except (SceneError, UsageError):  # the file is missing, or no scene
        scene = None
    rigid = rigid_theory(outcome, scene)
    shares = html.figure(sections.named(partition_picture(outcome), scene), folder / "figures")
    stop = "" if outcome.validity.finished else ": at the stop of this unfinished run"
    costs = sections.key_table(outcome, _keys("cost"))
    stated, path = [], folder / "scene.toml"
    if path.is_file():
        stated = [html.details("The scene", html.Markup(f"<pre>{escape(read_text(path))}</pre>"))]
    body = (
        *(verdict_of(folder, scene)[1:] if scene else ()),
        _cards(outcome, rigid, friction_spread(scene, outcome.provenance.fidelity) if scene else None),
        sections.notices([outcome], sections.mismatches(outcome, folder)),
        sections.film_section(folder),
        sections.beside_tests(outcome, scene, folder),
        html.section(
            f"Where the energy went{stop}",
            shares,
            html.bullets(heat_said(outcome)),
            _folded(outcome, "shares", ENERGY, rigid),
        ),
        html.section("Motion", _folded(outcome, "velocities and impulse ratios", MOTION, rigid)),
        _strikes(outcome, scene, folder),
        sections.waves_section(folder),
        sections.history_figures(outcome, folder, scene=scene),
        html.section(
            "Contact",
            sections.contact_places(outcome),
            html.details("Times and impulses", sections.contacts_table(outcome)),
        ),
        html.section("Heat of the contact", _heat(outcome, rigid)),
        html.section("Coefficients and losses", html.details("With three sets of arms", _arms(outcome))),
        sections.effects_section(outcome),
        sections.unknown([outcome]),
        sections.validity([outcome]),
        html.section("Cost", html.details("Time, memory and elements", costs)),
        html.sources([*outcome.provenance.effects, *(["film"] if html.film_of(folder) else [])]),
        html.section("Record", *stated, sections.all_keys(outcome)),
    )
    origin = outcome.provenance
    lead = (
        f"Why the run ended: {outcome.validity.stopped_because} Fidelity: {origin.fidelity}. "
        f"Effects in the model: {', '.join(origin.effects) or 'none'}."
    )
    versions = html.versions_text(origin.versions)
    footer = f"Computed {origin.created_utc} with {versions}. Scene {origin.scene_digest}."
    return html.page(origin.scene_title, f"Run · {origin.scene_id}", lead, footer, body)


def _strikes(outcome: Outcome, scene: Scene | None, folder: Path) -> html.Markup:
    """Return the strikes of a body that is followed beyond its first impact, nothing of another run."""
    each = or_none(outcome.strikes.each)
    if not each or scene is None:
        return html.Markup("")
    shape, pull = outline(scene.projectile.rigid_body), pull_of(scene)
    figures, spread = folder / "figures", or_none(outcome.strikes.spread)
    ratio, over_angles = outcome.strikes.other_end, html.Markup("")
    if not isinstance(ratio, Unknown):
        with suppress(SceneError):  # rigid theory does not follow the body at some inclination
            curve = other_end_curve(scene)
            over_angles = html.figure(tail_picture(curve, (scene.impact.angle, ratio)), figures)
    return html.section(
        "From the first strike to rest",
        html.paragraph(" ".join(told(outcome.strikes))),
        html.figure(path_picture(each, shape, pull), figures),
        html.figure(accounts_picture(each), figures),
        over_angles,
        html.details("Each strike of the path computed", html.table(strikes_table(outcome.strikes))),
        *([html.details("What strikes in 64 sequences", html.table(spread_table(spread)))] if spread else []),
    )


def rigid_theory(outcome: Outcome, scene: Scene | None) -> Outcome | None:
    """Return what rigid theory predicts for the scene of a run; None where it is the run, or cannot tell."""
    if outcome.provenance.fidelity == "rigid" or scene is None:
        return None
    try:
        return simulate(scene.untargeted, "rigid")
    except (SceneError, RunError, ResultError):  # `sections` reports tests that cannot be read
        return None


def _folded(outcome: Outcome, what: str, keys: Iterable[Key], rigid: Outcome | None) -> html.Markup:
    beside = " beside rigid theory" if rigid else ""
    return html.details(f"All {what}{beside}", sections.key_table(outcome, keys, rigid=rigid))


def _heat(outcome: Outcome, rigid: Outcome | None) -> html.Markup:
    """Return peaks, time above ignition and the bound with its assumptions; nothing where heat was off."""
    if isinstance(outcome.heat.power, Unknown):
        return html.Markup("")
    bound = html.paragraph("The bound for a safety case holds under these assumptions:")
    shown = html.join([sections.key_table(outcome, HEAT, rigid=rigid), bound, html.bullets(ASSUMPTIONS)])
    return html.details("Work, power and temperatures, and the bound for a safety case", shown)


def _cards(outcome: Outcome, rigid: Outcome | None, friction: FrictionSpread | None) -> html.Markup:
    """Return numbers with their bands, or why they have none; what rigid theory predicts and f changes."""
    tests = outcome.restitution.tests_state_arms
    restitution = ("e, the tests' arms", "e_paper", "") if tests else ("e, the tip's arms", "e_edge", "")
    shown = [restitution, ("impulse ratio µ", "mu", ""), ("Ω", "Omega_rad_per_s", " rad/s")]
    shown += [("peak force", "peak_force_N", " N"), ("flash temperature", "flash_temperature_K", " K")]
    bands, numbers = outcome.half_widths, []
    missing = bands.reason if isinstance(bands, Unknown) else ""
    for label, name, unit in shown:
        key = KEY_TABLE[name]
        if isinstance(value := key.of(outcome), Unknown):
            numbers.append(sections.card(label, DASH, value.reason))
            continue
        predicted = None if rigid is None else or_none(key.of(rigid))
        theory = "" if predicted is None else f"rigid theory: {number(predicted)}{unit}"
        changed = friction.told(key) if friction else ""
        by_friction = f"interval of f: {changed}" if changed else ""
        note = ". ".join(sentence for sentence in (by_friction, theory, missing) if sentence)
        numbers.append(sections.card(label, sections.estimated(outcome, key) + unit, note))
    residual = number(outcome.energy.residual, 2)
    last = sections.card("ledger residual", residual, "of E₀; a run must stay below 1e-4")
    said = f"Interval of f: {friction.said}" if friction and friction.said else ""
    all_cards = sections.cards(*numbers, _vibration_card(outcome, rigid), last)
    return html.join([all_cards, html.paragraph(said, "note")])


def _vibration_card(outcome: Outcome, rigid: Outcome | None) -> html.Markup:
    energy, name = outcome.energy, "vibration, of E₀"
    if isinstance(energy.vibration, Unknown):
        return sections.card(name, DASH, energy.vibration.reason)
    floor = or_none(energy.vibration_floor)
    theory = "rigid theory: none" if rigid else ""
    resolved = "" if floor is None else f"less than {percent(floor)} is not resolved"
    share = f"{html.signed(outcome.told('E_vib_over_E_0', 100.0))} %"
    shown = "below floor" if or_none(energy.below_floor) else share
    return sections.card(name, shown, ". ".join(filter(None, (theory, resolved))))


def _arms(outcome: Outcome) -> html.Markup:
    head = ("arms", "d_c, mm", "d_d, mm", "e", "e_m", "E_ln / E₀", "E_lt / E₀")
    titles = {
        "paper": "of the measured tests",
        "edge": "contact on the edge radius",
        "impulse": "centre of the impulse",
    }
    rows: list[list[Cell]] = []
    for name, title in titles.items():
        d_c, d_d, *ratios = _keys("restitution", name)
        arms = [or_none(key.of(outcome)) for key in (d_c, d_d)]
        lengths = [None if arm is None else 1e3 * arm for arm in arms]
        rows.append([title, *lengths, *(sections.estimated(outcome, key) for key in ratios)])
    return html.table(Table.of(head, rows))
