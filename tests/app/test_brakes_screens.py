"""The screens of `brakes app` without their page: pure functions from tables to answers and pictures."""

import re
import xml.etree.ElementTree as ET
from html import unescape
from pathlib import Path

import pytest

from beamdyn.common.edge.config import ConfigError, parse
from beamdyn.common.edge.input_sweep import sweep_csv
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.rendering import csv_text, html, png, svg
from beamdyn.common.edge.toml_text import toml_of
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.screens.form_entries import by_field, entries_of, in_unit, tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_tasks import drawn, report_of
from brakes.app.bases import base
from brakes.app.program import BRAKES, CALIPER, FORCES, FORKLIFT, KINEMATICS, VEHICLE
from brakes.calipers import NAMED
from brakes.config.forklift import parse_forklift

EXAMPLES = Path(__file__).parents[2] / "examples"
PLACES = [(document, screen) for document in BRAKES.documents for screen in document.screens]
NAMES = [screen.name for _, screen in PLACES]


@pytest.fixture(scope="module", params=PLACES, ids=NAMES)
def place(request):
    document, screen = request.param
    work = OpenDocument(document)
    assert work.solve(screen), work.mistakes
    return work, screen, work.answered[screen.name].answer


@pytest.mark.parametrize(
    "name, file",
    [("forklift", "forklift"), ("drum", "drum"), ("mechanism", "calipers/toggle-clamp")],
)
def test_base_case_is_the_example(name, file):
    assert base(name) == (EXAMPLES / f"{file}.toml").read_text(encoding="utf-8")


def test_drawing_is_svg_and_the_same_twice(place):
    _, screen, answer = place
    first = svg(screen.draw(answer, 1.0))
    assert ET.fromstring(first).tag == "{http://www.w3.org/2000/svg}svg"
    assert first == svg(screen.draw(answer, 1.0))
    assert png(screen.draw(answer, 1.0)).startswith(b"\x89PNG")


def test_drawing_follows_the_slider(place):
    _, screen, answer = place
    if screen.slider is None:
        pytest.skip("this screen has no slider")
    places = [i * (len(screen.slider.marks) - 1) / 4 for i in range(5)]
    assert len({svg(screen.draw(answer, at)) for at in places}) == 5


def test_tables_and_rows_agree(place):
    _, screen, answer = place
    assert "<table>" in html(screen.tables(answer))
    rows = csv_text(screen.rows(answer)).splitlines()
    assert len(rows) > 5
    assert len({row.count(",") for row in rows}) == 1


def test_saved_file_is_the_design(place):
    work, _, _ = place
    document = work.document
    saved = work.text()
    assert document.check(saved, "saved") == document.check(document.base, "base")
    assert document.opened(saved, "saved") == work.entries


def test_wrong_entry_gives_the_sentence_of_the_command_and_keeps_the_last_answer():
    work = OpenDocument(FORKLIFT)
    work.solve(VEHICLE)
    before = work.answered["Vehicle"]
    work.put("stop.speed", "20")
    assert not work.solve(VEHICLE)
    assert work.answered["Vehicle"] is before
    with pytest.raises(ConfigError) as said:
        parse_forklift(FORKLIFT.base.replace('"20 km/h"', '"20"'))
    assert work.mistakes["Vehicle"] == {"stop.speed": list(said.value.mistakes)}


def test_a_mistake_downstream_does_not_stop_what_is_upstream():
    work = OpenDocument(FORKLIFT)
    work.put("forces.piston_force", "much")
    assert work.solve(VEHICLE) and work.solve(KINEMATICS) and not work.solve(FORCES)


def test_stale_is_what_follows_from_a_change():
    work = OpenDocument(FORKLIFT)
    for screen in FORKLIFT.screens:
        work.solve(screen)
    work.put("brake.clearance", "9 mm")
    assert [work.stale(screen) for screen in FORKLIFT.screens] == [False, True, True]
    work.solve(KINEMATICS)
    assert [work.stale(screen) for screen in FORKLIFT.screens] == [False, False, True]
    work.put("brake.clearance", "10.6 mm")
    assert not work.stale(FORCES)


def test_slope_and_speed_stand_in_the_units_chosen_and_in_files_with_their_own():
    """The title said deg and km/h beside a form in % and m/s."""
    work = OpenDocument(FORKLIFT)
    work.put("stop.slope", "30 %")
    work.put("stop.speed", "5 m/s")
    assert work.solve(VEHICLE)
    answer = work.answered[VEHICLE.name].answer
    ((truck,),) = VEHICLE.drawings(answer, 1.0)
    assert truck.title.startswith("stops within") and "deg" not in truck.title
    for figure in (VEHICLE.draw(answer, 1.0), answer.figure()):
        assert figure.axes[0].get_title().startswith("16.7 deg, 18 km/h: stops within")


