import doctest
import importlib
import json
import pickle
import tomllib
from dataclasses import FrozenInstanceError, fields, replace
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from outcome_maker import altered
from result_maker import values

import fem_impact
from fem_impact.errors import ResultError, UsageError
from fem_impact.outcome import groups, strikes
from fem_impact.outcome.check import SCHEMA_VERSION
from fem_impact.outcome.groups import ARMS, Energy, Heat
from fem_impact.outcome.keys import STATED, Unknown, known, or_none, unknown
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome, installed_versions
from fem_impact.outcome.shares import SHARES, shares
from fem_impact.pages.bibliography import references

OUTCOME = Outcome.from_dict(values())
TEXT = OUTCOME.to_json()


def test_reads_back_what_was_written(tmp_path, record):
    written = Outcome.from_dict(record)
    written.write(tmp_path / "outcome.json")
    read = Outcome.read(tmp_path / "outcome.json")
    assert read == written
    assert read.to_dict() == record
    assert Outcome.read(tmp_path) == written
    with pytest.raises(ResultError, match=r"none/outcome\.json: cannot be read"):
        (tmp_path / "none").mkdir()
        Outcome.read(tmp_path / "none")


@pytest.mark.parametrize("name", ["keys", "record"])
def test_examples_are_true(name):
    assert doctest.testmod(importlib.import_module(f"fem_impact.outcome.{name}")).failed == 0


def test_attributes_hold_the_flat_keys():
    assert OUTCOME.restitution.mu == 0.597
    assert OUTCOME.energy.vibration == 0.0004
    assert OUTCOME.restitution.paper.e == 0.25
    assert OUTCOME.contact.markers.Omega == 5.2
    assert OUTCOME.contact.intervals[1].start == 610e-6
    assert OUTCOME.contact.intervals[1].duration == pytest.approx(180e-6)
    for key in KEYS:
        if key.kind in ("number", "count", "flag", "text"):
            assert or_none(key.of(OUTCOME)) == values()[key.name], key.name


def test_every_key_has_an_attribute_of_its_own():
    assert len({key.path for key in KEYS}) == len({key.name for key in KEYS}) == len(KEYS)
    named = vars(groups) | vars(strikes)
    for name, stated in STATED.items():
        assert {*stated} <= {one.name for one in fields(named[name])}, name


def test_groups_are_frozen_and_changed_by_replace():
    with pytest.raises(FrozenInstanceError):
        OUTCOME.energy.vibration = 0.0
    changed = replace(OUTCOME, energy=replace(OUTCOME.energy, vibration=0.01))
    assert changed.to_dict() == values(E_vib_over_E_0=0.01)


def test_what_is_not_known_cannot_be_computed_with():
    damping = OUTCOME.energy.damping
    assert damping == Unknown("no damping effect was in the model")
    with pytest.raises(TypeError):
        damping + 1.0
    with pytest.raises(TypeError):
        format(damping, ".3g")
    for asked in (known, bool):
        with pytest.raises(ResultError, match="Not known: no damping effect was in the model"):
            asked(damping)
    assert (or_none(damping), known(0.0)) == (None, 0.0)
    assert OUTCOME.to_dict()["W_damping_over_E_0"] is None
    assert OUTCOME.reasons["W_damping_over_E_0"] == damping.reason


def test_a_group_of_which_nothing_is_known():
    heat = unknown(Heat, "off")
    assert repr(heat).startswith("Heat(not known: patch, power, flux,")
    assert set(replace(OUTCOME, heat=heat).reasons) >= {k.name for k in KEYS if k.path[0] == "heat"}


def test_texts_for_the_eye_are_short_and_have_units():
    assert repr(OUTCOME) == "Outcome('t5b', solid: e=0.25, mu=0.597, Omega=5.1 rad/s, E_vib/E_0=0.0004)"
    assert "Omega=5.1 rad/s" in repr(OUTCOME.motion)
    assert "not known: damping" in repr(OUTCOME.energy)
    assert "intervals=2 entries" in repr(OUTCOME.contact)


def test_docstrings_name_unit_and_meaning():
    assert "E_0 : J\n    Kinetic energy of the whole projectile at first contact." in Energy.__doc__


def test_an_outcome_travels_between_processes():
    assert pickle.loads(pickle.dumps(OUTCOME)) == OUTCOME


