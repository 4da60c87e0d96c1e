"""What a screen shows first, while the whole answer is on its way: a picture, few digits, nothing fitted."""

import math
import re

import numpy as np
import pytest

pytest.importorskip("nicegui")

from beamdyn.analyses.about_motion import harvest
from beamdyn.app.program import BEAMDYN
from beamdyn.app.scene_screen import bar
from beamdyn.common.edge.console import table
from beamdyn.common.edge.rendering import html, in_haste, picture, svg, svg_in_haste
from beamdyn.common.results.columns import ShownUnit
from beamdyn.common.results.one_line import few_digits, number
from beamdyn.common.results.pictures import new_figure
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.form_entries import tables_of
from beamdyn.common.screens.open_document import ShownAnswer
from beamdyn.studies.beside_data.frequency_comparison import FrequencyComparison
from beamdyn.studies.beside_data.identify import Identification

SCREENS = {screen.name: (document, screen) for document in BEAMDYN.documents for screen in document.screens}


def first_of(name):
    document, screen = SCREENS[name]
    found = page_tasks.solve_for_drawing(document, screen, document.base_entries)
    assert isinstance(found, ShownAnswer), found
    return found


def test_digits_are_those_of_a_preliminary_result():
    mm = ShownUnit("mm", 1e3)
    assert (number(66.0234, "Hz"), number(1234.4), mm.say(1.2344, 5)) == ("66.02 Hz", "1234", "1234.4 mm")
    with few_digits():
        assert (number(66.0234, "Hz"), number(1234.4), mm.say(1.2344, 5)) == ("66 Hz", "1230", "1230 mm")
    assert number(66.0234, "Hz") == "66.02 Hz"


@pytest.mark.parametrize("name", ["Compare", "Identify"])
def test_data_stand_beside_the_model_before_anything_is_fitted(name):
    found = first_of(name)
    assert found.is_rough and not found.is_whole
    assert isinstance(found.answer.result, FrequencyComparison) and found.answer.result.explanations == ()
    assert found.picture.startswith('<img class="drawing"')


def test_a_preliminary_answer_is_completed_by_the_one_that_was_asked_for():
    document, screen = SCREENS["Identify"]
    whole = page_tasks.solve(document, screen, document.base_entries, first_of("Identify"))
    assert isinstance(whole, ShownAnswer) and whole.is_whole and not whole.is_rough
    assert isinstance(whole.answer.result, Identification)


def test_screens_of_charts_have_no_other_picture():
    found = first_of("Frequencies")
    assert found.is_rough and found.picture == ""
    assert all(len(words.value.split()[0]) <= 4 for words in found.headline[:2])  # "66.1 Hz"


def test_a_preliminary_harvest_is_at_few_of_the_speeds_and_at_the_ends():
    asked = np.linspace(10.0, 20.0, 101)
    few = []

    def at(_, **options):
        few.append(options["speeds"])

    assert harvest.sooner is not None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("beamdyn.analyses.about_motion.harvested", at)
        harvest.sooner(None, speeds=asked, modes=3, tolerance=1e-5)
    assert len(few[0]) == 11 and few[0][0] == 10.0 and few[0][-1] == 20.0 and np.isin(few[0], asked).all()


def test_a_picture_in_haste_has_the_layout_of_the_last_one():
    def drawn(highest, label):
        figure = new_figure(4.0, 3.0)
        ax = figure.subplots()
        ax.loglog([1.0, 10.0], [1.0, highest])
        ax.set_ylabel(label)
        return in_haste(figure)

    first, second = drawn(1e6, "layout"), drawn(1e6, "layout")
    places = [figure.axes[0].get_position().bounds for figure in (first, second)]
    assert places[0] == places[1] and second.get_layout_engine() is None
    assert len(second.axes[0].yaxis.get_minorticklocs()) == 0
    assert len(second.axes[0].xaxis.get_minorticklocs()) > 0  # a decade keeps its small ticks
    with_label = drawn(1e6, "two lines\nof a label").axes[0].get_position()
    assert with_label.x0 > second.axes[0].get_position().x0


