"""Curves of brakes as charts: what the answer says, the same on the page and in the file, also on the way."""

import numpy as np
import pytest
from rich.console import Group

from beamdyn.common.screens.form_entries import tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.panels import with_other_curves
from brakes.app.program import BRAKES

SCREENS = {screen.name: (document, screen) for document in BRAKES.documents for screen in document.screens}
WITH_CHARTS = ["Drum brake", "Caliper", "Mechanism"]


def tables(name, **changed):
    document, screen = SCREENS[name]
    work = OpenDocument(document)
    work.entries = work.entries | changed
    return tables_of(work.needed(screen), work.inputs)


def charts(name, place=1.0, **changed):
    _, screen = SCREENS[name]
    return screen.charts(screen.solve(tables(name, **changed)), place)


def curves(found):
    return {curve.name: curve for chart in found for curve in chart.curves}


@pytest.mark.parametrize("name", WITH_CHARTS)
def test_the_file_has_the_curves_of_the_page(name):
    _, screen = SCREENS[name]
    answer = screen.solve(tables(name))
    panels = screen.draw(answer, 1.0).axes[1:]
    shown = screen.charts(answer, 1.0)
    assert len(shown) == len(panels) > 0
    for chart, panel in zip(shown, panels, strict=True):
        lines = {line.get_label(): line for line in panel.lines}
        for curve in chart.curves:
            np.testing.assert_array_equal(lines[curve.name].get_xdata(), curve.x)
            np.testing.assert_array_equal(lines[curve.name].get_ydata(), curve.y)


def test_the_largest_pressure_of_the_chart_is_that_of_the_table():
    _, screen = SCREENS["Drum brake"]
    answer = screen.solve(tables("Drum brake"))
    pressure = screen.charts(answer, 0.0)[0]
    for curve, shoe in zip(pressure.curves, answer.result.shoes, strict=True):
        assert curve.y.max() == pytest.approx(1e-6 * shoe.peak_pressure, rel=1e-3)  # 61 angles


def test_a_locked_drum_has_no_pressure_but_says_from_which_friction_on():
    (factors,) = charts("Drum brake", **{"brake.friction": "1.2"})
    (mark,) = [mark for mark in factors.marks if mark.text.startswith("locks at ")]
    assert factors.title == "Shoe factors" and mark.curve in {curve.name for curve in factors.curves}
    assert max(factors.curves[0].x) < mark.at < 1.2


def test_the_cursor_is_where_the_slider_is():
    begin, middle, end = (charts("Caliper", place)[0] for place in (0.0, 0.5, 1.0))
    x = end.curves[0].x
    assert (begin.cursor, middle.cursor, end.cursor) == pytest.approx((x[0], (x[0] + x[-1]) / 2, x[-1]))


@pytest.mark.parametrize("name", ["Caliper", "Mechanism"])
def test_curves_follow_while_a_point_is_held(name):
    """Fewer positions of the stroke, but each of them on the curve."""
    _, screen = SCREENS[name]
    full = curves(screen.charts(screen.solve(tables(name)), 1.0))
    held = curves(screen.charts(screen.solve(screen.coarser(tables(name))), 1.0))
    assert held.keys() == full.keys()
    for key, curve in held.items():
        assert len(curve.x) >= 11
        scale = np.abs(full[key].y).max()
        there = np.interp(curve.x, full[key].x, full[key].y)
        np.testing.assert_allclose(curve.y, there, rtol=0, atol=2e-3 * scale)  # chords of the finer one


def test_the_position_that_is_drawn_has_its_table():
    _, screen = SCREENS["Mechanism"]
    answer = screen.solve(tables("Mechanism"))
    titles = [str(part.renderables[0]) for part in screen.tables(answer) if isinstance(part, Group)]
    for place, where in ((0.0, "as drawn"), (1.0, "14 mm of hand")):
        (drawing,) = screen.drawings(answer, place)[0]
        assert where in drawing.title
        assert any("forces" in title and where in title for title in titles)


def test_the_chart_has_room_for_the_other_design():
    """A larger clearance takes a longer stroke: the axis holds it, and its curve is pale."""
    here, there = charts("Caliper"), charts("Caliper", **{"dimensions.clearance": "2 mm"})
    for chart, one, other in zip(with_other_curves(here, there, "other"), here, there, strict=True):
        assert chart.x.high == other.x.high > one.x.high
        assert [curve.pale for curve in chart.curves] == [False] * len(one.curves) + [True] * len(
            other.curves
        )
