"""The screen of mechanisms that files describe part by part."""

from pathlib import Path

import numpy as np
import pytest

from beamdyn.common.edge.config import ConfigError, parse
from beamdyn.common.edge.rendering import html, svg
from beamdyn.common.edge.toml_text import toml_of
from beamdyn.common.screens.form_entries import entries_of, tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_tasks import drawn, inputs_html
from brakes.app.program import BRAKES, CALIPER, MECHANISM
from brakes.cli import main
from brakes.config.mechanism import parse_mechanism

EXAMPLES = Path(__file__).parents[2] / "examples" / "calipers"
SCREEN = MECHANISM.screens[0]
FILES = {path.stem: path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.toml"))}
OF_PARTS = ("own-caliper", "toggle-clamp")


def opened(text):
    work = OpenDocument(MECHANISM)
    work.open(text, "mine.toml")
    return work


def answer(work):
    assert work.solve(SCREEN), work.mistakes
    return work.answered[SCREEN.name].answer


@pytest.mark.parametrize("name", OF_PARTS)
def test_file_of_parts_opens_solves_and_is_saved(name):
    work = opened(FILES[name])
    found = answer(work)
    assert "<table>" in html(SCREEN.tables(found))
    assert drawn(SCREEN, found, 0.5).startswith("<?xml")
    assert not SCREEN.notes(found)
    assert parse_mechanism(work.text()) == parse_mechanism(FILES[name])
    assert MECHANISM.opened(work.text(), "saved") == work.entries


def test_screen_shows_what_the_command_prints(finished):
    """Hibbeler, Statics, 14th edition, problem 6-80: the work takes 3.6427 times the hand's force."""
    printed = finished(main(["caliper", str(EXAMPLES / "toggle-clamp.toml")]), 0).out
    shown = html(SCREEN.tables(answer(opened(FILES["toggle-clamp"]))))
    assert "364.27" in printed and ">364.27<" in shown
    words = {word for line in printed.splitlines() for word in line.split() if any(map(str.isdigit, word))}
    missing = {word for word in words if word not in shown}
    assert not missing


def test_screen_shows_forces_without_friction_squeezing_and_releasing():
    text = FILES["toggle-clamp"]
    for line in ('at = "A"  ', 'at = "B"\n'):
        text = text.replace(line, f'radius = "8 mm"\n{line}')
    work = opened(text.replace("[run]", "[run]\nfriction = 0.5"))
    found = answer(work)
    shown = html(SCREEN.tables(found))
    assert all(f">{number}<" in shown for number in ("364.27", "241.44", "723.52"))
    assert "241.4 N squeezing, 723.5 N releasing" in SCREEN.draw(found, 0.0).axes[0].get_title()
    work.put("run.driver", "")
    work.put("run.travel", "")
    assert not work.solve(SCREEN)
    assert "run.driver" in work.mistakes[SCREEN.name]


@pytest.mark.parametrize("name", FILES)
def test_each_file_opens_on_one_screen(name):
    accepted = []
    for document in BRAKES.documents:
        try:
            document.opened(FILES[name], f"{name}.toml")
        except ConfigError as error:
            assert "screen of its own" in str(error) or document not in (CALIPER, MECHANISM)
        else:
            accepted.append(document)
    assert accepted == [MECHANISM if name in OF_PARTS else CALIPER]


def test_a_moved_point_moves_what_names_it():
    work = opened(FILES["toggle-clamp"])
    work.put("points.C", '["18 mm", "20 mm"]')
    text = FILES["toggle-clamp"].replace('C = ["20 mm", "20 mm"]', 'C = ["18 mm", "20 mm"]')
    one, other = answer(work), answer(opened(text))
    assert np.array_equal(one.over.amplitudes["work"], other.over.amplitudes["work"])
    assert parse_mechanism(work.text()) == parse_mechanism(text)


def test_handles_are_the_points_as_drawn():
    found = answer(opened(FILES["toggle-clamp"]))
    handles = {handle.label: handle for handle in SCREEN.handles(found, 1.0)}
    assert set(handles) == {"A", "B", "C", "D", "E", "grip"}
    assert handles["grip"].at == pytest.approx((0.080, 0.012), rel=1e-12)
    assert handles["grip"].moved(0.01, 0.02) == {"points.grip": (0.01, 0.02)}
    low, high = np.array(
        [SCREEN.draw(found, 1.0).axes[0].get_xlim(), SCREEN.draw(found, 1.0).axes[0].get_ylim()]
    ).T
    places = np.array([np.multiply(handle.scale, handle.at) for handle in handles.values()])
    assert np.ptp(places, axis=0) == pytest.approx([80.0, 94.641], abs=1e-3)  # A to D, and the grip: in mm
    assert ((low < places) & (places < high)).all()


def test_slider_goes_from_the_drawing_to_the_end_of_the_stroke():
    found = answer(opened(FILES["toggle-clamp"]))
    places = [svg(SCREEN.draw(found, part)) for part in (0.0, 0.5, 1.0)]
    assert len(set(places)) == 3
    assert places[0] == svg(found.figure())  # the position that the table of forces describes


def test_without_a_stroke_the_slider_has_nothing_to_move():
    found = answer(opened(FILES["toggle-clamp"].partition("[run]")[0]))
    assert found.motion is None
    assert svg(SCREEN.draw(found, 0.0)) == svg(SCREEN.draw(found, 1.0))


# Entries that are wrong ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "path, text, sentence",
    [
        ("pin", '[{ name = "A" ', "not valid TOML"),
        ("pin", "A", "not valid TOML"),
        ("pin", '"A"', "give a list of tables"),
        ("pin", '[{ name = "A", body = "arm", at = "X" }]', "no such point in [points]"),
        ("pin", '[{ name = "A", body = "arm" }]', "missing; give the point"),
        (
            "force",
            '[{ name = "F", body = "arm", at = "E", direction = [0, 1], magnitude = "1 m" }]',
            "length",
        ),
        ("bodies", "arm, handle", "give a list in brackets"),
        ("bodies", "", "missing"),
        ("points.A", '["1 mm"]', "give two values"),
        ("points.A", "here", "no such point"),
        ("run.driver", "foot", "no such load; name one of hand, work"),
        ("run.travel", "10 deg", "moves by a length"),
        ("caliper.pads", '["a", "b"]', "caliper.cable: missing"),
    ],
)
def test_mistake_is_a_sentence(path, text, sentence):
    work = opened(FILES["toggle-clamp"])
    before = answer(work)
    work.put(path, text)
    assert not work.solve(SCREEN)
    said = [s for sentences in work.mistakes[SCREEN.name].values() for s in sentences]
    assert any(sentence in s for s in said), said
    assert work.answered[SCREEN.name].answer is before
    if path not in ("caliper.pads", "bodies"):
        assert path in work.mistakes[SCREEN.name]


