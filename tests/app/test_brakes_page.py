"""The page of `brakes app`, used by simulated clients."""

import pytest

from brakes.answers import STANDARD
from brakes.app.program import BRAKES
from brakes.calipers import NAMED

_STANDARD = [load().title for _, load in STANDARD.values()]
SCREENS = ("Vehicle", "Kinematics", "Internal forces", *_STANDARD, "Caliper", "Mechanism")


def tables(text):
    return [line for line in text.splitlines() if "<table>" in line]


def test_opens_on_the_papers_base_case(simulate, fields):
    async def body(client):
        page = fields(await client())
        assert page.tabs() == list(SCREENS)
        text = page.text()
        assert "13.425" in text and "9.5571" not in text  # distance, examples/forklift.toml: corrected
        assert page.field("stop.speed").value == "20 km/h"

    simulate(BRAKES, body)


WRONG = {
    "stop.speed": ("Vehicle", "20 s", 'stop.speed = "20 s": a unit of time'),
    "truck.empty_mass": ("Vehicle", "-3 kg", "it must be greater than 0"),
    "brake.tip_x": ("Kinematics", "fast", "not a number with a unit"),
    "stop.friction": ("Vehicle", "", "missing; give the"),
    "brake.friction": ("Drum brake", "35 %", "without a unit"),
    "shoe.drum_radius": ("Drum brake", "1e400 m", "finite"),
    "run.finger": ("Caliper", "40 m", "a unit of length"),
}


@pytest.mark.parametrize("path", WRONG)
def test_wrong_empty_and_extreme_entries_are_marked_at_their_field(simulate, fields, path):
    screen, given, sentence = WRONG[path]

    async def body(client):
        page = fields(await client())
        page.go(screen)
        before = page.text()
        good = page.field(path).value
        page.enter(path, given)
        assert sentence in page.field(path).error
        assert path in page.field(path).error
        assert page.text().count("Refused. Stale: for the entries before.") >= 1
        assert tables(before) == tables(page.text())
        page.enter(path, good)
        assert page.field(path).error is None
        assert "Refused. Stale: for the entries before." not in page.text()

    simulate(BRAKES, body)


def test_a_change_upstream_marks_what_is_stale_until_it_is_opened(simulate, fields):
    async def body(client):
        user = await client()
        page = fields(user)
        for name in SCREENS:
            page.go(name)
        page.enter("stop.speed", "25 km/h")
        assert page.tabs()[:3] == ["Vehicle", "Kinematics", "Internal forces (stale)"]
        assert page.greyed() == 1
        page.go("Internal forces")
        assert page.tabs() == list(SCREENS)
        assert page.greyed() == 0

    simulate(BRAKES, body)


@pytest.mark.parametrize("number", [3, pytest.param(10, marks=pytest.mark.slow)])
def test_clients_do_not_see_each_others_values(simulate, fields, number):
    async def body(client):
        pages = [fields(await client()) for _ in range(number)]
        for i, page in enumerate(pages):
            page.enter("stop.speed", f"{11 + i} km/h")
        for i, page in enumerate(pages):
            assert page.field("stop.speed").value == f"{11 + i} km/h"
        distances = {page.text().partition("reaction</td>")[2][:60] for page in pages}
        assert len(distances) == number
        assert fields(await client()).field("stop.speed").value == "20 km/h"

    simulate(BRAKES, body)


def test_form_is_made_when_its_screen_comes_to_the_front(simulate, fields):
    async def body(client):
        page = fields(await client())
        assert {"stop.speed"} <= paths(page) and "dimensions.side_pivot" not in paths(page)
        page.go("Caliper")
        assert "dimensions.side_pivot" in paths(page)

    def paths(page):
        return {e.props.get("data-path") for e in page.user.client.elements.values()}

    simulate(BRAKES, body)


def test_another_caliper_changes_the_form(simulate, fields):
    async def body(client):
        page = fields(await client())
        page.go("Caliper")
        assert page.field("dimensions.side_pivot")
        page.enter("caliper", "v-brake")
        assert page.field("dimensions.pivot")
        assert not [
            e
            for e in page.user.client.elements.values()
            if e.props.get("data-path") == "dimensions.side_pivot"
        ]

    simulate(BRAKES, body)


def test_every_field_has_a_label_and_help(simulate, fields):
    async def body(client):
        page = fields(await client())
        for name in SCREENS:
            page.go(name)
        made = [e for e in page.user.client.elements.values() if e.props.get("data-path")]
        assert len(made) > 60
        assert all(e.props.get("label") and e.props.get("hint") for e in made)

    simulate(BRAKES, body)


def test_the_sketch_is_that_of_the_caliper_that_is_chosen(simulate, fields):
    """Also where the form stays the same: a cantilever has the dimensions of a centre-pull."""

    async def body(another):
        page = fields(await another())
        page.go("Caliper")
        for name in ("centre-pull", "cantilever", "v-brake"):
            page.enter("caliper", name)
            assert f"{NAMED[name].label}, seen from the front" in page.text()

    simulate(BRAKES, body)
