"""What reaches a terminal is printable, and numbers in refusals are short."""

import io
import json
import re
import sys
import tokenize
from pathlib import Path

import h5py
import numpy as np
import outcome_maker
import pytest

import fem_impact
from fem_impact.cli.parser import Options
from fem_impact.cli.run import print_outcome
from fem_impact.cli.terminal import chosen_meter, printable_streams
from fem_impact.errors import (
    FemImpactError,
    ResultError,
    SceneError,
    UsageError,
    did_you_mean,
    in_options,
    printable,
)
from fem_impact.files.fields import read_fields
from fem_impact.files.fields_write import FieldWriter
from fem_impact.progress import Progress

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
        assert r"\u001b[31m" in message and r"\u0000" in message and r"\u202e" in message
    assert printable("5 µm, 45°, café\nnext") == "5 µm, 45°, café\nnext"


@pytest.mark.parametrize(
    "line", [("check", HOSTILE.replace("\0", "")), ("run", "t5b", "--set", "title=" + HOSTILE)]
)
def test_no_control_character_of_a_value_reaches_the_terminal(cli, line):
    _, out, err = cli(*line, *(("--fidelity", "rigid") if line[0] == "run" else ()))
    assert out + err
    assert not {"\x1b", "\0", "\u202e", "\x9b"} & set(out + err)


def hostile_file(name, text):
    """Write a file whose name and contents hold control characters; return its path."""
    path = Path(HOSTILE.replace("\0", "") + name)
    path.write_text(text)
    return path


CSV = "test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s,a\x1b]0;x\x07\u202e\n"
ROWS = "\x1b[31m,-1.5,-1.6,0.4,-0.4,3.6,0\n\u2066,-1.4,-1.6,0.3,-0.4,3.7,0\n"
ROD = ("--length", "80 mm", "--diameter", "19 mm", "--angle", "45 deg")


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_no_control_character_of_a_file_reaches_the_terminal(cli, more):
    """Names of files, labels and columns are the user's; a JSON document stays one."""
    code, out, err = cli("coefficients", hostile_file(".csv", CSV + ROWS), *ROD, *more)
    assert code == 0 and not err
    assert out.replace("\n", "").isprintable()
    if more:
        assert "\x1b[31m" in json.loads(out)["file"]


def test_a_forged_record_prints_no_control_character(capsys):
    limited = [{"kind": "run", "text": HOSTILE}] * 2
    notes = {"scene_title": HOSTILE, "limitations": limited, "stopped_because": HOSTILE}
    with printable_streams():
        print_outcome(outcome_maker.outcome(**notes), Path(HOSTILE))
    out = capsys.readouterr().out
    assert out.count(r"\u001b[31m") == 3
    assert out.replace("\n", "").isprintable()


def test_every_text_of_the_program_passes_one_place():
    """Nothing but a stream of the command writes to standard output or error."""
    for path in Path(fem_impact.__file__).parent.rglob("*.py"):
        if path.parent.name != "cli":
            assert not re.search(r"print\(|sys\.std(out|err)\.", _code(path)), path


def _code(path):
    """Return the code of a module without its texts."""
    tokens = tokenize.generate_tokens(io.StringIO(path.read_text()).readline)
    return "".join(token.string for token in tokens if token.type != tokenize.STRING)


def test_a_progress_line_cannot_be_forged(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.delenv("NO_COLOR", raising=False)
    with printable_streams():
        meter = chosen_meter(Options())
        meter(Progress(1e-6, 1e-3, 7, 0.0, "free", note="a\rb\x1b[2K[bold]"))
        meter.close()
    assert r"a\rb\u001b[2K[bold]  t 1/1000 us" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("value", "shown"), [(0.00467862, "0.004679"), (0.25, "0.25"), (1 / 3, "0.3333"), (7, "7")]
)
def test_numbers_in_refusals_are_short(value, shown):
    assert str(SceneError("is too small.", key="radius", value=value)) == f"radius = {shown}: is too small."


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        (("--set", "impact.angle_rad=1.6789012345"), "angle = 96.2 deg: "),
        (("--set", "projectile.diameter='1000.00012 mm'"), "diameter = 1000.0001 mm: "),
        (("--set", "projectile.diameter_m=1.23456789"), "diameter = 1.23e+03 mm: "),
        (("--set", "accuracy.tip_size_m=0.00567862"), 'tip_size = "5.68 mm": '),
        (("--set", "projectile.tip_radius='12.3456789 mm'"), 'tip_radius = "12.3 mm": '),
        (("--set", "surface.friction=-0.123456789"), "friction = -0.123: "),
    ],
)
def test_refused_values_have_the_users_unit_and_few_digits(cli, line, shown):
    code, _, err = cli("check", "t5b", *line)
    assert code == 3
    assert shown in err


def test_a_refused_drop_names_what_the_user_stated(cli):
    rod = ("--length", "80 mm", "--diameter", "19.123456789 mm", "--angle", "45 deg")
    _, _, err = cli("assess", *rod, "--height", "1000000 m", "--surface", "machined")
    assert '--height "1e+06 m": must be above 0 and below 1000 m' in err
    _, _, err = cli("coefficients", "x.csv", *rod, "--tip-radius", "12.3456789 mm")
    assert "<= 9.56 mm (the rod's radius), got 12.3 mm" in err


def test_the_nearest_name_is_found_in_any_case():
    assert did_you_mean("Plane", ("plain", "A"), "Known: A.") == "Did you mean plain?"
    assert did_you_mean("MM", ("mm", "m"), "") == "Did you mean mm?"
    assert did_you_mean("xyz", ("plain", "A"), "Known: A.") == "Known: A."


def test_a_wrong_letter_is_likelier_than_a_letter_too_many():
    lengths = ("m", "mm", "cm", "in")
    assert did_you_mean("mn", lengths, "") == "Did you mean mm?"
    assert did_you_mean("mmm", lengths, "") == "Did you mean mm?"
    assert did_you_mean("m", lengths, "") == "Did you mean m?"
    assert did_you_mean("angla", ("angles", "angle"), "") == "Did you mean angle?"


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


def test_arguments_in_a_message_are_options_of_the_command_that_has_them():
    said = 'tip_radius="3": no unit. Write tip_radius="3 mm", vary={...}, impact.out=1; another out=.'
    told = '--tip-radius "3": no unit. Write --tip-radius "3 mm", vary={...}, impact.out=1; another --out.'
    assert in_options(said, {"tip_radius", "out"}) == told
    assert in_options("Leave out heat=True, or 'heat=True'.", {"heat"}) == "Leave out --heat, or 'heat=True'."


def test_an_error_speaks_python_from_python_and_options_on_the_command_line(cli):
    with pytest.raises(SceneError, match=r'^fidelity="best": is not a fidelity of a verdict'):
        fem_impact.assess(fem_impact.load("t5b"), fidelity="best")
    _, _, err = cli("cost", "t5b", "--of", "E_all", "--target", "5 %")
    assert '--of "E_all": is not a quantity of interest' in err
