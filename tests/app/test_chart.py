"""Charts as options of the page's component: what is drawn is what was given, light, inert and readable."""

import json
import re

import numpy as np
import pytest

from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartBand, ChartCurve, ChartMark, ChartPoints
from beamdyn.common.drawing.strokes import INKS
from beamdyn.common.screens.chart_options import chart_colours, options_of, thinned

X = ChartAxis("speed", "rad/s", low=0.0, high=10.0)
Y = ChartAxis("frequency", "Hz")


def made(*curves, **more):
    return Chart("A chart", X, Y, curves, **more)


def series(chart, name):
    return next(s for s in options_of(chart)["series"] if s["name"] == name)


def test_axes_are_named_by_quantity_and_unit():
    options = options_of(made())
    assert options["xAxis"]["name"] == "speed [rad/s]"
    assert options["yAxis"]["name"] == "frequency [Hz]"
    assert ChartAxis("relative error").title == "relative error"


def test_curve_is_as_given_with_gaps_where_it_is_not_known():
    x, y = np.array([0.0, 2.0, 5.0, 8.0, 10.0]), np.array([1.0, 2.0, np.nan, 3.0, 3.0])
    data = series(made(ChartCurve("mode 1", x, y)), "mode 1")["data"]
    assert data == [[0, 1], [2, 2], [5, None], [8, 3], [10, 3]]


@pytest.mark.parametrize("y, marked", [([1, 2, 3], False), ([np.nan, 2, np.nan], True)])
def test_value_between_gaps_is_seen(y, marked):
    curve = ChartCurve("mode 1", np.arange(3.0), np.array(y, dtype=float))
    found = series(made(curve), "mode 1")
    assert found["showSymbol"] is marked
    dots = [point["value"] for point in found["data"] if isinstance(point, dict)]
    assert dots == ([[1.0, 2.0]] if marked else [])


def test_close_up_far_from_zero_keeps_its_places_apart():
    x = 1000.0 + np.linspace(0, 0.01, 101)
    data = series(made(ChartCurve("tip", x, np.sin(x))), "tip")["data"]
    assert np.allclose([p[0] for p in data], x, rtol=0, atol=0.01 * 1e-4)  # 1e-4 of the axis is not seen


def test_a_curve_that_varies_little_is_no_staircase_and_rounding_is_not_drawn():
    x = np.linspace(0.0, 1.0, 101)
    data = series(made(ChartCurve("advantage", x, 4.257 + 1e-5 * x)), "advantage")["data"]
    assert len({y for _, y in data}) == 101
    noise = 1e-15 * np.cos(40 * x)
    assert {y for _, y in series(made(ChartCurve("hand", x, 100.0 + noise)), "hand")["data"]} == {100.0}


def test_long_curve_is_light_and_keeps_its_ends_and_peaks():
    t = np.linspace(0, 30, 20_001)
    tip = np.sin(400 * t)
    tip[12_345] = 7.0
    tip[15_000] = np.nan
    x, y = thinned(t, tip, 400)
    assert len(x) <= 400
    assert np.all(np.diff(x) > 0)
    assert (x[0], x[-1]) == (0.0, 30.0)
    assert np.nanmax(y) == 7.0
    assert np.nanmin(y) == np.nanmin(tip)
    assert len(json.dumps(options_of(made(ChartCurve("tip", t, tip))))) < 20_000


def test_marks_bands_and_cursor_stand_where_they_belong():
    chart = made(
        marks=[ChartMark(3.0, "critical"), ChartMark(np.inf, "never")],
        bands=[ChartBand(3.0, 10.0, "unstable"), ChartBand(1.0, 1.2, "narrow")],
        cursor=2.0,
    )
    found = series(chart, "marks")
    lines = found["markLine"]["data"]
    assert [line["xAxis"] for line in lines] == [3.0, 2.0]
    assert lines[0]["name"] == "critical"
    (wide, end), (narrow, _) = found["markArea"]["data"]
    assert (wide["xAxis"], end["xAxis"], wide["name"]) == (3.0, 10.0, "unstable")
    assert narrow["name"] == ""  # it has no room for its text


def test_there_is_always_a_series_of_marks_so_that_old_ones_go():
    empty = series(made(), "marks")
    assert empty["markLine"]["data"] == [] and empty["markArea"]["data"] == []


def test_every_colour_is_one_of_the_page_with_one_for_pictures():
    chart = made(
        *(ChartCurve(f"mode {i}", np.arange(2.0), np.arange(2.0)) for i in range(8)),
        points=[ChartPoints("resonance", [(1.0, 2.0, "here")])],
        cursor=1.0,
    )
    text = json.dumps(options_of(chart))
    paints = set(re.findall(r"var\(--([\w-]+),(#[0-9a-f]{6})\)", text))
    more = dict(re.findall(r"--([\w-]+):(#[0-9a-f]{6})", chart_colours(":root")))
    dark = dict(re.findall(r"--([\w-]+):(#[0-9a-f]{6})", chart_colours(".dark", dark=True)))
    assert more.keys() == dark.keys()
    assert {role.removesuffix("-area") for role, _ in paints} <= {"paper", *INKS, *more}
    assert not re.findall(r'"#', text.replace('"backgroundColor": "#ffffff"', ""))  # of a saved picture


