"""Designs of an interactive program: undo and redo, links, named designs, comparison, examples."""

import base64
import json
import re
import tomllib
import zlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamdyn.app.drawings import bent_beam
from beamdyn.app.program import BEAMDYN, SCENE
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.console import table
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.browser_memory import LinkedDesign, named_designs, read_typed, refused_name
from beamdyn.common.screens.examples import examples_of
from beamdyn.common.screens.handles import draw_sheet
from beamdyn.common.screens.open_document import History, OpenDocument, OtherDesign
from beamdyn.common.screens.panels import (
    Difference,
    differences_html,
    headline_html,
    headline_of,
    input_differences,
    result_differences,
    with_ghost,
)
from brakes.app.program import BRAKES

VEHICLE = BRAKES.documents[0]
SCREEN = VEHICLE.screens[0]
DOCUMENTS = [*BRAKES.documents, *BEAMDYN.documents]

# Undo and redo ------------------------------------------------------------------------------------------


@given(st.lists(st.tuples(st.sampled_from("abc"), st.text("012", max_size=2)), max_size=30))
def test_undoing_all_and_redoing_all_comes_back(changes):
    history, entries = History({}), {}
    for at, (path, text) in enumerate(changes):
        entries = entries | {path: text}
        history.record(entries, now=10.0 * at)
    while history.can_undo:
        first = history.go(-1)
    assert not any((first if changes and history.can_redo else {}).values())
    assert history.go(-1) is None
    last = {}
    while history.can_redo:
        last = history.go(1)
    assert {k: v for k, v in last.items() if v} == {k: v for k, v in entries.items() if v}


def test_typing_into_a_field_is_one_step_and_a_pause_begins_another():
    history = History({"a": "1"})
    for at, text in enumerate(("12", "123", "123 m")):
        history.record({"a": text}, now=0.2 * at)
    history.record({"a": "9 m"}, now=60.0)
    assert history.go(-1) == {"a": "123 m"}
    assert history.go(-1) == {"a": "1"}


def test_change_after_undo_forgets_what_was_undone():
    history = History({"a": "1"})
    history.record({"a": "2"}, now=0.0)
    history.go(-1)
    history.record({"a": "3"}, now=0.1)
    assert not history.can_redo
    assert history.go(-1) == {"a": "1"}


def test_undo_of_another_file_brings_the_design_back():
    work = OpenDocument(VEHICLE)
    work.put("stop.speed", "31 km/h")
    work.history.record(work.entries, now=0.0)
    before = work.entries
    work.open(VEHICLE.base, "base")
    work.history.record(work.entries, now=0.1)
    assert work.go(-1)
    assert work.entries == before


# Links --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda d: d.name)
def test_link_carries_each_base_design(document):
    work = OpenDocument(document)
    options = {path: work.entries[path] for path in document.aside}
    fragment = LinkedDesign(document.name, work.text(), options).as_fragment()
    assert len(fragment) < 2000  # what every browser and mail program takes
    assert set(fragment) <= set("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=")
    found = LinkedDesign.of_fragment(f"#{fragment}")
    assert found.document == document.name and found.options == options
    other = OpenDocument(document)
    other.open(found.text, "the link")
    assert other.text() == work.text()
    assert tomllib.loads(found.text) == tomllib.loads(document.base)


def packed(value):
    text = value if isinstance(value, bytes) else json.dumps(value).encode()
    return "design=" + base64.urlsafe_b64encode(zlib.compress(text)).decode().rstrip("=")


