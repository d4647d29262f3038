"""Outcomes of runs that were never computed."""

from fem_impact.outcome.check import SCHEMA_VERSION
from fem_impact.outcome.record import KEYS, Outcome

PLAIN = {"text": "text", "texts": [], "flag": True, "count": 3, "number": 0.25, "named texts": {}}


def values(**changed):
    """Every key of a complete record: a plain value of its kind, null with a reason where there is none."""
    made = {key.name: PLAIN.get(key.kind) for key in KEYS}
    made |= {
        "schema_version": SCHEMA_VERSION,
        "fidelity": "solid",
        "contacts": [],
        "limitations": [],
    } | changed
    given = changed.get("reasons", {})
    nulls = [name for name, value in made.items() if value is None]
    return made | {"reasons": {name: given.get(name, "not in the test") for name in nulls}}


def outcome(**changed):
    """A complete outcome from flat keys."""
    return Outcome.from_dict(values(**changed))


def altered(before, **changed):
    """The outcome with other values under some flat keys."""
    return outcome(**before.to_dict() | changed)
