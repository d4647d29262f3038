"""The study as Markdown tables, beside the measurement, where the energy went, inputs."""

from __future__ import annotations

from collections.abc import Sequence

from fem_impact.compare import Row
from fem_impact.outcome import Key, Outcome, known, or_none, shares
from fem_impact.study.sensitivity import WORDS

COMPARED = ("e", "mu", "Omega", "E_ln/E_0", "E_lt/E_0", "E_r/E_0")


def summary(
    outcomes: Sequence[Outcome], comparison: list[Row], changed: list[Row], explained: list[Row]
) -> str:
    """Return the tables, with those of the changed inputs if they were computed."""
    tables = [_beside(comparison), _shares(outcomes), *_limits(outcomes)]
    if changed:
        words = "\n".join(f"- `{name}`: {meaning}" for name, meaning in WORDS.items())
        tables += [_changes(changed), _explanations(explained), words]
    return "\n\n".join(tables) + "\n"


def table(head: list[str], body: list[list[str]]) -> str:
    """Return a Markdown table: the first column to the left, the others to the right."""
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *body]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _beside(comparison: list[Row]) -> str:
    cells = {(row["set"], row["quantity"]): _cell(row) for row in comparison if row["quantity"] in COMPARED}
    names = list(dict.fromkeys(row["set"] for row in comparison))
    return table(["set", *COMPARED], [[name, *(cells[name, q] for q in COMPARED)] for name in names])


def _cell(row: Row) -> str:
    """Return model +- band / measured mean +- SD, and a mark: bold inside, ? undecided, plain else."""
    digits = 1 if row["quantity"] == "Omega" else 3
    band = f" ± {row['band']:.{digits}f}" if row["band"] is not None else ""
    model = f"{row['model']:.{digits}f}{band}"
    measured = f"{row['measured_mean']:.{digits}f} ± {row['measured_sd']:.{digits}f}"
    if row["verdict"] == "inside":
        return f"**{model}** / {measured}"
    return f"{model} / {measured}{' ?' if row['verdict'].startswith('undecided') else ''}"


def _shares(outcomes: Sequence[Outcome]) -> str:
    listed = shares("report")
    head = ["set", *(f"{share.label}, %" for share in listed), "residual", "steps", "CPU s"]
    body = [
        [
            o.provenance.scene_id,
            *(_percent(o, share.key) for share in listed),
            f"{o.energy.residual:.0e}",
            f"{known(o.cost.steps)}",
            f"{o.cost.cpu:.0f}",
        ]
        for o in outcomes
    ]
    return table(head, body)


def _limits(outcomes: Sequence[Outcome]) -> list[str]:
    """Return a row a set with two meshes: limits of e and E_vib, how uncertain, what the finer took."""
    head = ["set", "e, limit", "of e, %", "E_vib / E_0, %, limit", "of E_vib, %", "CPU s"]
    body = []
    for o in (o for o in outcomes if or_none(o.validity.mesh_band)):
        limits, bands = known(o.validity.mesh_limit), known(o.validity.mesh_band)
        (e, e_band), (vib, vib_band) = ((limits[k], bands[k]) for k in ("e_edge", "E_vib_over_E_0"))
        of = [f"{100 * band / abs(value):.2g}" for value, band in ((e, e_band), (vib, vib_band))]
        cells = [f"{e:.3f} ± {e_band:.3f}", of[0], f"{100 * vib:.3f} ± {100 * vib_band:.3f}", of[1]]
        body.append([o.provenance.scene_id, *cells, f"{o.cost.cpu:.0f}"])
    return [table(head, body)] if body else []


def _percent(outcome: Outcome, key: Key) -> str:
    value, band = outcome.estimate(key)
    share = or_none(value)
    if share is None:
        return "–"
    digits = 2 if abs(100 * share) < 10 else 1
    return f"{100 * share:.{digits}f}" + (f" ± {100 * band:.{digits}f}" if band is not None else "")


def _changes(changed: list[Row]) -> str:
    """Return a row a set and quantity: its value on the coarser mesh and what each input changes."""
    found: dict[tuple[str, str], dict[str, Row]] = {}
    for row in changed:
        found.setdefault((row["set"], row["quantity"]), {})[row["input"]] = row
    body = [
        [*key, f"{next(iter(of.values()))['base']:.3g}", *(_change(of.get(name)) for name in WORDS)]
        for key, of in found.items()
    ]
    return table(["set", "quantity", "coarser mesh", *WORDS], body)


def _change(row: Row | None) -> str:
    return "" if row is None else f"{row['changed'] - row['base']:+.2g}"


def _explanations(explained: list[Row]) -> str:
    """Return a row a quantity that lies outside: what alone could bring it in, and what cannot."""
    head = ["set", "quantity", "model", "measured", "could explain it", "cannot"]
    body = [
        [
            row["set"],
            row["quantity"],
            f"{row['model']:.3g}",
            f"{row['measured_mean']:.3g}",
            ", ".join(row["could"]) or "none of these",
            ", ".join(f"{name} ({s:+.0%})" for name, s in row["shares"].items() if name not in row["could"]),
        ]
        for row in explained
    ]
    return table(head, body)
