"""Every result in the hand: its line, its view in a notebook, its data frame, its label and its units."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from importlib.util import find_spec
from math import pi
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.edge.console import table
from beamdyn.common.edge.rendering import csv_text, html
from beamdyn.common.edge.views import View, rows_of, text_of, view_of
from beamdyn.common.results.columns import Column, Columns, DisplayUnits
from beamdyn.common.results.one_line import LONGEST, OneLine, error_at_most, number, spanned
from beamdyn.common.results.snapshots import fingerprint
from benchmarks.cases.scenes import HARVESTER, SHORT_SPIN_UP
from tests.unit.results_of_all_kinds import EXAMPLES_OF_INPUTS, MAKERS, SPEEDS, made, result_classes

every_result = pytest.mark.parametrize("name", sorted(MAKERS))
PLOTTED = sorted(name for name, kind in result_classes().items() if hasattr(kind, "plot"))
needs_pandas = pytest.mark.skipif(find_spec("pandas") is None, reason="pandas is not installed")
EMPTY_TAGS = {"img", "br", "hr", "meta"}
EXAMPLES = Path(__file__).parents[2] / "examples"
RPM = 30 / pi


class Page(HTMLParser):
    """Checks that tags are closed in order, and collects what a page must not have twice, or not at all."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in EMPTY_TAGS:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_there_is_an_example_of_every_class_of_results():
    """A new class of results belongs into `MAKERS`; all tests below then walk over it."""
    assert result_classes().keys() == MAKERS.keys()
    assert {name: type(made(name)).__name__ for name in MAKERS} == {name: name for name in MAKERS}


# One line -------------------------------------------------------------------------------------------


@every_result
def test_the_line_of_a_result(name):
    line = repr(made(name))
    assert line.startswith(f"{name}(") and line.endswith(")") and "\n" not in line
    assert len(line) <= LONGEST and re.search(r"\d", line)
    assert line != f"{name}(...)" and "array(" not in line and "object at" not in line


@pytest.mark.parametrize("given", EXAMPLES_OF_INPUTS, ids=lambda given: type(given).__name__)
def test_the_line_of_what_a_user_describes(given):
    line = repr(given)
    assert line.startswith(f"{type(given).__name__}(") and line.endswith(")")
    assert "\n" not in line and len(line) <= LONGEST and "array(" not in line and line[-5:] != "(...)"


def test_the_line_has_the_numbers_of_the_result():
    modes = made("Modes")
    frequencies = [float(x) for x in re.findall(r"[\d.]+(?=,| Hz)", repr(modes).partition(":")[2])]
    np.testing.assert_allclose(frequencies[:3], modes.frequency, rtol=5e-4)  # four digits
    stated = float(re.search(r"error <= (\S+?)[,)]", repr(modes))[1])
    assert modes.error.max() <= stated <= 11 * modes.error.max()
    assert "warning" in repr(made("SettingAngleLimits"))


def test_an_unstable_mode_is_said():
    past = bd.natural_modes(HARVESTER, 170.0, 2)
    assert "none" in repr(past) and "1 divergence" in repr(past) and "warning" in repr(past)


@pytest.mark.parametrize("error", [0.0, 1e-300, 9.6e-12, 1e-12, 0.1, 3.0, 1.0000001e-5])
def test_a_stated_error_is_not_below_the_true_one(error):
    stated = float(error_at_most([0.0, error]).rpartition(" ")[2])
    assert error <= stated <= 2 * error


def test_words_for_numbers():
    assert number(-0.0) == "0" and number(1234.56) == "1235" and number(1e9, "N") == "1e+09 N"
    assert spanned([np.nan]) == "none" and spanned([2.0, 2.0], "m") == "2 m"
    assert error_at_most([np.nan]) == "error not known" and error_at_most(np.inf) == "error unresolved"


def test_a_line_that_fails_is_a_line_nevertheless():
    class Broken(OneLine):
        def headline(self):
            raise RuntimeError

    class Long(OneLine):
        def headline(self):
            return "short", "x" * 200

    assert repr(Broken()) == "Broken(...)"
    assert repr(Long()) == "Long(short, ...)"


