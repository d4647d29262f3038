"""Families of materials: by them friction is looked up, and what an elastic body leaves out is told."""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

Kind = Literal["metal", "brittle", "ground", "plastic", "rubber", "wood"]


class Family(NamedTuple):
    """What its materials do beyond elasticity, wider families that hold it, and words of their names."""

    kind: Kind
    wider: tuple[str, ...]
    words: tuple[str, ...]


FAMILIES: dict[str, Family] = {
    "stainless steel": Family("metal", ("steel", "metal"), ("stainless", "304", "304l", "316", "316l")),
    "cast iron": Family("metal", ("metal",), ("iron",)),
    "steel": Family("metal", ("metal",), ("steel",)),
    "aluminium": Family("metal", ("metal",), ("aluminium", "aluminum", "dural")),
    "brass": Family("metal", ("metal",), ("brass",)),
    "bronze": Family("metal", ("metal",), ("bronze",)),
    "copper": Family("metal", ("metal",), ("copper", "cu")),
    "titanium": Family("metal", ("metal",), ("titanium", "ti")),
    "tungsten": Family("metal", ("metal",), ("tungsten",)),
    "lead": Family("metal", ("metal",), ("lead",)),
    "zinc": Family("metal", ("metal",), ("zinc", "zamak")),
    "magnesium": Family("metal", ("metal",), ("magnesium", "magnox")),
    "zirconium": Family("metal", ("metal",), ("zirconium", "zircaloy")),
    "nickel": Family("metal", ("metal",), ("nickel", "inconel")),
    "metal": Family("metal", (), ("metal",)),
    "glass": Family("brittle", (), ("glass",)),
    "ceramic": Family(
        "brittle", (), ("ceramic", "alumina", "zirconia", "nitride", "carbide", "sapphire", "porcelain")
    ),
    "concrete": Family("ground", (), ("concrete", "mortar", "cement", "masonry", "brick")),
    "rock": Family(
        "ground", (), ("rock", "stone", "granite", "basalt", "marble", "limestone", "sandstone", "slate")
    ),
    "soil": Family("ground", (), ("soil", "sand", "clay", "gravel", "earth")),
    "polyethylene": Family("plastic", ("plastic",), ("polyethylene", "hdpe", "ldpe", "uhmwpe", "pe")),
    "polyamide": Family("plastic", ("plastic",), ("polyamide", "nylon", "pa6", "pa66")),
    "ptfe": Family("plastic", ("plastic",), ("ptfe", "teflon")),
    "acrylic": Family("plastic", ("plastic",), ("acrylic", "pmma", "plexiglas", "perspex")),
    "rubber": Family("rubber", (), ("rubber", "elastomer", "neoprene", "silicone", "epdm", "latex")),
    "plastic": Family(
        "plastic",
        (),
        (
            *("plastic", "polymer", "polycarbonate", "pc", "abs", "peek", "pom", "acetal", "pvc", "epoxy"),
            *("polypropylene", "pp", "polystyrene", "polyurethane", "pu"),
        ),
    ),
    "wood": Family(
        "wood", (), ("wood", "hardwood", "timber", "oak", "beech", "ash", "maple", "pine", "spruce")
    ),
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
