"""What the pictures contain, and that nothing else happens when they are drawn."""

import subprocess
import sys
import warnings

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

from beamdyn.common.plots.curves import plot_along_span
from beamdyn.common.plots.plots import (
    COLOURS,
    mark_critical,
    mark_points,
    plot_growth,
    plot_loci_by_angle,
    plot_locus,
    plot_response,
    plot_transient,
    save_figure,
)
from beamdyn.common.plots.plots_of_shapes import plot_shapes

SPEEDS = np.linspace(0, 200, 21)
with np.errstate(invalid="ignore"):
    FIRST = 65 * np.sqrt(1 - (SPEEDS / 160.5) ** 2)  # nan past 160.5 rad/s
LOCUS = np.stack([FIRST, 400 - 0.1 * SPEEDS], axis=1)


@pytest.fixture
def ax():
    return Figure().subplots()


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_locus_has_one_line_a_mode(ax):
    assert plot_locus(SPEEDS, LOCUS, ax) is ax
    for line, mode in zip(ax.lines, LOCUS.T, strict=True):
        np.testing.assert_array_equal(line.get_xdata(), SPEEDS)
        np.testing.assert_array_equal(line.get_ydata(), mode)  # nan stays: a gap
    assert ax.get_xlabel() == "angular speed [rad/s]"
    assert ax.get_ylabel() == "natural frequency [Hz]"
    assert legend(ax) == ["mode 1", "mode 2"]


def test_own_labels(ax):
    assert legend(plot_locus(SPEEDS, LOCUS, ax, labels=["chordwise", "flapwise"])) == [
        "chordwise",
        "flapwise",
    ]
    with pytest.raises(ValueError, match="shorter"):
        plot_locus(SPEEDS, LOCUS, ax, labels=["one"])


def test_all_speeds_are_in_view_though_no_mode_oscillates_there(ax):
    plot_locus(SPEEDS, LOCUS[:, :1], ax)
    left, right = ax.get_xlim()
    assert left <= 0 and right >= 200


def test_value_between_gaps_is_visible(ax):
    frequency = np.array([[1.0, 2.0], [np.nan, 2.0], [1.0, 2.0], [np.nan, 2.0], [1.0, 2.0], [1.0, 2.0]])
    gaps, whole = plot_locus(np.arange(6.0), frequency, ax).lines
    assert gaps.get_marker() == "."
    np.testing.assert_array_equal(gaps.get_markevery(), [True, False, True, False, False, False])
    assert whole.get_marker() == "None"


def test_one_speed_is_visible(ax):
    assert all(line.get_marker() == "." for line in plot_locus(SPEEDS[:1], LOCUS[:1], ax).lines)


def test_locus_without_any_frequency_is_drawn_without_a_warning(tmp_path, ax):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        save_figure(plot_locus(SPEEDS, LOCUS * np.nan, ax, critical_speed=0.0), tmp_path / "empty.png")


def test_critical_speed_is_marked_and_what_lies_past_it_is_shaded(ax):
    plot_locus(SPEEDS, LOCUS, ax, critical_speed=160.5)
    assert list(ax.lines[-1].get_xdata()) == [160.5, 160.5]
    (shade,) = ax.patches
    assert shade.get_extents().transformed(ax.transData.inverted()).x0 == pytest.approx(160.5)
    assert ax.get_xlim()[1] == pytest.approx(204)
    assert legend(ax)[-1] == "critical speed 160.5 rad/s"


@pytest.mark.parametrize("speed", [np.inf, 1000.0, np.nan])
def test_critical_speed_out_of_view_is_not_drawn(ax, speed):
    mark_critical(plot_locus(SPEEDS, LOCUS, ax), speed)
    assert len(ax.lines) == 2 and not ax.patches


def test_growth_has_the_colours_of_the_locus(ax):
    growth = np.nan_to_num(LOCUS, nan=30.0)
    plot_growth(SPEEDS, growth, ax, critical_speed=160.5)
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), growth[:, 0])
    assert ax.get_ylabel() == "growth rate [1/s]"
    drawn = plot_locus(SPEEDS, LOCUS, Figure().subplots())
    assert [line.get_color() for line in ax.lines[:2]] == [line.get_color() for line in drawn.lines]


def test_panels_that_share_their_speeds_show_them_all():
    above, below = Figure().subplots(2, 1, sharex=True)
    plot_locus(SPEEDS, LOCUS[:, :1], above, critical_speed=160.5)
    plot_growth(SPEEDS, LOCUS[:, :1], below, critical_speed=160.5)
    assert below.get_xlim()[1] >= 200


def test_loci_by_angle_have_one_line_an_angle(ax):
    plot_loci_by_angle(SPEEDS, LOCUS.T, [88.35, 88.36], ax)
    assert legend(ax) == ["setting angle 88.35°", "setting angle 88.36°"]
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), LOCUS[:, 1])


def test_transient_is_in_millimetres_over_all_of_the_time(ax):
    t = np.linspace(0, 30, 301)
    assert plot_transient(t, 1e-3 * np.sin(t), ax) is ax
    np.testing.assert_allclose(ax.lines[0].get_ydata(), np.sin(t))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [s]", "tip deflection [mm]")
    assert ax.get_xlim() == (0, 30)


