"""Any input against any result: of designs that are solved one by one, and as used on the page."""

import asyncio
import csv
import io
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from nicegui import ui
from nicegui.testing.user_interaction import UserInteraction

from beamdyn import frequency_locus, resonance_speeds, steady_response
from beamdyn.app.program import BEAMDYN, FREQUENCIES, SCENE, STEADY_STATE
from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER, NoAnswer
from beamdyn.common.edge.input_sweep import sweep_csv
from beamdyn.common.edge.rendering import csv_text
from beamdyn.common.edge.varied_inputs import numbers
from beamdyn.common.screens.form_entries import tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.screens import Program
from beamdyn.common.screens.sweep_panel import around, sweep_charts
from brakes.app.program import BRAKES, CALIPER, MECHANISM
from brakes.cli import main
from tests.app.serving import PATIENCE

CALIPER_SCREEN, MECHANISM_SCREEN = CALIPER.screens[0], MECHANISM.screens[0]


def swept(document, screen, text, results, **changes):
    work = OpenDocument(document)
    for path, given in changes.items():
        work.put(path.replace("__", "."), given)
    tables = tables_of(work.needed(screen), work.inputs)
    return screen.sweeps.run(tables, text, results)


def solved(document, screen, **changes):
    work = OpenDocument(document)
    for path, given in changes.items():
        work.put(path.replace("__", "."), given)
    assert work.solve(screen), work.mistakes
    return work.answered[screen.name].answer


# Each case of a sweep is the answer to it ---------------------------------------------------------------


def test_caliper_against_its_clearance():
    found = swept(
        CALIPER, CALIPER_SCREEN, "clearance=1:2:3 mm", "finger_travel,right_pad_force,largest_roller"
    )
    for i, value in enumerate(("1 mm", "1.5 mm", "2 mm")):
        run = solved(CALIPER, CALIPER_SCREEN, dimensions__clearance=value).run
        one = 1e3 * run.finger[-1], run.pad_force[-1, 0], run.magnitudes["roller"].max()
        assert [values[i] for values in found.found] == pytest.approx(one, rel=1e-12)
    assert found.result_units == ("mm", "N", "N")


def test_a_coordinate_of_a_point_leaves_the_other_as_it_is():
    found = swept(CALIPER, CALIPER_SCREEN, "dimensions.pad.y=-50:-40:2 mm", "right_advantage")
    x = 1e3 * next(
        entry.default[0] for entry in OpenDocument(CALIPER).inputs if entry.path == "dimensions.pad"
    )
    for i, y in enumerate((-50, -40)):
        run = solved(CALIPER, CALIPER_SCREEN, dimensions__pad=f'["{x!r} mm", "{y} mm"]').run
        assert found.found[0][i] == pytest.approx(run.advantage[-1, 0], rel=1e-9)
    given = swept(CALIPER, CALIPER_SCREEN, "dimensions.pad.y=-50:-40:2 mm", "right_advantage",
                  dimensions__pad='["15 mm", "-45 mm"]')  # fmt: skip
    assert np.abs(given.found[0] - found.found[0]).min() > 1e-3


def test_mechanism_against_a_point():
    found = swept(MECHANISM, MECHANISM_SCREEN, "points.C.x=18:20:2 mm", "work,work_travel,largest_CD")
    answer = solved(MECHANISM, MECHANISM_SCREEN, points__C='["18 mm", "20 mm"]')
    one = answer.over.amplitudes["work"][-1], 1e3 * answer.motion.travel["work"][-1]
    assert [values[0] for values in found.found[:2]] == pytest.approx(one, rel=1e-12)
    assert found.found[2][0] == pytest.approx(np.abs(answer.over.magnitudes["CD"]).max(), rel=1e-12)


