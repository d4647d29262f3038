"""Quantities: exact to write and read, strict about units."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fem_impact.errors import SceneError
from fem_impact.scene.inputs import inputs
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_dict
from fem_impact.scene.units import DIMENSIONS, format_quantity, parse_number, parse_quantity

magnitudes = st.floats(1e-200, 1e30)
finite = magnitudes | magnitudes.map(lambda x: -x) | st.just(0.0)
PLAIN = [(d.name, u) for d in DIMENSIONS.values() for u in d.units if u.factor == 1.0 and not u.offset]
DECIMAL = [(name, u.symbol, u.power) for name, u in PLAIN]


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("240 mm", "length", 0.24),
        ("430 degC", "temperature", 703.15),
        ("0 °C", "temperature", 273.15),
        ("53 W/(m K)", "conductivity", 53.0),
        ("53 W/(mK)", "conductivity", 53.0),
        ("440 J/(kg K)", "heat capacity", 440.0),
        ("0.35 mm", "length", 0.00035),
        ("0.7mm", "length", 0.0007),
        ("2.1 m/s", "speed", 2.1),
        ("-1.5 m / s", "speed", -1.5),
        ("219 GPa", "stress", 219e9),
        ("546 MPa", "stress", 546e6),
        ("7850 kg/m3", "density", 7850.0),
        ("7.85 g/cm³", "density", 7850.0),
        ("4.43 t/m3", "density", 4430.0),
        ("4.43 kg/dm³", "density", 4430.0),
        ("2.5 ms", "time", 0.0025),
        ("400 µs", "time", 0.0004),
        ("45 rad/s", "angular speed", 45.0),
        ("45 deg", "angle", math.pi / 4),
        ("17°", "angle", math.radians(17)),
        ("60 rpm", "angular speed", 2 * math.pi),
        ("1e-3 m", "length", 0.001),
    ],
)
def test_reads_quantities_as_the_nearest_float(text, dimension, expected):
    assert parse_quantity(text, dimension, "key") == expected


@pytest.mark.parametrize(
    ("value", "dimension", "text"),
    [(53.0, "conductivity", "53 W/(m K)"), (440.0, "heat capacity", "440 J/(kg K)")],
)
def test_writes_metres_and_kelvin_apart_so_that_nobody_reads_millikelvin(value, dimension, text):
    assert format_quantity(value, dimension) == text


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (240, "bare number"),
        (0.24, "bare number"),
        ("240", "no unit"),
        ("240 kg", "not a unit of length"),
        ("240 MM", "Did you mean mm"),
        ("80 mn", "Did you mean mm"),
        ("2,4 m", "decimal comma"),
        ("nan m", "finite"),
        ("-inf m", "finite"),
        ("1e400 m", "too large"),
        ("1e999999999999 m", "too large"),
        ("", "cannot be read"),
        ("mm 240", "cannot be read"),
        ("1_000 mm", "not a unit"),
        ("٣ mm", "cannot be read"),
        ("1" * 70 + " mm", "cannot be read"),
        (True, "true/false"),
        (None, "NoneType"),
        ([240, "mm"], "list"),
        ({"value": 240}, "table"),
    ],
)
def test_refuses_what_is_no_length_and_names_key_and_remedy(value, words):
    with pytest.raises(SceneError) as caught:
        parse_quantity(value, "length", "length")
    assert words in str(caught.value)
    assert str(caught.value).startswith("length")


def test_a_bare_number_is_answered_with_both_ways_to_write_it():
    with pytest.raises(SceneError, match=r'"240 mm", or as length_m in SI'):
        parse_quantity(240, "length", "length", "length_m")


def test_no_key_is_proposed_that_does_not_exist():
    steel, rod = "rod-steel", to_dict(load("quick"))["projectile"]
    segments = [{"to": 0.02, "material": steel}, {"material": steel}]
    laid = {key: value for key, value in rod.items() if key != "material"} | {"segments": segments}
    for body in (laid, {"profile": [[0.0, "5 mm"], ["80 mm", "8 mm"]], "material": steel}):
        data = to_dict(load("quick")) | {"projectile": body}
        data.pop("measured", None)
        with pytest.raises(SceneError, match='such as "240 mm"') as refused:
            read_dict(data)
        assert "in SI" not in str(refused.value)


@pytest.mark.parametrize("value", ["3", True, None, [1.0]])
def test_a_pure_number_must_be_a_number(value):
    with pytest.raises(SceneError, match="nu"):
        parse_number(value, "nu")


def test_an_integer_beyond_floats_is_refused():
    with pytest.raises(SceneError, match="too large"):
        parse_number(10**400, "nu")


@given(finite, st.sampled_from(sorted(DIMENSIONS)))
def test_writing_and_reading_gives_the_same_float(value, dimension):
    text = format_quantity(value, dimension)
    assert parse_quantity(text, dimension, "key") == value


@pytest.mark.parametrize("degrees", ["17", "33.3", "12.345678901234567"])
def test_angles_are_written_in_degrees(degrees):
    assert format_quantity(math.radians(float(degrees)), "angle") == f"{degrees} deg"


@given(st.decimals(-1_000_000, 1_000_000, places=6), st.sampled_from(DECIMAL))
def test_decimal_units_round_once(number, unit):
    dimension, symbol, power = unit
    assert parse_quantity(f"{number:f} {symbol}", dimension, "key") == float(number.scaleb(power))


@given(finite, st.sampled_from(DECIMAL), st.sampled_from(DECIMAL))
def test_a_unit_of_another_dimension_is_never_taken(value, written, read):
    if written[0] == read[0]:
        return
    with pytest.raises(SceneError):
        parse_quantity(f"{value!r} {written[1]}", read[0], "key")


@given(st.text(max_size=80), st.sampled_from(sorted(DIMENSIONS)))
def test_any_text_is_read_as_finite_or_refused(text, dimension):
    try:
        value = parse_quantity(text, dimension, "key")
    except SceneError:
        return
    assert math.isfinite(value)


def test_rounding_of_a_unit_is_not_shown_among_the_inputs():
    scene = replace_all(
        load("t5b"), {"projectile.length": "50.00000000000001 mm", "impact.angle": "33.3333333 deg"}
    )
    shown = {row[0]: row[1] for row in inputs(scene).rows}
    assert (shown["projectile.length"], shown["impact.angle"]) == ("50 mm", "33.3333333 deg")
    assert scene.projectile.length != 0.05


@pytest.mark.parametrize(
    ("value", "dimension", "si"),
    [
        ("30 kgf/mm2", "stress", 9.80665e6),
        ("1 rev/s", "angular speed", 2 * math.pi),
        ("490 lb/ft^3", "density", 0.45359237 / 0.3048**3),
        ("2 st", "mass", 14 * 0.45359237),
        ("5 1/ms", "strain rate", 1e3),
        ("8 kn", "speed", 1852 / 3600),
        ("3 tsi", "stress", 2240 * 4.4482216152605 / 0.0254**2),
        ("3 lb in2", "inertia", 0.45359237 * 0.0254**2),
        ("3 lb ft2", "inertia", 0.45359237 * 0.3048**2),
        ("2 kip", "force", 4448.2216152605),
        ("1 yd", "length", 0.9144),
        ("1 gon", "angle", math.pi / 200),
        ("1 cal/(g K)", "heat capacity", 4186.8),
    ],
)
def test_a_unit_that_is_not_taken_is_told_in_one_that_is(value, dimension, si):
    """The nearest letters were proposed: rad/s for rev/s, N/mm2 for kgf/mm2, t for st, degC for degF."""
    with pytest.raises(SceneError) as refused:
        parse_quantity(value, dimension, "key")
    told = re.search(r"\)\. 1 \S+ is (.*?)\. Write", str(refused.value))
    assert told and parse_quantity(told[1], dimension, "key") == pytest.approx(si, rel=1e-5)


def test_a_fahrenheit_is_no_slip_of_a_degree_celsius():
    with pytest.raises(SceneError, match=r"x degF are \(x - 32\) / 1\.8 degC\. Write") as refused:
        parse_quantity("900 °F", "temperature", "key")
    assert "Did you mean" not in str(refused.value)


def test_every_other_unit_is_told_in_one_that_is_taken():
    for name, dimension in DIMENSIONS.items():
        for symbol, told in dimension.others:
            assert dimension.unit(symbol) is None
            if name != "temperature":
                parse_quantity(told.removesuffix(" of weight"), name, symbol)


def test_other_units_of_density_are_worked_out_from_their_parts():
    """A kg/mm3 was told to be 1000 t/m3, a thousandth of it."""
    masses = {"mg": 1e-6, "g": 1e-3, "kg": 1.0, "lb": 0.45359237}
    lengths = {"mm3": 1e-9, "cm3": 1e-6, "m3": 1.0, "ft3": 0.3048**3, "l": 1e-3, "L": 1e-3, "ml": 1e-6}
    for symbol, told in DIMENSIONS["density"].others:
        mass, volume = symbol.split("/")
        found = parse_quantity(told, "density", symbol)
        assert found == pytest.approx(masses[mass] / lengths[volume], rel=1e-5), symbol
