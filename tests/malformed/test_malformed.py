"""Whatever file or word is handed in: done, or refused in clear words with the right exit code.

The counts of the ordinary tests are small; `pytest -m slow` tries thousands and prints how many.
"""

import ast
import hashlib
import json
import os
import pickle
import subprocess
import sys
from io import BytesIO
from pathlib import Path

import damage
import numpy as np
import pytest
import result_maker
from damage import TRIED, VALUES, check_answer, spoiled_bytes, spoiled_tree, toml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import fem_impact
import meshes
import rigid
from fem_impact.errors import FemImpactError, ResultError, SceneError
from fem_impact.jobs import job as store_module
from fem_impact.jobs.job import Job, Store
from fem_impact.outcome.record import Outcome
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load
from fem_impact.scene.types import to_dict, to_toml
from fem_impact.solid.checkpoint import Checkpoint
from fem_impact.solid.state import State
from fem_impact.tables.table import read_csv

FEW = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
MANY = settings(max_examples=1500, deadline=None, suppress_health_check=list(HealthCheck))
SCENE = to_dict(load("t5b"))
SCENE_TEXT = to_toml(load("t5b")).encode()
OUTCOME = result_maker.values()
CAMERA = b"""test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s
1,-1.572,-1.602,0.381,-0.371,3.607
2,-1.516,-1.507,0.271,-0.369,1.019
3,-1.475,-1.475,0.340,-0.338,2.933
"""
ROD = ("--length", "80 mm", "--diameter", "19 mm", "--angle", "45 deg")
SETTINGS = [pytest.param(FEW, id="few"), pytest.param(MANY, id="many", marks=pytest.mark.slow)]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """An empty directory, in which nothing may be left that was not there."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "inside").mkdir()
    monkeypatch.chdir(tmp_path / "inside")
    yield
    told = ", ".join(f"{count} {what}" for what, count in sorted(TRIED.items()))
    print(f"\ntried so far: {told}")


def files():
    """Everything in this directory, ``inside``, and beside it."""
    return {path.relative_to("..").as_posix() for path in Path("..").rglob("*")} - {"inside"}


AS_BYTES = spoiled_tree(SCENE).map(lambda tree: toml(tree).encode("utf-8", "replace"))
SPOILED = spoiled_bytes(SCENE_TEXT) | AS_BYTES


@pytest.mark.parametrize("how", SETTINGS)
def test_spoiled_scenes(how):
    @how
    @given(SPOILED)
    def tried(data):
        Path("mine.toml").write_bytes(data)
        check_answer("scene files", {3}, "check", "mine.toml", "--json")
        assert files() == {"inside/mine.toml"}

    tried()


KEYS = [f"{section}.{key}" for section, table in SCENE.items() if isinstance(table, dict) for key in table]


@pytest.mark.parametrize("how", SETTINGS)
def test_wrong_changes_on_the_command_line(how):
    @how
    @given(st.sampled_from([*KEYS, "id", "effects", "measured", "nothing", "a.b.c", ""]), VALUES)
    def tried(key, value):
        words = f"{key}={value if isinstance(value, str) else damage.literal(value)}".replace("\0", "")
        check_answer("--set changes", {2, 3}, "check", "t5b", "--set", words, "--json")
        assert files() == set()

    tried()


@pytest.mark.parametrize("how", SETTINGS)
def test_spoiled_outcomes(how):
    whole = Outcome.from_dict(OUTCOME).to_json().encode()

    @how
    @given(spoiled_bytes(whole) | spoiled_tree(json.loads(whole)))
    def tried(spoiled):
        data = spoiled if isinstance(spoiled, bytes) else json.dumps(spoiled).encode()
        Path("outcome.json").write_bytes(data)
        TRIED["outcome files"] += 1
        try:
            found = Outcome.read("outcome.json")
        except ResultError as error:
            assert "outcome.json" in str(error)
            TRIED["outcome files, refused"] += 1
            return
        assert Outcome.from_json(found.to_json()) == found

    tried()


@pytest.mark.parametrize("how", SETTINGS)
def test_spoiled_tables(how):
    @how
    @given(spoiled_bytes(CAMERA))
    def tried(data):
        Path("mine.csv").write_bytes(data)
        check_answer("camera tables", {3, 5}, "coefficients", "mine.csv", *ROD, "--json")
        assert files() == {"inside/mine.csv"}
        try:
            table = read_csv("mine.csv")
            for column in table.columns:
                table.numbers(column)
        except ResultError as error:
            assert "mine.csv" in str(error)

    tried()


STATE = State(np.arange(30.0), np.ones(30), np.zeros(30), 1e-5, 7, 1e-8, 1e-8, 1e-8)


def checkpoint():
    """A checkpoint of a small state."""
    stamp = "scene 1\nsources 2\n"
    return Checkpoint(Path("run.checkpoint"), stamp, {"0-State": STATE}, 1.0, lambda: False)


@pytest.mark.parametrize("how", SETTINGS)
def test_spoiled_checkpoints(how):
    checkpoint().save()
    whole = Path("run.checkpoint").read_bytes()

    @how
    @given(spoiled_bytes(whole))
    def tried(data):
        Path("run.checkpoint").write_bytes(data)
        TRIED["checkpoints"] += 1
        if data != whole:
            with pytest.raises(ResultError, match="start anew"):
                checkpoint().restore()

    tried()


def signed(body):
    """Give a forged archive the mark and the right checksum."""
    return b"fem-ckp1" + hashlib.sha256(body).digest() + body


@pytest.mark.parametrize("how", SETTINGS)
def test_forged_checkpoints_with_a_right_checksum(how):
    checkpoint().save()
    whole = Path("run.checkpoint").read_bytes()[40:]

    @how
    @given(spoiled_bytes(whole))
    def tried(body):
        Path("run.checkpoint").write_bytes(signed(body))
        TRIED["forged checkpoints"] += 1
        try:
            checkpoint().restore()
        except ResultError as error:
            assert "start anew" in str(error)

    tried()


class Bomb:
    """Unpickling it leaves a file behind."""

    def __reduce__(self):
        return os.mkdir, ("hit",)


def test_no_file_is_ever_unpickled():
    archive = BytesIO()
    np.savez(archive, stamp=np.array("scene 1\nsources 2\n"), x=np.array([Bomb()], dtype=object))
    for body in (archive.getvalue(), pickle.dumps(Bomb())):
        Path("run.checkpoint").write_bytes(signed(body))
        with pytest.raises(ResultError):
            checkpoint().restore()
    for name in ("mine.toml", "mine.csv", "outcome.json"):
        Path(name).write_bytes(pickle.dumps(Bomb()))
    assert check_answer("pickles", {3}, "check", "mine.toml") == 3
    assert check_answer("pickles", {3, 5}, "coefficients", "mine.csv", *ROD) in (3, 5)
    assert check_answer("pickles", {5}, "report", ".") == 5
    assert not Path("hit").exists()


BANNED = {"pickle", "cPickle", "dill", "marshal", "shelve", "joblib"}


@pytest.mark.long
@pytest.mark.parametrize("package", [fem_impact, meshes, rigid])
def test_no_source_can_run_code_out_of_a_file(package):
    for path in Path(package.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                assert not {alias.name.split(".")[0] for alias in node.names} & BANNED, path
            if isinstance(node, ast.ImportFrom):
                assert (node.module or "").split(".")[0] not in BANNED, path
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in {"eval", "exec", "compile", "__import__"}, path
            if isinstance(node, ast.keyword) and node.arg == "allow_pickle":
                assert isinstance(node.value, ast.Constant) and node.value.value is False, path


# the HDF5 library reads damaged files in C: another process, so that a crash there is seen and counted
READ_FIELDS = """
import sys
from pathlib import Path
import numpy as np
from fem_impact.errors import FemImpactError, ResultError
from fem_impact.files.fields import read_fields
whole, refused = Path("fields.vtkhdf").read_bytes(), 0
chance = np.random.default_rng(int(sys.argv[1]))
for k in range(int(sys.argv[2])):
    data = bytearray(whole)
    if k % 3 == 0:
        data = data[: chance.integers(len(data))]
    else:
        # most of the file is numbers: spoil what describes them as well
        reach = 4000 if k % 3 == 1 else len(data)
        for place in chance.integers(reach, size=chance.integers(1, 9)):
            data[place] ^= 1 << chance.integers(8)
    Path("spoiled.vtkhdf").write_bytes(data)
    try:
        fields = read_fields("spoiled.vtkhdf")
        for frame in range(min(len(fields.times), 3)):
            for name in fields.point_names:
                fields.point_data(name, frame)
            for name in fields.cell_names:
                fields.cell_data(name, frame)
    except ResultError as error:
        assert "spoiled.vtkhdf" in str(error)
        refused += 1
