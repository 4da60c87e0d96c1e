"""Points that are dragged in a real browser: with the mouse, too far and back, and by the arrow keys."""

import pytest

from tests.app.browsing import DRAWING, drawing, go, redrawn, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER
# Whether each chart shows a curve: a path of many points.
HAVE_CURVES = """(charts) => charts.every((each) =>
  [...each.querySelectorAll('path')].some((path) => path.getAttribute('d').length > 500))"""
NEAR = 2.0  # [px]: a picture is a tenth of a millimetre or less a pixel, to which what is written is rounded


def handle(page, label):
    return page.get_by_role("slider", name=label, exact=True).locator("visible=true")


def field(page, path):
    return page.locator(f"input[data-path='{path}'], [data-path='{path}'] input").first


def middle(found):
    box = found.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def pull(page, found, across, down):
    """Take hold of a handle beside its middle, and pull it in a few steps; it is not let go."""
    x, y = middle(found)
    page.mouse.move(x + 3, y + 2)
    page.mouse.down()
    page.mouse.move(x + 3 + across, y + 2 + down, steps=12)
    return x + across, y + down


def follows(page, found, x, y):
    """Wait until a handle is under the pointer that holds it."""
    comes(page, found, lambda at: abs(at[0] - x) < NEAR and abs(at[1] - y) < NEAR)


def comes(page, found, there):
    """Wait until the middle of what is found is where it should come to."""
    for _ in range(10 * PATIENCE):
        if there(at := middle(found)):
            return
        page.wait_for_timeout(100)
    raise AssertionError(f"it stays at {at}")


def at_rest(page, read):
    """What is read, as soon as it has stayed the same for a second."""
    last, now = None, read()
    while now != last:
        page.wait_for_timeout(1000)
        last, now = now, read()
    return now


@pytest.mark.parametrize(
    "screen, label, path, way",
    [
        ("Vehicle", "centre of gravity of the load", "truck.load_cg_y", (0, -30)),
        ("Kinematics", "tip of the shoe", "brake.tip_x", (-30, 20)),
        ("Drum brake", "pin of the shoe", "shoe.pivot_offset", (15, -20)),
        ("Caliper", "pivot of the arm of the right pad", "dimensions.side_pivot", (-25, 20)),
    ],
)
def test_point_follows_the_mouse_and_writes_its_field(page, screen, label, path, way):
    go(page, screen)
    before, picture = field(page, path).input_value(), drawing(page)
    found = handle(page, label)
    x, y = pull(page, found, *way)
    follows(page, found, x, y)
    assert field(page, path).input_value() != before
    held = drawing(page)
    assert held != picture
    page.mouse.up()
    written = at_rest(page, field(page, path).input_value)
    assert written not in ("", before)
    expect(page.get_by_text("Up to date.").locator("visible=true")).to_be_visible()
    page.mouse.move(x + 100, y + 100, steps=4)  # it has been let go
    page.wait_for_timeout(500)
    assert field(page, path).input_value() == written


def test_what_has_followed_a_point_lasts_when_another_screen_was_in_front(page):
    go(page, "Vehicle")
    found = handle(page, "centre of gravity of the load")
    x, y = pull(page, found, -20, -15)
    follows(page, found, x, y)
    page.mouse.up()
    written = at_rest(page, field(page, "truck.load_cg_x").input_value)
    place, picture = middle(found), drawing(page)
    go(page, "Drum brake")
    go(page, "Vehicle")
    assert field(page, "truck.load_cg_x").input_value() == written
    assert middle(found) == pytest.approx(place, abs=1) and drawing(page) == picture


@pytest.mark.parametrize("screen", ["Frequencies", "Rotor"])
def test_slider_pulled_by_the_mouse_is_followed_and_stays(opened, screen):
    page = opened("beamdyn")
    go(page, screen)
    expect(shown(page, "Up to date.")).to_be_visible()
    before, radius = drawing(page), field(page, "mount.radius")
    slider = page.get_by_role("slider", name="radius, r [mm]").locator("visible=true")
    slider.scroll_into_view_if_needed()
    x, y = middle(slider)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=12)
    redrawn(page, before)
    expect(shown(page, "The drawing follows; the tables wait.")).to_be_visible()
    place = at_rest(page, lambda: radius.input_value())
    assert page.locator(".chart:visible").evaluate_all(HAVE_CURVES)
    page.mouse.up()
    expect(shown(page, "Up to date.")).to_be_visible()
    assert radius.input_value() == place
    assert slider.get_attribute("aria-valuenow") == place.removesuffix(" mm")
    go(page, "Mode shapes")
    go(page, screen)
    assert field(page, "mount.radius").input_value() == place
    assert slider.get_attribute("aria-valuenow") == place.removesuffix(" mm")


