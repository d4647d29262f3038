"""The record of a run, written as flat JSON with a checksum and read back with all checks."""

import json
import platform
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from math import inf
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar, get_type_hints

from fem_impact.errors import UsageError
from fem_impact.files.atomic import read_signed, read_text, signed, write_text
from fem_impact.outcome import groups
from fem_impact.outcome.check import SCHEMA_VERSION, check_record
from fem_impact.outcome.keys import Key, Num, Unknown, keys_of, nearest_key, or_none
from fem_impact.outcome.strikes import Strikes
from fem_impact.plugins import providers
from fem_impact.tables.table import Missing, Table
from fem_impact.tables.text import plain, with_band
from fem_impact.version import __version__

PACKAGES = ("numpy", "scipy", "scikit-fem", "numba")
ROUND_OFF = 1e-9
"""Size below which a number of a run, SI or a share of E_0, is told as 0."""
SIGNED = "E_ln_", "E_lt_", "W_gravity_"
"""How those shares of E_0 with half-widths begin that may be below 0."""
NOT_BELOW_0 = "peak_force_", "dent_", "contact_patch_", "friction_", "flash_rise_", "time_above_"
"""How other numbers with half-widths begin that are sizes."""
_version = cache(metadata.version)  # a file is read each time else


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Outcome:
    """One run's result, the same record for every fidelity.

    A value that a fidelity does not give is `Unknown` with the reason; ``help`` of a group's class names
    unit and meaning of its values. `dataclasses.replace` makes a changed copy.

    Raises
    ------
    ResultError
        A value is of the wrong kind or not finite.

    Examples
    --------
    >>> from fem_impact.run.simulate import simulate
    >>> from fem_impact.scene.shipped import load
    >>> outcome = simulate(load("t5b"), "rigid")
    >>> round(outcome.restitution.edge.e, 2)
    0.31
    >>> outcome.energy.vibration
    Unknown(reason='a rigid body in an impact without duration does not know it')
    """

    provenance: groups.Provenance
    validity: groups.Validity
    motion: groups.RodMotion
    barrier: groups.BarrierMotion
    restitution: groups.Restitution
    energy: groups.Energy
    contact: groups.Contact
    heat: groups.Heat
    strikes: Strikes
    cost: groups.RunCost

    schema_version: ClassVar[int] = SCHEMA_VERSION

    def __post_init__(self) -> None:
        check_record(self.to_dict(), KEYS, "outcome")

    def __repr__(self) -> str:
        names = ("e_edge", "mu", "Omega_rad_per_s", "E_vib_over_E_0")
        e, mu, Omega, vibration = map(self.told, names)
        unit = "" if isinstance(self.motion.Omega, Unknown) else " rad/s"
        return (
            f"Outcome({self.provenance.scene_id!r}, {self.provenance.fidelity}: e={e}, "
            f"mu={mu}, Omega={Omega}{unit}, E_vib/E_0={vibration})"
        )

    def _repr_html_(self) -> str:
        """Return every number of the outcome as the table that a notebook shows."""
        numbers = ((key, key.of(self)) for key in KEYS if key.kind == "number")
        rows = [
            (
                f"`{key.name}`",
                Missing(value.reason) if isinstance(value, Unknown) else self.told(key),
                key.unit,
                key.meaning,
            )
            for key, value in numbers
        ]
        return Table.of(("quantity", "value", "unit", "meaning"), rows, left=(0, 2, 3)).html(repr(self))

    @property
    def reasons(self) -> dict[str, str]:
        """For every key whose value is not known, the sentence that says why."""
        values = ((key.name, key.of(self)) for key in KEYS if key.nullable)
        return {name: value.reason for name, value in values if isinstance(value, Unknown)}

    def estimate(self, key: Key | str) -> tuple[Num, float | None]:
        """Return limit and half-width that meshes give a number, else its value in this run.

        The reduced model has a half-width beside its value, the others None.

        ``key`` is that of the number or its name, such as ``"e_edge"`` (UsageError: there is none).
        """
        key = _key_named(key)
        halves, limits = or_none(self.half_widths) or {}, or_none(self.validity.mesh_limit) or {}
        half = halves.get(key.name)
        return (key.of(self) if half is None else limits.get(key.name, key.of(self))), half

    def ends_of(self, key: Key) -> tuple[float, float]:
        """Return between which ends a number lies: the contact is no colder than before the impact."""
        at, rise = or_none(self.heat.temperature), or_none(self.heat.rise)
        if key.path == ("heat", "temperature") and at is not None and rise is not None:
            return at - rise, inf
        return ends_of(key)

    def band_of(self, key: Key) -> tuple[float, float] | None:
        """Return the ends of the band of a number, None where it has none: none beyond `ends_of` it."""
        value, half = self.estimate(key)
        if half is None or isinstance(value, Unknown):
            return None
        low, high = self.ends_of(key)
        return min(value, max(low, value - half)), max(value, min(high, value + half))

    @property
    def half_widths(self) -> Mapping[str, float] | Unknown:
        """Half-widths by key: of the limits of meshes, of the reduced model about its values."""
        told = self.validity
        return told.model_band if self.provenance.fidelity == "modal" else told.mesh_band

    def told(self, key: Key | str, scale: float = 1.0) -> str:
        """Return a number times ``scale`` as text: with its half-width to the digits that hold.

        One that may have a half-width and has none is told to three digits, and one that is below `ROUND_OFF`
        with it as 0; "not known" stands for `Unknown`.

        Examples
        --------
        >>> from fem_impact.run.simulate import simulate
        >>> from fem_impact.scene.shipped import load
        >>> simulate(load("t5b"), "rigid").told("mu")
        '0.57'
        """
        key = _key_named(key)
        value, band = self.estimate(key)
        if isinstance(value, Unknown):
            return "not known"
        least = ROUND_OFF**3 if key.unit == "m3" else ROUND_OFF  # that of a length, cubed
        if key.banded and abs(value) + (band or 0.0) < least:
            return "0"
        if band is not None:
            return with_band(scale * value, scale * band, *(scale * end for end in self.ends_of(key)))
        return plain(scale * value) if key.banded else plain(scale * value, 4)

    def to_dict(self, keys: Iterable[Key] | None = None) -> dict[str, Any]:
        """Return the flat keys, all unless some are named, with plain JSON values."""
        return {key.name: _plain(key, key.of(self)) for key in (KEYS if keys is None else keys)}

    def to_json(self) -> str:
        """Return the text that ``write`` writes and ``--json`` prints."""
        return json.dumps(signed(self.to_dict()), indent=2, allow_nan=False) + "\n"

    def write(self, path: str | Path) -> Path:
        """Write the record as one atomic step; return the path.

        Raises
        ------
        OutputPathError
            The place cannot be written or the disk is full; nothing half-written is left.
        """
        return write_text(path, self.to_json())

    @classmethod
    def read(cls, path: str | Path) -> "Outcome":
        """Read a record back, refusing one that is damaged, edited or of another version.

        Parameters
        ----------
        path : path
            An ``outcome.json``, or the directory of results in which it stands.

        Raises
        ------
        ResultError
            With file, key and value.
        """
        file = Path(path) / "outcome.json" if Path(path).is_dir() else Path(path)
        return cls.from_json(read_text(file), source=str(file))

    @classmethod
    def from_json(cls, text: str, source: str = "JSON text") -> "Outcome":
        """Read a record from text, as strictly as from a file."""
        return cls.from_dict(read_signed(text, source), source)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any], source: str = "outcome") -> "Outcome":
        """Make a record from its flat keys with plain JSON values.

        Raises
        ------
        ResultError
            A key is unknown, missing, of the wrong kind, not finite, or null without a reason.
        """
        check_record(values, KEYS, source)
        outcome: Outcome = _build(cls, {key.path: _field_value(key, values) for key in KEYS})
        return outcome