print(refused)
"""


@pytest.mark.parametrize("count", [150, pytest.param(3000, marks=pytest.mark.slow)])
def test_spoiled_fields(count):
    result_maker.write_fields(Path("fields.vtkhdf"), frames=3, across=4, along=6)
    done = subprocess.run(
        [sys.executable, "-c", READ_FIELDS, "5", str(count)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert 0.3 * count < int(done.stdout) < count
    TRIED["field files"] += count
    TRIED["field files, refused"] += int(done.stdout)


@pytest.mark.parametrize("how", SETTINGS)
def test_spoiled_stores_of_studies(how):
    with Store.open(Path("store.sqlite")):
        pass
    whole = Path("store.sqlite").read_bytes()

    @how
    @given(spoiled_bytes(whole))
    def tried(data):
        for name in ("store.sqlite-wal", "store.sqlite-shm"):
            Path(name).unlink(missing_ok=True)
        Path("store.sqlite").write_bytes(data)
        TRIED["stores"] += 1
        try:
            with Store.open(Path("store.sqlite")) as store:
                store.get(Job("a", load("t5b")))
        except FemImpactError as error:
            assert error.exit_code in (4, 5)
            assert "store.sqlite" in str(error)

    tried()


OTHERS = [pytest.param(name, marks=pytest.mark.slow) for name in ("history.csv", "contacts.csv")]


@pytest.mark.parametrize("name", ["outcome.json", *OTHERS])
def test_a_report_of_spoiled_files_is_refused_and_not_half_written(name):
    here = result_maker.write_result(Path("run"))
    whole = (Path(here) / name).read_bytes()
    for data in (b"", b"\xff\xfe", whole[: len(whole) // 2].rsplit(b",", 3)[0] + b"\n", b"a,b\n1\n", b"{}"):
        (Path(here) / name).write_bytes(data)
        code = check_answer("reports", {5}, "report", "run")
        assert code == 5 or name != "outcome.json"
        assert code == 0 or not (Path(here) / "report.html").exists()
        (Path(here) / "report.html").unlink(missing_ok=True)


@pytest.mark.parametrize(
    "id", ["../up", "/abs", "a/b", ".", "..", "", "a\\b", "A", "a b", "-x", "x" * 65, 3, None]
)
def test_an_id_that_would_leave_its_directory_is_refused(id):
    with pytest.raises(SceneError, match="id"):
        read_dict({**SCENE, "id": id})
    Path("mine.toml").write_text(toml({**SCENE, "id": id}))
    assert check_answer("ids", {3}, "run", "mine.toml", "--quiet") == 3
    assert files() == {"inside/mine.toml"}


def test_a_store_whose_complaint_is_no_text_is_damaged():
    """SQLite quotes a spoiled name in its words, and Python cannot read them."""
    with pytest.raises(ResultError, match="is damaged"), store_module._named(Path("store.sqlite")):
        b"\x80".decode()
