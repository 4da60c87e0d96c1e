"""In a real browser: at 45 deg no linear number is alone, and a page that computes for long goes on."""

import pytest

from tests.app.browsing import field, go, shown, unfold
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

BEYOND = "large deflection, left out, changes the answer by"


def enter(page, label, text):
    field(page, label).fill(text)


def choose(page, label, option):
    field(page, label).click()
    page.locator(".q-menu").get_by_text(option, exact=True).click()


def last_row(page, head):
    """The first two cells of the last row of the table with a heading."""
    table = page.locator("table:visible").filter(has_text=head)
    return table.locator("tr").last.locator("td")


def test_number_of_the_straight_beam_is_not_alone_and_automatic_physics_mends_it(opened):
    page = opened("beamdyn")
    enter(page, "modes, n", "1")
    enter(page, "top speed, omega", "100 rad/s")
    enter(page, "setting angle, phi", "45 deg")
    frequency = last_row(page, "tracking").nth(1)
    expect(frequency).to_contain_text("55.62")
    expect(frequency.locator(".beyond")).to_have_text("55.62005798")  # 9 % leave no digit
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 900})
        expect(shown(page, f"{BEYOND} +9.1 %")).to_be_visible()
        expect(shown(page, "left out at 100 rad/s: large deflection +9.1 %")).to_be_visible()
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.set_viewport_size({"width": 1280, "height": 900})
    unfold(page, "section", "physics.auto")
    choose(page, "auto", "true")
    go(page, "Steady response")  # a page that computes takes a click
    expect(shown(page, "Up to date.")).to_be_visible()
    expect(shown(page, "large deflection (")).to_be_visible()
    expect(field(page, "setting angle, phi")).to_have_value("45 deg")
    go(page, "Frequencies")
    expect(shown(page, "Up to date.")).to_be_visible()
    expect(frequency).to_contain_text("60.65")
    expect(shown(page, 'physics "auto", tolerance 0.001: large deflection (9.1 %')).to_be_visible()
    expect(page.get_by_text(BEYOND).locator("visible=true")).to_have_count(0)