BROKEN = {
    "nothing": "",
    "no base64": "design=%%%",
    "no zlib": "design=" + base64.urlsafe_b64encode(b"plain").decode(),
    "no JSON": packed(b"import os"),
    "deep": packed(b"[" * 100_000),
    "another form": packed({"document": "forklift"}),
    "numbers": packed(["forklift", 1, {}]),
    "options of numbers": packed(["forklift", "", {"a": 1}]),
    "bomb": packed(b" " * 50_000_000),
    "long": "design=" + "A" * 40_000,
    "cut": packed(["forklift", "a" * 100, {}])[:-8],
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_link_is_refused_in_a_sentence(name):
    with pytest.raises(ConfigError, match="the link: it "):
        LinkedDesign.of_fragment(BROKEN[name])


@given(st.text(max_size=60))
def test_any_fragment_is_a_design_or_refused(text):
    with pytest.raises(ConfigError):
        LinkedDesign.of_fragment(text)


def test_design_too_large_for_a_link_is_refused():
    noise = np.random.default_rng(3).bytes(60_000).hex()
    with pytest.raises(ConfigError, match="save it as a file"):
        LinkedDesign("forklift", noise, {}).as_fragment()


# Kept by the browser ------------------------------------------------------------------------------------


@pytest.mark.parametrize("stored", [None, "", "[", "[]", "3", '{"a": 3}', '{"a": ["b", {"c": 1}]}'])
def test_what_is_no_named_design_is_left_out(stored):
    assert named_designs(stored) == {}


def test_named_designs_are_read():
    assert named_designs('{"mine": ["forklift", {"a": "1"}]}') == {"mine": ("forklift", {"a": "1"})}


@pytest.mark.parametrize(("name", "said"), [("", "name"), (" ", "name"), ("x" * 81, "80"), ("mine", "")])
def test_names_of_designs(name, said):
    assert said in refused_name(name, {}) and bool(refused_name(name, {})) == bool(said)


def test_hundred_and_first_design_is_refused():
    assert "delete" in refused_name("new", dict.fromkeys(map(str, range(100))))
    assert not refused_name("7", dict.fromkeys(map(str, range(100))))


def test_what_was_typed_last_is_read_as_the_form_reads_it():
    inputs, base = VEHICLE.inputs(VEHICLE.base_entries), VEHICLE.base_entries
    typed = {"stop.speed": "25", "stop.friction": "0,6", "no.input": "1", "truck.wheelbase": 3}
    found = read_typed(typed, base, inputs)
    assert found == base | {"stop.speed": "25 km/h", "stop.friction": "0.6"}


# Comparison ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def compared():
    """A design, and another one that is faster on other wheels; both solved."""
    work = OpenDocument(VEHICLE)
    changed = work.entries | {"stop.speed": "30 km/h", "stop.gravity": "9.81 m/s2"}
    work.compare(OtherDesign("fast", changed))
    assert work.solve(SCREEN)
    work.compared[SCREEN.name] = page_tasks.solve(VEHICLE, SCREEN, work.other.entries)
    return work


def test_inputs_that_differ_are_listed_with_defaults(compared):
    found = [*input_differences(compared.entries, compared.other.entries, compared.inputs)]
    assert [(d.words, d.here, d.there, d.change) for d in found] == [
        ("speed, V", "20 km/h", "30 km/h", "-33.3 %"),
        ("gravity, g", "(9.806 m/s2)", "9.81 m/s2", "-0.0408 %"),
    ]


def test_results_that_differ_are_those_of_the_answers(compared):
    here, there = compared.answered[SCREEN.name], compared.compared[SCREEN.name]
    found = {d.words: (d.here, d.there) for d in result_differences(here.tables, there.tables)}
    stops = here.answer.stop, there.answer.stop
    assert [float(text) for text in found["time to rest [s]"]] == pytest.approx(
        [float(s.time) for s in stops], rel=1e-4
    )
    assert [*result_differences(here.tables, here.tables)] == []


HEADS = "speed [rad/s]", "deflection [mm]", "status"


@pytest.mark.parametrize(
    "here, there, found",
    [
        (
            [("1.0", "2", "stable"), ("5.0", "3", "stable"), ("7.0", "4", "stable"), ("9.0", "5", "stable")],
            [("1.0", "2", "stable"), ("5.0", "6", "stable"), ("8.0", "7", "stable"), ("9.0", "8", "peak")],
            [
                ("speed [rad/s] 5.0, deflection [mm]", "3", "6"),
                ("speed [rad/s] 9.0, deflection [mm]", "5", "8"),
            ],
        ),
        (
            [("1.0", "2", "road"), ("4.0", "3", "road")],
            [("1.5", "2", "road"), ("4.0", "6", "road")],
            [("road, row 1, speed [rad/s]", "1.0", "1.5"), ("road, row 2, deflection [mm]", "3", "6")],
        ),
    ],
    ids=["curve", "few"],
)
def test_rows_that_have_the_same_words_are_compared_at_the_same_place(here, there, found):
    tables = ([table("Response", HEADS, rows, left=(2,))] for rows in (here, there))
    assert [(d.words, d.here, d.there) for d in result_differences(*tables)] == found


@pytest.mark.parametrize(
    "path, here, there, change",
    [
        ("truck.empty_mass", "1000 kg", "3500 kg", "-71.4 %"),
        ("stop.slope", "20 %", "0.3 rad", "-34.2 %"),
        ("stop.friction", "0.6", "0.4", "+50 %"),
        ("stop.friction", "", "0.5", ""),
        ("stop.friction", "much", "0.5", ""),
    ],
)
def test_the_change_stands_beside_two_numbers(path, here, there, change):
    inputs = VEHICLE.inputs({})
    (made,) = input_differences({path: here}, {path: there}, inputs)
    assert made.change == change
    assert f'<td class="number">{change}</td></tr>' in differences_html([made], "results", "other")


@pytest.mark.parametrize(
    "here, there, change",
    [("15.458", "13.425", "+15.1 %"), ("-1.5", "-3", "+50 %"), ("5", "0", ""), ("stops", "never", "")],
)
def test_the_change_stands_beside_two_results(here, there, change):
    tables = ([table("Stop", ("", "value"), [("distance", value)])] for value in (here, there))
    assert [d.change for d in result_differences(*tables)] == [change]


def test_other_design_is_solved_once_and_again_for_another(compared):
    assert not compared.wants_other(SCREEN)
    work = OpenDocument(VEHICLE)
    work.compare(OtherDesign("broken", work.entries | {"stop.speed": "fast"}))
    work.compared[SCREEN.name] = page_tasks.solve(VEHICLE, SCREEN, work.other.entries)
    assert work.other_answer(SCREEN) is None
    assert "stop.speed" in work.compared[SCREEN.name]
    work.compare(None)
    assert not work.wants_other(SCREEN)


def test_ghost_lies_beneath_and_keeps_to_its_role(compared):
    here, there = (
        SCREEN.drawings(a[SCREEN.name].answer, 0.0) for a in (compared.answered, compared.compared)
    )
    drawn = with_ghost(here, there, "fast")[0][0]
    number = len(drawn.shapes) - len(here[0][0].shapes)
    assert number > 0
    assert {shape.role for shape in drawn.shapes[:number]} == {"other"}
    assert drawn.shapes[number:] == list(here[0][0].shapes)
    assert drawn.legend["other"] == "fast"


def test_ghost_of_a_bent_beam_says_its_scale_and_has_no_lines_that_are_not_drawn():
    x = np.linspace(0.0, 1.0, 5)
    here, there = (
        bent_beam(x, 0.1 * x**2, "At 1 s", room=0.2, scale=f"drawn {n} times larger") for n in (2, 5)
    )
    drawn = with_ghost([[here]], [[there]], "thick")[0][0]
    assert drawn.legend["other"] == "thick, drawn 5 times larger"
    assert with_ghost([[here]], [[here]], "thick")[0][0].legend["other"] == "thick"
    assert max(np.abs(np.asarray(s.points)[:, 1]).max() for s in drawn.shapes if s.role == "other") < 0.15


def test_markup_in_names_and_values_stays_text():
    script = "<script>alert(1)</script>"
    made = differences_html([Difference(script, script, script, (None, None))], script, script)
    made += headline_html([(script, script)], [(script, "1")], script)
    assert "<script" not in made


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda d: d.name)
def test_each_screen_has_a_headline(document):
    work = OpenDocument(document)
    for screen in document.screens:
        assert work.solve(screen), work.mistakes
        found = [*screen.headline(work.answered[screen.name].answer)]
        assert len(found) <= 4 and (found or screen.name == "Rotor")  # which draws the inputs
        assert all(result.words and result.value for result in found)