@pytest.mark.parametrize("travel", ["15 mm", "1 km"])
def test_a_stroke_past_the_toggle_is_refused_as_the_command_does(travel, tmp_path, finished):
    work = opened(FILES["toggle-clamp"])
    work.put("run.travel", travel)
    assert not work.solve(SCREEN)
    (said,) = work.mistakes[SCREEN.name].values()
    file = tmp_path / "far.toml"
    file.write_text(work.text(), encoding="utf-8")
    assert said[0] in finished(main(["caliper", str(file)]), 1).err


def test_what_statics_does_not_determine_is_a_note():
    work = opened(FILES["toggle-clamp"].partition("[run]")[0])
    held = work.entries["pin"].replace("]", ',\n { name = "extra", body = "arm", at = "E" }]')
    work.put("pin", held)
    (note,) = SCREEN.notes(answer(work))[:1]
    assert "not determined" in note or "indeterminate" in note or "determine" in note


def test_names_with_spaces_are_kept_and_names_with_dots_refused():
    spaced = FILES["toggle-clamp"].replace('grip = ["80', '"the grip" = ["80').replace('"grip"', '"the grip"')
    work = opened(spaced)
    assert work.entries["points.the grip"] == '["80 mm", "12 mm"]'
    assert parse_mechanism(work.text()) == parse_mechanism(spaced)
    dotted = spaced.replace("the grip", "the.grip")
    with pytest.raises(ConfigError, match=r'points: "the\.grip" has a dot'):
        opened(dotted)
    assert parse_mechanism(dotted)  # which the command does read


# Lists of tables as entries -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", OF_PARTS)
def test_lists_are_entries_of_a_line_a_part_and_come_back(name):
    tables = parse(FILES[name], name)
    inputs = MECHANISM.inputs(entries_of(tables, ()))
    entries = entries_of(tables, inputs)
    assert tables_of(entries, inputs) == tables
    assert len(entries["pin"].splitlines()) == len(tables["pin"]) == 2
    assert parse(toml_of(tables), "again") == tables
    assert toml_of(tables).count("[[pin]]") == 2


# On the page --------------------------------------------------------------------------------------------


def test_a_file_of_parts_opens_on_its_screen_and_a_caliper_on_its_own(simulate, fields):
    async def body(client):
        page = fields(await client())
        page.go("Mechanism")
        assert page.field("pin.0.body").value == "arm"
        page.leave("points.C.x", "here")
        assert 'points.C = "here": not a number with a unit' in page.text()
        page.leave("points.C.x", "20 mm")
        assert "not a number with a unit" not in page.text()

    simulate(BRAKES, body)


def test_fields_of_a_caliper_are_shown_where_loads_are_its_cable_and_pads(simulate, fields):
    async def body(client):
        page = fields(await client())
        page.go("Mechanism")
        field = page.field("caliper.cable")
        idle = ("run.finger", "run.wear", "stop.mass")

        def shown():
            return [all(each.visible for each in page.field(p).ancestors()) for p in idle]

        assert shown() == [False, False, False]
        page.enter("caliper.cable", "hand")
        assert shown() == [True, True, True]
        assert page.field("caliper.cable") is field  # which is typed into, and keeps the focus
        page.enter("caliper.cable", "")
        assert shown() == [False, False, False]

    simulate(BRAKES, body)


def test_what_a_file_gives_though_it_means_nothing_is_kept_and_shown():
    work = opened(FILES["toggle-clamp"].replace("[run]", '[run]\nfinger = "30 N"\n'))
    assert work.entries["run.finger"] == "30 N" and 'finger = "30 N"' in work.text()
    assert work.idle >= {"run.wear", "stop.mass"} and "run.finger" not in work.idle
    page = inputs_html(work)
    assert "thicknesses lost" not in page and "force of the finger" in page


def test_free_bodies_are_drawn_when_they_are_opened(simulate, fields):
    async def body(client):
        page = fields(await client())
        page.go("Mechanism")
        folds = [e for e in page.user.client.elements.values() if e.props.get("label") == "Free bodies"]
        assert len(folds) == 2  # of the caliper and of the mechanism

        def drawings():
            written = [str(e.props.get("innerHTML")) for e in page.user.client.elements.values()]
            return [text for text in written if "Free body of handle" in text]

        assert not drawings()
        with page.user.client:
            folds[1].set_value(True)
        before = drawings()
        assert len(before) == 1
        page.leave("points.C.x", "18 mm")
        assert len(drawings()) == 1
        assert drawings() != before

    simulate(BRAKES, body)
