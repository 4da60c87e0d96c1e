"""The model beside the numbers on the beam's screens, and screens whose answers take long."""

import asyncio
import re
import threading
import time
from dataclasses import replace

import pytest
from nicegui.testing.user_interaction import UserInteraction

from beamdyn.app.program import BEAMDYN, FREQUENCIES, SCENE, STEADY_STATE
from beamdyn.common.edge.rendering import csv_text, html
from beamdyn.common.screens.computations import SOON
from beamdyn.common.screens.controls import DragSlider
from beamdyn.common.screens.form_entries import tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_tasks import report_of
from beamdyn.common.screens.screens import Program
from beamdyn.scene.physics import AUTO
from tests.app.conftest import InThread
from tests.app.serving import PATIENCE

pytestmark = pytest.mark.filterwarnings("ignore::beamdyn.common.results.statements.OutsideLinearTheory")
AT_45 = {
    "beam.poissons_ratio": "0",
    "mount.setting_angle": "45 deg",
    "options.top_speed": "100 rad/s",
    "options.modes": "1",
}
LINEAR, TRUE = 55.62, 60.66  # Hz, at 100 rad/s: of the straight beam, and in fact; printed to 0.01


def opened(**more):
    work = OpenDocument(SCENE)
    for path, text in (AT_45 | more).items():
        work.put(path, text)
    return work


def written(report):
    """What stands in HTML, without its marks."""
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", re.sub(r"</?span[^>]*>|<img[^>]*>", "", report)))


def test_linear_frequency_stands_beside_what_it_leaves_out():
    work = opened()
    assert work.solve(FREQUENCIES), work.mistakes
    found = work.answered[FREQUENCIES.name]
    rows = csv_text(FREQUENCIES.rows(found.answer)).splitlines()
    last = dict(zip(rows[0].split(","), rows[-1].split(","), strict=True))
    assert float(last["frequency_Hz_1"]) == pytest.approx(LINEAR, abs=0.005)
    error = float(last["model_error_1"])
    assert error == pytest.approx(TRUE / LINEAR - 1, abs=2e-4)  # both printed to 0.01 of 60
    page = written(report_of(work, "Mine"))
    assert re.search(r"\b100 55\.62\d+ 9e-02", page)
    for words in (page, written(html(found.tables))):
        assert "left out at 100 rad/s: large deflection +9.1 %" in words
    for words in (page, " ".join(found.notes)):
        assert "large deflection, left out, changes the answer by +9.1 %" in words


def test_automatic_physics_is_chosen_on_the_screen_and_says_what_it_added():
    work = opened(**{"physics.auto": "true"})
    assert work.solve(FREQUENCIES), work.mistakes
    found = work.answered[FREQUENCIES.name]
    assert found.answer.locus.frequency[-1, 0] == pytest.approx(TRUE, abs=0.005)
    page = written(report_of(work, "Mine"))
    assert (
        page.count("physics &quot;auto&quot;, tolerance 0.001: large deflection (") == 2
    )  # loci and resonances
    assert "[physics] auto = true" in page
    assert not any("left out, changes" in note for note in found.notes)


@pytest.mark.parametrize("screen", SCENE.screens, ids=lambda s: s.name)
@pytest.mark.parametrize(
    "path, text, sentence",
    [
        ("physics.camber", "true", "it cannot be combined with large_deflection"),
        ("physics.auto", "true", "physics is auto"),
        ("mount.root_stiffness", "0 N m/rad", "large_deflection"),
    ],
)
def test_large_deflection_refuses_by_name_what_it_does_not_do(screen, path, text, sentence):
    work = opened(**{"physics.large_deflection": "true", "beam.poissons_ratio": "0.3", path: text})
    assert not work.solve(screen)
    ((where, said),) = work.mistakes[screen.name].items()
    assert where == ("physics.large_deflection" if path == "physics.auto" else path)
    assert sentence in said[0]


def test_automatic_physics_of_a_file_has_its_field_and_stays():
    work = OpenDocument(SCENE)
    work.open('physics = "auto"\n' + SCENE.base, "mine")
    assert work.entries["physics.auto"] == "true"
    work.put("mount.radius", "0.2 m")
    assert SCENE.check(work.text(), "saved").physics == AUTO