def test_frequencies_against_the_setting_angle():
    found = swept(SCENE, FREQUENCIES, "mount.setting_angle=0:90:3 deg",
                  "frequency_1,frequency_2,frequency_1_at_rest,first_resonance")  # fmt: skip
    for i, angle in enumerate(("0 deg", "45 deg", "90 deg")):
        work = OpenDocument(SCENE)
        work.put("mount.setting_angle", angle)
        scene = SCENE.check(work.text(), "one")
        locus = frequency_locus(scene, [0.0, 150.0], 2)  # another way to the same: 1e-9 is asked of both
        assert found.found[0][i] == pytest.approx(locus.frequency[1, 0], rel=1e-8)
        assert found.found[1][i] == pytest.approx(locus.frequency[1, 1], rel=1e-8)
        assert found.found[2][i] == pytest.approx(locus.frequency[0, 0], rel=1e-8)
        lowest = min(crossing.speed for crossing in resonance_speeds(scene, 150.0, 2))
        assert found.found[3][i] == pytest.approx(lowest, rel=1e-9)


def test_largest_steady_amplitude_is_that_of_a_dense_search():
    found = swept(
        SCENE,
        STEADY_STATE,
        "model.damping_ratio=0.005:0.01:2",
        "amplitude,largest_amplitude,speed_of_largest",
    )
    amplitude, largest, speed = found.found[:3]  # then the model error that stands beside them
    for i, ratio in enumerate((0.005, 0.01)):
        work = OpenDocument(SCENE)
        work.put("model.damping_ratio", str(ratio))
        scene = SCENE.check(work.text(), "one")
        coarse = steady_response(scene, np.linspace(0.25, 150.0, 600), 2)
        near = coarse.speeds[np.nanargmax(coarse.amplitude)]
        dense = steady_response(scene, np.linspace(near - 0.25, near + 0.25, 501), 2)
        assert largest[i] == pytest.approx(1e3 * np.nanmax(dense.amplitude), rel=1e-6)
        assert speed[i] == pytest.approx(dense.speeds[np.nanargmax(dense.amplitude)], abs=2e-3)  # its steps
        assert amplitude[i] == pytest.approx(1e3 * coarse.amplitude[-1], rel=1e-9)


# Where there is no answer -------------------------------------------------------------------------------


def test_values_without_an_answer_are_gaps_with_a_sentence():
    found = swept(MECHANISM, MECHANISM_SCREEN, "run.travel=10:20:3 mm", "work")
    assert np.isfinite(found.found[0]).tolist() == [True, False, False]
    (sentence,) = found.warnings
    assert sentence.startswith("at 2 of 3 values there is no answer; run.travel = 15 mm: ")
    assert "toggle" in sentence


def test_no_answer_anywhere_is_refused():
    with pytest.raises(NoAnswer, match=r"there is no answer at any of 3 values; run\.travel = 15 mm"):
        swept(MECHANISM, MECHANISM_SCREEN, "run.travel=15:20:3 mm", "work")


def test_what_statics_does_not_determine_is_no_answer():
    pins = (
        OpenDocument(MECHANISM).entries["pin"].replace("]", ',\n { name = "extra", body = "arm", at = "E" }]')
    )
    with pytest.raises(NoAnswer, match="at any of 2 values"):
        swept(
            MECHANISM,
            MECHANISM_SCREEN,
            "points.C.x=18:20:2 mm",
            "work",
            pin=pins,
            run__driver="",
            run__travel="",
        )


def test_without_damping_a_resonance_has_no_largest_amplitude():
    with pytest.raises(NoAnswer, match=r"model\.damping_ratio = 0: without damping"):
        swept(SCENE, STEADY_STATE, "beam.thickness=0.2:0.3:2 mm", "largest_amplitude")


@pytest.mark.parametrize(
    "text, results, sentence",
    [
        ("dimensions.pad=1:2:3 mm", "finger_travel", "did you mean dimensions.pad"),
        ("dimensions.split=0:1:3", "finger_travel", "unknown name"),
        ("run.wear=0:1:3 mm", "finger_travel", "unknown name"),
        ("run.finger=0:10:3 N", "finger_travel", "greater than 0"),
        ("run.finger=1:10:3 mm", "finger_travel", "unit of length"),
        ("run.finger=1:10:3 N", "finger_travl", "did you mean finger_travel"),
        ("run.finger=1:10:3 N", "", "name at least one of"),
        ("run.finger=1:10", "finger_travel", "start:stop:count"),
    ],
)
def test_mistakes_are_refused_by_name(text, results, sentence):
    with pytest.raises(ValueError, match=r"sweep|results") as refused:
        swept(CALIPER, CALIPER_SCREEN, text, results)
    assert sentence in str(refused.value)


