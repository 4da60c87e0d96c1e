"""Undo, links, named designs and what is typed when a page is reloaded, in a real browser."""

import re

import pytest

from tests.app.browsing import field
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER


def headline(page):
    return page.locator(".headline:visible dd").first


def test_number_is_read_in_the_unit_shown_and_undone_by_keys(page):
    speed, before = field(page, "speed, V"), headline(page).inner_text()
    speed.fill("25,5")
    expect(page.get_by_text("read as 25.5 km/h").locator("visible=true")).to_be_visible()
    field(page, "wheelbase, L").focus()
    expect(speed).to_have_value("25.5 km/h")
    expect(headline(page)).not_to_have_text(before)
    page.keyboard.press("Control+z")
    expect(speed).to_have_value("20 km/h")
    expect(headline(page)).to_have_text(before)
    page.keyboard.press("Control+Shift+Z")
    expect(speed).to_have_value("25.5 km/h")


def test_what_is_being_typed_survives_a_reload(page):
    rise = field(page, "rise time, t2")
    rise.focus()
    page.keyboard.press("Control+a")
    page.keyboard.type("0.45 s")
    page.reload()
    expect(field(page, "rise time, t2")).to_have_value("0.45 s")


def test_link_opens_the_design_elsewhere(opened):
    page = opened()
    field(page, "speed, V").fill("33 km/h")
    page.get_by_role("button", name="File").click()
    page.get_by_text("Link to this design", exact=True).first.click()
    link = page.get_by_label("link", exact=True)
    expect(link).to_have_value(re.compile("#design="))
    other = opened(at=link.input_value())
    expect(field(other, "speed, V")).to_have_value("33 km/h")
    assert "#" not in other.url


def test_design_is_kept_and_compared(page):
    page.get_by_role("button", name="Designs").click()
    page.get_by_label("name for this design").fill("slow")
    page.get_by_role("button", name="Keep").click()
    expect(page.get_by_role("button", name="Compare slow")).to_be_visible()
    page.get_by_role("button", name="Close").locator("visible=true").click()
    expect(page.locator(".q-dialog")).to_have_count(0)  # until then it takes the focus, and what is typed
    field(page, "speed, V").fill("30 km/h")
    page.get_by_role("button", name="Designs").click()
    page.get_by_role("button", name="Compare slow").click()
    expect(page.get_by_text("slow: 13.425 m").locator("visible=true")).to_be_visible()
    page.get_by_role("button", name="Stop comparing with slow").click()
    expect(page.get_by_text("slow: 13.425 m")).to_have_count(0)


def test_a_long_name_does_not_push_the_values_of_a_design_out_of_sight(opened):
    page = opened("beamdyn")
    page.set_viewport_size({"width": 390, "height": 844})
    page.get_by_role("button", name="Designs").click(timeout=20_000)
    page.get_by_role("button", name="Compare An aluminium fan blade").first.click(timeout=20_000)
    head = page.locator("th:visible", has_text="An aluminium fan blade").first
    box = head.bounding_box(timeout=20_000)
    assert box["x"] + box["width"] <= 390
