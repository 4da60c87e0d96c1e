"""`beamdyn app`: pure functions, and its page used by a simulated client."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from beamdyn import frequency_locus, load_scene
from beamdyn.app.program import BEAMDYN, DECK, FREQUENCIES, SCENE, STEADY_STATE
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.rendering import csv_text, html
from beamdyn.common.screens.controls import DragSlider
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_tasks import drawn
from beamdyn.scene.physics import Physics

# Rows of an outline, of modes, of settings, of measured values, and of numbers to be found.
FEW_ROWS = {
    "Rotor": 83,
    "Mode shapes": 3,
    "Trade": 20,
    "Compare": 4,
    "Identify": 2,
    "Design": 2,
    "Loads": 22,
    "Map": 82,
}
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize("screen", SCENE.screens, ids=lambda s: s.name)
def test_screen_answers_draws_and_tabulates(screen):
    work = OpenDocument(SCENE)
    assert work.solve(screen), work.mistakes
    answer = work.answered[screen.name].answer
    assert drawn(screen, answer, 1.0).startswith("<?xml")
    assert "<table>" in html(screen.tables(answer))
    least = FEW_ROWS.get(screen.name, 101)
    assert len(csv_text(screen.rows(answer)).splitlines()) >= least


def test_frequencies_are_those_of_the_function():
    work = OpenDocument(SCENE)
    work.put("mount.setting_angle", "90 deg")
    work.put("options.modes", "3")
    assert work.solve(FREQUENCIES), work.mistakes
    found = work.answered[FREQUENCIES.name].answer.locus
    (scene := SCENE.check(work.text(), "saved"))
    assert np.array_equal(found.frequency, frequency_locus(scene, found.speeds, 3).frequency)


def test_saved_file_is_a_scene_without_what_is_asked(tmp_path):
    work = OpenDocument(SCENE)
    (tmp_path / "scene.toml").write_text(work.text(), encoding="utf-8")
    assert load_scene(tmp_path / "scene.toml") == SCENE.check(SCENE.base, "base")


@pytest.mark.parametrize(
    "path, text, sentence",
    [
        ("options.modes", "0", "at least 1"),
        ("options.modes", "1.5", "whole number"),
        ("options.top_speed", "150", "give a unit"),
        ("mount.setting_angle", "0.5 m", "unit of length"),
        ("beam.thickness", "", "missing"),
        ("beam.thickness", "{ polynomial = 1 }", "list"),
        ("physics.shear", "true", "it needs shear_stiffness; give beam.poissons_ratio"),
        ("mount.root_stiffness", "-1 N m/rad", "0 is a hinge"),
    ],
)
def test_mistake_is_at_its_field(path, text, sentence):
    work = OpenDocument(SCENE)
    work.put(path, text)
    assert not work.solve(FREQUENCIES)
    ((where, said),) = work.mistakes[FREQUENCIES.name].items()
    assert where == path
    assert sentence in said[0]


@pytest.mark.parametrize(
    "kind, more", [("steady", {"speed"}), ("sampled", {"times"}), ("rolling", {"rolling_radius"})]
)
def test_motion_chooses_its_inputs(kind, more):
    work = OpenDocument(SCENE)
    work.put("motion.kind", kind)
    names = {entry.path.removeprefix("motion.") for entry in work.inputs if entry.path.startswith("motion.")}
    assert more <= names
    assert ("road.wavelength" in names) == (kind == "rolling")


def test_steady_response_without_motion_says_what_is_missing():
    work = OpenDocument(SCENE)
    work.open("\n".join(SCENE.base.partition("[motion]")[:1]), "scene")
    assert work.solve(FREQUENCIES), work.mistakes
    assert not work.solve(STEADY_STATE)
    assert "choose the motion" in str(work.mistakes[STEADY_STATE.name])


def test_tapered_beam_is_opened_and_saved():
    work = OpenDocument(SCENE)
    text = SCENE.base.replace('thickness = "0.2 mm"', 'thickness = { polynomial = ["0.3 mm", "-0.1 mm"] }')
    work.open(text, "tapered")
    assert work.solve(FREQUENCIES), work.mistakes
    assert SCENE.check(work.text(), "saved") == SCENE.check(text, "tapered")


def test_blade_of_stations_is_opened_and_saved():
    work = OpenDocument(SCENE)
    text = (EXAMPLES / "twisted_blade.toml").read_text(encoding="utf-8")
    work.open(text, "blade")
    assert "beam.bending_stiffness" in {entry.path for entry in work.inputs}  # not width and thickness
    assert SCENE.check(work.text(), "saved") == SCENE.check(text, "blade")
    assert work.entries["beam.stations"].count("\n") == 49  # a line a row, in the field and in the file
    assert "\n [0.00325, -13.308," in work.text()
    rows = work.entries["beam.stations"].replace("0.00325", "-1")
    work.put("beam.stations", rows)
    assert not work.solve(FREQUENCIES)
    ((where, said),) = work.mistakes[FREQUENCIES.name].items()
    assert (where, said[0][:24]) == ("beam.stations", "beam.stations[2][0] = -1")


def test_physics_is_chosen_and_an_empty_spring_is_clamped():
    work = OpenDocument(SCENE)
    for path, text in {
        "physics.planes": "2",
        "physics.rotary_inertia": "true",
        "beam.twist": "5 deg",
    }.items():
        work.put(path, text)
    scene = SCENE.check(work.text(), "saved")
    assert scene.physics == Physics(planes=2, rotary_inertia=True)
    assert scene.mount.root_stiffness == np.inf
    work.put("mount.root_stiffness", "0 N m/rad")
    assert SCENE.check(work.text(), "saved").mount.root_stiffness == 0


def test_page_shows_the_table_of_physics(simulate, fields):
    async def body(client):
        page = fields(await client())
        assert set(page.field("physics.planes").options) == {"", "1", "2"}
        assert page.field("mount.root_stiffness").props["placeholder"] == "clamped"
        assert page.field("beam.stations").props["type"] == "textarea"
        page.enter("physics.shear", "true")
        assert "give beam.poissons_ratio" in page.field("physics.shear").error

    simulate(BEAMDYN, body)


def test_hostile_text_changes_nothing():
    work = OpenDocument(SCENE)
    before = dict(work.entries)
    with pytest.raises(ConfigError):
        work.open("[beam]\nlength = '1 m'\n__import__ = 'os'", "hostile")
    assert work.entries == before


def test_a_file_opens_in_the_document_in_front_if_that_reads_it(monkeypatch):
    """A scene stays on the screens of harvesters; a blade of another program goes to that of decks."""
    page = pytest.importorskip("beamdyn.common.screens.page")
    monkeypatch.setattr(page.ui, "notify", lambda said: None)
    harvester, brought = next(each for each in BEAMDYN.documents if each.name == "harvester"), []
    works = {each.name: OpenDocument(each) for each in BEAMDYN.documents}
    front = SimpleNamespace(program=BEAMDYN, works=works, current=(harvester, None), _bring=brought.append)
    front._file = SimpleNamespace(close=lambda: None)
    for name in ("bir_tip.toml", "blade_stations.csv"):
        page.Page.open(front, (EXAMPLES / name).read_text(encoding="utf-8"), name)
    assert brought == [harvester, DECK]
    assert works["harvester"].entries["beam.tip.mass"] and works["harvester"].entries["harvest.speeds"]


def test_page_marks_a_mistake_and_slider_writes_the_field(simulate, fields):
    async def body(client):
        page = fields(await client())
        assert page.tabs() == [screen.name for document in BEAMDYN.documents for screen in document.screens]
        page.enter("mount.radius", "wide")
        assert "not a number with a unit" in page.field("mount.radius").error
        page.enter("mount.radius", "0.2 m")
        assert page.field("mount.radius").error is None
        made = page.user.client.elements.values()
        slider = next(e for e in made if isinstance(e, DragSlider) and "radius" in e.props["aria-label"])
        with page.user.client:
            slider.set_value(250)
        assert page.field("mount.radius").value == "250 mm"

    simulate(BEAMDYN, body)


def test_a_slider_without_a_unit_writes_a_number_alone(simulate, fields):
    async def body(another):
        page = fields(await another())
        page.go("Trade")
        elements = page.user.client.elements.values()
        sliders = (e for e in elements if isinstance(e, DragSlider))
        slider = next(e for e in sliders if e.props["aria-label"] == "digits, n")
        with page.user.client:
            slider.set_value(5)
        assert page.field("trade.digits").value == "5"

    simulate(BEAMDYN, body)


def test_notes_on_the_page_name_inputs_as_the_form_does(simulate, fields):
    async def body(another):
        page = fields(await another())
        page.go("Steady response")
        assert "Physics: shear = true includes it" in page.text()
        assert "[physics]" not in page.text()

    simulate(BEAMDYN, body)
