"""Tables of a scene as stated: their numbers, inner tables and keys, with complaints that name the place."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from fem_impact.errors import SceneError, did_you_mean
from fem_impact.scene import fields, impact
from fem_impact.scene.fields import Parameter
from fem_impact.scene.units import parse_number, parse_quantity

T = TypeVar("T")
Table = Mapping[str, Any]
UNKNOWN_KEY = "is not a known key."
OTHER_NAMES = {
    "density": "rho",
    "modulus": "E",
    "young": "E",
    "poisson": "nu",
    "yield_strength": "yield_stress",
    "source": "source",
}
"""Keys by other words for the same, or by a word of a longer one."""
_RUBBER = (
    "Of a rubber by Mooney and Rivlin give E = 6 (C10 + C01), its stiffness at small strains, and nu = 0.49."
)
_JOHNSON_COOK = (
    'Johnson and Cook\'s A is yield_stress; B and n stand in flow = { law = "johnson-cook", ... }, C in '
    'rate = { law = "johnson-cook", ... }.'
)
_DIAMETER = "Give diameter, twice the radius."
INSTEAD = {
    "rho": dict.fromkeys(("C10", "C01"), _RUBBER) | dict.fromkeys(("A", "B", "C", "n"), _JOHNSON_COOK),
    "diameter": {"radius": _DIAMETER, "radius_m": _DIAMETER},
}
"""What to write for keys of other programs, by a key of the table in which they stand."""
PLACES = {
    f.key: place
    for place, wanted in (
        ("a material: projectile.material or barrier.material", fields.MATERIAL),
        ("[surface]", fields.SURFACE),
        ("[impact]", impact.NUMBERS),
        ("[accuracy]", fields.ACCURACY),
        ("[save]", fields.SAVE),
        ("[strikes]", fields.STRIKES),
    )
    for f in wanted
}
"""Where a key belongs that is not known where it stands."""


def numbers_of(
    table: Table, wanted: tuple[Parameter, ...], others: Iterable[str] = (), instead: Table | None = None
) -> dict[str, Any]:
    """Read the numbers of one table: each with its unit, as its SI key, or left to its default.

    ``others`` are keys of the table that hold no number; ``instead`` are defaults that replace the tables'.
    """
    keys = [f.key for f in wanted]
    check_keys(table, [*others, *keys, *(f.si_key for f in wanted if f.si_key)], shown=[*others, *keys])
    defaults = {f.key: (instead or {}).get(f.key, f.default) for f in wanted}
    lacking = [
        f for f in wanted if not {f.key, f.si_key} & {*table} and defaults[f.key] is None and not f.derived
    ]
    if lacking:
        first, *more = lacking
        so_are = f", and so {'is' if len(more) == 1 else 'are'} " if more else ""
        told = f"the {first.meaning}{so_are}{', '.join(f'{f.key} ({f.meaning})' for f in more)}"
        how = "with its unit" if first.dimension else "as a bare number"
        remedy = f"Give it {how}; `fem-impact scenes` lists complete scenes."
        raise SceneError(f"is missing: {told}.", key=first.key, remedy=remedy)
    return {f.key: _number(table, f, defaults[f.key]) for f in wanted}


def values_of(
    table: Table, wanted: tuple[Parameter, ...], words: Iterable[str], others: Iterable[str] = ()
) -> dict[str, Any]:
    """Read the numbers of one table, as `numbers_of` does, and those of its ``words`` that stand in it."""
    stated = {key: table[key] for key in words if key in table}
    return numbers_of(table, wanted, (*others, *words)) | stated


def _number(table: Table, field: Parameter, default: Any) -> Any:
    if field.si_key and field.si_key in table:
        if field.key in table:
            raise SceneError(
                f"is given twice, here and as {field.si_key}.", key=field.key, remedy="Keep one."
            )
        return parse_number(table[field.si_key], field.si_key)
    if field.key not in table:
        return default
    value = table[field.key]
    if field.dimension:
        return parse_quantity(value, field.dimension, field.key, field.si_key)
    parse_number(value, field.key)
    return value


def within(data: Table, key: str, read: Callable[[Any], T], default: Table | None = None) -> T:
    """Read one sub-table and place its complaints below its key."""
    table = data.get(key, default) if default is not None else needed(data, key)
    if not isinstance(table, Mapping) and not (key in ("material", "accuracy") and isinstance(table, str)):
        text = {"accuracy": ' or write accuracy = "5 %"', "material": " or name one"}.get(key, "")
        raise SceneError("must be a table.", key=key, value=table, remedy=f"Open it with [{key}]{text}.")
    try:
        return read(table)
    except SceneError as error:
        raise _under(error, table, key) from None


def _under(error: SceneError, table: Any, place: str) -> SceneError:
    """Return a table's complaint below its place, with the value in the unit in which it was written."""
    stated = table.get(error.key) if isinstance(table, Mapping) else None
    if isinstance(error.value, fields.Shown) and isinstance(stated, str):
        unit = stated.split()[-1]
        if unit != error.value.text.split()[-1]:  # that of its bounds
            error.value = fields.Shown(stated)
    return error.under(place)


def listed(tables: Any, key: str, read: Callable[[Table], T], example: str) -> tuple[T, ...]:
    """Read a list of tables, each by ``read``; messages name its number, from 1."""
    if not isinstance(tables, list) or not tables or not all(isinstance(table, Mapping) for table in tables):
        raise SceneError(f"must be a list of {key}.", key=key, remedy=f"Write {key} = [{example}, ...].")

    def one(number: int, table: Table) -> T:
        try:
            return read(table)
        except SceneError as error:
            raise _under(error, table, f"{key}[{number}]") from None

    return tuple(one(number, table) for number, table in enumerate(tables, 1))


def needed(table: Table, key: str, example: str = "") -> Any:
    """Return the value of a key that must be there; ``example`` is one such as could be written."""
    if key not in table:
        lists = "`fem-impact scenes` lists complete scenes to start from."
        raise SceneError("is missing.", key=key, remedy=f"Write {key} = {example}." if example else lists)
    return table[key]


def check_keys(table: Table, known: Iterable[str], shown: Iterable[str] = ()) -> None:
    """Refuse a key that is not known, and name the nearest, or those ``shown``."""
    for key in table:
        if key not in known:
            near = next(
                (name for word, name in OTHER_NAMES.items() if word in str(key) and name in known), str(key)
            )
            told = next(
                (words[str(key)] for of, words in INSTEAD.items() if of in known and key in words), ""
            )
            remedy = told or (
                f"It is a key of {PLACES[near]}."
                if near in PLACES and near not in known
                else did_you_mean(near, known, f"Known here: {', '.join(shown or known)}.")
            )
            raise SceneError(UNKNOWN_KEY, key=str(key), remedy=remedy)
