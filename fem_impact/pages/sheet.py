"""One page of a run to print on A4 and sign: drawing, verdict, numbers with errors, inputs with sources."""

from pathlib import Path

from fem_impact.answers.friction_spread import FrictionSpread, friction_spread
from fem_impact.answers.verdict.sentences import never_covered
from fem_impact.case.case import Case
from fem_impact.errors import MissingLibraryError, ResultError
from fem_impact.files.atomic import checksum, make_directory, write_text
from fem_impact.files.run_directory import FIELDS
from fem_impact.outcome.groups import HEAVIEST_FIRST, WRONG_NUMBERS, texts
from fem_impact.outcome.keys import Unknown, or_none, why_unknown
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.said import HEATING, MOTION, errors_said, floor_said, heat_said
from fem_impact.outcome.shares import IF_ON, shares
from fem_impact.outcome.strikes import SHOWN, strikes_table, told
from fem_impact.pages import html
from fem_impact.pages.drawing import draw_projectile
from fem_impact.pages.run_page import verdict_of
from fem_impact.scene.inputs import inputs
from fem_impact.scene.read import read_toml
from fem_impact.scene.types import Scene, digest
from fem_impact.tables.table import Table
from fem_impact.tables.text import plain

SHEET = "sheet.html"
NARROW = 4.5  # inches, of the drawing
BLANK = "____________"
ROLES = ("prepared by", "checked by", "approved by")
NUMBERS = (
    ("restitution e (tip's arms)", "e_edge", ""),
    *MOTION,
    ("peak force", "peak_force_N", "N"),
    ("dent that stays in the barrier", "dent_depth_m", "mm"),
    ("flash temperature", "flash_temperature_K", "K"),
    ("ignition temperature, stated or 430 degC", "ignition_temperature_K", "K"),
    ("temperature that no spot exceeds", "flash_bound_K", "K"),
    (f"{HEATING}, of E_0", "W_skin_over_E_0", "%"),
)
"""Label, key and unit of the numbers before the shares of energy."""


def write_sheet(folder: Path, document: str = "", revision: str = "") -> Path:
    """Write ``sheet.html`` into the folder of a run and return its path.

    It states the verdict of ``fem-impact assess`` where ``verdict.json`` lies in the folder too, with the
    change of e that was allowed as the criterion; the closed-form estimate otherwise.

    Parameters
    ----------
    folder : with outcome.json and scene.toml
    document, revision : number of the document and its revision; lines to fill in where empty

    Raises
    ------
    ResultError
        The folder holds no run, its files are damaged, or the scene was changed after the run.
    """
    outcome = Outcome.read(folder / "outcome.json")
    scene = read_toml(folder / "scene.toml")
    origin = outcome.provenance
    if digest(scene) != origin.scene_digest:
        changed = "was changed after the run, or a file that it names: run it again to sign it."
        raise ResultError(f"{folder / 'scene.toml'}: {changed}")
    case = Case(scene)
    drawing = make_directory(folder / "figures") / "projectile.svg"
    draw_projectile(case, drawing, NARROW)
    criterion, box = verdict_of(folder, scene)
    spread = friction_spread(scene, origin.fidelity)
    numbers, unknown = _numbers(outcome, scene, spread)
    limits = outcome.validity.limitations
    said = (*errors_said(outcome, scene.accuracy.target_of), *floor_said(outcome), *heat_said(outcome))
    known = not isinstance(outcome.half_widths, Unknown)
    uncovered = texts(limits, *(kind for kind in HEAVIEST_FIRST if kind not in WRONG_NUMBERS))
    blank = [(role, "", "", "") for role in ROLES]
    signatures = Table.of(("", "name", "date", "signature"), blank, left=range(4))
    state = "" if outcome.validity.finished else f"The run did not finish: {outcome.validity.stopped_because}"
    body = (
        html.paragraph(state, "notice"),
        html.place(
            "pictures",
            html.join((html.image(drawing, "the projectile in its plane of motion"), _still(folder))),
        ),
        _followed(outcome),
        html.section("Verdict", html.paragraph(criterion), box),
        html.section(
            f"Numbers of the first impact{', with their errors' if known else ''}",
            html.bullets((*texts(limits, *WRONG_NUMBERS), *said)),
            html.table(numbers, compact=True),
            html.paragraph(f"Last column: {spread.said}" if spread.said else "", "note"),
            _dent(outcome),
            html.bullets(unknown),
        ),
        html.section("Inputs and their sources", html.table(inputs(scene))),
        html.section("Not covered", html.bullets((*uncovered, *never_covered(scene)))),
        html.section("Signatures", html.table(signatures)),
    )
    film = html.film_of(folder)
    footer = (
        f"Run {origin.created_utc}, fidelity {origin.fidelity}, {html.versions_text(origin.versions)}. "
        f"Digest of the scene {origin.scene_digest}; of the record {checksum(outcome.to_dict())}. "
        f"Film: {film.name if film else 'none'} in the folder of the run."
    )
    lead = f"Document {document or BLANK}  ·  revision {revision or BLANK}  ·  {origin.created_utc[:10]}"
    inner = html.Markup(f'<div class="sheet">\n{html.join(body).text}\n</div>')
    kind = f"Impact · {origin.scene_id}"
    return write_text(folder / SHEET, html.page(origin.scene_title, kind, lead, footer, [inner]))


