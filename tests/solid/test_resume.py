"""A run that was stopped and goes on is the run that was never stopped, bit for bit."""

from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.case.effects.registry import NAMES
from fem_impact.errors import ResultError
from fem_impact.files.fields import read_fields
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.files.waves import read_waves
from fem_impact.options import RunOptions
from fem_impact.run.program import stamp
from fem_impact.run.solid import reduce
from fem_impact.scene.material import SkinSpec
from fem_impact.solid.build import build
from fem_impact.solid.checkpoint import put_back, take_out
from fem_impact.solid.march import march
from fem_impact.solid.rodview import RodState
from fem_impact.solid.run import solve
from fem_impact.solid.watchers import Stopwatch, Watchers

# together these sets name every effect that finite elements can hold
SETS = (
    tuple(n for n in NAMES if n not in ("barrier-rigid", "barrier-elastic", "plate-bending", "contact-loss")),
    ("vibration", "friction", "barrier-rigid", "rod-plasticity", "large-rotation", "contact-heating"),
    ("vibration", "friction", "barrier-elastic", "plate-bending"),
    ("friction", "rod-plasticity", "barrier-rigid", "large-rotation"),
    ("vibration", "friction", "barrier-rigid", "large-rotation", "contact-loss"),
)


def short(effects, max_time=3e-5, **changes):
    scene = scenes.scene(*effects, length=0.06, v_n=-3.0, v_t=-3.0, max_time=max_time, **changes)
    if "machined-skin" in effects:
        harder = replace(scene.barrier.material, skin=SkinSpec(1.3, 0.5e-3))
        scene = replace(scene, barrier=replace(scene.barrier, material=harder))
    if "contact-loss" in effects:
        viscous = replace(scene.projectile.material, name="viscous", loss_factor=0.1)
        scene = replace(scene, projectile=replace(scene.projectile, material=viscous))
    if "plate-bending" in effects:
        scene = replace(scene, barrier=replace(scene.barrier, thickness=30e-3, support="infinite"))
    return replace(scene, save=replace(scene.save, frames=400, history_every=7))


def stop_at(step):
    """A progress report that interrupts the run."""

    def progress(report):
        if report.step >= step:
            raise KeyboardInterrupt

    return progress


def kept(scene, out, **options):
    """Run with files in ``out``, as `simulate` does."""
    return solve(Case.of(scene), RunOptions(out, stamp=stamp(scene), **options))


def interrupted(scene, out, step):
    out.mkdir()
    with pytest.raises(KeyboardInterrupt):
        kept(scene, out, progress=stop_at(step), checkpoint_s=0.0)
    return out


def outcome_numbers(result):
    return {k: v for k, v in reduce(result).to_dict().items() if k not in scenes.OF_THE_CLOCK}


def test_these_sets_name_every_effect():
    assert {name for names in SETS for name in names} == set(NAMES)


@pytest.mark.parametrize(
    "effects", [*(pytest.param(one, marks=pytest.mark.long) for one in SETS[:-1]), SETS[-1]]
)
def test_resumed_is_uninterrupted(effects, tmp_path):
    scene, whole = short(effects), tmp_path / "whole"
    whole.mkdir()
    expected = kept(scene, whole)
    parts = interrupted(scene, tmp_path / "parts", 200)
    assert (parts / CHECKPOINT).stat().st_size > 0
    found = kept(scene, parts, resume=True)
    assert found.steps == expected.steps >= 300
    assert outcome_numbers(found) == outcome_numbers(expected)
    assert (parts / "history.csv").read_bytes() == (whole / "history.csv").read_bytes()
    same_frames(read_fields(parts / "fields.vtkhdf"), read_fields(whole / "fields.vtkhdf"))
    assert (parts / "waves.h5").is_file() == ("vibration" in effects)
    if "vibration" in effects:
        found, expected = (read_waves(place / "waves.h5") for place in (parts, whole))
        assert (found.times == expected.times).all() and len(found.times) > 30
        assert (found.stretch == expected.stretch).all() and (found.bending == expected.bending).all()


@pytest.mark.slow
def test_a_run_on_a_plate_that_is_meshed_through_goes_on(tmp_path):
    scene = short(SETS[2])
    scene = replace(scene, barrier=replace(scene.barrier, thickness=5e-3))
    assert Case.of(scene).slots.bending is not None
    expected = kept(scene, tmp_path / "whole")
    found = kept(scene, interrupted(scene, tmp_path / "parts", 200), resume=True)
    assert found.accounts["plate"] > 0
    assert outcome_numbers(found) == outcome_numbers(expected)


@pytest.mark.long
def test_killed_after_its_last_step_a_run_does_not_go_on_past_its_end(tmp_path):
    scene = short(SETS[1])
    expected = kept(scene, tmp_path, checkpoint_s=0.0)  # a checkpoint whenever one may be written
    history = (tmp_path / "history.csv").read_bytes()
    found = kept(scene, tmp_path, resume=True)
    assert found.steps == expected.steps
    assert outcome_numbers(found) == outcome_numbers(expected)
    assert (tmp_path / "history.csv").read_bytes() == history


def test_a_resumed_run_can_tell_its_drift_before_the_next_sample(tmp_path):
    scene = short(SETS[3])
    scene = replace(scene, save=replace(scene.save, history_every=5000))
    told = []
    kept(scene, interrupted(scene, tmp_path / "parts", 200), progress=told.append, resume=True)
    first = next(one for one in told if one.step)
    assert 200 <= first.step < 5000 and first.energy_drift == 0.0  # that of the start


