"""Numbers with units, as people write them."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamdyn.common.edge.units import _COMMON, _convert, _parse, quantity, show, unit_as_written

FINITE = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("0.2 mm", "m", 0.0002),
        ("0.2mm", "m", 0.0002),
        (" -2.5e-1  m ", "m", -0.25),
        (".5 m", "m", 0.5),
        ("5. m", "m", 5.0),
        ("2 ft", "m", 0.6096),
        ("3 µm", "m", 3e-6),
        ("3 μm", "m", 3e-6),
        ("200 GPa", "Pa", 200e9),
        ("0.2 N/mm2", "Pa", 0.2e6),
        ("88.36 deg", "rad", math.radians(88.36)),
        ("180°", "rad", math.pi),
        ("1 turn", "rad", 2 * math.pi),
        ("525 rpm", "rad/s", 525 * 2 * math.pi / 60),
        ("90 deg/s", "rad/s", math.pi / 2),
        ("5 Hz", "Hz", 5.0),
        ("7850 kg/m3", "kg/m3", 7850.0),
        ("7850 kg/m^3", "kg/m3", 7850.0),
        ("7850 kg/m**3", "kg/m3", 7850.0),
        ("7850 kg / m³", "kg/m3", 7850.0),
        ("7850 kg m-3", "kg/m3", 7850.0),
        ("7.85 g/cm3", "kg/m3", 7850.0),
        ("2 N m2", "N m2", 2.0),
        ("2 N*m^2", "N m2", 2.0),
        ("2 N·m²", "N m2", 2.0),
        ("2 kg m3/s2", "N m2", 2.0),
        ("2 Nm", "N m", 2.0),
        ("9.81 m/s2", "m/s2", 9.81),
        ("9.81 m/s/s", "m/s2", 9.81),
        ("20 g mm2", "kg m2", 2e-8),
        ("20 degC", "K", 293.15),
        ("5 %", "", 0.05),
        ("0.5", "", 0.5),
        (2, "", 2.0),
    ],
)
def test_value_in_si(text, unit, value):
    assert quantity(text, unit) == pytest.approx(value, rel=4e-16)


def test_revolutions_a_minute():
    assert quantity("525 rpm", "rad/s") == pytest.approx(54.98, abs=0.005)


def test_conversion_is_decimal():
    """No digit is lost between units of a power of ten: stations and lengths can be compared."""
    assert quantity("5 cm", "m") == quantity("50 mm", "m") == quantity("50000 um", "m") == 0.05


@pytest.mark.parametrize(
    ("text", "unit", "remedy"),
    [
        (0.2, "m", 'give a unit, e.g. "0.2 m" or "0.2 mm"'),
        ("0.2", "m", 'give a unit, e.g. "0.2 m" or "0.2 mm"'),
        (0, "kg/m3", 'give a unit, e.g. "0 kg/m3"'),
        ("0.2 kg", "m", 'a unit of mass where length is wanted; give e.g. "0.2 mm"'),
        ("5 m", "", "a unit of length where plain number is wanted"),
        ("5 %", "rad", 'a unit of plain number where angle is wanted; give e.g. "5 deg"'),
        ("2 N m", "N m2", 'a unit of moment where bending stiffness is wanted; give e.g. "2 N m2"'),
        ("7850 kg/m4", "kg/m3", 'a unit of kg/m**4 where density is wanted; give e.g. "7850 kg/m3"'),
        (
            "5 Hz",
            "rad/s",
            'ambiguous for an angular speed; give "300 rpm" if turns are meant, rad/s if radians',
        ),
        ("5 s^-1", "rad/s", "ambiguous for an angular speed; give rpm if turns are meant"),
        ("5 rpm", "Hz", 'a unit of angular speed where frequency is wanted; give e.g. "5 Hz"'),
        ("2 parsnips", "m", 'unknown unit parsnips; give length, e.g. "2 mm"'),
        ("2 kg m5 m", "kg m5", "where a quantity in kg m5 is wanted"),
        ("0.2 mm mm", "m", "a unit of area where length is wanted"),
        ("nan m", "m", 'not a finite number; give e.g. "1 mm"'),
        ("-inf m", "m", "not a finite number"),
        (math.nan, "m", "not a finite number"),
        ("1e999 m", "m", "out of range; give a finite number in m"),
        ("1e308 km", "m", "out of range"),
        ("1e-99999999999999999999 m", "m", "out of range"),
        ("1 dBm", "W", "out of range"),
        ("", "m", "not a number with a unit"),
        ("mm", "m", "not a number with a unit"),
        ("9**9**9 m", "m", "not a number with a unit"),
        ("2 A0", "m", "not a number with a unit"),
        ("2*3 m", "m", "not a number with a unit"),
        ("1,5 mm", "m", 'a decimal comma; give a point, "1.5 mm"'),
        ("2 m^(1+1)", "m2", "not a number with a unit"),
        ("٣ m", "m", "not a number with a unit"),
        (True, "m", 'a truth value; give a quantity, e.g. "1 mm"'),
        (None, "m", "not a number with a unit"),
        ([1], "m", 'a list where one quantity is wanted; give e.g. "1 mm"'),
        (["50 mm"], "m", 'a list where one quantity is wanted; give it without brackets, "50 mm"'),
        ({"a": 1}, "m", 'a table where one quantity is wanted; give e.g. "1 mm"'),
    ],
)
def test_refusal_gives_value_and_remedy(text, unit, remedy):
    with pytest.raises(ValueError) as refusal:
        quantity(text, unit)
    assert str(refusal.value).startswith(f"{show(text)}: ")
    assert remedy in str(refusal.value)


@given(FINITE, st.sampled_from(["m", "kg/m3", "N m2", "rad", "rad/s", "Pa"]))
def test_round_trip(number, unit):
    assert quantity(f"{number!r} {unit}", unit) == number


@given(
    st.floats(-1e6, 1e6, allow_subnormal=False),
    st.sampled_from([("mm", "m", 1e-3), ("GPa", "Pa", 1e9), ("deg", "rad", math.pi / 180)]),
)
def test_round_trip_through_another_unit(number, units):
    text, unit, factor = units
    assert quantity(f"{number!r} {text}", unit) == pytest.approx(number * factor, rel=1e-15, abs=1e-300)


@given(
    st.text() | st.from_regex(r"-?[0-9.eE+-]{1,9} ?[A-Za-zµ°%/*^ 0-9]{0,9}", fullmatch=True),
    st.sampled_from(["m", ""]),
)
def test_any_text_is_a_finite_number_or_refused(text, unit):
    try:
        assert math.isfinite(quantity(text, unit))
    except ValueError as refusal:
        assert len(str(refusal)) < 200


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "true"),
        (0.5, "0.5"),
        ('a "b"', r'"a \"b\""'),
        ([1, "m"], '[1, "m"]'),
        ({"a": [True, {"b": 1}]}, "{ a = [true, ...] }"),
        ({}, "{}"),
    ],
)
def test_show_writes_toml(value, text):
    assert show(value) == text


def test_show_is_short():
    assert len(show(["mm"] * 1000)) == 60


@pytest.mark.parametrize(("unit", "given"), [(unit, given) for unit in _COMMON for given in _COMMON[unit]])
@given(number=st.decimals(-1e6, 1e6, places=6))
def test_common_units_are_those_of_pint(unit, given, number):
    kind, wanted = _parse(given), _parse(unit)
    assert quantity(f"{number:f} {given}", unit) == _convert(f"{number:f}", kind, wanted)  # to the last bit
    assert unit_as_written(f"1 {given}", unit)[1](float(number)) == pytest.approx(
        _convert(repr(float(number)), wanted, kind), rel=4e-16
    )