@pytest.mark.parametrize(
    "hostile", ["<img src=x onerror=alert(1)>", "</script><script>alert(1)</script>", "{a}{b}"]
)
def test_names_are_text_and_no_option_is_a_script(hostile):
    chart = made(ChartCurve(hostile, np.arange(2.0), np.arange(2.0)), marks=[ChartMark(1.0, hostile)])
    options = options_of(chart)
    assert options["tooltip"]["renderMode"] == "richText"

    def keys(part):
        if isinstance(part, dict):
            yield from part
            for value in part.values():
                yield from keys(value)
        elif isinstance(part, list):
            for value in part:
                yield from keys(value)

    assert not [key for key in keys(options) if key.startswith(":")]  # which the page would run


def axes_over(y, **of_y):
    curve = ChartCurve("error", np.arange(1.0, len(y) + 1), np.array(y))
    return options_of(Chart("Errors", X, ChartAxis("error", **of_y), [curve]))["yAxis"]


def test_axis_over_decades_ends_with_whole_ones_and_has_a_number_at_each():
    axis = axes_over([0.4, 3e-7, np.nan, 0.0], logarithmic=True)
    assert axis["min"] == pytest.approx(1e-7) and axis["max"] == pytest.approx(1.0)
    assert axis["axisLabel"]["customValues"] == pytest.approx([10.0**k for k in range(-7, 1)])
    assert axes_over([0.4, 3e-7], logarithmic=True, high=5.0)["max"] == 5.0
    for nothing in ([-1.0], [np.nan]):
        axis = axes_over(nothing, logarithmic=True)
        assert 0 < axis["min"] < axis["max"]


@pytest.mark.parametrize("high, shown", [(70.0, True), (71.0, False), (150.0, True), (69.87, False)])
def test_number_at_the_end_of_an_axis_is_left_out_where_it_would_cover_another(high, shown):
    assert axes_over([1.0, 2.0], low=0.0, high=high)["axisLabel"]["showMaxLabel"] is shown


def test_words_say_what_it_shows():
    chart = made(ChartCurve("mode 1", [0], [1]), marks=[ChartMark(1.0, "critical speed 164 rad/s")])
    assert chart.words == "A chart: frequency [Hz] over speed [rad/s]; mode 1; critical speed 164 rad/s"


def test_curves_that_are_compared_with_differ_by_their_dashes_and_have_no_dots_in_the_legend():
    x = np.arange(3.0)
    lines = [ChartCurve(name, x, x, dashed=True, pale=True) for name in ("road -", "road +", "2 per rev")]
    measured = ChartCurve("measured", x, x, points=True)
    chart = made(measured, *lines)
    kinds = [series(chart, line.name)["lineStyle"]["type"] for line in lines]
    assert len({json.dumps(kind) for kind in kinds}) == 3
    entries = {each["name"]: each for each in options_of(chart)["legend"]["data"]}
    assert [*entries] == ["measured", *(line.name for line in lines)]
    assert all(entries[line.name]["itemStyle"]["opacity"] == 0 for line in lines)
    assert "itemStyle" not in entries["measured"]


def test_a_wide_chart_leaves_no_room_for_rows_of_a_legend_that_it_does_not_have():
    x = np.arange(3.0)
    options = options_of(made(*(ChartCurve(f"elements, graded, extrapolated {i}", x, x) for i in range(8))))
    wide, narrow = options["media"]
    assert wide["query"] == {"minWidth": 700} and "query" not in narrow  # which holds where no other does
    assert narrow["option"]["grid"]["bottom"] == options["grid"]["bottom"]
    assert wide["option"]["grid"]["bottom"] <= narrow["option"]["grid"]["bottom"] - 30


def test_a_mark_has_its_text_where_curves_leave_room():
    chart = made(marks=[ChartMark(1.0, "critical"), ChartMark(2.0, "the motion's speed", at_foot=True)])
    critical, motion = options_of(chart)["series"][0]["markLine"]["data"]
    assert "position" not in critical["label"] and motion["label"]["position"] == "insideStartTop"


def test_what_is_said_at_the_pointer_has_the_units_of_the_axes():
    label = options_of(made())["xAxis"]["axisPointer"]["label"]
    assert label["formatter"] == "speed {value} rad/s\nfrequency [Hz]"


def channels(colour):
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)])


@pytest.mark.parametrize("dark", [False, True])
def test_colours_of_curves_are_told_apart(dark):
    more = re.findall(r":(#[0-9a-f]{6})", chart_colours(":root", dark))
    inks = [INKS[role] for role in ("normal", "friction", "reaction")]
    colours = [channels(each) for each in (*(ink.dark_line if dark else ink.line for ink in inks), *more)]
    apart = [np.abs(a - b).max() for i, a in enumerate(colours) for b in colours[:i]]
    assert min(apart) >= 60


def test_curves_stay_what_they_are_whichever_way_they_are_zoomed():
    options = options_of(made())
    zooms = [*options["dataZoom"], options["toolbox"]["feature"]["dataZoom"]]
    assert [zoom["filterMode"] for zoom in zooms] == ["none", "none"]  # points outside are kept
