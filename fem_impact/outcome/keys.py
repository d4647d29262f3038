"""Keys of the outcome's JSON file: attributes of its groups, with what data/keys.toml states of them.

The table of keys, the checks of a file, its text and the attributes in docstrings are made from these.
"""

import re
import tomllib
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from importlib.resources import files
from operator import attrgetter
from types import UnionType
from typing import Any, Literal, NoReturn, TypeVar, dataclass_transform, get_args, get_origin, get_type_hints

from fem_impact.errors import ResultError, nearest

T = TypeVar("T")
Kind = Literal["number", "count", "flag", "text", "texts", "named texts", "named numbers", "entries"]
KINDS: Mapping[Any, Kind] = {
    float: "number",
    int: "count",
    bool: "flag",
    str: "text",
    tuple[str, ...]: "texts",
    Mapping[str, str]: "named texts",
    Mapping[str, float]: "named numbers",
}
"""Kind of a value by the annotation of its field."""
STATED: Mapping[str, Mapping[str, Mapping[str, Any]]] = tomllib.loads(
    files("fem_impact.outcome").joinpath("data/keys.toml").read_text(encoding="utf-8")
)
"""What is stated of every attribute, by group."""


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that a run does not give.

    It cannot be computed with: test for it, or call `known`. In JSON it is null and an entry in ``reasons``.

    Parameters
    ----------
    reason : str
        The sentence that says why.

    Examples
    --------
    >>> known(Unknown("no contact took place"))
    Traceback (most recent call last):
    ...
    fem_impact.errors.ResultError: Not known: no contact took place.
    """

    reason: str

    def __bool__(self) -> NoReturn:
        raise self.error()

    def error(self) -> ResultError:
        """Return the error that is raised where a value is required."""
        return ResultError(f"Not known: {self.reason.rstrip('.')}.")


Num = float | Unknown


def known(value: T | Unknown) -> T:
    """Return a value, or raise ResultError with the reason why it is not known.

    Examples
    --------
    >>> known(0.57), or_none(Unknown("a rigid impact takes no time."))
    (0.57, None)
    """
    if isinstance(value, Unknown):
        raise value.error()
    return value


def or_none(value: T | Unknown) -> T | None:
    """Return a value, None where it is not known: for tables and JSON."""
    return None if isinstance(value, Unknown) else value


@dataclass(frozen=True, slots=True, eq=False)
class Key:
    """One key of the record, equal to itself alone: records are checked by the keys, often.

    Parameters
    ----------
    name : str
        The key in the JSON file.
    kind : str
        Kind of its value; a count is a whole number, zero or more.
    unit : str
        SI unit; ``-`` for a pure number and the empty string where a unit makes no sense.
    meaning : str
        One sentence for the reader of the file.
    nullable : bool
        Whether the value may be unknown: ``null``, and ``reasons`` says why.
    banded : bool
        Whether two meshes give it a limit and a band.
    path : tuple of str
        Names of the attributes from the outcome down to the value.
    entries : tuple of Key
        Keys of each entry, where the value is a list of entries.
    entry : type
        Class of such an entry.
    of : callable
        Returns the value in an outcome, or in an entry.
    choices : tuple of str
        The words that a text may be; empty where it is free.
    """

    name: str
    kind: Kind
    unit: str
    meaning: str
    nullable: bool = False
    banded: bool = False
    path: tuple[str, ...] = ()
    entries: "tuple[Key, ...]" = ()
    entry: type = object
    choices: tuple[str, ...] = ()
    of: Callable[[object], Any] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "of", attrgetter(".".join(self.path)) if self.path else None)


@dataclass_transform(frozen_default=True, kw_only_default=True)
def group(cls: type[T]) -> type[T]:
    """Make a frozen dataclass whose docstring names unit and meaning of every field."""
    frozen = dataclass(frozen=True, slots=True, kw_only=True, repr=False)(cls)
    frozen.__repr__ = _group_repr  # type: ignore[method-assign]
    lines = [f"{key.path[-1]} : {key.unit or key.kind}\n    {key.meaning}" for key in _own_keys(frozen)]
    frozen.__doc__ = "\n".join([f"{cls.__doc__}\n", "Attributes", "----------", *lines])
    return frozen


def unknown(cls: type[T], reason: str) -> T:
    """Return a group whose every value is unknown for the same reason; `dataclasses.replace` sets others."""
    return cls(**{one.name: Unknown(reason) for one in fields(cls)})  # type: ignore[arg-type]


def keys_of(cls: type, path: tuple[str, ...] = (), name: str = "", meaning: str = "") -> Iterator[Key]:
    """Yield the keys of a group and of the groups in it."""
    hints, stated = get_type_hints(cls), STATED.get(cls.__name__, {})
    for one in fields(cls):
        place = (*path, one.name)
        if is_dataclass(hints[one.name]):
            said = stated.get(one.name, {})
            yield from keys_of(hints[one.name], place, said.get("part", ""), said.get("meaning", ""))
        else:
            yield _key(stated[one.name], hints[one.name], place, name, meaning)


def _own_keys(cls: type) -> Iterator[Key]:
    return (key for key in keys_of(cls, meaning="these arms") if len(key.path) == 1)


def _key(
    stated: Mapping[str, Any], hint: Any, path: tuple[str, ...], group_name: str, group_meaning: str
) -> Key:
    options = get_args(hint) if isinstance(hint, UnionType) else (hint,)
    choices = get_args(options[0]) if get_origin(options[0]) is Literal else ()
    entry = object if choices else next(iter(get_args(options[0])), object)
    entries = tuple(keys_of(entry)) if is_dataclass(entry) else ()
    kind = "text" if choices else "entries" if entries else KINDS[options[0]]
    return Key(
        stated.get("key", path[-1]).replace("{}", group_name),
        kind,
        stated.get("unit", ""),
        stated["meaning"].replace("{}", group_meaning),
        nullable=len(options) > 1,
        banded=stated.get("banded", False),
        path=path,
        entries=entries,
        entry=entry,
        choices=choices,
    )


UNIT = re.compile(r"(?<=\w\w)_(over_E_0|(rad|m)_per_s|W_per_m2|MB|kg|rad|m[23]?|[JKNWs])$")
"""End of a key's name that states its unit."""