def _numbers(outcome: Outcome, scene: Scene, spread: FrictionSpread) -> tuple[Table, list[str]]:
    """Return the numbers with their errors, and why others are not known."""
    named, listed = scene.projectile.named, [(label, KEY_TABLE[name], unit) for label, name, unit in NUMBERS]
    if "barrier-elastoplastic" not in outcome.provenance.effects:  # then no dent stays
        listed = [one for one in listed if one[1].name != "dent_depth_m"]
    listed += [(named(f"{share.label}, of E_0"), share.key, "%") for share in shares("report")]
    rows = [
        (
            label,
            html.signed(outcome.told(key, _scale(unit))),
            unit,
            html.signed(spread.told(key, _scale(unit))),
        )
        for label, key, unit in listed
        if not isinstance(key.of(outcome), Unknown)
    ]
    asked = {label: key.of(outcome) for label, key, _ in listed if key.path[-1] not in IF_ON}
    head = ("quantity", "value", "unit", "what f changes")[: 4 if spread.said else 3]
    return Table.of(head, [row[: len(head)] for row in rows], left=(0, 2, 3)), why_unknown(asked)


def _still(folder: Path) -> html.Markup:
    """Return the frame of the film at the greatest force, nothing where none can be drawn."""
    if not (folder / FIELDS).is_file():
        return html.Markup("")
    from fem_impact.films.film import context, render
    from fem_impact.films.movement import Span

    _, _, (times, force), _ = context(folder)
    at = float(times[force.argmax()]) if len(times) else 0.0
    try:
        still = render(folder, folder / "figures" / "still.png", Span(at, frames=1), size=(800, 560)).path
    except MissingLibraryError:
        return html.Markup("")
    return html.image(still / "frame_0000.png", "the body when the force is greatest")


def _followed(outcome: Outcome) -> html.Markup:
    """Return the end, the hardest and the certain strikes of a body that is followed, nothing of others."""
    strikes = outcome.strikes
    if isinstance(strikes.each, Unknown):
        return html.Markup("")
    return html.section(
        "From the first strike to the last",
        html.bullets(told(strikes)),
        html.table(strikes_table(strikes, or_none(strikes.certain) or SHOWN), compact=True),
    )


def _scale(unit: str) -> float:
    return {"%": 100.0, "mm": 1e3}.get(unit, 1.0)


def _dent(outcome: Outcome) -> html.Markup:
    """Return how deep and wide the places of contact are, nothing where that is not known."""
    sites = or_none(outcome.contact.sites) or ()
    cell = or_none(outcome.cost.tip_size)
    if not sites or cell is None:
        return html.Markup("")
    depth, width = max(site.depth for site in sites), max(site.width for site in sites)
    dent = f"; the barrier is pressed in by at most {plain(1e6 * depth, 2)} µm" if depth else ""
    return html.paragraph(
        f"Widest place of contact {1e3 * width:.2g} mm, known to about a cell, {1e3 * cell:.2g} mm{dent}."
    )
