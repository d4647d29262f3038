import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
import result_maker

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.files.fields import read_fields
from fem_impact.files.fields_write import FieldWriter

POINTS, CELLS = result_maker.grid((2, 1, 1))


def frame(number):
    """Point and cell data that name their frame."""
    moved = np.full((len(POINTS), 3), number) + POINTS
    return {"displacement": moved, "velocity": -moved}, {"mises": np.full(len(CELLS), 10.0 * number)}


def writer(path):
    """A field file of two cells."""
    return FieldWriter(path, POINTS, CELLS, {"body": np.array([0, 1])})


def vtk_steps(path):
    """Times, and per step the displacement, mises and body arrays, as VTK's own reader gives them."""
    import pyvista
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

    reader = pyvista.get_reader(str(path)).reader
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS())
    steps = []
    for now in times:
        reader.UpdateTimeStep(now)
        steps.append(pyvista.wrap(reader.GetOutput()).copy())
    return times, steps


def test_own_reader_gives_back_every_frame(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    assert [fields.append(0.5 * k, *frame(k)) for k in range(3)] == [True] * 3
    read = read_fields(fields.path)
    assert read.times.tolist() == [0.0, 0.5, 1.0]
    assert (read.points == POINTS).all()
    assert (read.cells == CELLS).all()
    assert read.static["body"].tolist() == [0, 1]
    assert (read.point_names, read.cell_names) == (("displacement", "velocity"), ("mises",))
    for k in range(3):
        assert np.allclose(read.point_data("velocity", k), -k - POINTS)
        assert read.cell_data("mises", k).tolist() == [10.0 * k] * 2


def test_vtk_reader_gives_right_data_at_every_time_while_frames_are_added(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(1e-5, *frame(1))  # VTK tells no times before the second
    for count in range(2, 5):
        fields.append(1e-5 * count, *frame(count))
        if count == 4:
            fields.pack()
            with h5py.File(fields.path) as file:
                assert {file["VTKHDF"][name].compression for name in ("Points", "CellData/mises")} == {"gzip"}
        times, steps = vtk_steps(fields.path)
        assert np.allclose(times, 1e-5 * np.arange(1, count + 1))
        for number, grid in enumerate(steps, start=1):
            assert np.allclose(grid.point_data["displacement"], number + POINTS)
            assert grid.cell_data["mises"].tolist() == [10.0 * number] * 2
            assert grid.cell_data["body"].tolist() == [0, 1]
    assert fields.warnings == ()


def test_vtk_cells_have_their_volume(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    fields.append(1.0, *frame(1))
    sizes = vtk_steps(fields.path)[1][1].compute_cell_sizes(length=False, area=False)
    assert np.allclose(sizes.cell_data["Volume"], 0.5)


def test_mesh_is_stored_once(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    for k in range(3):
        fields.append(float(k), *frame(k))
    with h5py.File(fields.path) as file:
        assert file["VTKHDF/Points"].shape == (len(POINTS), 3)
        assert file["VTKHDF/CellData/body"].shape == (2,)
        assert file["VTKHDF/PointData/velocity"].shape == (3 * len(POINTS), 3)


HOLD = """
import sys, h5py, time
with h5py.File(sys.argv[1], "r"):
    print("held", flush=True)
    time.sleep(float(sys.argv[2]))
"""


def held_by_reader(path, seconds):
    child = subprocess.Popen([sys.executable, "-c", HOLD, str(path), str(seconds)], stdout=subprocess.PIPE)
    assert child.stdout.readline() == b"held\n"
    return child


def test_reader_that_keeps_the_file_costs_a_frame_and_never_the_run(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    with held_by_reader(fields.path, 60) as child:
        assert fields.append(0.25, *frame(1)) is False
        child.kill()
    assert fields.append(0.5, *frame(2)) is True
    assert len(fields.warnings) == 1
    assert "the frame at 0.25 s was dropped" in fields.warnings[0]
    assert read_fields(fields.path).times.tolist() == [0.0, 0.5]


def test_short_lock_costs_nothing(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    with held_by_reader(fields.path, 0.12):
        assert fields.append(0.25, *frame(1)) is True


def test_vanished_file_drops_frames_with_a_warning(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.path.unlink()
    assert fields.append(0.0, *frame(0)) is False
    assert "dropped" in fields.warnings[0]


def test_full_disk_drops_the_frame_and_keeps_the_file(tmp_path, monkeypatch):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    usage = type("Usage", (), {"free": 1000})
    monkeypatch.setattr("shutil.disk_usage", lambda folder: usage)
    assert fields.append(1.0, *frame(1)) is False
    assert "the disk is full" in fields.warnings[0]
    assert read_fields(fields.path).times.tolist() == [0.0]


def test_frame_that_was_begun_and_not_counted_is_written_over(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    fields.append(1.0, *frame(1))
    with h5py.File(fields.path, "r+") as file:
        file["VTKHDF/Steps"].attrs["NSteps"] = 1
    fields.append(2.0, *frame(2))
    read = read_fields(fields.path)
    assert read.times.tolist() == [0.0, 2.0]
    assert read.cell_data("mises", 1).tolist() == [20.0, 20.0]


ENDLESS = """
import itertools, sys
sys.path[:0] = sys.argv[2:]
from test_fields import frame, writer
fields = writer(sys.argv[1])
for number in itertools.count():
    fields.append(float(number), *frame(number))
"""


@pytest.mark.long
def test_killed_run_leaves_readable_fields(tmp_path):
    path = tmp_path / "fields.vtkhdf"
    here = Path(__file__).parent
    child = subprocess.Popen([sys.executable, "-c", ENDLESS, path, here, here.parent])
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and (not path.exists() or path.stat().st_size < 100_000):
        time.sleep(0.02)
    child.send_signal(signal.SIGKILL)
    child.wait()
    read = read_fields(path)
    last = len(read.times) - 1
    assert last > 3
    assert read.cell_data("mises", last).tolist() == [10.0 * last] * 2


@pytest.mark.parametrize(
    ("points", "cells", "static", "message"),
    [
        (POINTS[:, :2], CELLS, {}, "points must have shape"),
        (POINTS, CELLS[:, :4], {}, "cells must have shape"),
        (POINTS, CELLS + 20, {}, "cells name points"),
        (POINTS, CELLS, {"body": np.zeros(3)}, "cell data body"),
    ],
)
def test_wrong_mesh_is_refused(tmp_path, points, cells, static, message):
    with pytest.raises(ValueError, match=message):
        FieldWriter(tmp_path / "fields.vtkhdf", points, cells, static)
    assert list(tmp_path.iterdir()) == []


def test_wrong_field_is_refused(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    points, cells = frame(0)
    with pytest.raises(ValueError, match="point data displacement"):
        fields.append(0.0, {"displacement": np.zeros((3, 3))}, cells)
    fields.append(0.0, points, cells)
    with pytest.raises(ValueError, match="the first one"):
        fields.append(1.0, {"displacement": points["displacement"]}, cells)


def test_place_that_cannot_be_written(tmp_path):
    (tmp_path / "run").write_text("a file")
    with pytest.raises(OutputPathError, match="cannot be written"):
        writer(tmp_path / "run" / "fields.vtkhdf")


def test_reading_what_is_not_there(tmp_path):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    read = read_fields(fields.path)
    with pytest.raises(ResultError, match=r'no PointData "stress"; it holds displ.* save.fields = "all"'):
        read.point_data("stress", 0)
    with pytest.raises(ResultError, match="frame 1 is asked for, it holds 1"):
        read.cell_data("mises", 1)
    with pytest.raises(ResultError, match="no such field file"):
        read_fields(tmp_path / "other.vtkhdf")


@pytest.mark.parametrize("keep", [0, 50, 900])
def test_truncated_field_file_is_refused(tmp_path, keep):
    fields = writer(tmp_path / "fields.vtkhdf")
    fields.append(0.0, *frame(0))
    fields.path.write_bytes(fields.path.read_bytes()[:keep])
    with pytest.raises(ResultError, match="not a readable field file"):
        read_fields(fields.path)


def put(root, name, values):
    """Replace a dataset by one with these values; one that grows keeps growing."""
    limits = (None, *np.shape(values)[1:]) if root[name].maxshape[0] is None else None
    del root[name]
    root.create_dataset(name, data=values, maxshape=limits, chunks=limits and True)


FORGED = {
    "cells name points -1": lambda root: root["Connectivity"].write_direct(np.full(16, -1)),
    "there are 12": lambda root: root["Connectivity"].write_direct(np.full(16, 2**62)),
    "cells must be whole numbers": lambda root: put(root, "Connectivity", np.zeros(16)),
    "cannot reshape": lambda root: put(root, "Connectivity", np.zeros(15, int)),
    "Points holds 1 values that are not finite": lambda root: root["Points"].__setitem__((0, 1), np.nan),
    "points must have shape": lambda root: put(root, "Points", np.zeros((12, 2))),
    "Values holds 1 values that are not finite": lambda root: root["Steps/Values"].__setitem__(1, np.nan),
    "is not after 2 s": lambda root: put(root, "Steps/Values", [2.0, 1.0]),
    "is not after 1 s": lambda root: put(root, "Steps/Values", [1.0, 1.0]),
    "must be numbers": lambda root: put(root, "Steps/Values", [b"0.0", b"soon"]),
    "times of 9 frames are stated": lambda root: root["Steps"].attrs.__setitem__("NSteps", 9),
    "times of -1 frames are stated": lambda root: root["Steps"].attrs.__setitem__("NSteps", -1),
    "invalid literal": lambda root: root["Steps"].attrs.__setitem__("NSteps", "many"),
    "cell data body": lambda root: put(root, "CellData/body", [0, 0, 1]),
}


@pytest.mark.parametrize("reason", FORGED)
def test_forged_mesh_or_times_are_refused(tmp_path, reason):
    fields = writer(tmp_path / "fields.vtkhdf")
    for number in range(2):
        fields.append(float(number), *frame(number))
    with h5py.File(fields.path, "r+") as file:
        FORGED[reason](file["VTKHDF"])
    with pytest.raises(ResultError, match=rf"fields\.vtkhdf: .*{reason}"):
        read_fields(fields.path)


@pytest.mark.parametrize(
    ("harm", "reason"),
    [
        (lambda root: root["Steps/PointDataOffsets/displacement"].__setitem__(1, -12), "start at row -12"),
        (lambda root: root["Steps/PointDataOffsets/displacement"].__setitem__(1, 0), "start at row 0"),
        (lambda root: root["PointData/displacement"].__setitem__((13, 0), np.inf), "not finite"),
        (lambda root: put(root, "PointData/displacement", np.zeros((24, 1))), r"has shape \(12, 1\)"),
        (lambda root: put(root, "PointData/displacement", np.zeros((20, 3))), r"has shape \(8, 3\)"),
    ],
)
def test_forged_data_of_a_frame_are_refused(tmp_path, harm, reason):
    fields = writer(tmp_path / "fields.vtkhdf")
    for number in range(2):
        fields.append(float(number), *frame(number))
    with h5py.File(fields.path, "r+") as file:
        harm(file["VTKHDF"])
    with pytest.raises(ResultError, match=reason):
        read_fields(fields.path).point_data("displacement", 1)


def test_every_frame_is_a_pyvista_grid_at_its_time(tmp_path):
    fields = read_fields(result_maker.write_fields(tmp_path / "f.vtkhdf", frames=3, across=4, along=4).path)
    listed = list(fields.grids())
    assert [time for time, _ in listed] == fields.times.tolist()
    time, grid = listed[2]
    assert grid.n_cells == len(fields.cells) and grid.field_data["time_s"][0] == time
    assert np.allclose(grid.points, fields.points + fields.point_data("displacement", 2))
    assert set(grid.cell_data.keys()) == {"body", "mises", "plastic_strain"}
    assert np.array_equal(grid.cell_data["mises"], fields.cell_data("mises", 2))
    with pytest.raises(ResultError, match="frame 3 is asked for"):
        fields.grid(3)


def test_strains_are_those_of_the_deformation_and_probes_take_the_nearest_place(tmp_path):
    """A stretch of 10 %, a shear of 6 %, then a turn by a right angle, of which strains are free."""
    fields = writer(tmp_path / "fields.vtkhdf")
    F = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) @ [
        [1.1, 0.06, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ]
    for number, moved in enumerate((POINTS, POINTS @ F.T)):
        fields.append(
            float(number), {"displacement": moved - POINTS}, {"mises": np.array([3.0, 4.0 + number])}
        )
    read = read_fields(fields.path)
    wanted = [[0.105, 0.033, 0.0], [0.033, 0.0018, 0.0], [0.0, 0.0, 0.0]]
    assert read.strain(1) == pytest.approx(np.array([wanted] * 2), abs=1e-6)
    far = POINTS.max(axis=0) * 1.01
    assert read.probe("mises", far).tolist() == [4.0, 5.0]
    assert read.probe("strain", far)[1] == pytest.approx(np.array(wanted), abs=1e-6)
    assert read.probe("displacement", far)[1] == pytest.approx((F - np.eye(3)) @ POINTS.max(axis=0))
    with pytest.raises(ResultError, match='"speed"'):
        read.probe("speed", far)
