"""The page of the interactive programs in a real browser: layout, keyboard, names, a program that stops."""

import pytest

from beamdyn.app.program import BEAMDYN
from brakes.app.program import BRAKES
from tests.app.browsing import DRAWING, drawing, field, go, in_front, kept, redrawn, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE, free_port, start, stop

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

SCREENS = [(p.name, s.name) for p in (BRAKES, BEAMDYN) for d in p.documents for s in d.screens]
WITHOUT_DRAWING = {s.name for d in BEAMDYN.documents for s in d.screens if s.picture is not None}
NAMED = ("textbox", "combobox", "slider", "button", "tab", "image", "checkbox")


@pytest.fixture(scope="module")
def pages(shared):
    """One page a program, for tests that only look."""
    return {program: shared(program) for program in ("brakes", "beamdyn")}


@pytest.mark.parametrize("program, name", SCREENS)
def test_screen_fits_at_1280_and_at_800_pixels(pages, program, name):
    page = pages[program]
    for width in (1280, 800):
        page.set_viewport_size({"width": width, "height": 900})
        go(page, name)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        shown_first = page.locator(".tables:visible").first if name in WITHOUT_DRAWING else in_front(page)
        box = shown_first.bounding_box()
        assert box["width"] > 0.5 * width
        assert box["x"] >= 0 and box["x"] + box["width"] <= width


@pytest.mark.parametrize("program, name", SCREENS)
def test_everything_that_is_used_has_a_name(pages, program, name):
    page = pages[program]
    go(page, name)
    expect(shown(page, "Up to date.")).to_be_visible()  # a drawing that is being replaced has lost its words
    found = used(page)
    assert len(found) > 10
    assert [node for node in found if not node["name"].get("value", "").strip()] == []
    sliders = [node for node in found if node["role"]["value"] == "slider"]
    assert [node["name"]["value"] for node in sliders if not takes_focus(node)] == []


def takes_focus(node):
    return any(each["name"] == "focusable" and each["value"]["value"] for each in node["properties"])


def test_slider_that_has_the_focus_says_its_name_and_value(opened):
    page = opened("beamdyn")
    slider = page.get_by_role("slider", name="radius, r [mm]", exact=True).locator("visible=true")
    slider.focus()
    page.keyboard.press("ArrowRight")
    expect(field(page, "radius, r")).to_have_value("220 mm")
    expect(slider).to_be_focused()
    expect(slider).to_have_attribute("aria-valuenow", "220")


def test_everything_in_the_dialog_has_a_name(page):
    page.get_by_role("button", name="File").click()
    page.get_by_text("Open a file", exact=True).click()
    expect(page.get_by_role("button", name="Close")).to_be_visible()
    names = [node["name"].get("value", "") for node in used(page)]
    assert "Close" in names
    assert "" not in names


def used(page):
    """What a page offers to those who use it without seeing it, or by keyboard."""
    nodes = page.context.new_cdp_session(page).send("Accessibility.getFullAXTree")["nodes"]
    return [node for node in nodes if not node["ignored"] and node["role"]["value"] in NAMED]


@pytest.mark.parametrize("program, name", [("brakes", "Internal forces"), ("beamdyn", "Mode shapes")])
def test_letters_of_drawings_below_one_another_are_readable_on_a_phone(opened, program, name):
    page = opened(program, width=390)
    go(page, name)
    expect(shown(page, "Up to date.")).to_be_visible()
    heights = page.locator(f"{DRAWING}:visible text").evaluate_all(
        "(all) => all.map((text) => parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().a)"
    )
    assert len(heights) > 3 and min(heights) > 7.0  # px


def test_form_stays_while_results_scroll_and_another_screen_starts_at_its_top(page):
    page.mouse.move(900, 500)
    page.mouse.wheel(0, 10_000)
    page.wait_for_function("scrollY > 100")
    expect(field(page, "empty mass, m")).to_be_in_viewport()
    assert field(page, "empty mass, m").bounding_box()["y"] > 40  # below the tabs
    go(page, "Drum brake")
    page.wait_for_function("scrollY === 0")


def focused(page):
    """Label of what has the focus, and how wide its mark is."""
    return page.evaluate(
        "(e => [e.getAttribute('aria-label') || e.innerText, getComputedStyle(e).outlineWidth])"
        "(document.activeElement)"
    )


def test_keyboard_goes_from_tabs_to_the_form_to_the_results(page):
    page.get_by_role("tab", name="Vehicle").focus()
    page.keyboard.press("ArrowRight")
    assert focused(page) == ["Kinematics", "3px"]
    page.keyboard.press("ArrowLeft")
    order = []
    while "download Vehicle as CSV" not in order and len(order) < 80:
        page.keyboard.press("Tab")
        order.append(focused(page)[0])
    labels = ["File", "empty mass, m", "wheelbase, L", "speed, V", "download Vehicle as SVG"]
    places = [order.index(label) for label in labels]
    assert places == sorted(places)


