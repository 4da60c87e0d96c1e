"""Points of drawings that are moved: where they are in the picture, what they write, and their page."""

import asyncio
import dataclasses
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from matplotlib.figure import Figure

from beamdyn.common.drawing.shapes import Disc, points_of_shape
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.handles import Sheet, changed_texts, describe_place, draw_sheet
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.screen_view import ScreenView
from beamdyn.common.screens.screens import Screen
from brakes.app.program import BRAKES, CALIPER, FORKLIFT, KINEMATICS, VEHICLE
from brakes.calipers import NAMED
from tests.app.serving import wait_for

SVG = "{http://www.w3.org/2000/svg}"
DRUM = next(document for document in BRAKES.documents if document.name == "drum")
CALIPERS = CALIPER.screens[0]
WITHOUT = {"Internal forces"}


def answered(document, screen, entries=()):
    work = OpenDocument(document)
    for path, text in dict(entries).items():
        work.put(path, text)
    assert work.solve(screen), work.mistakes
    return work, work.answered[screen.name].answer


def cases():
    for document in BRAKES.documents:
        for screen in document.screens:
            places = (0.0, 0.5, 1.0, 1.7, 2.0) if screen is KINEMATICS else (0.3, 1.0)
            for place in places if screen.slider else (1.0,):
                if screen.name not in WITHOUT:
                    entries = (
                        {"run.travel": "8 mm"} if screen.name == "Mechanism" else {}
                    )  # far from its toggle
                    yield pytest.param((document, screen, entries, place), id=f"{screen.name} at {place}")
    for name in NAMED:
        yield pytest.param((CALIPER, CALIPERS, {"caliper": name}, 1.0), id=name)


@dataclasses.dataclass
class Case:
    """A screen with an answer, and its drawing."""

    screen: Screen
    entries: dict
    work: OpenDocument
    answer: object
    place: float
    sheet: Sheet


@pytest.fixture(scope="module", params=[*cases()])  # solved and drawn once for all tests
def case(request):
    document, screen, entries, place = request.param
    work, answer = answered(document, screen, entries)
    return Case(screen, entries, work, answer, place, draw_sheet(screen, answer, place))


def named(handles, label):
    return next(handle for handle in handles if handle.label == label)


# In the picture -----------------------------------------------------------------------------------------


def test_handle_is_where_the_svg_has_its_point(case):
    """The view is made from the layout; the SVG says where its points really are."""
    root = ET.fromstring(case.sheet.element)
    size = np.array(root.get("viewBox").split()[2:], dtype=float)
    assert case.sheet.ratio == pytest.approx(size[0] / size[1], rel=1e-6)
    grips = root.findall(f".//{SVG}circle[@class='grip']")
    for grip, handle in zip(grips, case.sheet.handles, strict=True):
        assert grip.get("id").endswith(handle.label.replace(" ", "-"))
        at = np.array([float(grip.get("cx")), float(grip.get("cy"))]) / size
        # numbers in the SVG have four decimals of a point
        np.testing.assert_allclose(case.sheet.place(handle), at, rtol=0, atol=1e-6)


def test_drawing_has_the_point_that_a_handle_moves(case):
    ((drawing, *_), *_) = case.screen.drawings(case.answer, case.place)
    circles = [shape for shape in drawing.shapes if isinstance(shape, Disc)]
    points = [points_of_shape(shape) for shape in drawing.shapes if not isinstance(shape, Disc)]
    points = np.vstack([*points, [circle.centre for circle in circles] or np.empty((0, 2))])
    for handle in case.sheet.handles:
        at = handle.scale * np.array(handle.at)
        on_circle = [abs(np.hypot(*(at - circle.centre)) - circle.radius) for circle in circles]
        assert min(*np.hypot(*(points - at).T), *on_circle) < 1e-9 * handle.scale, handle.label


def test_no_label_lies_under_a_handle(case):
    layout = case.sheet.view.layout
    for place in map(layout.fit.to_paper, layout.drawing.points.values()):
        for text in layout.texts:
            nearest = np.clip(place, text.box[:2], text.box[2:])
            assert np.hypot(*(nearest - place)) > 6.0, text.lines  # radius of a handle [pt]


