"""How a form reads what people type: bare numbers, decimal commas, slopes in %."""

import math

import pytest

from beamdyn.app.program import BEAMDYN
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.varied_inputs import numbers
from beamdyn.common.screens.form_entries import in_unit, is_bare, read_entry, unit_of, units_of, usual_unit
from brakes.app.program import BRAKES

DOCUMENTS = {d.name: d for d in (*BRAKES.documents, *BEAMDYN.documents)}


def entry(path, document="forklift"):
    made = DOCUMENTS[document]
    return next(i for i in made.inputs(made.base_entries) if i.path == path)


READ = {
    ("25", "stop.speed", "km/h"): "25 km/h",
    ("25", "stop.speed", "m/s"): "25 m/s",
    ("25,5", "stop.speed", "km/h"): "25.5 km/h",
    ("1,5 m", "truck.wheelbase", "mm"): "1.5 m",
    (",5 m", "truck.wheelbase", "mm"): ".5 m",
    ("-1,2e1", "truck.load_cg_x", "cm"): "-1.2e1 cm",
    ("0,35", "stop.friction", ""): "0.35",
    ("5", "stop.slope", "%"): "5 %",
    ("2,5 %", "stop.slope", "deg"): "2.5 %",
}
AS_TYPED = (
    *("20 km/h", "", "fast", "1.234,5 m", "1,234,567 m", "nan", "inf", "[1, 2]", "20 s"),
    *("1e400 m", "--1", "25 km/h x"),
)


@pytest.mark.parametrize(("typed", "path", "unit"), READ)
def test_number_is_read_in_the_unit_shown_and_said(typed, path, unit):
    found = read_entry(typed, entry(path), unit)
    assert found.text == READ[typed, path, unit]
    assert found.remark == f"read as {found.text}"


@pytest.mark.parametrize("typed", AS_TYPED)
def test_what_is_a_quantity_or_none_is_left_to_the_checks(typed):
    found = read_entry(typed, entry("stop.speed"), "km/h")
    assert (found.text, found.remark) == (typed, "")


@pytest.mark.parametrize(
    ("typed", "text"),
    [
        ("26.9, 4", '["26.9 mm", "4 mm"]'),
        ("(26,9; 4)", '["26.9 mm", "4 mm"]'),
        ("2.69 cm, -4 mm", '["2.69 cm", "-4 mm"]'),
    ],
)
def test_a_point_is_read_without_brackets_and_quotes(typed, text):
    given = read_entry(typed, entry("dimensions.side_pivot", "caliper"), "mm")
    assert (given.text, given.remark) == (text, f"read as {text}")


@pytest.mark.parametrize("typed", ['["26.5 mm", "4 mm"]', "26.9", "26.9, four", "1, 2, 3", ""])
def test_what_is_no_pair_is_left_to_the_checks(typed):
    given = read_entry(typed, entry("dimensions.side_pivot", "caliper"), "mm").text
    assert given == typed or "," not in typed


def test_words_and_choices_are_left_alone():
    for path, document in (("caliper", "caliper"), ("title", "caliper"), ("brake.assembly", "drum")):
        assert read_entry("1,5", entry(path, document), "").text == "1,5"


@pytest.mark.parametrize("document", DOCUMENTS.values(), ids=lambda d: d.name)
def test_reading_is_stable_for_every_number(document):
    for one in numbers(document.inputs(document.base_entries)):
        if one.path in document.base_entries:
            text = read_entry("0,5", one, usual_unit(one.quantity.unit)).text
            assert read_entry(text, one, "another").text == text
            assert unit_of(text, one) == usual_unit(one.quantity.unit)


def test_bare_numbers():
    assert is_bare(" 25 ") and is_bare("0,5") and not is_bare("25 m") and not is_bare("")


# Slopes -------------------------------------------------------------------------------------------------


def test_slope_in_per_cent_is_a_rise_over_the_level():
    slope = entry("stop.slope").quantity
    assert slope.parse("100 %") == pytest.approx(math.pi / 4, rel=1e-15)
    assert slope.parse("30%") == pytest.approx(math.atan(0.3), rel=1e-15)


@pytest.mark.parametrize("unit", ["deg", "rad", "%"])
def test_slope_goes_to_another_unit_and_back(unit):
    assert "%" in units_of(entry("stop.slope"))
    there = in_unit("12.5 %", entry("stop.slope").quantity, unit)
    assert there.endswith(unit)
    back = in_unit(there, entry("stop.slope").quantity, "%")
    assert float(back.removesuffix(" %")) == pytest.approx(12.5, rel=1e-8)  # ten digits are written


@pytest.mark.parametrize("text", ["x %", "%", "nan %", "1e400 %", "1 2 %"])
def test_what_is_no_slope_is_refused(text):
    with pytest.raises(ValueError, match="%"):
        entry("stop.slope").quantity.parse(text)


def test_file_may_give_a_slope_in_per_cent_but_no_other_angle():
    document = DOCUMENTS["forklift"]
    text = document.base.replace('"0.3019 rad"', '"30 %"')
    assert document.opened(text, "file")["stop.slope"] == "30 %"
    with pytest.raises(ConfigError, match="face_tilt"):
        document.opened(document.base.replace('"19.7 deg"', '"30 %"'), "file")
