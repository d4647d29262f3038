"""The one record of a run for every fidelity: typed groups, written as flat JSON in SI units."""

from fem_impact.outcome.check import SCHEMA_VERSION
from fem_impact.outcome.groups import (
    ARMS,
    ArmCoefficients,
    Contact,
    ContactInterval,
    EffectChoice,
    Energy,
    Heat,
    Markers,
    Provenance,
    Restitution,
    RodMotion,
    RunCost,
    Validity,
)
from fem_impact.outcome.keys import Key, Num, Unknown, keys_of, known, markdown_table, or_none, unknown
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome, installed_versions, utc_now
from fem_impact.outcome.shares import SHARES, EnergyShare, shares

__all__ = [
    "ARMS",
    "KEYS",
    "KEY_TABLE",
    "SCHEMA_VERSION",
    "SHARES",
    "ArmCoefficients",
    "Contact",
    "ContactInterval",
    "EffectChoice",
    "Energy",
    "EnergyShare",
    "Heat",
    "Key",
    "Markers",
    "Num",
    "Outcome",
    "Provenance",
    "Restitution",
    "RodMotion",
    "RunCost",
    "Unknown",
    "Validity",
    "installed_versions",
    "keys_of",
    "known",
    "markdown_table",
    "or_none",
    "shares",
    "unknown",
    "utc_now",
]