def test_the_line_has_no_digits_beyond_the_error():
    """Of expected loads three, of peaks what half a unit of the last digit leaves above all errors."""
    assert "moment to" in (line := repr(made("RandomLoads")))
    assert len(re.search(r"moment to ([\d.]+)", line)[1].replace(".", "").lstrip("0")) <= 3
    peaks = made("Sweep")
    at = int(peaks.peaks.argmax())
    rough = replace(peaks, mode_error=2e-3)
    error = peaks.time_error[at] + 2e-3 * peaks.largest[at]
    shown = re.search(r"peak ([\d.]+) mm", repr(rough))[1]
    assert 10.0 ** -len(shown.partition(".")[2]) / 2 >= 1e3 * error
    stated = float(re.search(r"error <= (\S+?)[,)]", repr(rough))[1])
    assert error / peaks.peaks[at] <= stated <= 2 * error / peaks.peaks[at]


# Notebooks ------------------------------------------------------------------------------------------


@every_result
def test_the_view_of_a_result_in_a_notebook(name):
    """Well-formed, without scripts, names or addresses that a page could have twice or must fetch."""
    text = made(name)._repr_html_()
    page = Page(text)
    assert "table" in page.tags or name == "CriticalPoint"  # which is a sentence
    assert not {"script", "iframe", "link", "object"} & {*page.tags}
    assert not [value for key, value in page.attributes if key in ("id", "href", "onload", "onerror")]
    sources = [value for key, value in page.attributes if key == "src"]
    assert all(source.startswith("data:image/png;base64,") for source in sources)
    has_picture = hasattr(made(name), "plot") or view_of(made(name)).figure is not None
    assert len(sources) == has_picture


def test_every_result_of_beams_is_shown_as_its_command_prints_it():
    """Not by its fields: it has an entry among the views, with table or columns of its own."""
    kinds = {name for name, kind in result_classes().items() if kind.__module__.startswith("beamdyn.")}
    assert not [name for name in kinds if view_of(made(name)) == View()]
    assert "expected in 3600 s" in text_of(made("RandomLoads")) and "at worst" in text_of(made("Spread"))


@needs_pandas
def test_the_data_frame_of_random_loads_is_over_positions():
    assert [*made("RandomLoads").to_pandas().index.names] == ["position_m", "side"]


def test_text_in_names_is_inert():
    attack = "<script>alert(1)</script><img src=x onerror=alert(1)>"
    scene = replace(HARVESTER, label=attack)
    diagram = bd.campbell({attack: scene, "other": HARVESTER}, SPEEDS, 1)
    swept = replace(made("InputSweep"), results=(attack,), inputs=(attack,))
    of_brake = made("BrakeSweep")
    titled = replace(of_brake, results=(attack, *of_brake.results[1:]))
    for result in (diagram, swept, titled, bd.frequency_locus(scene, SPEEDS, 1)):
        page = Page(result._repr_html_())
        assert "script" not in page.tags and page.tags.count("img") <= 1
        assert not [key for key, _ in page.attributes if key == "onerror"]


def test_a_long_table_shows_head_and_tail_and_says_how_many():
    rows = [(f"row {i}", str(i)) for i in range(100)]
    cut = html([table("", ("", "value"), rows)], 20)
    assert "80 of 100 rows are not shown" in cut
    assert all(f"row {i}<" in cut for i in (0, 9, 90, 99)) and "row 50<" not in cut
    Page(cut)


