"""Doing to a scene file what the remedy of a refusal says, where the remedy names what to write."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Iterator
from typing import Any

from fem_impact.errors import StatementError
from fem_impact.scene.library import stated

Tree = dict[str, Any]
Try = tuple[str, Tree, str]
FIDELITY = re.compile(r"--fidelity (rigid|modal|solid)(?: or (modal|solid))?")
ADDED = re.compile(r'[Aa]dd "(-?[a-z-]+)" to effects')
PLAIN = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
EXAMPLE = re.compile(rf'((?<![.a-z_])[a-z_]+ = (?:\{{.*?\}}|\[\[.*?\]\]|"[^"]*"|{PLAIN}\b))')
DOTTED = re.compile(rf'([a-z_]+\.[a-z_]+) = "?({PLAIN}(?: [a-z]+)?)"? or')
ELASTIC = {"E": "30 GPa", "nu": 0.2, "rho": "2300 kg/m3"}
VALUES: Tree = {
    "tangent_modulus": "1 MPa",
    "hardening": "0 MPa",
    "yield_stress": "3 MPa",
    "loss_factor": 0.1,
    "friction": 0.3,
    "restitution": 0.5,
    "E": "200 GPa",
    "nu": 0.3,
    "rho": "7800 kg/m3",
    "diameter": "20 mm",
    "length": "80 mm",
    "angle": "10 deg",
    "speed": "1 m/s",
    "height": "0.1 m",
    "v_n": "-2 m/s",
    "v_t": "-1 m/s",
    "tip_radius": "3 mm",
    "nose_radius": "2 mm",
    "mass": "5 kg",
    "B": "300 MPa",
    "n": 0.3,
    "C": 0.01,
    "D": "40 /s",
    "q": 5,
    "hardness": 900,
}
NUMBER = r"(-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)(?: ([A-Za-z%][^ .,]*))?"
LIST = r"Write \w+ = \[(\{[^}]*\}), \.\.\.\]"
BEFORE = r"(?:\b(?:[Gg]ive|[Ss]tate|[Gg]ive the|or|an?)|,) "


def followed(tree: Tree, fidelity: str, refusal: StatementError) -> Iterator[Try]:
    """Yield (what was done, tree, fidelity) for each thing that a remedy says; nothing if it names none."""
    said, key = refusal.remedy, refusal.key.removeprefix("scene: ")
    yield from ((did, new, fidelity) for did, new in _written(tree, key, refusal))
    if "own" in said and 'family = "' in said:
        yield _own_table(tree, key, said, fidelity)
        return
    for found in FIDELITY.finditer(said):
        yield from ((f"--fidelity {one}", tree, one) for one in found.groups() if one)
    for effect in ADDED.findall(said):
        yield effect, changed(tree, "effects", [*tree.get("effects", ["auto"]), effect]), fidelity
    for example in EXAMPLE.findall(re.sub(LIST, "", said)) if "[" not in key else ():
        yield example, _put(tree, key, tomllib.loads(example)), fidelity
    for place, value in DOTTED.findall(said):
        yield f"{place} = {value}", changed(tree, place, value if " " in value else int(value)), fidelity
    yield from ((did, new, fidelity) for did, new in _stated(tree, key, refusal))


def _written(tree: Tree, key: str, refusal: StatementError) -> Iterator[tuple[str, Tree]]:
    """Yield the tree with the refused value, or its key, as the refusal says that it is to be written."""
    said, last, above = refusal.remedy, key.rpartition(".")[2], key.rpartition(".")[0]
    if not last or "[" in key:
        return
    if like := re.search(r'(?:such as|Write it like) "([^"]*)"', said):
        yield like[1], changed(tree, key, like[1])
    if said.startswith("Write a plain number"):
        yield "a number", changed(tree, key, VALUES.get(last, 8))
    if rows := re.search(LIST, said):
        yield "a list", changed(tree, key, [tomllib.loads(f"row = {rows[1]}")["row"]])
    if choices := re.match(r'Use (?:one of )?("[^.]*)\.$', said):
        for choice in re.findall(r'"([^"]+)"', choices[1]):
            yield choice, changed(tree, key, choice)
    if meant := re.search(r"Did you mean ([\w.-]+)\?", said):
        renamed = changed(changed(tree, key, None), f"{above}.{meant[1]}".lstrip("."), _at(tree, key))
        yield meant[1], renamed if "known key" in refusal.problem else changed(tree, key, meant[1])
    if some := re.search(r"Some that are: ([\w.-]+)", said):
        yield some[1], changed(tree, key, some[1])
    if said.startswith("All: `fem-impact scenes --materials`"):
        yield "a known material", changed(tree, key, "copper")
    if "lists complete scenes to start from" in said or said.startswith("Open it with"):
        yield f"{key} of a scene", changed(tree, key, _at(stated("quick"), key))
    if said.startswith("Known here"):
        yield f"without {last}", changed(tree, key, None)
    for names in re.findall(r"^Leave out (\w+), or (\w+)\.", said):
        yield from ((f"without {name}", _put(tree, key, {name: None})) for name in names)
    yield from ((did, changed(tree, key, value)) for did, value in _within(tree, refusal))


def _within(tree: Tree, refusal: StatementError) -> Iterator[tuple[str, Any]]:
    """Yield a value within the limits that a refusal names."""
    said = refusal.remedy
    both = rf"must be (?:at least|above) {NUMBER} and (?:at most|below) {NUMBER}"
    if limits := re.search(both, refusal.problem):
        low, unit, high, _ = limits.groups()
        middle = 0.4 * float(low) + 0.6 * float(high)
        yield "between the limits", f"{middle:.6g} {unit}" if unit else middle
    if "has v_n below 0" in said:
        yield "v_n below 0", "-2 m/s"
    if "of at most half the diameter" in said:
        yield "half the diameter", _half(_at(tree, "projectile.diameter"))
    for low, high in re.findall(r"a velocity above (\S+) m/s and below (\S+) m/s", said):
        yield "a velocity between them", f"{0.4 * float(low) + 0.6 * float(high):.6g} m/s"
    for bound, unit in re.findall(rf"^Give at (?:least|most) {NUMBER}", said):
        yield f"{bound} {unit}", f"{bound} {unit}"


def _half(size: str) -> str:
    number, _, unit = size.partition(" ")
    return f"{0.5 * float(number):.6g} {unit}"


def _at(tree: Tree, key: str) -> Any:
    """Return the value at a dotted key."""
    value: Any = tree
    for name in key.split("."):
        value = value[name]
    return value


def kind(refused: StatementError) -> tuple[str, str]:
    """Return key and problem of a refusal without its numbers, so that alike ones are one."""
    return refused.key, re.sub(r"\d[-+\d.e]*", "#", refused.problem)


def _stated(tree: Tree, key: str, refusal: StatementError) -> Iterator[tuple[str, Tree]]:
    """Yield the tree with a key that the remedy says to state, or without what it says to leave out."""
    said, last = refusal.remedy, key.rpartition(".")[2]
    if "leave the effect out" in said and (named := re.search(r'names "([a-z-]+)"', refusal.problem)):
        yield f"-{named[1]}", changed(tree, "effects", [one for one in tree["effects"] if one != named[1]])
    to_give = said.partition("leave out")[0].partition("{")[0]
    for name, value in VALUES.items():
        if not said.startswith("Known here") and re.search(rf"{BEFORE}{name}\b", to_give):
            yield name, _put(tree, key, {name: value})
    if re.match(r"Give it\b", said) and last in VALUES:
        yield f"{last} itself", _put(tree, key, {last: VALUES[last]})
    if re.match(r"Leave (it|.*) out", said):
        yield f"without {last}", _put(tree, key, {last: None})
    for name in re.findall(r"leave out (?!both)([a-z_]+)", said):
        yield f"without {name}", _put(tree, key, {name: None})


def _own_table(tree: Tree, key: str, said: str, fidelity: str) -> Try:
    """A material that is refused by its name becomes a table of its family, which stays elastic."""
    family = re.findall(r'family = "([a-z ]+)"', said)[0]
    new = changed(tree, key, {"name": "of our own", "family": family, **ELASTIC})
    if "effects" in said:
        elastic = "-rod-plasticity" if key.startswith("projectile") else "barrier-elastic"
        new = changed(new, "effects", ["auto", elastic])
    return f"own {family}", new, fidelity


def changed(tree: Tree, key: str, value: Any) -> Tree:
    """Return a copy of a tree with one value changed, or removed if it is None."""
    new = copy.deepcopy(tree)
    *path, last = key.split(".")
    table = new
    for name in path:
        if not isinstance(table.get(name), dict):
            table[name] = {}
        table = table[name]
    table.pop(last, None)
    if value is not None:
        table[last] = value
    return new


def _put(tree: Tree, key: str, values: Tree) -> Tree:
    """Return the tree with values beside the refused key, or at the top where that is their place."""
    beside = key.rpartition(".")[0]
    for name, value in values.items():
        at_top = name in ("surface", "restitution", "effects", "id") or not beside
        tree = changed(tree, name if at_top else f"{beside}.{name}", value)
    return tree