def test_an_estimate_is_the_limit_of_two_meshes_or_the_run_itself():
    mu = KEY_TABLE["mu"]
    assert OUTCOME.estimate(mu) == (0.597, None)
    assert altered(OUTCOME, mesh_limit={"mu": 0.6}).estimate(mu) == (0.597, None)  # a mean of one mesh
    assert altered(OUTCOME, mesh_limit={"mu": 0.6}, mesh_band={"mu": 0.01}).estimate(mu) == (0.6, 0.01)
    reduced = altered(OUTCOME, fidelity="modal", model_band={"mu": 0.02})
    assert reduced.estimate(mu) == (mu.of(OUTCOME), 0.02) and reduced.estimate("e_edge")[1] is None


def test_shares_stand_in_the_places_that_list_them():
    assert "numerical loss at contact" not in [share.label for share in shares("comparison")]
    assert "numerical loss at contact" in [share.label for share in shares("figure")]
    assert [share.of(OUTCOME.energy) for share in SHARES[:2]] == [0.06, 0.0004]
    assert all(share.key.path[0] == "energy" for share in SHARES)


def test_file_is_flat_but_for_named_structures(record):
    held = json.loads(Outcome.from_dict(record).to_json())
    nested = {name for name, value in held.items() if isinstance(value, dict | list)}
    assert nested == {"versions", "effects", "limitations", "contacts", "reasons"}


def test_numpy_values_become_plain():
    energy = replace(OUTCOME.energy, vibration=np.float64(0.5), below_floor=np.bool_(False))
    cost = replace(OUTCOME.cost, steps=np.int64(7))
    flat = replace(OUTCOME, energy=energy, cost=cost).to_dict()
    names = ("E_vib_over_E_0", "steps", "E_vib_below_floor")
    assert [type(flat[name]) for name in names] == [float, int, bool]


def test_what_is_no_number_is_refused_in_python_too():
    with pytest.raises(ResultError, match=r'"mu" = nan must be finite'):
        replace(OUTCOME, restitution=replace(OUTCOME.restitution, mu=float("nan")))


def test_a_null_key_needs_a_reason(record):
    record |= {"E_vib_over_E_0": None}
    with pytest.raises(ResultError, match=r'"E_vib_over_E_0" is null, and "reasons" does not say why'):
        Outcome.from_dict(record)
    record["reasons"] |= {"E_vib_over_E_0": "no modes"}
    assert Outcome.from_dict(record).energy.vibration == Unknown("no modes")


def test_a_record_of_an_earlier_version_is_refused_in_one_sentence():
    """Its keys are others, which is not what the user must hear."""
    from fem_impact.files.atomic import signed

    old = {"schema_version": 2, "mu": 0.5, "bands": None}
    text = json.dumps(signed(old))
    words = rf'^old.json: key "schema_version" = 2 is not the version {SCHEMA_VERSION} that .* compute'
    with pytest.raises(ResultError, match=words):
        Outcome.from_json(text, "old.json")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mu": "0.5"}, r'"mu" = 0.5 must be a number'),
        ({"mu": float("nan")}, r'"mu" = nan must be finite'),
        ({"mu": True}, r'"mu" = True must be a number'),
        ({"E_0_J": None}, r'"E_0_J" = None must not be null'),
        ({"steps": -1}, r'"steps" = -1 must be a whole number'),
        ({"finished": None}, r'"finished" = None must not be null'),
        ({"fidelity": "liquid"}, r'"fidelity" = liquid must be one of rigid, modal, solid'),
        ({"schema_version": 99}, rf'"schema_version" = 99 is not the version {SCHEMA_VERSION}'),
        ({"muu": 1.0}, r'unknown key "muu". Did you mean mu\?'),
        ({"effects": "friction"}, r'"effects" = friction must be a list of texts'),
        (
            {"limitations": [{"kind": "doubt", "text": "x"}]},
            r'whose "kind" must be one of input, model, range',
        ),
        ({"limitations": [{"text": "x"}]}, r"entries of exactly kind, text"),
        ({"contacts": [{"start_s": 0.0}]}, r"entries of exactly start_s, end_s"),
        ({"mesh_limit": {"speed": 1.0}}, r'names "speed", a key that meshes give no limit'),
        ({"mesh_limit": {"steps": 1.0}}, r'names "steps", a key that meshes give no limit'),
        ({"mesh_band": {"mu": 0.1}}, r'names "mu", which has no limit'),
        ({"mesh_limit": {"mu": 0.5}, "mesh_band": {"mu": -1.0}}, r"a half-width below zero"),
        ({"model_band": {"mu": -1.0}}, r"half-width below zero"),
        ({"mesh_limit": {"mu": "0.5"}}, r"must map names to finite numbers"),
        ({"reasons": {"mu": "because"}}, r"reasons"),
    ],
)
def test_wrong_record_is_refused_with_file_key_and_value(record, change, message):
    with pytest.raises(ResultError, match=message) as caught:
        Outcome.from_dict(record | change, source="here.json")
    assert str(caught.value).startswith("here.json: ")