def same_frames(found, expected):
    assert len(expected.times) > 8
    assert (found.times == expected.times).all()
    for frame in range(len(expected.times)):
        for name in expected.point_names:
            assert (found.point_data(name, frame) == expected.point_data(name, frame)).all()
        for name in expected.cell_names:
            assert (found.cell_data(name, frame) == expected.cell_data(name, frame)).all()


# set anew by each step before it is read, or of the clock and the file: not in a checkpoint
WORK_SPACE = {
    *(
        "NodeProduct.moved",
        "NodeProduct.product",
        "ElasticRod.d",
        "ElasticRod.y",
        "MaxwellCells.w",
        "MaxwellCells.y",
    ),
    *(
        "Blocks.pressure",
        "Blocks.nodal",
        "YieldingZone.taken",
        "YieldingZone.room",
        "MassPoints.room",
    ),
    *(f"Points.{name}" for name in ("nodes", "weights", "normal", "target", "before", "p", "owner", "f")),
    *(
        "SurfaceContact.normals",
        "SurfaceContact.rod_normals",
        "HistoryWriter._due",
        "FieldWriter._begun",
        "FieldWriter._shapes",
    ),
}
OF_THE_FILE = {"History/writer.size", "Frames/writer.frames"}


def numbers(thing, name, seen):
    """Yield (name, value) of everything that can be reached from a thing but for its work space."""
    if isinstance(thing, (bool, int, float, str, np.ndarray)):
        yield name, np.array(thing)
    elif id(thing) not in seen:
        seen.add(id(thing))
        for part, value in parts(thing):
            if f"{type(thing).__name__}.{part}" not in WORK_SPACE:
                yield from numbers(value, f"{name}.{part}", seen)


def parts(thing):
    if isinstance(thing, dict):
        return thing.items()
    if is_dataclass(thing):
        return [(f.name, getattr(thing, f.name)) for f in fields(thing)]
    if hasattr(thing, "_asdict"):
        return thing._asdict().items()
    if isinstance(thing, (list, tuple)):
        return enumerate(thing)
    return vars(thing).items() if type(thing).__module__.startswith("fem_impact") else ()


class At:
    """Stops at a step, as the observer of checkpoints sees it."""

    every = 1

    def __init__(self, step):
        self.step = step

    def observe(self, state):
        return state.step >= self.step


class Run:
    """A run laid open: whatever moves in it can be reached from ``roots``."""

    def __init__(self, scene, out, go_on):
        planned = Case.of(scene)
        self.model = build(planned)
        self.state = self.model.initial_state()
        view = RodState.of(self.model)
        self.looking = Watchers.of(planned, self.model, view, out, go_on)
        self.holders = self.looking.holders(self.model, self.state, Stopwatch())

    def numbers(self):
        return dict(numbers((self.model, self.state, self.looking), "run", set()))

    def march(self, step):
        march(self.model, self.state, [*self.looking.all, At(step)])


def halted_run(scene, out):
    """A run at step 400, what of it a checkpoint keeps, and a new run of the scene beside it."""
    out.mkdir()
    run = Run(scene, out, go_on=False)
    run.march(400)
    run.model.book.outside = 1  # no node of these scenes leaves its zone
    return run, take_out(run.holders), Run(scene, out, go_on=True)


@pytest.fixture(scope="module")
def halted(tmp_path_factory):
    place = tmp_path_factory.mktemp("halted")
    return [halted_run(short(effects, 5e-5), place / str(i)) for i, effects in enumerate(SETS)]


@pytest.mark.long
def test_every_declared_part_moves(halted):
    """So the next test notices if any of them is left out."""
    moved = {}
    for _, kept, new in halted:
        first = take_out(new.holders)
        for name, value in kept.items():
            item = name.partition("-")[2]
            moved[item] = moved.get(item, False) or not np.array_equal(value, first[name])
    assert {item for item in moved if not moved[item]} == OF_THE_FILE


@pytest.mark.long
def test_whatever_moves_is_in_the_checkpoint(halted):
    """A part that moves and is not declared has its first value in the restored run."""
    for run, kept, new in halted:
        put_back(new.holders, kept)
        found, expected = new.numbers(), run.numbers()
        assert len(expected) > 150
        assert found.keys() == expected.keys()
        assert [name for name in expected if not same(found[name], expected[name])] == []


def same(found, expected):
    return found.dtype == expected.dtype and found.tobytes() == expected.tobytes()


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """A scene and the directory of its stopped run; tests copy it before they harm it."""
    scene = short(SETS[1])
    return scene, interrupted(scene, tmp_path_factory.mktemp("stopped") / "run", 200)


def refusal(scene, place):
    """The words with which the run is refused; the files stay as they were."""
    before = {path.name: path.read_bytes() for path in place.iterdir()}
    with pytest.raises(ResultError, match=r"Run again without resuming to start anew\.") as refused:
        kept(scene, place, resume=True)
    assert {path.name: path.read_bytes() for path in place.iterdir()} == before
    return str(refused.value)


def test_a_checkpoint_of_another_scene_is_refused(stopped):
    scene, place = stopped
    other = replace(scene, impact=replace(scene.impact, v_n=-2.9))
    assert "written with another scene;" in refusal(other, place)


def test_a_checkpoint_of_another_program_is_refused(stopped, monkeypatch):
    scene, place = stopped
    monkeypatch.setattr("fem_impact.run.program.source_digest", lambda: "0" * 64)
    assert "written with another sources;" in refusal(scene, place)


@pytest.mark.long
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