KEYS: tuple[Key, ...] = (
    Key("schema_version", "count", "-", "Version of this table of keys.", path=("schema_version",)),
    *keys_of(Outcome),
    Key(
        "reasons",
        "named texts",
        "",
        "For every null key, the sentence that says why it is null.",
        path=("reasons",),
    ),
)
"""Every key of the JSON file."""

KEY_TABLE: Mapping[str, Key] = MappingProxyType({key.name: key for key in KEYS})
"""The keys by name."""


def _key_named(key: Key | str) -> Key:
    """Return the key of a name. Raises UsageError where there is none."""
    if isinstance(key, Key):
        return key
    if key not in KEY_TABLE:
        hint = nearest_key(key, KEYS, "The table of keys in the documentation lists them.")
        raise UsageError("is no key of an outcome.", key="key=", value=key, remedy=hint)
    return KEY_TABLE[key]


def ends_of(key: Key) -> tuple[float, float]:
    """Return between which ends a number lies in every model: 0 and 1 of a share, 0 of a size."""
    share = key.name.endswith("_over_E_0") and not key.name.startswith(SIGNED)
    return (0.0, 1.0) if share else (0.0 if key.name.startswith(NOT_BELOW_0) else -inf, inf)


def utc_now() -> str:
    """Return the present time as ISO 8601 in UTC, to the second."""
    return datetime.now(UTC).replace(microsecond=0).isoformat()


def installed_versions() -> dict[str, str]:
    """Return the versions of Python, of this program and of the packages that shape a result."""
    libraries = {name: _version(name) for name in PACKAGES}
    own = {"fem-impact": __version__}
    return {"python": platform.python_version(), **libraries, **own, **providers()}


def _plain(key: Key, value: Any) -> Any:
    """Return a value as plain JSON; NumPy's scalars are unpacked."""
    if type(value) in (float, str, bool, int):
        return value
    if isinstance(value, Unknown):
        return None
    if key.kind == "entries":
        return [{one.name: _plain(one, one.of(entry)) for one in key.entries} for entry in value]
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, tuple):
        return list(value)
    return value.tolist() if hasattr(value, "tolist") else value


def _field_value(key: Key, values: Mapping[str, Any]) -> Any:
    """Return the value of a field of an outcome from plain JSON values."""
    value = values[key.name]
    if value is None:
        return Unknown(values["reasons"][key.name])
    if key.kind == "entries":
        names = {one.path[-1]: one.name for one in key.entries}
        return tuple(key.entry(**{field: entry[name] for field, name in names.items()}) for entry in value)
    return tuple(value) if key.kind == "texts" else value


def _build(cls: Any, values: Mapping[tuple[str, ...], Any], path: tuple[str, ...] = ()) -> Any:
    """Return an instance of a group and of the groups in it; ``values`` are given by their paths."""
    places = {name: (*path, name) for name in _hints(cls)}
    return cls(
        **{
            name: values[place] if place in values else _build(_hints(cls)[name], values, place)
            for name, place in places.items()
        }
    )


@cache
def _hints(cls: Any) -> Mapping[str, Any]:
    """Return the types of a group's fields."""
    hints = get_type_hints(cls)
    return {one.name: hints[one.name] for one in fields(cls)}
