"""Playing a slider: the course of its places, the button, and pictures that do not pile up."""

import asyncio
import re

import pytest

pytest.importorskip("nicegui")

from beamdyn.app.transient_screen import TRANSIENT
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.screen_parts import Slider
from brakes.app.program import BRAKES
from tests.app.browsing import go
from tests.app.serving import IN_BROWSER

PAINTED = re.compile(r".*requestAnimationFrame", re.DOTALL)


def test_time_goes_on_and_strokes_go_back():
    """A transient that ran backwards would show a motion that there is not."""
    assert TRANSIENT.slider.onward
    for screen in (screen for document in BRAKES.documents for screen in document.screens if screen.slider):
        assert not screen.slider.onward


def slider(last, seconds, onward):
    return Slider("", ("",) * (last + 1), seconds=seconds, onward=onward)


@pytest.mark.parametrize("course", [slider(2, 3.0, False), slider(7, 4.0, True)])
def test_a_course_starts_at_zero_stays_within_its_ends_and_returns(course):
    places = [course.place(0.01 * i) for i in range(1300)]
    assert places[0] == 0 and min(places) >= 0 and max(places) <= course.last
    assert max(places) > 0.99 * course.last
    back = 2 * course.seconds if not course.onward else course.seconds
    assert course.place(back + 0.7) == pytest.approx(course.place(0.7), rel=1e-12)


@pytest.mark.parametrize("course", [slider(2, 2.5, False), slider(2, 10.0, True)])
@pytest.mark.parametrize("place", [0.0, 0.3, 1.0, 1.9])
def test_playing_goes_on_from_the_place_of_the_slider(course, place):
    assert course.place(course.elapsed(place)) == pytest.approx(place, abs=1e-12)


def test_back_and_forth_starts_backwards_at_its_end():
    course = slider(1, 2.5, False)
    assert course.place(course.elapsed(1.0) + 0.3) < 1.0


class Played:
    """The player and the slider of a screen of a simulated client."""

    def __init__(self, user, fields, name):
        page = fields(user)
        page.go(name)
        elements = user.client.elements.values()
        self.user = user
        self.slider = next(e for e in elements if e.props.get("aria-label") == "stage")
        self.button = next(e for e in elements if "player" in e.classes)

    def press(self):
        with self.user.client:
            for listener in self.button._event_listeners.values():
                if listener.type == "click":
                    self.button._handle_event({"listener_id": listener.id, "args": {}})

    @property
    def words(self):
        return self.button.props["aria-label"]


async def places(slider, count):
    """The next places of a slider that plays."""
    seen = [slider.value]
    for _ in range(400):
        if len(seen) > count:
            break
        await asyncio.sleep(0.02)
        if slider.value != seen[-1]:
            seen.append(slider.value)
    return seen


def test_the_button_plays_and_pauses_and_a_hand_on_the_slider_pauses(simulate, fields):
    async def body(another):
        user = await another()
        user.javascript_rules[PAINTED] = lambda _: "moving"
        it = Played(user, fields, "Kinematics")
        assert it.words == "play stage"
        it.press()
        assert it.words == "pause stage"
        seen = await places(it.slider, 4)
        assert len(set(seen)) > 4 and all(0 <= place <= 2 for place in seen)
        it.press()
        await asyncio.sleep(0.2)
        stays = it.slider.value
        await asyncio.sleep(0.2)
        assert it.slider.value == stays and it.words == "play stage"
        it.press()
        await places(it.slider, 2)
        with user.client:
            it.slider.set_value(1.0)
        assert it.words == "play stage"
        await asyncio.sleep(0.2)
        assert it.slider.value == 1.0

    simulate(BRAKES, body)


def test_pictures_and_places_are_written_past_the_toolkit_and_told_to_it_at_rest(
    simulate, fields, monkeypatch
):
    """The toolkit renders the whole page for each change that it is told: half as many pictures."""

    async def body(another):
        user = await another()
        written, told = [], []
        user.javascript_rules[PAINTED] = lambda _: "moving"
        monkeypatch.setattr(PageWriter, "write", lambda _, __, changed: written.extend(changed))
        it = Played(user, fields, "Kinematics")
        update = type(it.slider).update
        monkeypatch.setattr(type(it.slider), "update", lambda self: told.append(self.value) or update(self))
        it.press()
        await places(it.slider, 4)
        assert min(written.count("place"), written.count("innerHTML")) >= 3
        assert not told
        it.press()
        assert told and {*told} == {it.slider.value}

    simulate(BRAKES, body)


def test_no_picture_before_the_last_was_painted_and_none_where_nobody_looks(simulate, fields):
    async def body(another):
        user = await another()
        asked = []
        user.javascript_rules[PAINTED] = lambda _: asked.append(1) or "away"
        it = Played(user, fields, "Kinematics")
        before = it.slider.value
        it.press()
        await asyncio.sleep(0.3)
        assert asked == [1] and it.slider.value == before and it.words == "play stage"

    simulate(BRAKES, body)


@IN_BROWSER[0]
@IN_BROWSER[1]
def test_the_slider_stands_where_it_was_paused_and_is_dragged_from_there(page):
    go(page, "Kinematics")
    slider = page.locator(".stroke .q-slider").locator("visible=true").first
    picture = page.locator(".board svg.machine").locator("visible=true").first

    def shown():
        place = slider.locator("[role=slider]").get_attribute("aria-valuenow")
        return float(place or "nan"), picture.get_attribute("id")

    page.get_by_role("button", name="play stage").locator("visible=true").click()
    page.wait_for_timeout(1200)
    page.get_by_role("button", name="pause stage").locator("visible=true").click()
    page.wait_for_timeout(300)
    paused = shown()
    assert 0 <= paused[0] < 2
    page.wait_for_timeout(500)
    assert shown() == paused
    box = slider.bounding_box()
    held = slider.locator(".q-slider__thumb").bounding_box()
    page.mouse.move(held["x"] + held["width"] / 2, held["y"] + held["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.25 * box["width"], held["y"], steps=10)
    page.mouse.up()
    page.wait_for_timeout(500)
    place, name = shown()
    assert place == pytest.approx(0.5, abs=0.1) and name != paused[1]


@IN_BROWSER[0]
@IN_BROWSER[1]
@pytest.mark.parametrize("motion", ["no-preference", "reduce"])
def test_a_stroke_is_played_by_the_space_bar(page, motion):
    page.emulate_media(reduced_motion=motion)
    go(page, "Kinematics")
    button = page.get_by_role("button", name="play stage").locator("visible=true")
    button.focus()
    page.keyboard.press("Space")
    pause = page.get_by_role("button", name="pause stage").locator("visible=true")
    pause.wait_for()
    page.evaluate("""() => {
      window.seen = new Set();
      const look = () => {
        for (const it of document.querySelectorAll('.board svg.machine'))
          if (it.getBoundingClientRect().width) window.seen.add(it.id);
        requestAnimationFrame(look);
      };
      look();
    }""")
    page.wait_for_timeout(4000)
    seen = page.evaluate("() => window.seen.size")
    assert 2 <= seen <= 6 if motion == "reduce" else seen > 8
    page.keyboard.press("Space")
    button.wait_for()
    page.wait_for_timeout(500)
    page.evaluate("() => window.seen.clear()")
    page.wait_for_timeout(1500)
    assert page.evaluate("() => window.seen.size") == 1