@pytest.mark.parametrize("auto, said", [("", "large deflection, left out"), ("true", '"auto" added large')])
def test_sweep_says_what_is_left_out_and_what_was_added(auto, said):
    work = opened(**{"physics.auto": auto})
    tables = tables_of(work.needed(STEADY_STATE), work.inputs)
    swept = FREQUENCIES.sweeps.run(tables, "mount.setting_angle=0:45:2 deg", "frequency_1")
    assert swept.found[0][1] == pytest.approx(TRUE if auto else LINEAR, abs=0.005)
    assert swept.results == ("frequency_1", "model_error")
    (sentence,) = swept.warnings
    assert said in sentence and "at 1 of 2 values" in sentence
    below = FREQUENCIES.sweeps.draw(swept).get_supxlabel()
    assert below.replace("\n", " ") == sentence


# Forms and answers that take long -----------------------------------------------------------------------


def elements(page, path):
    """The fields of an input, on all screens."""
    return [e for e in page.user.client.elements.values() if e.props.get("data-path") == path]


def test_each_screen_shows_the_entries_that_it_solves(simulate, fields):
    async def body(client):
        page = fields(await client())
        page.enter("mount.radius", "0.2 m")
        page.enter("motion.kind", "steady")
        page.go(STEADY_STATE.name)
        assert [field.value for field in elements(page, "mount.radius")] == ["0.2 m"] * 2
        assert elements(page, "motion.rolling_radius") == []

    two = replace(SCENE, screens=(FREQUENCIES, STEADY_STATE))
    simulate(Program("two", "Two screens", (two,)), body)


def test_slider_follows_its_field_and_leaves_it_as_it_is(simulate, fields):
    async def body(client):
        page = fields(await client())
        sliders = [e for e in page.user.client.elements.values() if isinstance(e, DragSlider)]
        slider = next(e for e in sliders if "radius" in e.props["aria-label"])
        for text, at in (("0.2003 m", 200.3), ("1 m", 500.0), ("wide", 500.0)):
            page.enter("mount.radius", text)
            assert slider.value == pytest.approx(at, rel=1e-9)
            assert page.field("mount.radius").value == text

    simulate(BEAMDYN, body)


class Slow:
    """A screen that answers when it is let go."""

    def __init__(self):
        self.go, self.solved = threading.Event(), []
        # Without tables: those that take long on a machine are computed separately, after the drawing.
        told = {"coarser": lambda tables: tables, "tables": lambda answer: (), "notes": lambda answer: ()}
        self.screen = replace(FREQUENCIES, solve=self.solve, **told)
        self.program = Program("slow", "Slow", (replace(SCENE, screens=(self.screen,)),))

    def solve(self, tables):
        assert self.go.wait(PATIENCE)
        self.solved.append(tables["mount"]["radius"])
        return FREQUENCIES.solve(tables)


def element(user, words):
    """What is called so; or the entry of a menu that says so, in a part of its own."""
    made = user.client.elements.values()
    found = next(e for e in made if words in (e.props.get("aria-label"), getattr(e, "text", None)))
    return found.parent_slot.parent if found.tag == "q-item-section" else found


async def becomes(said, page):
    for _ in range(20 * PATIENCE):
        if said in page.text():
            return
        await asyncio.sleep(0.05)
    raise AssertionError(page.text())


def test_page_goes_on_while_an_answer_takes_long_and_solves_the_newest_entries_next(simulate, fields):
    slow = Slow()

    async def body(client):
        slow.go.set()
        page = fields(await client())
        await becomes("Up to date.", page)
        slow.go.clear()
        slow.solved.clear()
        for radius in ("0.11 m", "0.12 m", "0.13 m", "0.14 m"):
            page.enter("mount.radius", radius)
            assert "Computing. Stale: for the entries before." in page.text()
        await asyncio.sleep(2 * SOON)
        assert page.greyed() == 1
        slow.go.set()
        await becomes("Up to date.", page)
        assert slow.solved == ["0.11 m", "0.14 m"]
        assert page.greyed() == 0

    simulate(slow.program, body, InThread())


