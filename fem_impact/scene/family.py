"""Families of materials: by them friction is looked up, and what an elastic body leaves out is told."""

import re
import tomllib
from importlib.resources import files
from typing import Literal, NamedTuple

Kind = Literal["metal", "brittle", "ground", "plastic", "rubber", "wood"]


class Family(NamedTuple):
    """What its materials do beyond elasticity, wider families that hold it, and words of their names."""

    kind: Kind
    wider: tuple[str, ...]
    words: tuple[str, ...]


_STATED = files("fem_impact.scene").joinpath("data/families.toml").read_text(encoding="utf-8")
FAMILIES: dict[str, Family] = {
    name: Family(one["kind"], tuple(one["wider"]), tuple(one["words"]))
    for name, one in tomllib.loads(_STATED).items()
}


def family_by_words(name: str) -> str:
    """Return the family whose word stands in the name of a material, empty where none does."""
    parts = re.findall(r"[a-z]+\d*[a-z]*|\d+[a-z]*", name.lower())
    return next((family for family, of in FAMILIES.items() if set(parts) & set(of.words)), "")


def kind_of(family: str) -> Kind | None:
    """Return the kind of a family, None of no family."""
    return FAMILIES[family].kind if family else None


def widening(family: str) -> tuple[str, ...]:
    """Return a family and the wider ones that hold it, the narrowest first; none of no family."""
    return (family, *FAMILIES[family].wider) if family else ()
