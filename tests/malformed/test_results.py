"""Results that were changed after the run: refused with file and reason, or shown with that sentence."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import result_maker
from damage import TRIED, call, check_answer

import fem_impact.films.film as films
from fem_impact.answers.report import Request, Sheet, StudyReport, publish
from fem_impact.case.case import Case
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.files.atomic import CHECKSUM, signed
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import keys_of
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load
from fem_impact.tables.table import Table

COUNTS = [pytest.param(20, id="few"), pytest.param(1500, id="many", marks=pytest.mark.slow)]
SEED = 20
HOSTILE = (
    *(None, True, -1, 0, 2**63, 1e308, -1e-300, "", "abc", "\x1b[31m\u202e", "../x", [], {}, [[]], [None]),
    *({"a": 1}, ["x", 1], {"name": "../../x"}, [{"name": None}], "nan", float("nan"), float("inf"), "$x_{$"),
)


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty directory; a film is not drawn there, only everything that it needs is read."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(films, "encode", lambda frames, path, fps: path)
    return tmp_path


def leaves(tree, path=()):
    """Return the places of all values in nested lists and tables, those of lists and tables included."""
    inner = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [path, *(place for key, value in inner for place in leaves(value, (*path, key)))]


def spoil_tree(chance, tree):
    """Change, remove or add a value anywhere in nested lists and tables; return the tree."""
    *path, key = pick(chance, leaves(tree)[1:])
    holder = tree
    for name in path:
        holder = holder[name]
    act = chance.random()
    if act < 0.1:
        del holder[key]
    elif act < 0.2 and isinstance(holder, dict):
        holder["strange"] = pick(chance, HOSTILE)
    elif isinstance(holder[key], float) and act < 0.5:
        holder[key] *= pick(chance, (-1.0, 1e6, 1e-30, 1.01))
    else:
        holder[key] = pick(chance, HOSTILE)
    return tree


def pick(chance, among):
    """Return one of a sequence."""
    return among[int(chance.integers(len(among)))]


def spoil_bytes(chance, data):
    """Cut off, change bits of, remove or double a piece of a file."""
    data, at, kind = bytearray(data), int(chance.integers(len(data))), chance.integers(4)
    if kind == 0:
        return bytes(data[:at])
    if kind == 1:
        for bit in chance.integers(8 * len(data), size=chance.integers(1, 6)):
            data[bit // 8] ^= 1 << (bit % 8)
    if kind == 2:
        del data[at : at + 40]
    if kind == 3:
        data[at:at] = data[at : at + 40]
    return bytes(data)


def full_outcome():
    """An outcome with effect choices and two meshes, in which nearly no value is null."""
    told = [replace(choice, share=0.1) for choice in Case.of(load("t5b")).choices]
    choices = [{key.name: key.of(choice) for key in keys_of(type(choice))} for choice in told]
    meshes = {"mesh_limit": {"mu": 0.6, "e_edge": 0.3}, "mesh_band": {"mu": 0.01}}
    return result_maker.values(effect_choices=choices, **meshes)


def write_full_study(place):
    """Write a study with a figure, tables, conclusions, runs and a comparison; return its document."""
    line = Series("one", [0.0, 1.0], [2.0, 3.0])
    cells = Table.of(("name", "value_m"), [["<b>", 0.25], ["none", None]])
    rows = [Outcome.from_dict(full_outcome() | {"scene_id": name}) for name in ("t4", "t5b")]
    report = StudyReport(
        "gamma",
        "A study",
        ["It rises."],
        [Picture("line", "A rising line.", (Panel("a line", "x, m", "y, -", (line,)),))],
        [Sheet("numbers", "Some numbers", cells)],
        ["one assumption"],
        conclusions=[("line", "It rises.")],
        outcomes=rows,
        comparison=result_maker.comparison(("t4", "t5b")),
    )
    failed = Failure("t6-17", "it stopped")
    publish(report, Request(place), {"t4": rows[0], "t5b": rows[1], "t6-17": failed})
    return json.loads((place / "study.json").read_text())


@pytest.mark.parametrize("count", COUNTS)
def test_forged_outcomes(place, count):
    """The checksum is right again: only the schema and the rules of the record are left to refuse them."""
    here, chance = result_maker.write_result(Path("run")), np.random.default_rng(SEED)
    whole = full_outcome()
    (here / "history.csv").unlink()
    for _ in range(count):
        values = spoil_tree(chance, json.loads(json.dumps(whole)))
        (here / "outcome.json").write_text(json.dumps(signed(values)))
        check_answer("forged outcomes", {5}, "report", "run")


@pytest.mark.parametrize("count", [8, pytest.param(500, marks=pytest.mark.slow)])
def test_forged_studies(place, count):
    chance, place = np.random.default_rng(SEED), Path("study")
    whole = write_full_study(place)
    whole.pop(CHECKSUM)
    for _ in range(count):
        document = spoil_tree(chance, json.loads(json.dumps(whole)))
        (place / "study.json").write_text(json.dumps(signed(document)))
        check_answer("forged studies", {5}, "report", "study")


DRAWN = ("outcome.json", "history.csv", "fields.vtkhdf", "waves.h5")


@pytest.mark.long
@pytest.mark.parametrize("count", COUNTS)
def test_spoiled_files_of_a_run(place, count):
    """Bytes of one file are changed; a page or film that does not use it says why."""
    here, chance = Path("run"), np.random.default_rng(SEED)
    result_maker.write_result(here, frames=3, across=4, along=6)
    whole = {name: (here / name).read_bytes() for name in DRAWN}
    for _ in range(count):
        name = pick(chance, list(whole))
        (here / name).write_bytes(spoil_bytes(chance, whole[name]))
        code, _, err = call("render", "run")
        TRIED["films"] += 1
        assert code in ((0, 5) if name in ("fields.vtkhdf", "waves.h5") else (0,)), err
        assert "Traceback" not in err
        assert name != "outcome.json" or "is named after its folder: run/outcome.json" in err
        (here / name).write_bytes(whole[name])