# What is offered ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["eebrake", "dual-pivot", "v-brake"])
def test_every_number_of_a_caliper_can_be_swept(name):
    work = OpenDocument(CALIPER)
    work.put("caliper", name)
    work.put("run.points", "5")
    tables = tables_of(work.needed(CALIPER_SCREEN), work.inputs)
    offered = [e for e in numbers(work.inputs) if not e.path.startswith(("stop.", "run.travel"))]
    assert len(offered) > 6
    for entry in offered:
        text = f"{entry.path}={around(entry, work.entries)}".replace(":21 ", ":2 ").replace(":21", ":2")
        found = CALIPER_SCREEN.sweeps.run(tables, text, "finger_travel")
        assert np.isfinite(found.found[0]).any(), entry.path


@pytest.mark.parametrize("document", [*BRAKES.documents, *BEAMDYN.documents], ids=lambda d: d.name)
def test_values_to_begin_with_are_around_what_is_given(document):
    work = OpenDocument(document)
    entries = {entry.path: entry for entry in numbers(work.inputs)}
    given = {
        "forklift": ("truck.empty_mass", "4.76e+03:7.14e+03:21 kg"),
        "vehicle": ("truck.empty_mass", "4.76e+03:7.14e+03:21 kg"),
        "caliper": ("dimensions.clearance", "1:1.5:21 mm"),
        "mechanism": ("points.E.y", "-32:-48:21 mm"),
        "scene": ("mount.bending_angle", "0:1:21 deg"),
        "harvester": ("mount.bending_angle", "0:1:21 deg"),
        "periodic motion": ("mount.bending_angle", "0:1:21 deg"),
        "deck": ("deck.length", "32:48:21 m"),
    }
    friction = float(work.entries.get("brake.friction", "0"))  # of all others
    others = "brake.friction", f"{0.8 * friction:.3g}:{1.2 * friction:.3g}:21"
    path, values = given.get(document.name, others)
    assert around(entries[path], work.entries) == values


def test_charts_of_a_sweep_have_its_results_and_mark_designs_without_an_answer():
    document = next(document for document in BRAKES.documents if document.name == "drum")
    found = swept(document, document.screens[0], "brake.friction=0.9:1.1:5", "torque,c_star")
    torque, factor = sweep_charts(found)
    assert torque.title == "torque [N m] over friction" and factor.title == "c star over friction"
    for chart, values in zip((torque, factor), found.found, strict=True):
        np.testing.assert_array_equal(chart.curves[0].y, values)
        (lacking,) = chart.points
        assert [x for x, _, _ in lacking.at] == found.values[0][np.isnan(values)].tolist() != []


# On the page --------------------------------------------------------------------------------------------


def element(user, label):
    (found,) = [e for e in user.client.elements.values() if e.props.get("label") == label]
    return found


def test_sweep_is_shown_and_handed_over_as_csv_svg_and_png(simulate):
    async def body(client):
        user = await client()
        panel = element(user, "Sweep an input")
        with user.client:
            panel.set_value(True)
        chooser = element(user, "input")
        assert "dimensions.pad.x" in chooser.options and "dimensions.split" not in chooser.options
        assert "stop.mass" not in chooser.options  # not asked for: there is no [stop]
        results = element(user, "results")
        assert "largest_roller" in results.options
        with user.client:
            chooser.set_value("run.finger")
        low, high, count = (element(user, label) for label in ("from", "to", "how many values"))
        assert (low.value, high.value, count.value) == ("32 N", "48 N", "21")
        with user.client:
            low.set_value("0.01 kN")  # another unit than the other end's, which has the last word
            high.set_value("20 N")
            count.set_value("3")
            results.set_value(["right_pad_force", "finger_travel"])
        user.find("Sweep as CSV").click()
        rows = [*csv.reader(io.StringIO((await user.download.next(timeout=PATIENCE)).text))]
        assert rows[0] == ["finger_N", "right_pad_force_N", "finger_travel_mm"]
        forces = [float(row[1]) for row in rows[1:]]
        assert forces[2] == pytest.approx(
            2 * forces[0], rel=1e-9
        )  # without friction forces are as the finger's
        user.find("Sweep as SVG").click()
        assert ET.fromstring((await user.download.next(timeout=PATIENCE)).text).tag.endswith("svg")
        user.find("Sweep as PNG").click()
        assert (await user.download.next(timeout=PATIENCE)).content.startswith(b"\x89PNG")

    simulate(Program("calipers", "Calipers", (CALIPER,)), body)