def test_a_view_leaves_no_figure_open_and_changes_no_setting():
    """In a process of its own: pyplot is not even imported, nor matplotlib before a view is asked for."""
    code = (
        "import sys, beamdyn as bd\n"
        "from benchmarks.cases.scenes import HARVESTER\n"
        "modes = bd.natural_modes(HARVESTER, 50.0)\n"
        "repr(modes), repr(HARVESTER)\n"
        "assert not {'matplotlib', 'rich', 'pandas', 'pint'} & {*sys.modules}, 'imported'\n"
        "import matplotlib; before = dict(matplotlib.rcParams)\n"
        "modes._repr_html_()\n"
        "assert 'matplotlib.pyplot' not in sys.modules, 'pyplot'\n"
        "assert dict(matplotlib.rcParams) == before, 'settings'\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=EXAMPLES.parent)


def test_a_view_computes_no_model_error_that_takes_long():
    run = bd.simulate(SHORT_SPIN_UP, 0.3, 2)
    text = run._repr_html_()
    assert "not computed yet" in text and not {"left_out_effects", "mode_error", "refined"} & {*vars(run)}
    assert np.isfinite(run.model_error) and "not computed yet" not in run._repr_html_()


def test_a_picture_that_cannot_be_drawn_is_a_sentence():
    locus = made("Locus")
    broken = replace(locus, frequency=np.full_like(locus.frequency, 1e308))
    Page(broken._repr_html_())


# Data frames ----------------------------------------------------------------------------------------


@needs_pandas
@every_result
def test_the_data_frame_of_a_result(name):
    """The columns of the CSV file, named as there; what it is over is the index."""
    result = made(name)
    frame, (heads, *rows) = result.to_pandas(), [*rows_of(result)]
    flat = frame.reset_index() if view_of(result).index else frame
    assert [*flat.columns] == [str(head) for head in heads] and len(flat) == len(rows)
    assert len({*flat.columns}) == len(flat.columns)
    assert frame.attrs["result"] == name
    if getattr(result, "provenance", None):
        assert frame.attrs["provenance"]["version"] == bd.__version__


@needs_pandas
def test_the_data_frame_has_the_numbers_of_the_result():
    locus = made("Locus")
    frame = locus.to_pandas(units={"speed": "rpm"})
    np.testing.assert_allclose(frame.index, locus.speeds * RPM, rtol=1e-15)
    np.testing.assert_array_equal(frame["frequency_Hz_2"], locus.frequency[:, 1])


def test_without_pandas_the_message_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install 'beamdyn\[pandas\]'"):
        made("Modes").to_pandas()


def test_columns_of_the_file_and_of_the_frame_have_one_source(tmp_path):
    scene = str(EXAMPLES / "tyre_harvester.toml")
    assert main(["modes", scene, "--speed", "500 rpm", "--csv", str(tmp_path / "m.csv")]) == 0
    modes = bd.natural_modes(bd.load_scene(scene), 500 / RPM).in_units(speed="rpm")
    written = (tmp_path / "m.csv").read_text().splitlines()
    assert written[0] == csv_text(rows_of(modes)).splitlines()[0]
    assert written[0].startswith("mode,speed_rpm,frequency_Hz")
    assert float(written[1].split(",")[1]) == pytest.approx(500.0, rel=1e-14)


# Labels ---------------------------------------------------------------------------------------------


def axes():
    return Figure().subplots()


@pytest.mark.parametrize("name", PLOTTED)
def test_two_results_on_one_pair_of_axes_are_told_apart(name):
    ax = axes()
    first = made(name).plot(ax=ax, label="thin")
    if name in ("Tradeoff", "Equilibrium"):  # panels of their own; one line to scale
        return
    count = len(ax.lines)
    assert made(name).plot(ax=ax, label="thick") is first
    entries = ax.get_legend_handles_labels()[1]
    assert any(text.startswith("thin") for text in entries), entries
    assert any(text.startswith("thick") for text in entries), entries
    shown = {text.get_text() for text in ax.get_legend().get_texts()}
    assert {*entries} == shown and len({*entries}) == len(entries)
    new = {
        (line.get_color(), line.get_linestyle()) for line in ax.lines[count:] if line.get_label()[0] != "_"
    }
    old = {
        (line.get_color(), line.get_linestyle()) for line in ax.lines[:count] if line.get_label()[0] != "_"
    }
    assert not {pair for pair in new & old if pair[0] in {"#0072B2", "#D55E00", "#009E73"}}


def test_the_label_of_a_scene_is_that_of_its_results():
    thin, thick = (
        replace(HARVESTER, beam=bd.Beam.rectangular(0.05, 0.01, h, 200e9, 7850.0), label=f"{1e3 * h:g} mm")
        for h in (2e-4, 3e-4)
    )
    ax = axes()
    for scene in (thin, thick):
        bd.frequency_locus(scene, SPEEDS, 2).plot(ax)
    assert ax.get_legend_handles_labels()[1] == [f"{h} mm, mode {k}" for h in ("0.2", "0.3") for k in (1, 2)]
    assert len({line.get_color() for line in ax.lines}) == 4
    assert bd.campbell([thin, thick], SPEEDS, 1).labels == ("0.2 mm", "0.3 mm")
    assert bd.campbell([thin, thin], SPEEDS, 1).labels == ("scene 1", "scene 2")
    plain = bd.frequency_locus(HARVESTER, SPEEDS, 2).plot(Figure().subplots())
    assert plain.get_legend_handles_labels()[1] == ["mode 1", "mode 2"]


def test_a_label_changes_neither_equality_nor_what_is_stored():
    named = replace(HARVESTER, label="a", units={"speed": "rpm"})
    assert named == HARVESTER and hash(named) == hash(HARVESTER)
    assert fingerprint(named) == fingerprint(HARVESTER)
    assert fingerprint(replace(HARVESTER, gravity=1.0)) != fingerprint(HARVESTER)


# Units ----------------------------------------------------------------------------------------------


def test_a_file_in_rpm_and_mm_is_answered_in_them(tmp_path, finished):
    text = (EXAMPLES / "rolling_harvester.toml").read_text()
    assert "55 rad/s" in text and "50 mm" in text
    path = tmp_path / "scene.toml"
    path.write_text(text.replace("55 rad/s", "525 rpm"))
    scene = bd.load_scene(path)
    assert scene.units == DisplayUnits("rpm", "mm")
    response = bd.steady_response(scene, [50.0, 55.0], 2)
    assert "speed [rpm]" in response.to_table() and "[mm]" in response.to_table()
    assert next(iter(rows_of(response)))[:2] == ["speed_rpm", "amplitude_mm"]
    assert response.plot(Figure().subplots()).get_xlabel() == "angular speed [rpm]"
    assert response.to_dict()["speeds"] == [50.0, 55.0]  # SI
    printed = finished(main(["critical", str(path)]), 0).out
    speed = bd.critical_speed(scene)
    assert f"{speed * RPM:.6f}" in printed and "rad/s" not in printed


def test_the_unit_of_an_option_comes_before_that_of_the_file(finished):
    scene = str(EXAMPLES / "rolling_harvester.toml")
    printed = finished(main(["locus", scene, "--speeds", "0:900:3 rpm", "--modes", "1"]), 0).out
    assert "speed [rpm]" in printed and re.search(r"^\s+450 ", printed, re.MULTILINE)


def test_a_blade_in_metres_is_answered_in_metres():
    blade = bd.Scene(bd.Beam.from_stiffness(10.0, 1.2, 1.4e4), bd.Mount(0.5, pi), units={"length": "m"})
    loads = bd.static_loads(blade, [6.0])
    assert "position [m]" in loads.to_table() and "at 0 m" in loads.to_table()
    assert "position [mm]" in loads.to_table(units={"length": "mm"})
    assert "_m" in str([*next(iter(rows_of(loads)))][1])


def test_numbers_in_other_units_are_the_same_numbers():
    response = made("SteadyResponse")
    heads, *rows = rows_of(response.in_units(speed="rpm", length="mm"))
    si_heads, *si = rows_of(response.in_units(speed="rad/s", length="m"))
    scale = {"speed_rpm": RPM, "amplitude_mm": 1e3, "sum_of_lines_mm": 1e3}
    assert [h for h, s in zip(heads, si_heads, strict=True) if h != s] == [*scale]
    for k, head in enumerate(heads):
        if isinstance(si[0][k], float):
            want = [row[k] * scale.get(head, 1.0) for row in si]
            np.testing.assert_allclose([row[k] for row in rows], want, rtol=1e-15)
    assert response.in_units(speed="rpm").speeds is response.speeds
    assert "_display_units" not in vars(response)


def test_loads_and_drawings_speak_in_the_units_of_the_scene():
    rough = made("RandomLoads").to_table(units={"speed": "rpm"})
    assert f"{50 * RPM:.6g} rpm" in rough and "rad/s" not in rough
    drawn = made("RotorDrawing").to_table(units={"length": "m"})
    assert re.search(rf"radius r of the root\s+{HARVESTER.mount.radius:g}\s+m$", drawn, re.MULTILINE)
    assert " mm" not in drawn


def test_quantities_that_only_look_like_lengths_or_speeds_stay():
    names = {"moment": "N m", "curvature": "1/m", "inertia": "kg m", "speed": "rad/s", "x": "m", "m": ""}
    columns = Columns(
        *(Column(name, [1.0], unit) for name, unit in names.items()), Column("speed", [1.0], "rpm")
    )
    heads, _ = columns.in_units(units := DisplayUnits("rpm", "mm"))
    stay = ["moment_N_m", "curvature_per_m", "inertia_kg_m", "speed_rad_per_s"]
    assert heads == [*stay, "x_mm", "m", "speed_rpm"]
    shown = Columns(Column("x", [1.0], "m"), Column("v", np.array([pi]), "rad/s", 2)).in_units(units)
    assert [*shown] == [["x_mm", "v_rpm_2"], (1e3, pytest.approx(30.0))]


@pytest.mark.parametrize(
    "units, part", [({"speed": "Hz"}, "rad/s"), ({"mass": "kg"}, "speed, length"), ("rpm", "dictionary")]
)
def test_unknown_units_are_refused(units, part):
    with pytest.raises(ValueError, match="units") as refusal:
        made("Modes").to_table(units)
    assert part in str(refusal.value)
    with pytest.raises(ValueError, match="units"):
        replace(HARVESTER, units=units)


@every_result
def test_the_table_of_a_result_as_text(name):
    text = text_of(made(name))
    assert text.strip() and max(map(len, text.splitlines())) <= 120
