"""What commands print on standard output: one JSON document, or a short readable summary."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fem_impact.wrap import wrapped

__all__ = ["print_json", "print_outcome", "print_table"]

_PAPER = ("restitution e (paper's arms)", "e_paper", "")
_EDGE = ("restitution e (tip's arms)", "e_edge", "")
_MOTION = (
    ("impulse ratio mu", "mu", ""),
    ("V_n after", "V_n_m_per_s", "m/s"),
    ("V_t after", "V_t_m_per_s", "m/s"),
    ("Omega after", "Omega_rad_per_s", "rad/s"),
)
_SHARES = (
    ("retained as rigid motion", "E_r_over_E_0"),
    ("vibration of the rod", "E_vib_over_E_0"),
    ("friction", "W_friction_over_E_0"),
    ("plastic work, rod", "E_plastic_rod_over_E_0"),
    ("plastic work, barrier", "E_plastic_barrier_over_E_0"),
    ("locked in, rod", "E_locked_rod_over_E_0"),
    ("locked in, barrier", "E_locked_barrier_over_E_0"),
    ("radiated into the barrier", "W_radiated_over_E_0"),
    ("contact closing", "W_closing_over_E_0"),
    ("residual of the ledger", "residual_over_E_0"),
)
_IF_ON = (("material damping", "W_damping_over_E_0"), ("added by gravity", "W_gravity_over_E_0"))
_SKIN = ("friction + plate's top 0.1 mm", "W_skin_over_E_0")


def print_json(document: Any) -> None:
    """Print one JSON document; NaN and infinity are never written."""
    sys.stdout.write(json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False) + "\n")


def print_outcome(record: Mapping[str, Any], out: Path) -> None:
    """Print the motion after impact, where the energy went, and every warning."""
    lines = [f"{record['scene_id']}: {record['scene_title']}", ""]
    # only a measured set has arms of the paper
    restitution = _EDGE if record["e_paper"] is None else _PAPER
    lines += [_motion(record, *row) for row in (restitution, *_MOTION)]
    lines += ["", f"of the initial energy, E_0 = {_value(record, 'E_0_J')} J:"]
    lines += [_share(record, words, key) for words, key in _SHARES]
    lines += [_share(record, words, key) for words, key in _IF_ON if record[key] is not None]
    lines += ["", _share(record, *_SKIN)]
    lines += [_vibration_note(record)] if record["E_vib_below_floor"] else []
    lines += _accuracy(record)
    lines += _unknown(record)
    lines += ["", *(line for sentence in _sentences(record) for line in wrapped(f"note: {sentence}"))]
    sys.stdout.write("\n".join([*lines, f"results: {out}"]) + "\n")


def _accuracy(record: Mapping[str, Any]) -> list[str]:
    """Return expected and achieved error and time of a run that a target chose."""
    if record["accuracy_target"] is None:
        return []
    lines = ["", f"asked for {_percent(record, 'accuracy_target')}: {record['accuracy_setting']}"]
    for word in ("expected", "achieved"):
        error, wall = _percent(record, f"{word}_error"), _value(record, f"{word}_wall_s")
        lines += [f"  {word} error of e and E_vib {error}, time {wall} s"]
    if record["extrapolated"]:
        e, vibration = (record["extrapolated"][key] for key in ("e_edge", "E_vib_over_E_0"))
        lines += [f"  all runs together: e (tip's arms) {_number(e)}, E_vib/E_0 {_number(vibration)}"]
    return lines


def _percent(record: Mapping[str, Any], key: str) -> str:
    return f"{100 * record[key]:.2g} %" if record[key] is not None else f"not known: {_reason(record, key)}"


def _sentences(record: Mapping[str, Any]) -> list[str]:
    return [*record["assumptions"], *record["validity"], *record["warnings"]]


def print_table(rows: list[Mapping[str, Any]], columns: tuple[str, ...]) -> None:
    """Print rows as a table with aligned columns."""
    texts = [list(columns), *([str(row[column]) for column in columns] for row in rows)]
    widths = [max(len(text[i]) for text in texts) for i in range(len(columns))]
    for text in texts:
        line = "  ".join(cell.ljust(width) for cell, width in zip(text, widths, strict=True))
        sys.stdout.write(line.rstrip() + "\n")


def _motion(record: Mapping[str, Any], words: str, key: str, unit: str) -> str:
    band = (record["bands"] or {}).get(key)
    spread = f" +- {_number(band)}" if band is not None else ""
    told = f"{spread} {unit}" if record[key] is not None else ""
    return f"  {words:<30} {_value(record, key)}{told}".rstrip()


def _share(record: Mapping[str, Any], words: str, key: str) -> str:
    share = record[key]
    text = f"{100 * share:9.3f} %" if share is not None else f"{'not known':>11}"
    return f"  {words:<30} {text.replace('-0.000', ' 0.000')}"


def _unknown(record: Mapping[str, Any]) -> list[str]:
    """Return why shares are not known, each reason once."""
    named: dict[str, list[str]] = {}
    for words, key in (*_SHARES, _SKIN):
        if record[key] is None:
            named.setdefault(_reason(record, key), []).append(words)
    told = [wrapped(f"not known ({'; '.join(words)}): {reason}", "  ") for reason, words in named.items()]
    return [line for lines in ([""], *told) for line in lines] if told else []


def _vibration_note(record: Mapping[str, Any]) -> str:
    return f"  vibration is below its numerical floor (fraction {_value(record, 'E_vib_floor_over_E_0')})"


def _value(record: Mapping[str, Any], key: str) -> str:
    return _number(record[key]) if record[key] is not None else f"not known: {_reason(record, key)}"


def _reason(record: Mapping[str, Any], key: str) -> str:
    return str(record["reasons"].get(key, "no reason given"))


def _number(value: float) -> str:
    return f"{value:.4g}"