def test_picture_is_fitted_when_the_point_is_let_go(page):
    go(page, "Caliper")
    found = handle(page, "stop of the housing, on the arm of the left pad")
    x, y = pull(page, found, 30, -60)
    follows(page, found, x, y)
    held = drawing(page)
    page.mouse.up()
    page.wait_for_function(
        "([wanted, held]) => document.querySelector(wanted).dataset.picture != held",
        arg=[f"{DRAWING}[data-words^='Caliper']", held],
    )
    assert middle(found)[1] > y + 5  # [px] the picture reaches farther up


def test_dragged_too_far_marks_the_field_and_greys_and_back_recovers(page):
    go(page, "Kinematics")
    found = handle(page, "tip of the shoe")
    start = middle(found)
    pull(page, found, 200, -40)  # out of the drum
    expect(page.locator(".greyed:visible")).to_have_count(1)
    expect(page.locator(".q-field--error:visible")).not_to_have_count(0)
    page.mouse.move(start[0] - 20, start[1] + 10, steps=5)
    expect(page.locator(".greyed:visible")).to_have_count(0)
    expect(page.locator(".q-field--error:visible")).to_have_count(0)
    page.mouse.up()
    expect(shown(page, "Up to date.")).to_be_visible()  # the picture has been fitted: its points have moved
    pull(page, found, 200, -40)
    expect(page.locator(".greyed:visible")).to_have_count(1)
    page.mouse.up()
    expect(page.locator(".greyed:visible")).to_have_count(1)
    x, y = pull(page, found, -10, 10)  # from where the last good result has it
    expect(page.locator(".greyed:visible")).to_have_count(0)
    follows(page, found, x, y)
    page.mouse.up()


def test_dragged_until_the_brake_locks_and_back(page):
    """A locked brake is drawn with its handles, by which it is brought back."""
    go(page, "Drum brake")
    friction = field(page, "brake.friction")
    before = drawing(page)
    friction.fill("0.9")
    redrawn(page, before)
    found = handle(page, "end of the lining")
    pull(page, found, -90, -90)
    locks = page.locator(f"{DRAWING}:visible").get_by_text("locks from")
    expect(locks).to_have_count(1)
    expect(page.locator(".handle:visible")).to_have_count(5)
    page.mouse.up()
    expect(locks).to_have_count(1)
    at_rest(page, lambda: middle(found))  # the drawing at rest has another frame
    pull(page, found, 93, 92)
    expect(locks).to_have_count(0)
    page.mouse.up()


def test_arrow_keys_move_the_point_that_has_the_focus(page):
    go(page, "Caliper")
    found = handle(page, "roller between the arms")
    found.focus()
    page.keyboard.press("ArrowRight")
    expect(field(page, "dimensions.roller")).to_have_value('["13.5 mm", "1 mm"]')
    page.keyboard.press("Shift+ArrowDown")
    expect(field(page, "dimensions.roller")).to_have_value('["13.5 mm", "-4.0 mm"]')
    expect(found).to_be_focused()
    expect(found).to_have_attribute("aria-valuetext", 'roller ["13.5 mm", "-4.0 mm"]')


def test_a_field_moves_its_point(page):
    go(page, "Kinematics")
    found = handle(page, "adjuster's pin")
    x, _ = middle(found)
    field(page, "brake.adjuster_x").fill("45 mm")
    comes(page, found, lambda at: at[0] < x - 5)


@pytest.mark.parametrize("width", [1280, 800])
def test_handles_stay_on_the_drawing_at_any_width(page, width):
    page.set_viewport_size({"width": width, "height": 900})
    for name in ("Vehicle", "Kinematics", "Drum brake", "Caliper"):
        go(page, name)
        expect(page.locator(".board:visible")).to_have_count(1)
        box = page.locator(f"{DRAWING}:visible").bounding_box()
        board = page.locator(".board:visible").bounding_box()
        assert box == pytest.approx(board, abs=1)
        for found in page.locator(".handle:visible").all():
            x, y = middle(found)
            assert box["x"] < x < box["x"] + box["width"]
            assert box["y"] < y < box["y"] + box["height"]
