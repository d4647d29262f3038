"""What is shipped: materials, surfaces, scenes with sources; and a material from the table that states it."""

from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from typing import Any

from fem_impact.errors import SceneError, did_you_mean
from fem_impact.plugins import added, wrong
from fem_impact.scene import curve, fields
from fem_impact.scene.material import (
    FLOWS,
    RATES,
    Flow,
    JohnsonCookRate,
    Material,
    Rate,
    SkinSpec,
    Surface,
    TableFlow,
    families_by_words,
    family_by_words,
    tested_at,
)
from fem_impact.scene.sliding import SlidingLaw, law_of
from fem_impact.scene.tables import Table, check_keys, needed, numbers_of, values_of, within
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.scene.units import data_tables, parse_quantity

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
    readers = {
        "flow": lambda flow: _flow(flow, stated["E"]),
        "rate": lambda rate: _rate(rate, stated.get("flow")),
        "skin": lambda skin: SkinSpec(**values_of(skin, fields.SKIN, ("shape",))),
    }
    for key, read in readers.items():
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


def _rate(table: Table, flow: Flow | None) -> Rate:
    law = fields.check_choice(needed(table, "law"), tuple(RATES), "law")
    numbers = numbers_of(table, fields.RATES[law], ("law",))
    if law == JohnsonCookRate.law and not any(key.startswith("tested") for key in table):
        numbers["tested"] = tested_at(flow, numbers["reference"])
    return RATES[law](**numbers)


def _flow(table: Table, E: float) -> Flow:
    law = fields.check_choice(needed(table, "law"), tuple(FLOWS), "law")
    if law != TableFlow.law:
        return FLOWS[law](**numbers_of(table, fields.FLOWS[law], ("law",)))
    check_keys(table, ("law", "points", "strain"))
    return TableFlow(curve.curve(needed(table, "points", curve.EXAMPLE), table.get("strain", "plastic"), E))


CHANGED = " (changed)"
"""End of the name of a shipped material of which a scene changes a value."""
BESIDE = ("melting", "intervals", "sources", "aliases", "about")
"""Keys of a shipped material that are no values of it."""
MISSPELT, NEAR = 0.9, 0.75
"""Likeness of a name to a shipped material's from which it is taken for that, misspelt, and is proposed."""


def shipped() -> tuple[str, ...]:
    """Return the ids of the shipped scenes: the measured sets in the paper's order, then the others."""
    return (*MEASURED_SETS, *data_tables("scenes.toml")["others"])


def stated(name: str) -> dict[str, Any]:
    """Return the tables of a shipped scene as its file states them."""
    return data_tables(f"scenes/{name}.toml")


def other_tip(measured: str) -> dict[str, Any]:
    """Return tip and tip_radius with which the rows of a measured set may also be read, empty if none."""
    return dict(data_tables("scenes.toml")["other_tips"].get(measured, {}))


ALL_MATERIALS = "All: `fem-impact scenes --materials`; or give a table of values."


def materials() -> dict[str, Material]:
    """Return the shipped materials by name, SI units."""
    return {name: _material(name) for name in _material_tables()}


def material(name: str) -> Material:
    """Return one shipped material by its name or an alias of it, or refuse the name with a suggestion."""
    plain = _plain(name)
    for group in data_tables("not_modelled.toml").values():
        if plain in map(_plain, group["names"]):
            raise SceneError(group["reason"], value=name, remedy=group["remedy"])
    own = own_name(name)
    if not own:
        raise SceneError("is not a shipped material.", value=name, remedy=_nearest_material(name))
    return _material(own)


def own_name(name: str) -> str:
    """Return the name of the shipped material that a name or an alias stands for, empty if there is none."""
    plain = _plain(name)
    return next((one for one in _material_tables() if plain in map(_plain, (one, *aliases_of(one)))), "")


def aliases_of(name: str) -> tuple[str, ...]:
    """Return other names of a shipped material, of standards and of trade."""
    return tuple(_material_tables()[name].get("aliases", ()))


def about(name: str) -> str:
    """Return which product a shipped material is, its state and temperature; empty if it is not told."""
    return str(_material_tables()[name].get("about", ""))


def sources_of(name: str) -> dict[str, str]:
    """Return where each value of a shipped material comes from."""
    return dict(_material_tables()[name].get("sources", {}))


def _plain(name: str) -> str:
    """Return a name in small letters and digits alone: ``AISI 316L``, ``aisi-316l`` are one."""
    return "".join(letter for letter in name.lower() if letter.isalnum())


def read_material(table: Table | str) -> Material:
    """Return a shipped material by its name, or one of a table of values (SceneError)."""
    if isinstance(table, str):
        return material(table)
    made = material_of(needed(table, "name", '"my-steel", a name of its own'), table, ("name",))
    known = materials().get(made.name)
    if known is not None and known != made:
        raise SceneError(
            "is the name of a shipped material with other values.",
            key="name",
            value=made.name,
            remedy="Give a changed material a name of its own.",
        )
    if not family_of(made) and (of := families_by_words(made.name)):
        choices = " or ".join(f'"{family}"' for family in of)
        remedy = f"State which it is, family = {choices}."
        problem = f"is missing: the words of the name {made.name!r} are those of {' and of '.join(of)}."
        raise SceneError(problem, key="family", remedy=remedy)
    return made


