"""Pictures of studies: curves over one input, maps over two, and where there is no answer."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.analyses import analyses
from beamdyn.common.edge.command_options import VaryOptions
from beamdyn.common.plots.curves import mark_missing
from beamdyn.common.plots.maps import MapAnswer, MapInput, levels_of, plot_maps
from tests.drawn_texts import drawn_texts, overlapping

SCENE = bd.load_scene(Path(__file__).parents[2] / "examples" / "rolling_harvester.toml")
SPEEDS = [0.0, 100.0, 200.0, 300.0]  # it buckles at 159.8 rad/s


def drawn(study, size=(7.5, 4.8)):
    figure = Figure(figsize=size, layout="constrained")
    ax = study.plot(figure.subplots())
    return figure, ax


def texts(figure):
    return [text for text, _ in drawn_texts(figure)]


def test_speeds_without_an_answer_are_hatched_and_say_why():
    figure, ax = drawn(bd.study(SCENE, {"speed": SPEEDS}, modes=1))
    (span,) = (patch for patch in ax.patches if patch.get_hatch())
    assert (span.get_x(), span.get_x() + span.get_width()) == (150.0, 300.0)  # from between the last two
    assert "buckles" in texts(figure)


def test_where_all_have_an_answer_nothing_is_hatched():
    for vary in ({"speed": [0.0, 100.0]}, {"speed": [0.0, 50.0], "mount.radius": [0.2, 0.21]}):
        _, ax = drawn(bd.study(SCENE, vary, modes=1))
        assert not any(
            getattr(each, "hatches", [each.get_hatch()])[0] for each in (*ax.patches, *ax.collections)
        )


def test_lines_of_equal_value_are_where_the_answer_has_that_value():
    """Frequencies at rest are proportional to the thickness, over the length squared."""
    vary = {"beam.thickness": np.linspace(2e-4, 4e-4, 41), "beam.length": np.linspace(0.04, 0.05, 41)}
    study = bd.study(replace(SCENE, motion=None), vary, modes=1, speed=0.0)
    _, ax = drawn(study)
    (lines,) = (each for each in ax.collections if each.get_facecolor().size == 0)
    of_one = study.value[0, 0, 0] / (2e-4 / 0.04**2)
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        thickness, length = path.vertices.T / study.display_units.length_unit("m").per_si
        # Between designs, 2.5 % apart, lines are straight: off by (0.025)^2 / 8, times 1 to 3.
        np.testing.assert_allclose(of_one * thickness / length**2, level, rtol=3e-4)


def test_resonances_are_where_the_answer_meets_a_line():
    sides = {"beam.thickness": np.linspace(2e-4, 4e-4, 41), "speed": np.linspace(1.0, 150.0, 41)}
    figure, ax = drawn(bd.study(SCENE, sides, modes=1))
    assert {"road -", "road +", "present design"} <= {*texts(figure)}
    crossing = bd.study(SCENE, {"beam.thickness": [2.5e-4]}, "crossings", speed=150.0, modes=1)
    meets = [each for each in ax.collections if list(getattr(each, "levels", ())) == [0.0]]
    at = [np.interp(0.25, *np.sort(each.get_paths()[0].vertices, axis=0).T) for each in meets]
    np.testing.assert_allclose(at, crossing.value[0, :2], rtol=1e-3)  # the grid, as above


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [(0.0, 1.0, [0.2, 0.4, 0.6, 0.8]), (1.0, 1000.0, [2, 5, 10, 20, 50, 100, 200, 500])],
)
def test_levels_are_round_numbers(low, high, expected):
    spaced = np.linspace if low == 0 else np.geomspace
    np.testing.assert_allclose(levels_of(spaced(low, high, 1000)), expected, rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    "x", [np.linspace(-0.1, 0.1, 5), np.geomspace(0.2, 3.0, 5), np.geomspace(1e-3, 1e3, 5)]
)
def test_maps_side_by_side_have_numbers_that_are_told_apart(x):
    """The values differ in their fifth digit alone."""
    inputs = [MapInput("a", "m", x), MapInput("b", "m", np.linspace(0.0, 1.0, 5))]
    z = 1.666 + 8e-4 * np.add.outer(np.linspace(0, 0.5, 5), np.linspace(0, 0.5, 5))
    answers = [MapAnswer(name, z, np.full(z.shape, "")) for name in "pqr"]
    figure = Figure(figsize=(12.7, 3.9), layout="constrained")
    plot_maps(inputs, answers, figure.subplots())
    levels = [text for text in texts(figure) if text.startswith("1.666")]
    assert len(levels) == 3 * len({*levels}) > 9
    assert not overlapping(figure)


def test_an_answer_that_is_the_same_everywhere_says_so():
    inputs = [MapInput(name, "m", np.array([1.0, 2.0])) for name in "ab"]
    figure = Figure()
    plot_maps(inputs, [MapAnswer("c", np.full((2, 2), 3.0), np.full((2, 2), ""))], figure.subplots())
    assert "3 wherever there is an answer" in texts(figure)


def test_axes_and_notes_have_the_units_that_were_typed():
    varying = VaryOptions(("beam.thickness=0.1:0.4:5 mm", "speed=0:3000:5 rpm"))
    made = analyses(("study",))["study"].function(SCENE, varying=varying, modes=1).result
    ax = drawn(made)[1]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("thickness [mm]", "speed [rpm]")
    assert ax.get_xlim() == pytest.approx((0.1, 0.4)) and ax.get_ylim() == pytest.approx((0.0, 3000.0))


def test_values_at_equal_ratios_have_an_axis_of_such():
    varied = {"beam.tip.mass": np.geomspace(1e-6, 1e-3, 4), "mount.radius": [0.1, 0.2]}
    _, ax = drawn(bd.study(SCENE, varied, modes=1, speed=0.0))
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")


@pytest.mark.parametrize(("last", "between"), [(800.0, True), (2000.0, False)])
def test_an_axis_of_less_than_three_decades_has_numbers_between_them(last, between):
    given = MapInput("a", "m", np.geomspace(1.0, last, 5))
    figure = Figure()
    ax = plot_maps([given], [MapAnswer("c", np.arange(5.0), np.full(5, ""))], figure.subplots())
    figure.draw_without_rendering()
    assert any(tick.label1.get_text() == "20" for tick in ax.xaxis.get_minor_ticks()) is between


def test_curves_with_gaps_have_rows_of_their_own():
    ax = Figure().subplots()
    for values in ([1.0, np.nan], [np.nan, 2.0]):
        ax.plot([0.0, 1.0], values)
    assert mark_missing(ax, "no answer")
    heights = [
        line.get_ydata()[0] for line in ax.get_lines() if line.get_marker() == "x" and len(line.get_xdata())
    ]
    assert len({*heights}) == 2


def test_five_inputs_keep_the_words_within_the_picture():
    vary = {"speed": [0.0, 50.0], "beam.thickness": [2e-4, 3e-4]}
    further = {"mount.radius": [0.1, 0.2], "mount.setting_angle": [0.1, 0.2], "beam.length": [0.04, 0.05]}
    figure, _ = drawn(bd.study(SCENE, vary | further, modes=1))
    whole = figure.bbox
    for _, (x0, y0, x1, y1) in drawn_texts(figure):
        assert whole.x0 <= x0 <= x1 <= whole.x1 and whole.y0 <= y0 <= y1 <= whole.y1
    assert any("mount radius = 100 mm" in text for text in texts(figure))


def test_the_edge_of_what_is_hatched_parts_designs_and_has_no_steps():
    x, y = np.linspace(0.0, 1.0, 15), np.linspace(0.0, 1.0, 17)
    X, Y = np.meshgrid(x, y, indexing="ij")
    z = np.where(Y < 0.2 + 0.6 * X, X + Y, np.nan)
    why = np.where(np.isfinite(z), "", "buckles")
    inputs = [MapInput("a", "m", x), MapInput("b", "m", y)]
    ax = plot_maps(inputs, [MapAnswer("sum", z, why)])
    (hatched,) = (each for each in ax.collections if getattr(each, "hatches", [None])[0])
    (region,) = hatched.get_paths()
    inside = region.contains_points(np.c_[X.ravel(), Y.ravel()], radius=1e-9)
    within = (X > 0) & (X < 1) & (Y > 0) & (Y < 1)  # no rounding on the frame
    np.testing.assert_array_equal(inside.reshape(X.shape)[within], np.isnan(z)[within])
    edge = region.vertices[(region.vertices > 0.1).all(axis=1) & (region.vertices < 0.9).all(axis=1)]
    slope = np.diff(edge[:, 1]) / np.diff(edge[:, 0])
    assert (np.abs(slope / 0.6 - 1) < 0.6).all()  # a step has slopes of 0 and infinity


def test_answers_on_one_edge_of_a_map_are_drawn_without_lines():
    """No cell of the grid has four answers: the lines of equal value have no points to label."""
    z = np.array([[1.0, 2.0, 4.0], [np.nan] * 3]).T
    inputs = [MapInput("a", "m", np.arange(3.0)), MapInput("b", "m", np.arange(2.0))]
    figure = Figure()
    plot_maps(inputs, [MapAnswer("c", z, np.where(np.isnan(z), "too long", ""))], figure.subplots())
    assert "too long" in texts(figure)


def test_frequencies_over_speed_in_a_motion_without_a_steady_state_have_no_lines_of_excitation():
    """The picture ended in the refusal of a steady state that nobody asked for."""
    pulsating = replace(SCENE, motion=bd.PulsatingRotation(50.0, fluctuation=0.1, frequency=100.0))
    _, ax = drawn(bd.study(pulsating, {"speed": SPEEDS[:2]}, modes=1))
    assert "--" not in [line.get_linestyle() for line in ax.lines]
    assert "--" in [
        line.get_linestyle() for line in drawn(bd.study(SCENE, {"speed": SPEEDS[:2]}, modes=1))[1].lines
    ]
