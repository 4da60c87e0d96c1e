"""The interactive programs in a real browser (Debian's chromium, driven by playwright): their use."""

import pytest

from beamdyn.app.program import BEAMDYN
from brakes.app.program import BRAKES
from tests.app.browsing import drawing, field, go, kept, redrawn, shown
from tests.app.serving import CHROMIUM, IN_BROWSER, NO_PLAYWRIGHT, PATIENCE, free_port, start, stop

__all__ = ["CHROMIUM", "free_port", "start", "stop"]  # other modules take them from here, too
sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

CHANGED = {"brakes": ("speed, V", "25 km/h"), "beamdyn": ("radius, r", "0.3 m")}
SCREENS = {p.name: [s.name for d in p.documents for s in d.screens] for p in (BRAKES, BEAMDYN)}

WITHOUT_DRAWING = {s.name for d in BEAMDYN.documents for s in d.screens if s.picture is not None}


@pytest.mark.parametrize("program", SCREENS)
def test_every_screen_opens_and_shows_its_drawing(opened, program):
    page = opened(program)
    for name in reversed(SCREENS[program]):
        go(page, name)
        expect(shown(page, "Up to date.")).to_be_visible()


@pytest.mark.parametrize("program", CHANGED)
def test_change_by_keyboard_mistake_and_remedy(opened, program):
    page = opened(program)
    before = drawing(page)
    label, good = CHANGED[program]
    number = good.partition(" ")[0]
    field(page, label).focus()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(f"{number} x")  # at once: typed slowly, the number alone is an entry too
    expect(shown(page, f'"{number} x": unknown unit')).to_be_visible()
    expect(page.locator(".greyed:visible")).to_have_count(1)
    expect(shown(page, "Refused. Stale: for the entries before.")).to_be_visible()
    assert drawing(page) == before
    page.keyboard.press("Backspace")
    page.keyboard.type(good.removeprefix(number).strip())
    expect(page.locator(".greyed:visible")).to_have_count(0)
    redrawn(page, before)


def test_stage_slider_by_keyboard_moves_the_shoes(page):
    go(page, "Kinematics")
    before = drawing(page)
    page.locator(".slider:visible [tabindex='0']").first.focus()
    for _ in range(5):
        page.keyboard.press("ArrowLeft")
    redrawn(page, before)


def test_unit_of_a_field(page):
    before = drawing(page)
    page.get_by_role("button", name="unit of wheelbase", exact=True).click()
    page.locator(".q-menu").get_by_text("mm", exact=True).click()
    expect(field(page, "wheelbase, L")).to_have_value("1890 mm")
    assert drawing(page) == before
    field(page, "wheelbase, L").fill("2000 mm")
    redrawn(page, before)


@pytest.mark.parametrize("name", [n for n in SCREENS["beamdyn"] if n not in WITHOUT_DRAWING])
def test_slider_in_the_form_changes_its_field_and_the_drawing(opened, name):
    page = opened("beamdyn")
    go(page, name)
    before, radius = drawing(page), field(page, "radius, r")
    value = radius.input_value()
    slider = page.get_by_role("slider", name="radius, r [mm]").locator("visible=true")
    slider.focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    expect(radius).not_to_have_value(value)
    redrawn(page, before)


def test_reload_keeps_the_design_and_the_screen(page):
    go(page, "Drum brake")
    field(page, "drum radius, r").fill("150 mm")
    kept(page, "150 mm")
    page.reload()
    expect(page.get_by_role("tab", name="Drum brake")).to_have_attribute("aria-selected", "true")
    expect(field(page, "drum radius, r")).to_have_value("150 mm")


@pytest.mark.parametrize("number", [3, pytest.param(10, marks=pytest.mark.slow)])
def test_browsers_at_once_keep_their_own_values(opened, number):
    pages = [opened() for _ in range(number)]
    speeds = [f"{10 + i} km/h" for i in range(number)]
    before = drawing(pages[0])
    for page, speed in zip(pages, speeds, strict=True):
        field(page, "speed, V").fill(speed)
    for page, speed in zip(pages, speeds, strict=True):
        redrawn(page, before)
        expect(field(page, "speed, V")).to_have_value(speed)
    distance = "tr:has-text('stopping distance') td.number"
    distances = [page.locator(distance).first.inner_text() for page in pages]
    assert len(set(distances)) == number
    assert distances == sorted(distances, key=float)
    expect(field(opened(), "speed, V")).to_have_value("20 km/h")
