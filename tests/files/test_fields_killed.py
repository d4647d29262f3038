"""A writer killed between any two writes leaves every earlier frame readable."""

import io

import h5py
import numpy as np
import pytest

from fem_impact.files.fields import read_fields
from fem_impact.files.fields_write import FieldWriter, add_frame

NODES, CELLS = 90, 40
RNG = np.random.default_rng(1)


class Recorder(io.RawIOBase):
    """A file in memory that remembers each write: place and bytes."""

    def __init__(self, data):
        self.buffer, self.log = io.BytesIO(data), []
        self.seek, self.tell, self.readinto = self.buffer.seek, self.buffer.tell, self.buffer.readinto

    def write(self, data):
        self.log.append((self.buffer.tell(), bytes(data)))
        return self.buffer.write(data)

    def truncate(self, size=None):
        return self.buffer.truncate(size)


def fields_of(frame):
    displacement = np.full((NODES, 3), frame + 1.0)
    return {"displacement": displacement}, {"mises": np.full(CELLS, frame + 0.5)}


@pytest.fixture
def writer(tmp_path):
    cells = RNG.integers(0, NODES, (CELLS, 8))
    writer = FieldWriter(tmp_path / "fields.vtkhdf", RNG.random((NODES, 3)), cells, {"body": np.zeros(CELLS)})
    writer.append(0.0, *fields_of(0))
    return writer


def states(before, log):
    """Yield the file after each of the writes."""
    now = bytearray(before)
    yield bytes(now)
    for place, data in log:
        now.extend(bytes(max(0, place - len(now))))
        now[place : place + len(data)] = data
        yield bytes(now)


def killed_states(path, frame):
    """Add a frame; return the file as a kill at each moment would have left it."""
    before = path.read_bytes()
    recorder = Recorder(before)
    with h5py.File(recorder, "r+") as file:
        add_frame(file["VTKHDF"], frame * 1e-6, *fields_of(frame))
    path.write_bytes(recorder.buffer.getvalue())
    return list(states(before, recorder.log))


@pytest.mark.long
def test_every_earlier_frame_is_readable_at_any_moment(writer, tmp_path):
    killed = tmp_path / "killed.vtkhdf"
    tried = 0
    for frame in range(1, 130):
        kills = killed_states(writer.path, frame)
        # each frame costs time to check: those beside the borders of pieces, and a few more
        if frame % 16 in (0, 1) or frame < 4:
            for state in kills:
                killed.write_bytes(state)
                found = read_fields(killed)
                assert len(found.times) in (frame, frame + 1)
                for k in {0, frame // 2, len(found.times) - 1}:
                    assert (found.point_data("displacement", k) == k + 1.0).all()
                    assert (found.cell_data("mises", k) == k + 0.5).all()
                tried += 1
    assert tried > 300


def test_the_first_frame_is_there_or_not(tmp_path, monkeypatch):
    """It makes the places of all frames, so it is made in a copy: the file itself is never half made."""
    cells = RNG.integers(0, NODES, (CELLS, 8))
    writer = FieldWriter(tmp_path / "fields.vtkhdf", RNG.random((NODES, 3)), cells)
    before = writer.path.read_bytes()
    seen = []

    def looked_at(root, *rest):
        add_frame(root, *rest)
        root.file.flush()
        seen.append(writer.path.read_bytes())

    monkeypatch.setattr("fem_impact.files.fields_write.add_frame", looked_at)
    assert writer.append(0.0, *fields_of(0))
    assert seen == [before]
    assert writer.frames == 1


def test_frames_after_a_checkpoint_are_dropped_and_written_anew(writer):
    for frame in (1, 2, 3):
        writer.append(frame * 1e-6, *fields_of(frame))
    again = FieldWriter(writer.path, RNG.random((NODES, 3)), RNG.integers(0, NODES, (CELLS, 8)), go_on=True)
    again.frames = 2
    assert len(read_fields(writer.path).times) == 2
    again.append(5e-6, *fields_of(5))
    found = read_fields(writer.path)
    assert found.times.tolist() == [0.0, 1e-6, 5e-6]
    assert (found.point_data("displacement", 2) == 6.0).all()
    with pytest.raises(ValueError, match="holds 3 frames of the 4 written before"):
        again.frames = 4
