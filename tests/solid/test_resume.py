"""A run that was stopped and goes on is the run that was never stopped, bit for bit."""

from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.errors import ResultError
from fem_impact.output import read_fields
from fem_impact.reduce import reduce
from fem_impact.scene import NAMES
from fem_impact.solid.checkpoint import CHECKPOINT
from fem_impact.solid.run import solve

# together these sets name every effect that a scene can name
SETS = (
    tuple(n for n in NAMES if n not in ("barrier-rigid", "barrier-elastic")),
    ("vibration", "friction", "barrier-rigid", "rod-plasticity", "large-rotation", "contact-heating"),
    ("vibration", "friction", "barrier-elastic"),
    ("friction", "rod-plasticity", "barrier-rigid", "large-rotation"),
)
OF_THE_CLOCK = {"created_utc", "wall_s", "cpu_s", "peak_memory_MB", "effect_choices"}


def short(effects, **changes):
    scene = scenes.scene(*effects, length=0.06, v_n=-3.0, v_t=-3.0, max_time=5e-5, **changes)
    return replace(scene, save=replace(scene.save, frames=400, history_every=7))


def stop_at(step):
    """A progress report that interrupts the run."""

    def progress(report):
        if report.step >= step:
            raise KeyboardInterrupt

    return progress


def interrupted(scene, out, step):
    out.mkdir()
    with pytest.raises(KeyboardInterrupt):
        solve(scene, out, stop_at(step), interval=0.0)
    return out


def everything(thing, name="", seen=None):
    """Yield (name, array) of all numbers that can be reached from a thing."""
    seen = set() if seen is None else seen
    if id(thing) in seen:
        return
    seen.add(id(thing))
    if isinstance(thing, (int, float, np.ndarray)):
        yield name, np.asarray(thing)
    elif is_dataclass(thing):
        for f in fields(thing):
            yield from everything(getattr(thing, f.name), f"{name}.{f.name}", seen)
    elif isinstance(thing, (list, tuple)):
        for i, part in enumerate(thing):
            yield from everything(part, f"{name}[{i}]", seen)


def outcome_numbers(result):
    return {k: v for k, v in reduce(result.scene, result).items() if k not in OF_THE_CLOCK}


def test_these_sets_name_every_effect():
    assert {name for names in SETS for name in names} == set(NAMES)


@pytest.mark.parametrize("effects", SETS)
def test_resumed_is_uninterrupted(effects, tmp_path):
    scene, whole = short(effects), tmp_path / "whole"
    whole.mkdir()
    expected = solve(scene, whole)
    parts = interrupted(scene, tmp_path / "parts", 400)
    assert (parts / CHECKPOINT).stat().st_size > 0
    found = solve(scene, parts, resume=True)
    assert found.steps == expected.steps > 500
    assert outcome_numbers(found) == outcome_numbers(expected)
    assert (parts / "history.csv").read_bytes() == (whole / "history.csv").read_bytes()
    same_frames(read_fields(parts / "fields.vtkhdf"), read_fields(whole / "fields.vtkhdf"))


def same_frames(found, expected):
    assert len(expected.times) > 8
    assert (found.times == expected.times).all()
    for frame in range(len(expected.times)):
        for name in expected.point_names:
            assert (found.point_data(name, frame) == expected.point_data(name, frame)).all()
        for name in expected.cell_names:
            assert (found.cell_data(name, frame) == expected.cell_data(name, frame)).all()


@pytest.mark.parametrize("effects", SETS)
def test_nothing_that_moves_is_left_out_of_a_checkpoint(effects, tmp_path):
    """Whatever an item holds is the same after both ways: an undeclared moving array would differ."""
    scene = short(effects)
    expected = dict(everything(solve(scene).model))
    found = dict(everything(solve(scene, interrupted(scene, tmp_path / "parts", 400), resume=True).model))
    assert len(expected) > 60
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        assert found[name].tobytes() == value.tobytes(), name


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """A scene and the directory of its stopped run; tests copy it before they harm it."""
    scene = short(SETS[1])
    return scene, interrupted(scene, tmp_path_factory.mktemp("stopped") / "run", 400)


def refusal(scene, place):
    """The words with which the run is refused; the files stay as they were."""
    before = {path.name: path.read_bytes() for path in place.iterdir()}
    with pytest.raises(ResultError, match=r"Run again without --resume to start anew\.") as refused:
        solve(scene, place, resume=True)
    assert {path.name: path.read_bytes() for path in place.iterdir()} == before
    return str(refused.value)


def test_a_checkpoint_of_another_scene_is_refused(stopped):
    scene, place = stopped
    other = replace(scene, impact=replace(scene.impact, v_n=-2.9))
    assert "written with another scene;" in refusal(other, place)


def test_a_checkpoint_of_another_program_is_refused(stopped, monkeypatch):
    scene, place = stopped
    monkeypatch.setattr("fem_impact.sources.source_digest", lambda: "0" * 64)
    assert "written with another sources;" in refusal(scene, place)


def test_a_damaged_checkpoint_is_refused(stopped):
    scene, place = stopped
    path = place / CHECKPOINT
    whole = path.read_bytes()
    try:
        for harm in (b"", whole[:-1], whole[:100], whole + b"x", whole[:-9] + b"!" + whole[-8:], b"{}"):
            path.write_bytes(harm)
            assert "is damaged" in refusal(scene, place)
    finally:
        path.write_bytes(whole)


@pytest.mark.parametrize("name", ["history.csv", "fields.vtkhdf"])
def test_files_that_lost_what_was_written_before_are_refused(stopped, name):
    scene, place = stopped
    path = place / name
    whole = path.read_bytes()
    try:
        path.write_bytes(whole[:50])
        assert name in refusal(scene, place)
        path.unlink()
        assert name in refusal(scene, place)
    finally:
        path.write_bytes(whole)