def test_dense_transient_is_drawn_thin(ax):
    plot_transient(np.arange(100.0), np.zeros(100), ax)
    plot_transient(np.arange(9000.0), np.zeros(9000), ax)
    few, many = ax.lines
    assert many.get_linewidth() < few.get_linewidth()


def test_response_shows_its_bound_and_itself_in_millimetres(ax):
    amplitude = np.array([1e-3, np.nan, 0.0, 2e-3])
    plot_response(np.arange(4.0), amplitude, 1.5 * amplitude, ax)
    own, bound = ax.lines
    np.testing.assert_allclose(own.get_ydata(), [1, np.nan, np.nan, 2])
    np.testing.assert_allclose(bound.get_ydata(), [1.5, np.nan, np.nan, 3])
    assert (own.get_linestyle(), bound.get_linestyle(), ax.get_yscale()) == ("-", "--", "log")
    assert ax.get_ylabel() == "largest tip deflection [mm]"


def test_response_without_a_bound_is_one_line(ax):
    assert legend(plot_response(np.arange(3.0), np.ones(3), ax=ax)) == ["largest over both phases"]


def test_close_frequencies_are_written_in_full(ax):
    plot_loci_by_angle(SPEEDS, 65.23 + 1e-5 * LOCUS[None, :, 1], [88.36], ax)
    ax.figure.canvas.draw()
    assert ax.yaxis.get_offset_text().get_text() == ""


def test_published_points_lie_over_the_lines(ax):
    mark_points(plot_locus(SPEEDS, LOCUS, ax), [0, 50, 100], [65.230, 61.963, 50.907], "ANSYS")
    points = ax.lines[-1]
    assert points.get_linestyle() == "None" and points.get_zorder() > ax.lines[0].get_zorder()
    np.testing.assert_array_equal(points.get_ydata(), [65.230, 61.963, 50.907])
    assert legend(ax) == ["mode 1", "mode 2", "ANSYS"]


def test_shapes_are_drawn_over_their_largest_value(ax):
    x = np.linspace(0, 0.05, 11)
    shapes = np.stack([71 * x**2, -3 * x, 0 * x])
    plot_shapes(x, shapes, ["a", "b", "c"], ax)
    curves = {line.get_label(): line.get_ydata() for line in ax.lines}
    np.testing.assert_allclose(curves["a"], (x / 0.05) ** 2)
    np.testing.assert_allclose(curves["b"], -x / 0.05)
    np.testing.assert_array_equal(curves["c"], 0)
    assert ax.get_xlabel() == "position along the beam [m]"
    assert legend(ax) == ["a", "b", "c"]


def test_many_modes_differ_in_look_and_have_the_legend_beside_them(ax):
    plot_locus(SPEEDS, np.outer(np.ones(21), np.arange(20.0)), ax)
    assert len({(line.get_color(), line.get_linestyle()) for line in ax.lines}) == 20
    assert {line.get_color() for line in ax.lines} == set(COLOURS)
    ax.figure.canvas.draw()
    assert ax.get_legend().get_window_extent().x0 >= ax.get_window_extent().x1


def test_new_axes_are_made_only_where_none_are_given():
    before = pyplot.get_fignums()
    plot_locus(SPEEDS, LOCUS, Figure().subplots())
    assert pyplot.get_fignums() == before
    plot_locus(SPEEDS, LOCUS)
    assert len(pyplot.get_fignums()) == len(before) + 1


def test_import_leaves_pyplot_and_meshio_alone():
    code = "import sys, beamdyn.common.plots.plots; print({'matplotlib.pyplot', 'meshio'} & set(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.strip() == "set()"


@pytest.mark.parametrize(
    ("suffix", "start"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF"), (".PNG", b"\x89PNG")]
)
def test_figure_is_saved_by_suffix(tmp_path, ax, suffix, start):
    path = save_figure(plot_locus(SPEEDS, LOCUS, ax), tmp_path / f"locus{suffix}")
    assert path.read_bytes().startswith(start)


def test_figure_or_any_axes_in_it_save_the_whole(tmp_path):
    figure = Figure()
    inner = figure.subfigures(1, 2)[0].subplots()
    saved = [save_figure(what, tmp_path / f"{i}.png") for i, what in enumerate([figure, inner])]
    assert saved[0].read_bytes() == saved[1].read_bytes()


def test_existing_picture_is_kept_unless_forced(tmp_path, ax):
    path = tmp_path / "locus.png"
    path.write_text("precious")
    with pytest.raises(FileExistsError, match=r"exists; .* force"):
        save_figure(ax, path)
    assert path.read_text() == "precious"
    assert save_figure(ax, path, force=True).read_bytes().startswith(b"\x89PNG")


def test_unknown_suffix_is_refused(tmp_path, ax):
    with pytest.raises(ValueError, match=r"unknown suffix '.bmp'; give one of \.png, \.svg, \.pdf"):
        save_figure(ax, tmp_path / "locus.bmp")


def test_equal_loads_along_the_span_are_one_curve_and_unknown_ones_hide_none(ax):
    known = np.array([3.0, 2.0, 1.0])
    values = np.stack([np.full(3, np.nan), known, known], axis=-1)[None]
    plot_along_span(np.arange(3.0), values, ["top", "left", "right"], "stress [MPa]", ax=ax)
    assert legend(ax) == ["top", "left and right"]