def test_the_page_shows_the_headline_that_comes_with_the_answer():
    """Of an answer that comes from another process the page would have to compute the model error anew."""

    def fail(answer):
        raise AssertionError("computed in the process that serves")

    work = OpenDocument(SCENE)
    (screen,) = (screen for screen in SCENE.screens if screen.name == "Mode shapes")
    held, full = (
        task(SCENE, screen, work.entries) for task in (page_tasks.solve_for_drawing, page_tasks.solve)
    )
    shown = replace(screen, headline=fail, quick_headline=fail)
    assert "model error at most" in headline_of(work, shown, full)
    assert "first frequency" in (quick := headline_of(work, shown, held)) and "model error" not in quick


def test_headline_of_a_truck_that_never_stops():
    work = OpenDocument(VEHICLE)
    work.put("stop.friction", "0.05")
    assert work.solve(SCREEN)
    found = dict(SCREEN.headline(work.answered[SCREEN.name].answer))
    assert found["stopping distance"] == "never"


# Examples -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("program", [BRAKES, BEAMDYN], ids=lambda p: p.name)
def test_examples_are_designs_with_titles(program):
    found = examples_of(program)
    assert len(found) >= 4
    assert len({example.title for example in found}) == len(found)
    for example in found:
        assert example.document in program.documents and len(example.title) <= 110
        assert not example.title.endswith(
            (" of which", " front", " of", " the", " and")
        )  # cut within a clause
        example.document.check(example.text, example.name)


# On a narrow page -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("document", BRAKES.documents, ids=lambda d: d.name)
def test_narrow_paper_has_letters_of_the_same_size(document):
    """On a page of 390 px letters of 9 pt on 400 pt are 9 px high: they are read without zooming."""
    work = OpenDocument(document)
    for screen in document.screens:
        assert work.solve(screen)
        answer = work.answered[screen.name].answer
        wide, narrow = (draw_sheet(screen, answer, screen.last, narrow=n) for n in (False, True))
        if wide.element:
            assert 'viewBox="0 0 400 ' in narrow.element and 'viewBox="0 0 680 ' in wide.element
            sizes = [set(re.findall(r'font-size="([\d.]+)"', s.element)) for s in (wide, narrow)]
            assert min(map(float, sizes[1])) >= min(map(float, sizes[0]))