def test_sweep_of_another_design_is_greyed_and_offers_are_those_of_the_design(simulate, fields):
    async def body(client):
        user = await client()
        page = fields(user)
        with user.client:
            element(user, "Sweep an input").set_value(True)
        (button,) = [
            e for e in user.client.elements.values() if isinstance(e, ui.button) and e.text == "Sweep"
        ]
        UserInteraction(user, {button}, None).click()
        async with asyncio.timeout(PATIENCE):
            while "finger travel [mm] over" not in page.text():
                await asyncio.sleep(0.1)
        assert page.greyed() == 0
        page.enter("run.finger", "50 N")
        assert page.greyed() == 1
        page.enter("run.finger", "40 N")
        assert page.greyed() == 0
        page.enter("caliper", "v-brake")
        assert "dimensions.roller.x" not in element(user, "input").options
        assert "largest_right_boss" in element(user, "results").options

    simulate(Program("calipers", "Calipers", (CALIPER,)), body)


# On the command line ------------------------------------------------------------------------------------


def test_command_sweeps_a_caliper_as_the_screen_does(tmp_path, capsys):
    path = tmp_path / "sweep.csv"
    options = [
        "--vary",
        "clearance=1:2:3 mm",
        "--what",
        "finger_travel,largest_roller",
        "--csv",
        str(path),
    ]
    assert main(["caliper", "dual-pivot", *options]) == DONE
    work = OpenDocument(CALIPER)
    work.open('caliper = "dual-pivot"', "mine")
    tables = tables_of(work.needed(CALIPER_SCREEN), work.inputs)
    found = CALIPER_SCREEN.sweeps.run(tables, "clearance=1:2:3 mm", "finger_travel,largest_roller")
    assert path.read_text(encoding="utf-8") == csv_text(sweep_csv(found))
    assert "clearance [mm]" in capsys.readouterr().out


def test_two_sweeps_of_a_caliper_have_a_row_a_case(tmp_path, capsys):
    path = tmp_path / "sweep.csv"
    sweeps = ["--vary", "finger=10:30:3 N", "--vary", "lever_ratio=3:4:2"]
    assert main(["caliper", "dual-pivot", *sweeps, "--what", "right_pad_force", "--csv", str(path)]) == DONE
    rows = [[float(v) for v in row] for row in [*csv.reader(path.read_text().splitlines())][1:]]
    assert [row[:2] for row in rows] == [[10, 3], [10, 4], [20, 3], [20, 4], [30, 3], [30, 4]]
    assert rows[5][2] == pytest.approx(4 * rows[0][2], rel=1e-6)  # 3 times the finger, 4/3 the lever


@pytest.mark.parametrize(
    "options, code, sentence",
    [
        (["--what", "finger_travel"], BAD_INPUT, "--what goes with --vary"),
        (["--vary", "clearanc=1:2:3 mm"], BAD_INPUT, "did you mean clearance"),
        (["--vary", "finger=1:2:3 N", "--vary", "run.finger=1:2:3 N"], BAD_INPUT, "given twice"),
        (["--vary", "travel=40:60:3 mm"], NO_ANSWER, "at any of 3 values"),
    ],
)
def test_command_says_what_is_wrong_with_a_sweep(options, code, sentence, finished):
    assert sentence in finished(main(["caliper", "dual-pivot", *options]), code).err