def _nearest_material(name: str) -> str:
    """Return the shipped materials that a name is a part of, in either spelling, or that have a grade of it.

    So are those of the family that a word of the name tells. Where there are none, the nearest name.
    """
    part = name.lower().replace("aluminum", "aluminium")
    grades = {word for word in part.split("-") if word[-1:].isdigit()}
    family = family_by_words(part)
    known = _material_tables()
    found = [
        one
        for one, table in known.items()
        if part in one or grades & set(one.split("-")) or (family and family == table.get("family"))
    ]
    from difflib import get_close_matches

    near = get_close_matches(part, known, 1, MISSPELT)
    if near:
        return f"Did you mean {near[0]}?"
    if len(found) > 1 and part:
        return f"Some that are: {', '.join(found)}. {ALL_MATERIALS}"
    proposed = found if len(found) == 1 else get_close_matches(part, known, 1, NEAR)
    return f"Did you mean {proposed[0]}?" if proposed else ALL_MATERIALS


def family_of(metal: Material) -> str:
    """Return the family of a material: stated, of the shipped material of its name, or by a word of its name.

    It is empty where none is known.
    """
    name = metal.name.removesuffix(CHANGED)
    shipped_family = _material_tables().get(name, {}).get("family", "")
    return metal.family or str(shipped_family) or family_by_words(name)


def friction_pairs() -> list[dict[str, Any]]:
    """Return the table of dry pairs: their families, ends of the interval of f, and where they were read."""
    return list(data_tables("friction_pairs.toml")["pair"])


def sliding_laws() -> dict[str, SlidingLaw]:
    """Return the laws of friction over speed by name: shipped ones, and those that other packages add."""
    laws = {
        name: law_of({k: v for k, v in table.items() if k != "about"}, name)
        for name, table in data_tables("sliding_laws.toml").items()
    }
    for name, law in added("friction_laws", laws).items():
        if not isinstance(law, SlidingLaw):
            raise wrong(name, "friction_laws", "is no SlidingLaw.")
        laws[name] = replace(law, name=name)
    return laws


def sliding_law(name: str) -> SlidingLaw:
    """Return one law of friction over speed, or refuse the name (SceneError)."""
    known = sliding_laws()
    if name not in known:
        hint = did_you_mean(name, known, f"Use one of {', '.join(known)}, or give a table.")
        raise SceneError("is no law of friction.", value=name, remedy=hint)
    return known[name]


def surfaces() -> dict[str, Surface]:
    """Return the shipped surface states by name, each with its interval of f and its source."""
    keys = ("friction", "friction_low", "friction_high", "source")
    return {
        name: Surface(name, **{key: table[key] for key in keys})  # type: ignore[arg-type]
        for name, table in data_tables("surfaces.toml").items()
    }


def surface(state: str) -> Surface:
    """Return one shipped surface state, or refuse the word."""
    known = surfaces()
    if not isinstance(state, str) or state not in known:
        choices = ", ".join(f'"{s}"' for s in [*known, "pair", "custom"])
        raise SceneError("is not a surface state.", key="state", value=state, remedy=f"Use one of {choices}.")
    return known[state]


def source_of(name: str, key: str) -> str:
    """Return where a value of a shipped material comes from."""
    return str(_material_tables().get(name, {}).get("sources", {}).get(key, "stated in the scene"))


def melting_of(name: str) -> float | None:
    """Return the temperature, K, at which a shipped material begins to melt; None where none is known.

    It stands beside the material and is no value of it: a changed strength leaves it as it is.
    """
    stated = _material_tables().get(name.removesuffix(CHANGED), {}).get("melting")
    return None if stated is None else parse_quantity(stated, "temperature", "melting")


def intervals_of(name: str) -> dict[str, tuple[float, float]]:
    """Return the intervals of a shipped material, SI; ``rate_factor`` is that at 1000 per second."""
    dimensions = {parameter.key: parameter.dimension for parameter in fields.MATERIAL}

    def number(key: str, end: Any) -> float:
        return parse_quantity(end, dimensions[key], key) if isinstance(end, str) else float(end)

    table = _material_tables().get(name, {}).get("intervals", {})
    return {key: (number(key, low), number(key, high)) for key, (low, high) in table.items()}


def sourced_values(name: str) -> list[tuple[str, str, str, str]]:
    """Return key, value, interval and source of each value of a shipped material, as texts or empty."""
    metal, spread, melting = material(name), intervals_of(name), melting_of(name)
    numbers = {f.key: f for f in fields.MATERIAL if getattr(metal, f.key) is not None}
    values = {key: str(one.write(getattr(metal, key))) for key, one in numbers.items()}
    values |= {} if melting is None else {"melting": f"{melting:g} K"}

    def ends(key: str) -> str:
        return " to ".join(
            str(numbers[key].write(end)) if key in numbers else f"{end:g}" for end in spread[key]
        )

    return [
        (key, values.get(key, ""), ends(key) if key in spread else "", source)
        for key, source in sources_of(name).items()
    ]


def nearest_scene(name: str) -> str:
    """Return what to type instead of the id of a scene that is not shipped."""
    return did_you_mean(name, shipped(), "`fem-impact scenes` lists the shipped scenes.")


@cache
def _material(name: str) -> Material:
    """Return a material of the table, read once."""
    return material_of(name, _values(_material_tables()[name]))


def _values(table: dict[str, Any]) -> dict[str, Any]:
    """Return the values of a shipped material without what stands beside them; its family stays there too."""
    return {key: value for key, value in table.items() if key not in (*BESIDE, "family")}


@cache
def _material_tables() -> dict[str, Any]:
    """Return the tables of the shipped materials, and those that other packages add, each checked."""
    ours = data_tables("materials.toml")
    tables = added("materials", ours)
    for name, table in tables.items():
        try:
            material_of(name, _values(table))
        except (SceneError, TypeError, ValueError, AttributeError) as error:
            raise wrong(name, "materials", f"is no table of a material ({error}).") from None
    return ours | tables