@pytest.mark.parametrize("name", NAMED)
def test_every_named_caliper_has_a_form(name):
    work = OpenDocument(CALIPER)
    work.put("caliper", name)
    assert work.solve(CALIPER.screens[0]), work.mistakes
    assert {e.path.partition(".")[0] for e in work.inputs} >= {"caliper", "dimensions", "run"}


def test_core_mistakes_find_their_field():
    work = OpenDocument(FORKLIFT)
    work.put("brake.contact_angle", "-80 deg")  # the tip meets the drum first
    assert not work.solve(KINEMATICS)
    assert list(work.mistakes["Kinematics"]) == ["brake.clearance"]


@pytest.mark.parametrize(
    "text", ["import os", "[truck]\nfile = '/etc/passwd'", "a = 1\n" * 2, "[[brake]]", "\x00", ""]
)
@pytest.mark.parametrize("document", BRAKES.documents, ids=lambda d: d.name)
def test_hostile_file_is_refused_and_changes_nothing(document, text):
    work = OpenDocument(document)
    before = dict(work.entries)
    with pytest.raises(ConfigError):
        work.open(text, "hostile.toml")
    assert work.entries == before


def test_markup_in_an_entry_stays_text():
    work = OpenDocument(CALIPER)
    screen = CALIPER.screens[0]
    work.put("title", "<script>alert(1)</script>")
    assert work.solve(screen)
    assert "<script>" not in html(screen.tables(work.answered[screen.name].answer))
    assert "<script>" not in report_of(work, "<script>")


def test_report_holds_all_in_one_file():
    work = OpenDocument(FORKLIFT)
    for screen in FORKLIFT.screens:
        work.solve(screen)
    page = report_of(work, "Forklift")
    assert page.count("data:image/svg+xml") == 3
    assert page.count("<h3>As the paper prints</h3>") == 2
    assert "empty_mass" in page and "Warning:" in page
    assert 'src="http' not in page and "href" not in page


def test_what_the_paper_prints_is_folded_out_beside_the_right_values():
    work = OpenDocument(FORKLIFT)
    for screen, name, pair in (
        (VEHICLE, "stopping distance, from the driver's reaction", ["13.425", "9.5571"]),
        (FORCES, "torque of the brake T", ["8480.8", "11000"]),
    ):
        assert work.solve(screen)
        (part,) = screen.more
        shown = part.on_page(work.answered[screen.name].answer)
        rows = [re.findall(r">([^<>]*)</t[dh]>", row) for row in shown.split("<tr>")]
        (row,) = (row for row in rows if row and unescape(row[0]) == name)
        assert part.title == "As the paper prints" and row[1:3] == pair
        assert "corrected" in shown and "as printed" in shown


def test_sweep_gives_a_row_a_value():
    work = OpenDocument(FORKLIFT)
    sweeps = VEHICLE.sweeps
    found = sweeps.run(tables_of(work.entries, work.inputs), "stop.speed=10:30:5 km/h", "distance")
    rows = [*sweep_csv(found)]
    assert rows[0] == ["speed_km_per_h", "distance_m"]
    work.put("stop.speed", "15 km/h")
    work.solve(VEHICLE)
    single = work.answered["Vehicle"].answer.stop.distance
    assert rows[2] == pytest.approx([15.0, single], rel=1e-12)  # the same formula on an array
    assert svg(sweep_figure(found)).startswith("<?xml")


@pytest.mark.parametrize(
    "screen", [s for _, s in PLACES if s.sweeps], ids=[s.name for _, s in PLACES if s.sweeps]
)
def test_sweep_to_begin_with_works(screen):
    document = next(d for d in BRAKES.documents if screen in d.screens)
    work = OpenDocument(document)
    tables = tables_of(work.needed(screen), work.inputs)
    found = screen.sweeps.run(tables, screen.sweeps.example, screen.sweeps.results)
    assert len([*sweep_csv(found)]) > 10
    assert not found.warnings
    assert set(screen.sweeps.results.split(",")) <= set(screen.sweeps.names(tables))