def test_contact_must_not_end_before_it_starts(record):
    record["contacts"][0]["end_s"] = -1.0
    with pytest.raises(ResultError, match="ends before it starts"):
        Outcome.from_dict(record)


def test_an_entry_of_the_wrong_kind_is_named(record):
    record["contacts"][0]["impulse_n_Ns"] = "much"
    with pytest.raises(ResultError, match='has an entry whose "impulse_n_Ns" must be a number'):
        Outcome.from_dict(record)


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
    assert read == OUTCOME


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


def test_the_own_version_is_told_where_the_package_is_not_installed(monkeypatch):
    """As in a copy of the sources that runs without pip; the citation names the same version."""
    found = metadata.version

    def installed(name):
        if name == "fem-impact":
            raise metadata.PackageNotFoundError(name)
        return found(name)

    monkeypatch.setattr(metadata, "version", installed)
    root = Path(__file__).parents[2]
    assert installed_versions()["fem-impact"] == fem_impact.__version__
    citation = (root / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {fem_impact.__version__}\ndate-released: 20" in citation
    cited = references()[0].fields
    assert cited["version"] == fem_impact.__version__ and f"name: {cited['author'].strip('{}')}\n" in citation
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    assert "version" in project["project"]["dynamic"]
    assert project["tool"]["hatch"]["version"]["path"] == "fem_impact/version.py"


def test_a_notebook_shows_every_number_with_its_meaning(record):
    page = Outcome.from_dict(record)._repr_html_()
    assert page.count("<tr>") == 1 + sum(key.kind == "number" for key in KEYS)
    assert "Impulse ratio: tangential over normal impulse" in page


def test_an_estimate_is_asked_for_by_the_name_of_its_key():
    run = OUTCOME
    assert run.estimate("mu") == run.estimate(KEY_TABLE["mu"])
    with pytest.raises(UsageError, match=r"Did you mean mu\?"):
        run.estimate("muu")


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("vibration", "E_vib_over_E_0"),
        ("E_vibration_over_E_0", "E_vib_over_E_0"),
        ("peak_force", "peak_force_N"),
        ("omega", "Omega_rad_per_s"),
        ("e", "e_paper or e_edge or e_impulse"),
        ("e_m", "e_m_paper or e_m_edge or e_m_impulse"),
        ("E_ln", "E_ln_paper_over_E_0 or E_ln_edge_over_E_0 or E_ln_impulse_over_E_0"),
    ],
)
def test_a_key_is_found_by_the_name_of_its_attribute_and_without_its_unit(name, meant):
    with pytest.raises(UsageError) as caught:
        OUTCOME.estimate(name)
    assert f"Did you mean {meant}?" in str(caught.value)


@pytest.mark.parametrize(
    ("name", "value", "half", "ends"),
    [
        ("W_friction_over_E_0", 0.1, 0.3, (0.0, 0.4)),
        ("E_lt_edge_over_E_0", 0.1, 0.3, (-0.2, 0.4)),
        ("dent_depth_m", 1e-4, 3e-4, (0.0, 4e-4)),
        ("flash_rise_K", 100.0, 120.0, (0.0, 220.0)),
        ("flash_temperature_K", 393.15, 120.0, (293.15, 513.15)),
        ("V_n_m_per_s", 0.1, 0.3, (-0.2, 0.4)),
        ("dent_depth_m", -1e-5, 3e-4, (-1e-5, 2.9e-4)),
    ],
)
def test_a_band_ends_where_its_number_can_be(name, value, half, ends):
    """The table of a sweep had dents below 0 and temperatures below that of the surroundings."""
    hot = {"flash_rise_K": 100.0, "flash_temperature_K": 393.15}
    run = altered(OUTCOME, **hot | {name: value}, mesh_limit={name: value}, mesh_band={name: half})
    assert run.band_of(KEY_TABLE[name]) == pytest.approx(ends)


@pytest.mark.parametrize(
    ("key", "value", "text"),
    [("dent_volume_m3", 9.32e-11, "9.32e-11"), ("dent_depth_m", 1e-10, "0"), ("W_skin_over_E_0", 2e-10, "0")],
)
def test_round_off_is_told_as_none_and_a_small_volume_as_it_is(key, value, text):
    assert altered(OUTCOME, **{key: value}).told(key) == text
