"""From a table of a material's values, shipped or stated in a scene, to a checked `Material`."""

from collections.abc import Iterable
from typing import Any

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.material import FLOWS, RATES, Flow, Material, Rate, SkinSpec, TableFlow
from fem_impact.scene.tables import Table, check_keys, needed, numbers_of, values_of, within
from fem_impact.scene.units import parse_number, parse_quantity

NO_VALUES = ("law", "family")


def material_of(name: Any, table: Table, others: Iterable[str] = ()) -> Material:
    """Return the material of a table of values; ``others`` are keys that hold none.

    Raises
    ------
    SceneError
        A key is unknown, a value is missing or refused, or values contradict each other.
    """
    named = ("law", "rate", "flow", "skin", "family", *others)
    numbers = numbers_of(table, fields.MATERIAL, (*named, "source", "sources"))
    stated: dict[str, Any] = {
        f.key: f.checked(numbers[f.key]) for f in fields.MATERIAL if numbers[f.key] is not None
    }
    stated |= {key: table[key] for key in ("law", "family") if key in table}
    for key, read in (("rate", _rate), ("flow", _flow), ("skin", _skin)):
        if key in table:
            stated[key] = within(table, key, read)
    if isinstance(stated.get("flow"), TableFlow):
        stated.setdefault("yield_stress", stated["flow"].points[0][1])
    return Material(name=name, **stated, sources=_sources(table, [*stated, *others]))


def _sources(table: Table, stated: list[str]) -> tuple[tuple[str, str], ...]:
    """Return the source of each value: that of ``sources``, else ``source``; some have none."""

    def read(given: Table) -> Table:
        check_keys(given, stated)
        return given

    given = within(table, "sources", read, {})
    every = {key: table["source"] for key in stated if "source" in table and key not in ("name", *NO_VALUES)}
    found = every | dict(given)
    for text in found.values():
        fields.check_text(text, "source", 200)
    return tuple(sorted(found.items()))


def _rate(table: Table) -> Rate:
    law = fields.check_choice(needed(table, "law"), tuple(RATES), "law")
    return RATES[law](**numbers_of(table, fields.RATES[law], ("law",)))


def _skin(table: Table) -> SkinSpec:
    return SkinSpec(**values_of(table, fields.SKIN, ("shape",)))


def _flow(table: Table) -> Flow:
    law = fields.check_choice(needed(table, "law"), tuple(FLOWS), "law")
    if law != TableFlow.law:
        return FLOWS[law](**numbers_of(table, fields.FLOWS[law], ("law",)))
    check_keys(table, ("law", "points"))
    return TableFlow(_points(needed(table, "points", _EXAMPLE)))


_EXAMPLE = '[[0, "350 MPa"], [0.02, "360 MPa"], [0.15, "480 MPa"]], plastic strain and true stress'


def _points(rows: Any) -> tuple[tuple[float, float], ...]:
    if not isinstance(rows, (list, tuple)) or not all(
        isinstance(row, (list, tuple)) and len(row) == 2 for row in rows
    ):
        raise SceneError("must be a list of pairs.", key="points", remedy=f"Write points = {_EXAMPLE}.")
    return tuple(
        (parse_number(strain, f"points[{at}]"), parse_quantity(stress, "stress", f"points[{at}]"))
        for at, (strain, stress) in enumerate(rows, 1)
    )