@pytest.mark.parametrize(
    "path, given",
    [
        ("truck.wheelbase", "1e-300 m"),
        ("truck.empty_mass", "1e300 kg"),
        ("stop.slope", "89.9999 deg"),
        ("brake.clearance", "1 um"),
        ("brake.piston_bottom", "10 m"),
        ("forces.piston_force", "1e-300 N"),
        ("shoe.drum_radius", "1e200 m"),
        ("load.force", "1e300 N"),
        ("run.finger", "1e300 N"),
        ("run.travel", "1 km"),
    ],
)
def test_extreme_entries_give_an_answer_or_a_sentence(path, given):
    for document, screen in PLACES:
        work = OpenDocument(document)
        if path in work.entries and path.partition(".")[0] in screen.needs:
            work.put(path, given)
            if work.solve(screen):
                answer = work.answered[screen.name].answer
                assert html(screen.tables(answer))
                assert isinstance(drawn(screen, answer, 1.0), str)
            else:
                assert all(said for said in work.mistakes[screen.name].values())


@pytest.mark.parametrize(
    "path, given",
    [
        ("stop.speed", "1e300 km/h"),
        ("stop.rise_time", "1e300 s"),
        ("stop.gravity", "1e300 m/s2"),
        ("brake.drum_radius", "1e300 mm"),
        ("forces.piston_force", "1e-300 N"),
    ],
)
def test_numbers_beyond_all_range_are_named_as_they_stand_there(path, given):
    """They were "overflow encountered in scalar multiply", or "(34, 'Numerical result out of range')"."""
    said = [
        sentence
        for document, screen in PLACES
        for sentence in _refusals(OpenDocument(document), screen, path, given)
    ]
    assert any(f"{path} = " in s and "the results leave the range of numbers" in s for s in said), said
    assert all(word not in sentence for word in ("encountered", "(34") for sentence in said)


@pytest.mark.parametrize(
    "path, given, words",
    [
        ("shoe.drum_radius", "7 mm", "from the centre = 111.803 mm: more than two drum radii, 14 mm; move"),
        ("brake.drum_radius", "7 mm", "distance of tip from the centre = 119.38 mm"),
        ("second_shoe.pivot_offset", "500 mm", "second_shoe: distance of the pivot from the centre = 511."),
        ("dimensions.pivot_radius", "0 mm", "give the radius of the pivot"),
    ],
)
def test_refused_lengths_are_in_mm(path, given, words):
    said = " ".join(
        sentence
        for document, screen in PLACES
        for sentence in _refusals(OpenDocument(document), screen, path, given)
    )
    assert words in said and not said.endswith(" m")


def _refusals(work, screen, path, given):
    if path not in work.entries or path.partition(".")[0] not in screen.needs:
        return []
    work.put(path, given)
    if work.solve(screen):
        return []
    return [sentence for said in work.mistakes[screen.name].values() for sentence in said]


# Entries ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("document", BRAKES.documents, ids=lambda d: d.name)
def test_entries_and_tables_are_the_same_inputs(document):
    tables = parse(document.base, "base")
    inputs = document.inputs(tables)
    assert tables_of(entries_of(tables, inputs), inputs) == tables
    assert parse(toml_of(tables), "again") == tables


def test_empty_fields_are_not_in_the_file():
    assert "piston_stroke" not in OpenDocument(FORKLIFT).text()


def test_an_entry_cannot_add_a_key():
    work = OpenDocument(FORKLIFT)
    work.put("stop.friction", "0.7\ngravity = '1 m/s2'")
    assert not work.solve(VEHICLE) or work.answered["Vehicle"].answer.stop.conditions.gravity > 9


@pytest.mark.parametrize(
    "text, unit, target, expected",
    [("20 km/h", "m/s", "m/s", "5.555555556 m/s"), ("0.4 m", "m", "mm", "400 mm"), ("x", "m", "mm", "x")],
)
def test_another_unit_is_the_same_quantity(text, unit, target, expected):
    assert in_unit(text, Quantity(unit, "", ""), target) == expected


def test_mistake_about_no_field_is_kept():
    assert by_field(ValueError("something is wrong"), FORKLIFT.inputs({})) == {"": ["something is wrong"]}


def test_mistake_has_the_value_as_it_stands_in_its_field():
    work = OpenDocument(FORKLIFT)
    work.put("brake.clearance", "80 mm")
    assert not work.solve(KINEMATICS)
    ((path, (said,)),) = work.mistakes[KINEMATICS.name].items()
    assert path == "brake.clearance"
    assert said.startswith('brake.clearance = "80 mm": larger than the drum allows') and " m;" not in said
