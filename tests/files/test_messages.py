"""What reaches a terminal is printable, and numbers in refusals are short."""

import h5py
import numpy as np
import pytest

from fem_impact.errors import FemImpactError, ResultError, SceneError, UsageError, did_you_mean, printable
from fem_impact.files.fields_read import read_fields
from fem_impact.files.fields_write import FieldWriter

HOSTILE = "a\x1b[31mred\x00\u202egnp\r\x9b"


def test_control_characters_are_escaped_in_every_message():
    messages = (
        str(SceneError("is not known.", key="id", value=HOSTILE, remedy=HOSTILE, source=HOSTILE)),
        str(UsageError(HOSTILE)),
        str(ResultError(f"{HOSTILE}: cannot be read.")),
        printable(HOSTILE),
    )
    for message in messages:
        assert message.isprintable()
        assert r"\x1b[31m" in message and r"\x00" in message and r"\u202e" in message
    assert printable("5 µm, 45°, café\nnext") == "5 µm, 45°, café\nnext"


@pytest.mark.parametrize(
    "line", [("check", HOSTILE.replace("\0", "")), ("run", "t5b", "--set", "title=" + HOSTILE)]
)
def test_no_control_character_of_a_value_reaches_the_terminal(cli, line):
    _, out, err = cli(*line, *(("--fidelity", "rigid") if line[0] == "run" else ()))
    assert out + err
    assert not {"\x1b", "\0", "\u202e", "\x9b"} & set(out + err)


@pytest.mark.parametrize(
    ("value", "shown"), [(0.00467862, "0.004679"), (0.25, "0.25"), (1 / 3, "0.3333"), (7, "7")]
)
def test_numbers_in_refusals_are_short(value, shown):
    assert str(SceneError("is too small.", key="radius", value=value)) == f"radius = {shown}: is too small."


def test_the_nearest_name_is_found_in_any_case():
    assert did_you_mean("Plane", ("plain", "A"), "Known: A.") == "Did you mean plain?"
    assert did_you_mean("MM", ("mm", "m"), "") == "Did you mean mm?"
    assert did_you_mean("xyz", ("plain", "A"), "Known: A.") == "Known: A."


@pytest.mark.parametrize(
    "name", ["Points", "Connectivity", "CellData/body", "Steps/Values", "PointData/displacement"]
)
def test_a_dataset_that_states_more_than_the_file_holds_is_refused(tmp_path, name):
    """A few bytes may state terabytes, which must neither be allocated nor called a lack of memory."""
    path, huge = tmp_path / "fields.vtkhdf", 2**40
    writer = FieldWriter(path, np.zeros((8, 3)), np.arange(8)[None], {"body": np.zeros(1)})
    writer.append(0.0, {"displacement": np.zeros((8, 3))})
    with h5py.File(path, "r+") as file:
        tail = file["VTKHDF"][name].shape[1:]
        del file["VTKHDF"][name]
        limits = (None, *tail) if name.startswith(("Steps", "PointData")) else None
        file["VTKHDF"].create_dataset(name, (huge, *tail), "f8", maxshape=limits, chunks=(16, *tail))
        if name == "Steps/Values":
            file["VTKHDF/Steps"].attrs["NSteps"] = huge
        if name == "PointData/displacement":
            file["VTKHDF/NumberOfPoints"][0] = huge
    if name == "PointData/displacement":
        fields = read_fields(path)
        with pytest.raises(FemImpactError) as caught:
            type(fields)(path, fields.times, np.broadcast_to(0.0, (huge, 3)), *_rest(fields)).point_data(
                "displacement", 0
            )
    else:
        with pytest.raises(FemImpactError) as caught:
            read_fields(path)
    assert isinstance(caught.value, ResultError)
    assert "more than the file has" in str(caught.value)


def _rest(fields):
    return fields.cells, fields.static, fields.point_names, fields.cell_names