def test_place_and_point_are_inverse():
    _, answer = answered(FORKLIFT, VEHICLE)
    made = draw_sheet(VEHICLE, answer, 1.0)
    for place in ((0.0, 0.0), (0.2, 0.9), (1.0, 0.5)):
        assert made.view.place(made.view.point(place)) == pytest.approx(place, abs=1e-12)


def test_held_picture_of_the_same_design_is_the_same(case):
    held = draw_sheet(case.screen, case.answer, case.place, case.sheet.view)
    assert held.element == case.sheet.element


@pytest.mark.parametrize(
    "document, entries",
    [
        (CALIPER, {"dimensions.housing": '["-38 mm", "60 mm"]'}),
        (DRUM, {"shoe.pivot_offset": "33 mm", "shoe.pivot_depth": "96 mm"}),
    ],
    ids=["caliper", "drum"],
)
def test_held_picture_of_another_design_stays_in_place(document, entries):
    (screen,) = document.screens
    _, answer = answered(document, screen)
    _, other = answered(document, screen, entries)
    held = draw_sheet(screen, answer, 1.0).view
    kept, free = draw_sheet(screen, other, 1.0, held).view, draw_sheet(screen, other, 1.0).view
    ends = np.array([[0.0, 0.0], [1.0, 1.0]])  # corners of the picture, as points of the drawing
    at_first, still, elsewhere = ([view.point(end) for end in ends] for view in (held, kept, free))
    np.testing.assert_allclose(still, at_first, rtol=0, atol=1e-9)
    assert np.abs(np.subtract(elsewhere, at_first)).max() > 1e-4  # else nothing had to be kept


def test_locked_brake_is_drawn_in_its_place_with_handles_that_lead_back():
    _, good = answered(DRUM, DRUM.screens[0])
    held = draw_sheet(DRUM.screens[0], good, 1.0)
    _, locked = answered(DRUM, DRUM.screens[0], {"brake.friction": "1.2"})
    made = draw_sheet(DRUM.screens[0], locked, 1.0, held.view)
    assert [handle.label for handle in made.handles] == [handle.label for handle in held.handles]
    assert [made.place(handle) for handle in made.handles] == [held.place(handle) for handle in held.handles]
    assert "1: locks from" in made.element


@pytest.mark.parametrize(
    "document, screen, entries, mark",
    [
        (DRUM, DRUM.screens[0], {"brake.friction": "1.2"}, "locks from"),
        (FORKLIFT, VEHICLE, {"stop.slope": "40 deg"}, "does not stop"),
    ],
    ids=["drum locks", "never stops"],
)
def test_what_has_no_answer_is_drawn_with_a_mark_and_without_matplotlib(
    document, screen, entries, mark, monkeypatch
):
    _, answer = answered(document, screen, entries)
    monkeypatch.setattr(Figure, "savefig", lambda *_, **__: pytest.fail("the server draws no figure"))
    assert mark in draw_sheet(screen, answer, screen.last).element


# In the fields ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", [(1, -0.5), (-0.7, 0.9)])
def test_moved_point_is_really_there(case, way):
    """Written into the fields and solved: the point is where it was wanted, or says the same again."""
    work, screen = case.work, case.screen
    for handle in case.sheet.handles:
        far = 6 * handle.step * np.array(way)
        target = tuple(np.array(handle.at) + far)
        values = handle.moved(*target)
        texts = changed_texts(handle, target, work.entries, work.inputs)
        assert set(texts) <= set(values)
        assert texts
        _, other = answered(work.document, screen, case.entries | texts)
        again = named(screen.handles(other, case.place), handle.label)
        # a length is rounded to a grain, an angle to 0.1 deg, 0.28 mm of the larger drum
        for path, value in again.moved(*again.at).items():
            atol = 1.5e-3 if "angle" in path or "tilt" in path or "lining_" in path or "slope" in path else (
                1.2 * handle.grain)  # fmt: skip
            np.testing.assert_allclose(value, values[path], rtol=0, atol=atol, err_msg=path)
        if np.size([*values.values()]) == 2:
            assert np.hypot(*(np.array(again.at) - target)) < 2 * handle.grain, handle.label


