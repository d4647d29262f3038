"""Scene files that people might write: shipped ones and those of the pages, with values changed or spoilt."""

from __future__ import annotations

import copy
import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fem_impact.scene.library import shipped, stated

Tree = dict[str, Any]
PAGES = Path(__file__).parents[2] / "docs/how-to"
QUANTITY = re.compile(r"(-?[\d.]+(?:e-?\d+)?) ([A-Za-z/^0-9 ()]+)")
FACTORS = (0.0, 1e-6, 0.01, 0.1, 0.3, 0.7, 1.5, 3.0, 10.0, 100.0, 1e6, -1.0)
WRONG = (0, -1, "", "x", None, True, [], {}, "3 kg", "5 furlongs", "nan mm", "1e400 m/s", [1, 2], {"a": 1})
WORDS = ("steel", "rubber", "glass", "ball", "cone", "auto", "solid", "custom", "machined", "mild-steel")
KEYS = {
    "projectile": ("mass", "lenght", "bore", "segments", "tip", "shape", "cone_angle", "nose_radius"),
    "barrier": ("thickness", "support", "span", "mass", "layers", "v_n", "inertia"),
    "impact": ("omega", "height", "speed", "v_n", "v_t", "angle"),
    "surface": ("friction", "state"),
    "accuracy": ("tip_size", "across", "max_time", "levels", "target", "element"),
}
NEW = (
    *("1 mm", "20 mm", "0.5 m", "3 m/s", "-3 m/s", "30 deg", "200 rad/s", "2 kg", "1e-4 kg m2", "10 %"),
    *(0.3, 4, "infinite", "hemisphere", "B", "plain", "custom", "bbar"),
    [["0 mm", "3 mm"], ["80 mm", "3 mm"]],
    [{"to": "10 mm", "material": "copper"}, {"material": "lead"}],
    [{"thickness": "1 mm", "material": "lead"}],
)


@cache
def known() -> tuple[Tree, ...]:
    """Return the scenes from which the random ones are made."""
    pages = "\n".join((PAGES / name).read_text() for name in ("own-projectile.md", "own-barrier.md"))
    blocks = re.findall(r"```toml\n(.*?)```", pages, re.DOTALL)
    of_pages = [tree for tree in map(tomllib.loads, blocks) if "projectile" in tree]
    return (*(_bare(stated(name)) for name in shipped()), *of_pages)


def _bare(tree: Tree) -> Tree:
    return {key: value for key, value in tree.items() if key not in ("measured", "title")}


def spoilt_tree(seed: int, number: int) -> Tree:
    """Return the scene file of a number, with up to three places changed."""
    random = np.random.default_rng([seed, number, 7])
    scenes = known()
    tree = copy.deepcopy(scenes[random.integers(len(scenes))])
    for _ in range(random.integers(4)):
        _change(random, tree)
    return tree


def _one(random: np.random.Generator, choices: Any) -> Any:
    return choices[random.integers(len(choices))]


def _change(random: np.random.Generator, tree: Tree) -> None:
    """Scale a number, spoil or remove a value, or add one under a key that is known or misspelt."""
    act = random.random()
    if act < 0.25:
        section = _one(random, tuple(KEYS))
        if isinstance(tree.setdefault(section, {}), dict):
            tree[section][_one(random, KEYS[section])] = copy.deepcopy(_one(random, NEW))
        return
    holder, key = _one(random, _places(tree))
    value = holder[key]
    if act < 0.35:
        holder.pop(key)
    elif act < 0.45:
        holder[key] = copy.deepcopy(_one(random, WRONG))
    elif act < 0.5:
        holder[key] = _one(random, WORDS)
    elif isinstance(value, str) and (found := QUANTITY.fullmatch(value)):
        holder[key] = f"{float(found[1]) * _one(random, FACTORS):.6g} {found[2]}"
    elif isinstance(value, int | float) and not isinstance(value, bool):
        holder[key] = value * _one(random, FACTORS)


def _places(tree: Any) -> list[tuple[Any, Any]]:
    """Return the holder and the key of every value in nested tables and lists."""
    pairs = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    found = []
    for key, value in list(pairs):
        found += [(tree, key)] if isinstance(tree, dict) else []
        found += _places(value)
    return found