def nearest_key(name: str, keys: Collection[Key], otherwise: str) -> str:
    """Return a remedy that proposes the nearest key, ``otherwise`` where none is near; units are left out.

    A key is known by the name of its attribute as well; where several share it, all are proposed.
    """
    named = {key.name: [key.name] for key in keys}
    called: dict[str, list[str]] = {}
    for key in keys:
        called.setdefault(key.path[-1], []).append(key.name)
    known = {**called, **named}
    meant = name if name in called else nearest(name, known, lambda text: UNIT.sub("", text).lower())
    return f"Did you mean {' or '.join(known[meant])}?" if meant else otherwise


def why_unknown(listed: Mapping[str, Any]) -> list[str]:
    """Return a sentence for each reason why some of the labelled values are not known."""
    named: dict[str, list[str]] = {}
    for label, value in listed.items():
        if isinstance(value, Unknown):
            named.setdefault(value.reason, []).append(label)
    return [f"not known ({'; '.join(labels)}): {reason}" for reason, labels in named.items()]


def _group_repr(self: Any) -> str:
    """Return the ``repr`` of a group: values with units, then the names of the unknown ones."""
    values = {one.name: getattr(self, one.name) for one in fields(self)}
    units = {
        key.path[-1]: f" {key.unit}" if key.unit not in ("", "-") else "" for key in _own_keys(type(self))
    }
    parts = [
        f"{name}={_text(v)}{units.get(name, '')}" for name, v in values.items() if not isinstance(v, Unknown)
    ]
    missing = [name for name, value in values.items() if isinstance(value, Unknown)]
    parts += [f"not known: {', '.join(missing)}"] if missing else []
    return f"{type(self).__name__}({', '.join(parts)})"


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    return f"{len(value)} entries" if isinstance(value, tuple | Mapping) else repr(value)