def texts_of(document, screen, label, by, entries=(), place=0.0):
    work, answer = answered(document, screen, entries)
    handle = named(screen.handles(answer, place), label)
    return changed_texts(handle, (handle.at[0] + by[0], handle.at[1] + by[1]), work.entries, work.inputs)


def test_only_what_changes_is_written_in_the_fields_unit():
    tip = "tip of the shoe"
    assert texts_of(FORKLIFT, KINEMATICS, tip, (1e-3, 0)) == {"brake.tip_x": "62.5 mm"}
    in_metres = {"brake.tip_x": "0.06155 m"}
    assert texts_of(FORKLIFT, KINEMATICS, tip, (1e-3, 0), in_metres) == {"brake.tip_x": "0.0625 m"}
    in_inches = {"brake.tip_y": "4 in"}
    assert texts_of(FORKLIFT, KINEMATICS, tip, (0, 0.01), in_inches) == {"brake.tip_y": "4.394 in"}
    assert texts_of(FORKLIFT, KINEMATICS, tip, (4e-5, -4e-5)) == {}


def test_point_that_is_not_given_is_written_from_its_default():
    found = texts_of(CALIPER, CALIPERS, "roller between the arms", (2e-3, 0))
    assert found == {"dimensions.roller": '["15.0 mm", "1 mm"]'}
    given = {"dimensions.roller": '["1.3 cm", "0.001 m"]'}
    found = texts_of(CALIPER, CALIPERS, "roller between the arms", (0, 2e-3), given)
    assert found == {"dimensions.roller": '["1.3 cm", "0.0030 m"]'}


@pytest.mark.parametrize("wrong", ["wide", "", "[1, 2", '["1 mm"]', "[[1], {}]"])
def test_mistake_in_the_field_is_written_over(wrong):
    work, answer = answered(FORKLIFT, KINEMATICS)
    handle = named(KINEMATICS.handles(answer, 0.0), "tip of the shoe")
    found = changed_texts(handle, handle.at, work.entries | {"brake.tip_x": wrong}, work.inputs)
    assert found == {"brake.tip_x": "61.5 mm"} or found == {"brake.tip_x": "61.6 mm"}
    work, answer = answered(CALIPER, CALIPERS)
    handle = named(CALIPERS.handles(answer, 0.0), "right pad")
    entries = work.entries | {"dimensions.pad": wrong or "0"}
    assert changed_texts(handle, handle.at, entries, work.inputs) == {
        "dimensions.pad": '["12.5 mm", "-46.0 mm"]'
    }


def test_point_of_a_caliper_that_is_no_longer_named_writes_nothing():
    work, answer = answered(CALIPER, CALIPERS)
    work.put("caliper", "v-brake")
    for handle in CALIPERS.handles(answer, 1.0):
        found = changed_texts(handle, (0.0, 0.0), work.entries, work.inputs)
        assert set(found) <= {"dimensions.pad", "dimensions.clamp"}  # both kinds have these


def test_words_say_where_a_handle_is():
    work, answer = answered(CALIPER, CALIPERS)
    handle = named(CALIPERS.handles(answer, 1.0), "pivot of the arm of the right pad")
    assert describe_place(handle, work.entries, work.inputs) == 'side pivot ["27 mm", "4 mm"]'
    work, answer = answered(FORKLIFT, VEHICLE)
    handle = named(VEHICLE.handles(answer, 1.0), "centre of gravity of the load")
    assert describe_place(handle, work.entries, work.inputs) == "load cg x -1.20 m, load cg y 0.450 m"


def test_nothing_is_minus_nothing():
    assert texts_of(CALIPER, CALIPERS, "right pad", (-0.0125 - 1e-9, 0))["dimensions.pad"].startswith('["0.0')


def test_clearance_is_written_at_rest_alone():
    inward = (-2e-3 * np.cos(np.radians(56.5)), -2e-3 * np.sin(np.radians(56.5)))
    label = "contact of the lining"
    assert texts_of(FORKLIFT, KINEMATICS, label, inward) == {"brake.clearance": "12.6 mm"}
    on_drum = texts_of(FORKLIFT, KINEMATICS, label, (0.01, -0.01), place=1.0)
    assert set(on_drum) == {"brake.contact_angle"}


