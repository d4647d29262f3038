import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from result_maker import values

from fem_impact.errors import ResultError
from fem_impact.outcome.groups import ARMS
from fem_impact.outcome.keys import markdown_table
from fem_impact.outcome.record import KEYS, Outcome, installed_versions

TEXT = Outcome(values()).to_json()


def test_reads_back_what_was_written(tmp_path, record):
    written = Outcome(record)
    written.write(tmp_path / "outcome.json")
    read = Outcome.read(tmp_path / "outcome.json")
    assert read == written
    assert read.to_dict() == record


def test_file_is_flat_but_for_named_structures(record):
    held = json.loads(Outcome(record).to_json())
    nested = {name for name, value in held.items() if isinstance(value, dict | list)}
    assert nested == {"versions", "effects", "assumptions", "validity", "warnings", "contacts", "reasons"}


def test_numpy_values_become_plain(record):
    record |= {"mu": np.float64(0.5), "steps": np.int64(7), "finished": np.bool_(False)}
    outcome = Outcome(record)
    assert [type(outcome[name]) for name in ("mu", "steps", "finished")] == [float, int, bool]


def test_left_out_nullable_key_needs_a_reason(record):
    del record["mu"]
    with pytest.raises(ResultError, match=r'"mu" is null, and "reasons" does not say why'):
        Outcome(record)
    known = Outcome(record, {"mu": "no contact took place"})
    assert known["mu"] is None
    assert known.reason("mu") == "no contact took place"


def test_replace_drops_the_reason_of_a_known_key(record):
    banded = Outcome(record).replace(bands={"mu": 0.01})
    assert banded["bands"] == {"mu": 0.01}
    assert banded.reason("bands") is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mu": "0.5"}, r'"mu" = 0.5 must be a number'),
        ({"mu": float("nan")}, r'"mu" = nan must be finite'),
        ({"mu": True}, r'"mu" = True must be a number'),
        ({"steps": -1}, r'"steps" = -1 must be a whole number'),
        ({"finished": None}, r'"finished" = None must not be null'),
        ({"fidelity": "liquid"}, r'"fidelity" = liquid must be one of rigid, modal, solid'),
        ({"schema_version": 99}, r'"schema_version" = 99 is not the version 2'),
        ({"muu": 1.0}, r'unknown key "muu". Did you mean "mu"'),
        ({"effects": "friction"}, r'"effects" = friction must be a list of texts'),
        ({"contacts": [{"start_s": 0.0}]}, r"entries of exactly start_s, end_s"),
        ({"bands": {"speed": 1.0}}, r'names "speed", which is no numeric key'),
        ({"bands": {"mu": -1.0}}, r'gives "mu" a half-width'),
        ({"reasons": {"mu": "because"}}, r"reasons"),
    ],
)
def test_wrong_record_is_refused_with_file_key_and_value(record, change, message):
    with pytest.raises(ResultError, match=message) as caught:
        Outcome(record | change, source="here.json")
    assert str(caught.value).startswith("here.json: ")


def test_contact_must_not_end_before_it_starts(record):
    record["contacts"][0]["end_s"] = -1.0
    with pytest.raises(ResultError, match="ends before it starts"):
        Outcome(record)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not a readable JSON record"),
        ("[]", "holds a JSON list"),
        ("{}", "checksum_sha256.* is missing"),
        ('{"mu": NaN}', "NaN is no JSON number"),
        ('{"mu": 1, "mu": 2}', "a key stands twice"),
        ("[" * 100_000, "not a readable JSON record"),
    ],
)
def test_text_that_is_no_record(text, message):
    with pytest.raises(ResultError, match=message):
        Outcome.from_json(text)


def test_missing_file_and_binary_file(tmp_path):
    with pytest.raises(ResultError, match=r"outcome\.json: cannot be read"):
        Outcome.read(tmp_path / "outcome.json")
    (tmp_path / "outcome.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ResultError, match="not UTF-8 text at byte 0"):
        Outcome.read(tmp_path / "outcome.json")


def test_edited_number_is_noticed():
    with pytest.raises(ResultError, match="does not match the contents"):
        Outcome.from_json(TEXT.replace('"mu": 0.597', '"mu": 0.596'))


@given(st.integers(0, len(TEXT) - 3))
@settings(max_examples=40, deadline=None)
def test_truncated_text_is_refused(length):
    with pytest.raises(ResultError):
        Outcome.from_json(TEXT[:length])


@given(st.integers(0, len(TEXT) - 1), st.integers(0, 6))
@settings(max_examples=300, deadline=None)
def test_flipped_bit_is_refused_or_harmless(place, bit):
    damaged = TEXT[:place] + chr(ord(TEXT[place]) ^ 1 << bit) + TEXT[place + 1 :]
    try:
        read = Outcome.from_json(damaged)
    except ResultError:
        return
    assert read == Outcome(values())


def test_every_key_has_unit_and_meaning():
    assert len({key.name for key in KEYS}) == len(KEYS)
    for key in KEYS:
        assert key.meaning.endswith("."), key.name
        assert key.unit or key.kind not in ("number", "count"), key.name


@pytest.mark.parametrize("unit", ["J", "m", "kg", "rad", "s", "m_per_s", "rad_per_s", "m2"])
def test_name_ends_in_the_unit_of_the_table(unit):
    spelled = unit.replace("_per_", "/")
    named = {key.name for key in KEYS if key.name.endswith(f"_{unit}")}
    assert {key.name for key in KEYS if key.unit == spelled and key.kind == "number"} <= named


def test_markdown_has_a_row_for_every_key():
    rows = markdown_table().splitlines()
    assert len(rows) == len(KEYS) + 2
    assert all(row.count("|") == 6 for row in rows)


def test_every_arms_set_has_its_six_keys():
    names = {key.name for key in KEYS}
    for arms in ARMS:
        six = {f"d_c_{arms}_m", f"d_d_{arms}_m", f"e_{arms}", f"e_m_{arms}"}
        six |= {f"E_ln_{arms}_over_E_0", f"E_lt_{arms}_over_E_0"}
        assert six <= names


def test_versions_name_python_and_packages():
    versions = installed_versions()
    assert versions["numpy"] == np.__version__
    assert set(versions) == {"python", "numpy", "scipy", "scikit-fem", "numba", "fem-impact"}