def test_a_picture_in_haste_reuses_a_frame_that_has_not_changed():
    def drawn(highest, title):
        figure = new_figure(4.0, 3.0)
        ax = figure.subplots()
        ax.plot([0.0, 1.0], [0.0, highest])
        ax.set(xlabel="a frame", ylim=(0.0, 10 * np.ceil(highest / 10)), title=title)
        return figure

    def texts(made):
        return sorted(re.findall("<!-- (.*) -->", made))

    for highest, title in ((7.0, "seen once"), (8.0, "twice"), (99.0, "another"), (9.0, "again")):
        made, usual = svg_in_haste(drawn(highest, title)), svg(in_haste(drawn(highest, title)))
        assert texts(made) == texts(usual) and {"a frame", title} <= {*texts(made)}
        assert made.startswith("<?xml") and made.count("<svg") == made.count("</svg>") == 1
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("matplotlib.axis.Axis.draw", lambda it, _: it.get_visible() and pytest.fail("drawn"))
        assert texts(svg_in_haste(drawn(6.0, "again"))) == texts(made)


def test_a_picture_in_haste_does_not_reuse_a_frame_of_another_style():
    def drawn(grid):
        figure = new_figure(4.0, 3.0)
        ax = figure.subplots()
        ax.plot([0.0, 1.0])
        ax.grid(grid)
        return figure

    def lines(made):
        return made.count("<path") + made.count("<use")

    for _ in range(3):
        with_grid = svg_in_haste(drawn(True))
    plain, usual = svg_in_haste(drawn(False)), svg(in_haste(drawn(False)))
    assert lines(plain) == lines(usual) < lines(with_grid)


def test_a_broad_picture_takes_the_whole_width_of_a_page():
    def made(width):
        return picture(svg(new_figure(width, 3.0)), "")

    assert made(4.0).startswith('<img class="drawing" ') and made(9.0).startswith(
        '<img class="drawing broad"'
    )


def test_a_bar_in_a_table_is_styled_as_one_on_a_phone():
    made = html([table("", ("left out", "size"), [("shear", bar(0.1))], (0, 1))])
    assert '<td class="words">shear</td><td class="words bar">' in made


def test_a_picture_that_another_process_makes_comes_first_in_haste():
    found = first_of("Loads")
    assert found.picture.startswith('<img class="drawing"') and not found.is_whole


def test_a_preliminary_best_resistance_is_sought_less_finely():
    document, screen = SCREENS["Best resistance"]
    first = first_of("Best resistance")
    whole = page_tasks.solve(document, screen, document.base_entries, first)
    assert first.is_rough and isinstance(whole, ShownAnswer)
    found, best = first.answer.result, whole.answer.result
    assert found.resistance == pytest.approx(best.resistance, rel=0.03)  # 1e-2 of a decade is 2.3 %
    assert len(found.resistances) < len(best.resistances) / 2
    assert math.isnan(found.total_error[0]) and best.total_error[0] < 1e-2
    assert "unresolved" not in first.headline[0].value


def test_a_preliminary_harvest_has_no_error_and_the_power_of_the_whole_one(monkeypatch):
    monkeypatch.setattr("beamdyn.steady.road_harvest.root_mean_squares", None)  # compares, which takes long
    document, screen = SCREENS["Harvest"]
    found = first_of("Harvest").answer.result
    monkeypatch.undo()
    tables = tables_of(document.base_entries, document.inputs(document.base_entries))
    whole = screen.solve(tables).result
    assert np.isnan(found.total_error).all() and np.isfinite(whole.total_error).all()
    at = np.searchsorted(whole.speeds, found.speeds)
    np.testing.assert_allclose(found.total_power, whole.total_power[at], rtol=1e-2)