def test_the_picture_of_an_answer_comes_first_and_its_tables_follow(simulate, fields):
    go, drawn, tabled = threading.Event(), [], []

    def charts(answer, _):
        drawn.append(answer.locus.scene.mount.radius)
        return FREQUENCIES.charts(answer)

    def tables(answer):
        time.sleep(1.2 * SOON)
        assert go.wait(PATIENCE)
        tabled.append(answer.locus.scene.mount.radius)
        return [f"a table of {tabled[-1]:g} m"]

    async def body(client):
        go.set()
        page = fields(await client())
        await becomes("Up to date.", page)
        go.clear()
        page.enter("mount.radius", "0.13 m")
        await becomes("Preliminary. The tables follow.", page)
        assert drawn[-1] == 0.13 and "a table of 0.215 m" in page.text()
        assert page.greyed() == 0 and "Up to date." not in page.text()
        go.set()
        await becomes("Up to date.", page)
        assert "a table of 0.13 m" in page.text() and tabled == [0.215, 0.13]

    screen = replace(FREQUENCIES, charts=charts, tables=tables)
    simulate(Program("later", "Later", (replace(SCENE, screens=(screen,)),)), body, InThread())


def test_tables_that_fail_leave_the_picture_and_say_so(simulate, fields):
    def tables(answer):
        time.sleep(1.2 * SOON)
        if answer.locus.scene.mount.radius == 0.13:
            raise ValueError("it has no table")
        return ["a table"]

    async def body(client):
        page = fields(await client())
        await becomes("Up to date.", page)
        page.enter("mount.radius", "0.13 m")
        await becomes("it has no table", page)
        assert "Refused. Stale: for the entries before." in page.text() and page.greyed() == 1
        page.enter("mount.radius", "0.14 m")
        await becomes("Up to date.", page)
        assert "no table" not in page.text() and page.greyed() == 0

    screen = replace(FREQUENCIES, tables=tables)
    simulate(Program("none", "None", (replace(SCENE, screens=(screen,)),)), body, InThread())


def test_one_click_opens_the_scene_of_a_deck(simulate, fields):
    async def body(client):
        page = fields(await client())
        page.go("Deck")
        button = element(page.user, "Open its scene")
        with page.user.client:
            (listener,) = [e for e in button._event_listeners.values() if e.type == "click"]
            button._handle_event({"listener_id": listener.id, "args": {}})
        await asyncio.sleep(0.1)
        assert page.field("beam.length").value == "40 m"
        assert page.field("options.top_speed").value == "3.1 rad/s"
        page.go("Frequencies")
        await becomes("Up to date.", page)

    simulate(BEAMDYN, body)


@pytest.mark.parametrize("solver", [None, InThread()])
def test_an_answer_that_cannot_be_shown_is_an_error_and_not_computed_forever(simulate, fields, solver):
    def chart(answer, _):
        if answer.locus.scene.mount.radius == 0.13:
            raise TypeError("of a kind that no one has foreseen")
        return FREQUENCIES.charts(answer)

    async def body(client):
        page = fields(await client())
        await becomes("Up to date.", page)
        page.enter("mount.radius", "0.13 m")
        await becomes("of a kind that no one has foreseen", page)
        assert "Computing" not in page.text() and "Up to date." not in page.text()
        assert page.greyed() == 1
        page.enter("mount.radius", "0.14 m")
        await becomes("Up to date.", page)
        assert "foreseen" not in page.text() and page.greyed() == 0

    screen = replace(FREQUENCIES, charts=chart)
    simulate(Program("unshown", "Unshown", (replace(SCENE, screens=(screen,)),)), body, solver)


def test_report_and_downloads_wait_for_the_answer(simulate, fields):
    slow = Slow()

    async def body(client):
        slow.go.set()
        user = await client()
        page = fields(user)
        await becomes("Up to date.", page)
        wanted = {"Report as HTML": "<table>", f"download {FREQUENCIES.name} as CSV": "frequency_Hz_1"}
        for i, (label, head) in enumerate(wanted.items()):
            slow.go.clear()
            page.enter("mount.radius", f"0.1{i} m")
            assert "Computing" in page.text()
            UserInteraction(user, {element(user, label)}, None).click()
            await asyncio.sleep(0.1)
            slow.go.set()
            assert head in (await user.download.next(timeout=PATIENCE)).text
            assert "Computing" not in page.text()

    simulate(slow.program, body, InThread())
