"""One description of an analysis makes its command, its screen and its section of the manual."""

import sys
from importlib import import_module
from pathlib import Path

import pytest
from cyclopts import App

import beamdyn as bd
from beamdyn.analyses import analyses
from beamdyn.analyses.analysis import Analysis
from beamdyn.analyses.options import Count, PositiveSpeed
from beamdyn.analyses.results import cautions
from beamdyn.app.analysis_screen import analysis_screen, first_entries
from beamdyn.app.deck_screen import DECK
from beamdyn.app.program import BEAMDYN, SCENE, SHOWN
from beamdyn.app.scene_form import ASIDE, inputs_of
from beamdyn.common.edge.toml_text import toml_of
from beamdyn.common.edge.units import InvalidInput
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.screens.form_entries import options_of, tables_of
from beamdyn.common.screens.open_document import OpenDocument

ROOT = Path(__file__).parents[2]
SCENE_FILE = str(ROOT / "examples" / "tyre_harvester.toml")


def fast_modes(scene, *, speed: "PositiveSpeed", modes: "Count" = 2):
    """Natural frequencies of a beam that turns.

    Parameters
    ----------
    speed
        Speed of rotation, such as "5 rad/s".
    modes
        How many.
    """
    return bd.natural_modes(scene, speed, modes)


FAST_MODES = Analysis(
    fast_modes, ('beamdyn fast-modes examples/tyre_harvester.toml --speed "50 rad/s"',), screen="Fast modes"
)


@pytest.fixture
def new_screen(monkeypatch):
    monkeypatch.setitem(ASIDE, "fast_modes", None)  # it is entered below, and gone afterwards
    return analysis_screen(FAST_MODES)


def entries(**changed: str) -> dict[str, str]:
    return {**SCENE.base_entries, **first_entries(FAST_MODES), **changed}


def solve(screen, given):
    return screen.solve(tables_of(given, inputs_of(given), screen.needs))


def test_the_command_has_the_options_and_writes_the_files(tmp_path, capsys):
    app = App(name="beamdyn", result_action="return_value")
    app.command(FAST_MODES.command(), name=FAST_MODES.name)
    out, report = tmp_path / "modes.json", tmp_path / "modes.html"
    app(["fast-modes", SCENE_FILE, "--speed", "477.46 rpm", "--json", str(out), "--report", str(report)])
    expected = bd.natural_modes(bd.load_scene(SCENE_FILE), 50.0, 2)
    assert bd.load(out).frequency == pytest.approx(expected.frequency, rel=1e-4)
    assert "477.46" in capsys.readouterr().out  # in the unit that was given
    assert "# beamdyn fast-modes" in report.read_text()
    assert "--speed &#x27;477.46 rpm&#x27; --modes 2" in report.read_text()
    app(["fast-modes", "--help"])
    assert 'Speed of rotation, such as "5 rad/s".' in capsys.readouterr().out


def test_the_screen_has_a_form_of_the_options_and_shows_the_result(new_screen):
    given = entries()
    assert given["fast_modes.speed"] == "50 rad/s"
    answer = solve(new_screen, given)
    assert len(answer.result.frequency) == 2
    assert len(list(new_screen.rows(answer))) == 3
    assert new_screen.draw(answer, 0.0).axes
    assert all(new_screen.picture(answer, narrow).axes for narrow in (False, True))
    assert solve(new_screen, entries(**{"fast_modes.modes": "3"})).result.frequency.size == 3


@pytest.mark.parametrize("name", ["compare", "identify"])
def test_screens_on_own_data_take_it_as_text_and_write_no_files(name):
    screen, described = analysis_screen(analyses((name,))[name]), analyses((name,))[name]
    given = {**SCENE.base_entries, **first_entries(described)}
    assert not any(f"{name}.{option}" in given for option in ("write", "file"))
    assert given[f"{name}.data"] == ""
    answer = solve(screen, given)
    assert len([*screen.rows(answer)]) > 1
    assert screen.draw(answer, 0.0).axes


def test_data_are_pasted_with_their_heads_and_refused_at_their_line():
    screen = next(each for each in SCENE.screens if each.name == "Compare")
    text = "position [mm], axial [N]\n0, -0.4512\n20, -0.2494\n"
    given = SCENE.base_entries | {"compare.measured": "", "compare.data": text}
    assert solve(screen, given).result.along == "position"
    with pytest.raises(ValueError, match="data: line 3"):
        solve(screen, given | {"compare.data": text.replace("20", "x")})
    with pytest.raises(InvalidValue, match=r"data: position = 0\.06 m"):
        solve(screen, given | {"compare.data": text.replace("20", "60")})
    assert next(e for e in inputs_of(given) if e.path == "compare.data").quantity.meaning.endswith("here.")


