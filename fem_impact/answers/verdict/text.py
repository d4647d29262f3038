"""Transfers of measured tests and coefficients as text for the terminal."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped

Document = Mapping[str, Any]
SPANS = (("e", 1.0, 2), ("d_c_m", 1e3, 1))
"""Quantities of the searched range: key, factor from SI, decimals."""

LABELS = {
    "total": "total loss",
    "E_lt": "tangential E_lt",
    "E_ln": "normal E_ln",
    "E_r": "kept as rigid motion",
}
"""Label of each share."""


def transfer_text(document: Document) -> str:
    """Return the document of `transfer` as text, limitations before the results."""
    c, h, u, s = (document[name] for name in ("case", "friction_heat", "not_attributed", "slenderness"))
    sizes = f"{1e3 * c['length_m']:g} mm x {1e3 * c['diameter_m']:g} mm steel rod, tip {c['tip']}"
    angle = math.degrees(c["angle_rad"])
    drop = f"dropped {c['height_m']:g} m on a {c['surface']} plate at {angle:g} degrees"
    speed = math.hypot(c["v_n_m_per_s"], c["v_t_m_per_s"])
    lines = wrapped(f"{sizes}, {drop}")
    lines += [f"{c['mass_kg']:.3f} kg at {speed:.2f} m/s: E_0 = {c['E_0_J']:.3g} J", ""]
    told = [f"{one['kind']}: {one['text']}" for one in document["limitations"]]
    lines += [line for one in told or ["Inside what was measured."] for line in wrapped(one)]
    lines += [*_losses(document), *_worst(document), ""]
    bound = f"{h['upper_bound_J']:.3g} J ({100 * h['upper_bound_over_E_0']:.1f} % of E_0)"
    lines += [f"Friction heat: at most {bound}, assuming"]
    lines += [line for sentence in h["assumptions"] for line in wrapped(f"- {sentence}", "  ")]
    closer = f"{h['rigid_rod_J']:.3g} J ({100 * h['rigid_rod_over_E_0']:.1f} %)"
    lines += [*wrapped(f"Closer bound: {closer} for {h['rigid_rod_assumption']}.", "  "), ""]
    share = f"{100 * u['mean']:.0f} % ({100 * u['low']:.0f} to {100 * u['high']:.0f})"
    lines += [*wrapped(f"Not attributed: {share} {u['sentence']}"), ""]
    gamma = f"gamma = {s['gamma_per_m0_3815']:.1f} m^-0.3815 ({s['gamma_per_mm0_3815']:.2f} mm^-0.3815)"
    limit = f"limit {s['limit_per_m0_3815']:.2f} ({s['limit_per_mm0_3815']:.3f})"
    lines += wrapped(f"Slenderness: {gamma}, {limit}: {s['verdict']}. {s['meaning'].capitalize()}.")
    return "\n".join(lines) + "\n"


def _losses(d: Document) -> Iterator[str]:
    b, energy = d["basis"], d["case"]["E_0_J"]
    yield ""
    sets = ", ".join(f"{name} ({100 * w:.0f} %)" for name, w in b["weights"].items())
    yield from wrapped(
        f"Losses of the first impact, % of E_0, carried over from the {b['tests']} tests of {sets}"
    )
    head = ("", "mean", "95 % of impacts", "mean, J", f"all {b['all_tests']} of the surface")
    rows = []
    for name, label in LABELS.items():
        s = {key: 100 * share for key, share in d["losses"][name].items()}
        spread, of_all = f"{s['low']:.0f} to {s['high']:.0f}", f"{s['all_low']:.0f} to {s['all_high']:.0f}"
        rows.append((label, f"{s['mean']:.1f}", spread, f"{d['losses'][name]['mean'] * energy:.3g}", of_all))
    yield Table.of(head, rows).terminal(indent="  ")


def _worst(d: Document) -> Iterator[str]:
    w, r = d["worst_case"], d["range"]
    yield ""
    e, d_c = (f"{scale * r[key][0]:.{n}f} to {scale * r[key][1]:.{n}f}" for key, scale, n in SPANS)
    yield f"Worst case for any impulse ratio up to the critical one, e from {e},"
    yield f"  arm d_c of the impulse from {d_c} mm"
    if not r["measured"]:
        yield "  (every restitution, because the case lies outside what was measured)"
    if w["reason"]:
        yield from wrapped(w["reason"], "  ")
        return
    for name, label in (("tangential", "tangential loss (for ignition)"), ("total", "total loss")):
        x = w[name]
        yield (
            f"  {label:<32}{100 * x['over_E_0']:5.1f} % = {x['J']:.3g} J, at mu = {x['mu']:.2f}, e = "
            f"{x['e']:.2f}"
        )
    yield from wrapped(
        f"The critical ratio is {d['mu_c']['mean']:.2f} here; it is no upper bound of mu, since a tip "
        "that slides back exceeds it by about 20 %.",
        "  ",
    )


def own_text(document: Document) -> str:
    """Return the document of `own_coefficients` as text."""
    rod, arms, centre = (document[name] for name in ("rod", "arms", "impulse_centre"))
    size = f"{1e3 * rod['length_m']:g} mm x {1e3 * rod['diameter_m']:g} mm, tip {rod['tip']}"
    body = f"{rod['mass_kg']:.4f} kg, k2 = {1e6 * rod['k_squared_m2']:.1f} mm2"
    lines = [f"{document['tests']} tests of a projectile {size}: {body}"]
    point = f"d_c = {1e3 * arms['d_c_m']:.2f} mm, d_d = {1e3 * arms['d_d_m']:.2f} mm ({arms['source']})"
    lines += [*wrapped(f"contact point: {point}"), ""]
    coefficients = document["coefficients"].items()
    rows = [(n, _number(c["value"]), _span(c["first_order"]), _span(c["bootstrap"])) for n, c in coefficients]
    lines += wrapped(
        "Coefficients of the mean motion, 95 % intervals (velocity scatter, contact point 0.5 mm, "
        "tracking 2 %)"
    )
    lines += [Table.of(("", "value", "first order", "bootstrap"), rows).terminal(indent="  "), ""]
    parts = {name: c["first_order"]["parts"] for name, c in coefficients}
    sources = tuple(dict.fromkeys(source for part in parts.values() for source in part))
    by_source = [(name, *(_number(part[s]) for s in sources)) for name, part in parts.items()]
    lines += ["Standard uncertainty by source", Table.of(("", *sources), by_source).terminal(indent="  ")]
    scatter = [
        f"{name.replace('_over_E_0', '/E_0')} {s['mean']:.3f} ({s['sd']:.3f})"
        for name, s in document["scatter"].items()
    ]
    lines += ["", "Scatter of single tests, mean (SD)", *wrapped(", ".join(scatter), "  ", ""), ""]
    lines += wrapped(
        f"Centre of impulse (e_m = -1): d_c = {1e3 * centre['d_c_m']:.2f} mm, "
        f"{1e3 * centre['from_contact_m']:+.2f} mm from the contact point"
    )
    lines += [f"Critical impulse ratio: {_number(document['mu_c'])}"]
    lines += [line for note in document["notes"] for line in wrapped(f"note: {note}")]
    return "\n".join(lines) + "\n"


def _span(estimate: Mapping[str, Any]) -> str:
    return f"{_number(estimate['low'])} to {_number(estimate['high'])}"


def _number(value: float | None) -> str:
    return "not finite" if value is None else f"{value:.3f}"
