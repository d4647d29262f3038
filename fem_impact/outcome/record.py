"""The record itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fem_impact.errors import ResultError
from fem_impact.outcome.keys import KEYS, SCHEMA_VERSION
from fem_impact.outcome.text import from_text, plain, to_text
from fem_impact.outcome.validate import check_record
from fem_impact.output import read_text, write_text

__all__ = ["Outcome"]


@dataclass(frozen=True, slots=True, init=False, repr=False)
class Outcome(Mapping[str, Any]):
    """One run's result, read like a mapping whose keys are those of ``KEYS``.

    Parameters
    ----------
    values : mapping
        Key to value. ``schema_version`` may be left out; a nullable key that is left out counts as null.
    reasons : mapping, optional
        For each null key the sentence that says why; merged with ``values["reasons"]``.
    source : str
        Named in complaints.

    Raises
    ------
    ResultError
        A key is unknown, missing, of the wrong kind, not finite, or null without a reason.
    """

    values_: Mapping[str, Any]

    def __init__(
        self, values: Mapping[str, Any], reasons: Mapping[str, str] | None = None, source: str = "outcome"
    ) -> None:
        filled = _filled(plain(values), plain(reasons or {}))
        check_record(filled, source)
        object.__setattr__(self, "values_", MappingProxyType(filled))

    def __getitem__(self, name: str) -> Any:
        return self.values_[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.values_)

    def __len__(self) -> int:
        return len(self.values_)

    def __repr__(self) -> str:
        return f"Outcome({self['scene_id']!r}, fidelity={self['fidelity']!r})"

    def reason(self, name: str) -> str | None:
        """Return why ``name`` is null, or None when it is known."""
        reason: str | None = self["reasons"].get(name)
        return reason

    def replace(self, reasons: Mapping[str, str] | None = None, **values: Any) -> Outcome:
        """Return a copy with some values changed; reasons of keys that are now known go away."""
        changed = {**self.values_, **values}
        merged = {**self["reasons"], **(reasons or {})}
        changed["reasons"] = {name: why for name, why in merged.items() if changed.get(name) is None}
        return Outcome(changed)

    def to_dict(self) -> dict[str, Any]:
        """Return a plain, independent copy, as a study stores it in its rows."""
        copied: dict[str, Any] = plain(self.values_)
        return copied

    def to_json(self) -> str:
        """Return the text that ``write`` writes and ``--json`` prints."""
        return to_text(self.values_)

    def write(self, path: str | Path) -> Path:
        """Write the record as one atomic step; return the path.

        Raises
        ------
        OutputPathError
            The place cannot be written or the disk is full; nothing half-written is left.
        """
        return write_text(path, self.to_json())

    @classmethod
    def read(cls, path: str | Path) -> Outcome:
        """Read a record back, refusing one that is damaged, edited or of another version.

        Raises
        ------
        ResultError
            With file, key and value.
        """
        return cls.from_json(read_text(path), source=str(path))

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        """Travel between processes as text."""
        return Outcome.from_json, (self.to_json(),)

    @classmethod
    def from_json(cls, text: str, source: str = "JSON text") -> Outcome:
        """Read a record from text, as strictly as from a file."""
        values = from_text(text, source)
        missing = [key.name for key in KEYS if key.name not in values]
        if missing:
            raise ResultError(f'{source}: key "{missing[0]}" is missing ({len(missing)} in all).')
        return cls(values, source=source)


def _filled(values: dict[str, Any], reasons: dict[str, str]) -> dict[str, Any]:
    blank: dict[str, Any] = {key.name: None for key in KEYS if key.nullable}
    given = values.get("reasons", {})
    merged = {**given, **reasons} if isinstance(given, dict) else given
    joined = {"schema_version": SCHEMA_VERSION, **blank, **values, "reasons": merged}
    order = [key.name for key in KEYS if key.name in joined]
    return {name: joined[name] for name in (*order, *(name for name in joined if name not in order))}
