"""The keys by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from fem_impact.outcome.keys import KEYS, Key

__all__ = ["CHOICE_FIELDS", "CONTACT_FIELDS", "KEY_TABLE"]

KEY_TABLE: Mapping[str, Key] = MappingProxyType({key.name: key for key in KEYS})

CONTACT_FIELDS = ("start_s", "end_s", "impulse_n_Ns", "impulse_t_Ns")
"""Fields of each entry of ``contacts``, whole rod."""

CHOICE_FIELDS = (
    *("name", "on", "forced", "needed", "measure", "number", "threshold", "source"),
    *("change_of_e", "change_of_E_vib_over_E_0", "sentence", "share"),
)
"""Fields of each entry of ``effect_choices``: the changes are those of leaving the effect out."""