def test_a_deck_is_pasted_or_opened_and_makes_a_scene():
    given = DECK.base_entries
    (screen,) = DECK.screens
    found = screen.solve(tables_of(given, DECK.inputs(given)))
    expected = bd.read_deck(ROOT / "examples" / "blade_stations.csv", 40.0, 1.25)
    assert found.scene == expected.scene
    assert len([*screen.rows(found)]) > 5 and screen.draw(found, 0.0).axes
    assert "stations" in screen.more[0].on_page(found)
    text = (ROOT / "examples" / "blade_stations.csv").read_text()
    assert DECK.opened(text, "blade.csv")["deck.text"] == text
    assert DECK.accepts(text) and not DECK.accepts(SCENE.base) and not SCENE.accepts(text)
    saved = toml_of(tables_of(given, DECK.inputs(given)))
    assert DECK.opened(saved, "deck.toml") == {**given, "deck.text": given["deck.text"].strip()}
    with pytest.raises(ValueError, match="does not say the length"):
        screen.solve(tables_of(given | {"deck.length": ""}, DECK.inputs(given)))


@pytest.mark.parametrize("described", SHOWN, ids=lambda each: each.screen)
def test_screens_open_with_an_answer_and_a_picture_for_each_width(described):
    pairs = ((document, each) for document in BEAMDYN.documents for each in document.screens)
    document, screen = next(pair for pair in pairs if pair[1].name == described.screen)
    answer = solve(screen, document.base_entries)
    assert len([*screen.rows(answer)]) > 1 and [*screen.headline(answer)]
    assert all(screen.picture(answer, narrow).axes for narrow in (False, True))


def test_options_in_groups_have_fields_and_those_given_several_times_one_for_all():
    (described,) = analyses(("study",)).values()
    screen = next(each for each in SCENE.screens if each.name == "Map")
    given = SCENE.base_entries
    assert given["study.vary"] == "thickness=0.1:0.4:9 mm; speed=0:99:9 rad/s"
    assert not {"study.store", "study.workers", "study.together"} & {*given}
    result = solve(screen, given | {"study.vary": "mount.radius=0:300:3 mm; thickness=0.2,0.3 mm;"}).result
    assert [each.name for each in result.inputs] == ["mount.radius", "beam.thickness"]
    assert "An input and its values" in inputs_meaning("study.vary")
    assert first_entries(described)["study.vary"] == given["study.vary"]


def test_a_number_in_place_of_a_word_is_typed():
    """How many modes, or auto: an entry, as a list would have no number."""
    (screen,) = (each for each in SCENE.screens if each.name == "Frequency response")
    given = SCENE.base_entries | {"response.frequencies": "50, 60 Hz"}
    for text, kept in (("2", "2 modes"), ("auto", "all functions")):
        assert kept in solve(screen, given | {"response.modes": text}).result.provenance.method
    with pytest.raises(ValueError, match=r"response\.modes"):
        solve(screen, given | {"response.modes": "few"})


def test_a_number_is_typed_where_a_word_may_stand_as_well():
    given = SCENE.base_entries | {"response.modes": "3", "loads.modes": "auto"}
    known = {each.path: each for each in inputs_of(given)}
    assert options_of(known["response.modes"]) == ()  # it is no list of words
    assert options_of(known["beam.density"]) == () and options_of(known["motion.kind"])
    tables = tables_of(given, [*known.values()])
    assert tables["response"]["modes"] == 3 and tables["loads"]["modes"] == "auto"
    screen = next(each for each in SCENE.screens if each.name == "Frequency response")
    assert solve(screen, given).result.scene == solve(screen, SCENE.base_entries).result.scene


@pytest.mark.parametrize("name", ["Map", "Random road", "Frequency response"])
def test_what_follows_a_slider_waits_neither_for_model_errors_nor_for_the_choice_of_modes(name, monkeypatch):
    screen = next(each for each in SCENE.screens if each.name == name)
    work = OpenDocument(SCENE)
    monkeypatch.setattr(cautions, "_of_model_error", lambda *_: 1 / 0)
    found = work.attempt(screen, for_drawing=True)
    assert not found.is_whole and found.headline and screen.picture(found.answer, False).axes
    assert found.is_rough == (name != "Map")


def inputs_meaning(path):
    return next(each for each in inputs_of(SCENE.base_entries) if each.path == path).quantity.meaning


def test_refusals_stand_at_the_field(new_screen):
    with pytest.raises(InvalidInput) as refused:
        solve(new_screen, entries(**{"fast_modes.speed": "50"}))
    assert refused.value.field == "fast_modes.speed"
    with pytest.raises(InvalidValue) as refused:
        solve(new_screen, entries(**{"fast_modes.modes": "0"}))
    assert refused.value.field == "fast_modes.modes"


def test_the_manual_tells_every_option_of_every_analysis():
    sys.path.insert(0, str(ROOT / "docs" / "_ext"))
    page = import_module("analyses_page").page()
    sys.path.pop(0)
    for analysis in analyses().values():
        assert f"`beamdyn {analysis.name}`" in page
        assert all(analysis.meaning(name) for name in analysis.texts)
    assert "| `--top-speed` | Largest speed to search" in page
