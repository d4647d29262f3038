"""Random tables of materials, friction and effects, some incomplete or spoiled, as scene files have."""

from __future__ import annotations

from typing import Any

import numpy as np

from fem_impact.case.effects.registry import NAMES
from fem_impact.scene.library import aliases_of, materials
from fem_impact.scene.material import FAMILIES

Tree = dict[str, Any]
STIFF = (  # E, yield stress
    *(("210 GPa", "320 MPa"), ("70 GPa", "120 MPa"), ("3 GPa", "30 MPa"), ("12 GPa", "80 MPa")),
    *(("4 MPa", "30 kPa"), ("400 GPa", "300 MPa"), ("33 GPa", "30 MPa"), ("3 GPa", "1.5 GPa")),
)
UNKNOWN = ("concrete", "sand", "oak", "magnox", "peek", "unobtainium")
NU, RHO = (0.0, 0.2, 0.3, 0.49, 0.499), ("950 kg/m3", "2400 kg/m3", "7850 kg/m3", "19 g/cm3")
HARDENS: tuple[Tree, ...] = (
    {"ultimate_stress": "500 MPa"},
    {"ultimate_stress": "6 GPa"},
    {"tangent_modulus": "1 GPa"},
    {"tangent_modulus": "2 MPa"},
    {"hardening": "0 MPa"},
    {"hardening": "2 GPa"},
    {"law": "hardness", "hardness": 163},
    {"flow": {"law": "ramberg-osgood", "n": 12}},
    {"flow": {"law": "johnson-cook", "B": "300 MPa", "n": 0.3}},
    {
        "heat_capacity": "460 J/(kg K)",
        "flow": {
            "law": "johnson-cook",
            "B": "300 MPa",
            "n": 0.3,
            "m": 1.0,
            "melting": "1500 degC",
            "reference": "20 degC",
            "heat_share": 0.9,
        },
    },
    {"flow": {"law": "table", "points": [[0, "300 MPa"], [0.02, "340 MPa"], [0.2, "400 MPa"]]}},
    {},
)
RATES: tuple[Tree, ...] = (
    {"law": "johnson-cook", "C": 0.02, "tested": "1 /s"},
    {"law": "cowper-symonds", "D": "40 /s", "q": 5},
)
SPOILT = (
    0,
    -1,
    "",
    "x",
    None,
    True,
    [],
    {},
    "-3 MPa",
    "1e400 GPa",
    "nan MPa",
    "5 m",
    float("inf"),
    1e308,
    "pair",
)
SURFACES: tuple[Tree | None, ...] = (
    None,
    None,
    {"state": "pair"},
    {"state": "custom", "friction": 0.2, "source": "random"},
    {"state": "custom", "friction": 0.0, "source": "random"},
    *({"state": "custom", "friction": f, "source": "random"} for f in (0.05, 0.3, 0.9)),
    {"state": "machined"},
)
EFFECTS: tuple[tuple[str, ...], ...] = (
    ("auto",),
    ("auto",),
    ("auto", "barrier-elastic"),
    ("auto", "-contact-loss"),
    ("auto", "contact-loss"),
    ("auto", "-rod-plasticity"),
    ("auto", "rod-plasticity", "rate-hardening"),
    ("friction", "barrier-elastic", "contact-loss"),
    ("friction", "rod-plasticity", "barrier-elastoplastic"),
    ("auto", "barrier-elastoplastic", "-friction"),
)


def random_tree(seed: int, number: int) -> Tree:
    """Return the scene file of a number, of which a third has a value left out or spoiled."""
    random = np.random.default_rng([seed, number, 41])
    bodies: Tree = {"projectile": _projectile(random), "barrier": {"material": _material(random)}}
    if random.random() < 0.2:
        bodies["barrier"]["thickness"] = "10 mm"
    surface = _one(random, SURFACES)
    tree = {
        "id": f"m{seed}-{number}",
        "effects": list(_one(random, EFFECTS)),
        **bodies,
        **({} if surface is None else {"surface": dict(surface)}),
        "impact": {
            "angle": _one(random, ("0 deg", "10 deg", "45 deg")),
            "speed": _one(random, ("0.3 m/s", "3 m/s")),
        },
        "save": {"frames": 0},
    }
    if random.random() < 0.33:
        _spoil(random, tree)
    return tree


def _one(random: np.random.Generator, choices: Any) -> Any:
    return choices[random.integers(len(choices))]


def _projectile(random: np.random.Generator) -> Tree:
    material = _material(random)
    if random.random() < 0.5:
        return {"shape": "ball", "diameter": "20 mm", "material": material}
    rod = {"length": "80 mm", "diameter": "19 mm", "tip": "B", "tip_radius": "3 mm"}
    return {**rod, "material": material}


def _material(random: np.random.Generator) -> str | Tree:
    known = random.random()
    if known < 0.4:
        name = str(_one(random, sorted(materials())))
        return str(_one(random, (name, *aliases_of(name))))
    if known < 0.45:
        return str(_one(random, UNKNOWN))
    made: Tree = {
        "name": str(_one(random, ("thing", "my steel", "oak", "a rubber", "glass", "c30 concrete")))
    }
    E, yields = _one(random, STIFF)
    made |= {"E": E, "nu": _one(random, NU), "rho": _one(random, RHO)}
    if random.random() < 0.3:
        made["family"] = str(_one(random, sorted(FAMILIES)))
    if random.random() < 0.3:
        made["loss_factor"] = _one(random, (0.0, 0.01, 0.1, 0.5, 1.0))
    if random.random() < 0.7:
        laws = dict(_one(random, HARDENS))
        of_table = laws.get("flow", {}).get("law") == "table"
        made |= laws if of_table else {"yield_stress": yields, **laws}
        if random.random() < 0.4:
            made["rate"] = dict(_one(random, RATES))
    return made


def _spoil(random: np.random.Generator, tree: Tree) -> None:
    """Leave out, replace or add a value of a table, the deeper ones as often."""
    tables = [tree]
    for table in tables:
        tables += [value for value in table.values() if isinstance(value, dict)]
    tables = [table for table in tables if table]
    table = tables[random.integers(len(tables))]
    key = str(_one(random, sorted(table)))
    act = random.random()
    if act < 0.4:
        del table[key]
    elif act < 0.8:
        table[key] = _one(random, SPOILT)
    else:
        other = tables[random.integers(len(tables))]
        table[str(_one(random, (*sorted(other), *NAMES[:2], "loss_factor", "family")))] = _one(random, SPOILT)