# On the page --------------------------------------------------------------------------------------------


class Handles:
    """What a simulated client does to the handles of a page."""

    def __init__(self, page):
        self.page = page

    def element(self, label):
        elements = self.page.user.client.elements.values()
        return next(e for e in elements if "handle" in e.classes and e.props["aria-label"] == label)

    def send(self, label, kind, *args):
        element = self.element(label)
        listener = next(it for it in element._event_listeners.values() if it.type == kind)
        element._handle_event({"listener_id": listener.id, "args": list(args)})

    def place(self, label):
        style = self.element(label).style
        return float(style["left"].rstrip("%")) / 100, float(style["top"].rstrip("%")) / 100

    async def pull(self, label, across, down, done=False):
        x, y = self.place(label)
        self.send(label, "pointerdown", x + across, y + down, done)
        await asyncio.sleep(0.1)

    def picture(self, name):
        elements = self.page.user.client.elements.values()
        boards = [e for e in elements if e.props.get("data-words", "").startswith(name)]
        return next(e.props["data-picture"] for e in boards)


def on_page(simulate, fields, name, body):
    async def opened(client):
        page = fields(await client())
        page.go(name)
        await body(page, Handles(page))

    simulate(BRAKES, opened)


def test_pulled_point_writes_fields_and_is_drawn_there(simulate, fields):
    async def body(page, handles):
        label, before = "adjuster's pin", handles.picture("Kinematics")
        x, y = handles.place(label)
        await handles.pull(label, -0.03, 0.02)
        assert handles.place(label) == pytest.approx((x - 0.03, y + 0.02), abs=1e-3)  # a grain is 3e-4
        assert page.field("brake.adjuster_x").value != "53.04 mm"
        await handles.pull(label, 0.0, 0.0, done=True)
        texts = {path: page.field(path).value for path in ("brake.adjuster_x", "brake.adjuster_y")}
        _, answer = answered(FORKLIFT, KINEMATICS, texts)
        # let go, the drawing is the usual one of that design, with nothing over it
        usual = draw_sheet(KINEMATICS, answer, 2.0).name
        await wait_for(lambda: handles.picture("Kinematics") == usual)
        assert usual != before

    on_page(simulate, fields, "Kinematics", body)


def test_picture_stays_while_a_point_is_held_and_is_fitted_when_it_is_let_go(simulate, fields):
    async def body(page, handles):
        label, other = "stop of the housing, on the arm of the left pad", "right pad"
        before = handles.place(other)
        await handles.pull(label, 0.05, -0.15)
        assert handles.place(other) == pytest.approx(before, abs=1e-5)
        await handles.pull(label, 0.0, 0.0, done=True)
        assert handles.place(other) != pytest.approx(before, abs=1e-2)
        texts = {"dimensions.housing": page.field("dimensions.housing").value}
        assert (
            handles.picture("Caliper")
            == draw_sheet(CALIPERS, answered(CALIPER, CALIPERS, texts)[1], 1.0).name
        )

    on_page(simulate, fields, "Caliper", body)


def test_pulled_too_far_marks_the_fields_and_back_recovers(simulate, fields):
    async def body(page, handles):
        label, before, grey = "tip of the shoe", handles.picture("Kinematics"), page.greyed()
        x, y = handles.place(label)
        await handles.pull(label, 0.4, 0.0)
        assert page.greyed() == grey + 1
        assert "it must lie inside the drum" in page.field("brake.tip_x").error
        assert handles.place(label) == (x, y)
        assert handles.picture("Kinematics") == before
        await handles.pull(label, 0.0, 0.0, done=True)
        assert page.greyed() == grey
        assert page.field("brake.tip_x").error is None

    on_page(simulate, fields, "Kinematics", body)


