"""Lists of a mechanism in a real browser: what is clicked and typed as people do it, with slow fingers."""

import pytest

from tests.app.browsing import go
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER
_HOLD = 200  # how long a finger presses [ms]


def field(page, path):
    return page.locator(f'[data-path="{path}"]').locator("visible=true").first


def press(page, found):
    """Press and let go a while later, as people do."""
    box = found.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.wait_for_timeout(_HOLD)
    page.mouse.up()


def button(page, name):
    return page.get_by_role("button", name=name, exact=True).locator("visible=true").first


@pytest.fixture
def clamp(page):
    go(page, "Mechanism")
    return page


def test_a_button_is_pressed_while_a_name_is_being_typed(clamp):
    field(clamp, "bodies.1.name").fill("lower arm")
    press(clamp, button(clamp, "add body"))
    expect(field(clamp, "bodies.2.name")).to_have_value("body 1")
    expect(field(clamp, "bodies.1.name")).to_have_value("lower arm")


def test_the_focus_goes_on_after_a_name_has_been_typed(clamp):
    field(clamp, "points.A.name").fill("foot")
    clamp.keyboard.press("Tab")
    x = field(clamp, "points.foot.x")
    expect(x).to_be_focused()
    field(clamp, "points.foot.name").fill("toe")
    press(clamp, field(clamp, "points.foot.y"))
    expect(field(clamp, "points.toe.y")).to_be_focused()


def test_a_button_below_a_field_that_is_left_is_pressed(page):
    """The field's hint lies over what is below, which stays where it is."""
    field(page, "truck.empty_mass").click()
    expect(page.get_by_text("mass of the empty truck")).to_be_visible()
    press(page, button(page, "unit of load mass"))
    expect(page.get_by_role("menu")).to_be_visible()


def test_a_second_pin_where_the_first_is_can_be_moved_on(clamp):
    button(clamp, "Start from nothing").click()
    for _ in range(2):
        button(clamp, "add pin").click()
    expect(field(clamp, "pin.1.at")).to_be_visible()
    expect(clamp.get_by_text("a reason that the program does not know")).to_have_count(0)


def test_long_names_leave_the_cells_of_a_part_in_their_place(clamp):
    part = clamp.locator(".listed-part .cells:visible").last
    before = part.evaluate("it => it.scrollWidth")
    field(clamp, "bodies.0.name").fill("the arm that is held by both pins of the frame")
    field(clamp, "bodies.0.name").press("Tab")
    expect(clamp.locator(".listed-part", has_text="held by both pins").first).to_be_visible(timeout=20_000)
    widths = clamp.locator(".listed-part .cells:visible").evaluate_all(
        "them => them.map(it => it.scrollWidth)"
    )
    assert max(widths) <= before