def test_screen_is_chosen_by_keyboard(page):
    page.get_by_role("tab", name="Vehicle").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    page.wait_for_selector(f"{DRAWING}[data-words^='Kinematics']")


def test_mistake_in_a_folded_table_is_seen(page):
    go(page, "Vehicle")
    field(page, "friction, mu").fill("much")
    expect(page.get_by_text("stop.friction").locator("visible=true")).to_be_visible()
    page.get_by_role("button", name="Road and stop").click()
    expect(page.get_by_text("stop.friction").locator("visible=true")).to_have_count(0)
    field(page, "wheelbase, L").fill("2 m")
    expect(page.get_by_text("stop.friction").locator("visible=true")).to_be_visible()


@pytest.mark.parametrize(
    "program, label",
    [("brakes", "front wheel radius, r1"), pytest.param("beamdyn", "radius, r", marks=pytest.mark.slow)],
)
def test_page_that_is_open_while_its_program_stops_says_so_and_goes_on(opened, program, label):
    port = free_port()
    process = start(port, program)
    try:
        page = opened(at=f"http://127.0.0.1:{port}/")
        field(page, label).fill("0.42 m")
        kept(page, "0.42 m")
    finally:
        stop(process)
    banner = shown(page, f'Start "{program} app --port {port}" again: this page goes on by itself.')
    expect(banner).to_be_visible()
    expect(banner).to_be_in_viewport()
    process = start(port, program)
    try:
        expect(banner).not_to_be_visible()
        expect(field(page, label)).to_have_value("0.42 m")
        expect(shown(page, "Up to date.")).to_be_visible()
        before = drawing(page)
        field(page, label).fill("0.41 m")
        redrawn(page, before)
    finally:
        stop(process)


def test_page_that_becomes_narrow_and_wide_again_is_drawn_for_its_width(page):
    def paper():
        return page.locator(f"{DRAWING}:visible svg.machine").get_attribute("viewBox").split()[2]

    wide, before = paper(), drawing(page)
    page.set_viewport_size({"width": 390, "height": 900})
    redrawn(page, before)
    assert float(paper()) < 0.7 * float(wide)
    box = in_front(page).bounding_box()
    assert 300 < box["width"] <= 390 and page.evaluate("document.documentElement.scrollWidth") <= 390
    page.set_viewport_size({"width": 1280, "height": 900})
    expect(page.locator(f"{DRAWING}:visible")).to_have_attribute("data-picture", before)
    assert paper() == wide


def test_chart_is_zoomed_moved_and_shown_whole_by_keys(opened):
    page = opened("beamdyn")
    chart = page.locator(".chart:visible").first
    chart.wait_for()

    def texts():
        return chart.locator("text").all_text_contents()

    def pressed(key):
        before = texts()
        page.keyboard.press(key)
        page.wait_for_function(
            "([chart, before]) => [...chart.querySelectorAll('text')].map((e) => e.textContent).join()"
            " !== before.join()",
            arg=[chart.element_handle(), before],
        )
        return texts()

    whole = texts()
    chart.focus()
    assert "150" in whole and "150" not in pressed("+")
    for _ in range(3):
        page.keyboard.press("+")
    pressed("ArrowRight")
    assert pressed("0") == whole


def test_all_of_a_chart_is_that_of_the_present_entries(opened):
    page = opened("beamdyn")
    chart = page.locator(".chart:visible").first
    expect(chart.get_by_text("above: from 386 Hz")).to_be_visible()
    field(page, "radius, r").fill("220 mm")
    expect(chart.get_by_text("above: from 385.4 Hz")).to_be_visible()
    box = chart.bounding_box()
    page.mouse.click(box["x"] + box["width"] - 64, box["y"] + 25)  # the sign "all of it"
    page.wait_for_timeout(1000)  # a chart of before would stay
    assert chart.get_by_text("above: from 385.4 Hz").count() == 1


def test_long_words_in_a_table_have_a_column_on_a_phone(opened):
    page = opened("beamdyn")
    page.set_viewport_size({"width": 390, "height": 844})
    go(page, "Steady response")
    cell = page.locator("td:visible", has_text="the equations are linear").first
    assert cell.bounding_box(timeout=20_000)["width"] >= 150


def test_saved_chart_is_a_picture_for_programs_that_know_no_colours_of_the_page(opened):
    page = opened("beamdyn")
    chart = page.locator(".chart:visible").first
    chart.wait_for()
    box = chart.bounding_box()
    with page.expect_download(timeout=20_000) as saved:
        page.mouse.click(box["x"] + box["width"] - 35, box["y"] + 25)  # the sign "save as picture"
    assert saved.value.suggested_filename == "natural-frequencies-over-speed.svg"
    text = saved.value.path().read_text()
    assert "mode 1" in text and "#0072b2" in text
    assert "var(" not in text and "inherit" not in text