def test_places_that_come_in_meanwhile_are_left_out(simulate, fields, monkeypatch):
    solved = []

    async def body(page, handles):
        label = "pin of the shoe"
        x, y = handles.place(label)
        for way in ("solve_for_drawing", "solve"):  # while it is held, and when it is let go
            kept = getattr(page_tasks, way)
            monkeypatch.setattr(
                page_tasks, way, lambda *given, kept=kept, way=way: solved.append(way) or kept(*given)
            )
        for i in range(1, 31):
            handles.send(label, "pointerdown", x + 0.001 * i, y - 0.001 * i, False)
        handles.send(label, "pointerdown", x + 0.03, y - 0.03, True)
        for _ in range(100):
            if len(solved) > 1:
                break
            await asyncio.sleep(0.1)
        await asyncio.sleep(0.1)
        assert handles.place(label)[0] == pytest.approx(x + 0.03, abs=5e-3)  # the picture is fitted anew
        assert solved == [
            "solve_for_drawing",
            "solve",
        ]  # the first place and the last, each once for two fields

    on_page(simulate, fields, "Drum brake", body)


def test_held_point_stays_when_the_brake_locks(simulate, fields):
    async def body(page, handles):
        page.enter("brake.friction", "0.985")
        label = "end of the lining"
        held = handles.element(label)
        x, y = handles.place(label)
        handles.send(label, "pointerdown", x - 0.1, y - 0.1, False)
        await asyncio.sleep(0.1)
        assert "away" not in held.classes  # the locked brake is drawn, too
        handles.send(label, "pointerdown", x, y, True)
        await asyncio.sleep(0.1)
        assert handles.element(label) is held
        assert "away" not in held.classes
        assert page.field("shoe.lining_end").value in ("110 deg", "110.0 deg")

    on_page(simulate, fields, "Drum brake", body)


def test_arrow_keys_step(simulate, fields):
    async def body(page, handles):
        handles.send("right pad", "keydown", 1, 0, False)
        assert page.field("dimensions.pad").value == '["13.0 mm", "-46 mm"]'
        handles.send("right pad", "keydown", 0, 1, True)
        assert page.field("dimensions.pad").value == '["13.0 mm", "-41.0 mm"]'

    on_page(simulate, fields, "Caliper", body)


def test_arrow_keys_step_on_while_an_answer_takes_its_time(simulate, fields, monkeypatch):
    async def body(page, handles):
        monkeypatch.setattr(ScreenView, "solve", lambda self, held=False: None)
        for way in ((1, 0), (1, 0), (0, 1)):
            handles.send("right pad", "keydown", *way, True)
        assert page.field("dimensions.pad").value == '["22.5 mm", "-41.0 mm"]'
        monkeypatch.undo()
        page.enter("dimensions.pad", '["20 mm", "-46 mm"]')
        handles.send("right pad", "keydown", 0, 1, True)
        assert page.field("dimensions.pad").value == '["20 mm", "-41.0 mm"]'

    on_page(simulate, fields, "Caliper", body)


def test_field_moves_its_handle_and_another_caliper_has_its_own(simulate, fields, caplog):
    async def body(page, handles):
        before = handles.place("right pad")
        page.enter("dimensions.pad", '["20 mm", "-46 mm"]')
        assert handles.place("right pad")[0] > before[0] + 0.01
        page.enter("dimensions.pad", "")
        page.enter("caliper", "v-brake")
        elements = page.user.client.elements.values()
        labels = {e.props["aria-label"] for e in elements if "handle" in e.classes}
        assert "cable clamp at the top of the right arm" in labels
        assert "roller between the arms" not in labels
        assert [record.getMessage() for record in caplog.records if record.levelname == "ERROR"] == []

    on_page(simulate, fields, "Caliper", body)


def test_the_page_is_not_rendered_anew_for_each_place_of_a_point(simulate, fields, monkeypatch):
    told = []

    async def body(page, handles):
        label = "tip of the shoe"
        await handles.pull(label, -0.01, 0.01)  # says that the tables wait
        monkeypatch.setattr(page.user.client.outbox, "enqueue_update", told.append)
        before, text = handles.picture("Kinematics"), page.field("brake.tip_x").value
        await handles.pull(label, -0.01, 0.01)
        assert handles.picture("Kinematics") != before
        assert page.field("brake.tip_x").value != text
        assert told == []
        await handles.pull(label, 0.0, 0.0, done=True)
        assert page.field("brake.tip_x") in told
        assert handles.element(label) in told

    on_page(simulate, fields, "Kinematics", body)
