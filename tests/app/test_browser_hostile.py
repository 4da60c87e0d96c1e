"""Hostile texts and pages, and a program that is killed, in a real browser: nothing runs, nothing is lost."""

import re
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from beamdyn.app.program import BEAMDYN
from benchmarks.hostile_entries import ENTER
from brakes.app.program import BRAKES
from tests.app.browsing import field, go, kept, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE, free_port, start, stop

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

SCREENS = [(p.name, s.name) for p in (BRAKES, BEAMDYN) for d in p.documents for s in d.screens]
IN_EVERY_RUN = {"Vehicle", "Mechanism", "Transient"}  # of different kinds: plain, with lists, with a player
EACH = [pytest.param(*s, marks=() if s[1] in IN_EVERY_RUN else pytest.mark.slow) for s in SCREENS]
SCRIPT = "<img src=x onerror=alert(1)><script>alert(1)</script>"
PATH = "../../../etc/passwd"
NO_OTHER = re.compile("Stale: for the entries before.|No result yet.")
# Elements that only a text which is taken for HTML can have made.
MADE = "img[src=x], script:not([src]):text('alert')"


@pytest.mark.parametrize("program, name", EACH)
def test_script_in_every_text_field_stays_text(opened, program, name):
    """All fields at once, those of folded tables, too; `opened` fails where a dialog or an error comes."""
    page = opened(program)
    go(page, name)
    paths = page.evaluate("() => [...document.querySelectorAll('[data-path]')].map((e) => e.dataset.path)")
    page.evaluate(ENTER, [[(path, SCRIPT) for path in dict.fromkeys(paths)], 0])
    expect(page.get_by_text("onerror=alert(1)").locator("visible=true").first).to_be_visible()
    page.wait_for_timeout(300)
    assert page.locator(MADE).count() == 0
    expect(page.locator(".status[role=status]:visible")).to_have_text(NO_OTHER)


def test_script_and_path_as_the_name_of_a_design_are_names(page):
    for name in (SCRIPT, PATH):
        page.get_by_role("button", name="Designs").click()
        page.get_by_label("name for this design").fill(name)
        page.get_by_role("button", name="Keep").click()
        expect(page.get_by_role("button", name=f"Compare {name}")).to_be_visible()
        page.get_by_role("button", name=f"Compare {name}").click()
        expect(page.get_by_role("button", name=f"Stop comparing with {name}")).to_be_visible()
        assert page.locator(MADE).count() == 0


@pytest.mark.parametrize("name", [SCRIPT, PATH])
def test_script_or_path_as_the_name_of_a_part_stays_text(page, name):
    go(page, "Mechanism")
    box = page.locator("input[data-path$='.name']:visible").first
    before = box.input_value()
    box.fill(name)
    box.blur()
    expect(page.get_by_text(name).or_(page.locator(".mistake:visible")).first).to_be_visible()
    assert page.locator(MADE).count() == 0 and before


def test_link_to_another_kind_of_file_is_refused(opened, address):
    from beamdyn.common.screens.browser_memory import LinkedDesign

    for kind, text in ((PATH, ""), (SCRIPT, SCRIPT), ("forklift", SCRIPT)):
        fragment = LinkedDesign(kind, text, {}).as_fragment()
        page = opened(at=f"{address('brakes')}#{fragment}")
        expect(page.locator(".q-dialog .mistake")).not_to_be_empty()
        assert page.locator(MADE).count() == 0


@pytest.fixture
def elsewhere():
    """The address of a page of another server, which frames one: a function of what it frames."""

    class Answer(BaseHTTPRequestHandler):
        framed = ""

        def do_GET(self):
            body = f'<h1>elsewhere</h1><iframe src="{self.framed}"></iframe>'.encode()
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    with HTTPServer(("127.0.0.1", 0), Answer) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()

        def framing(address):
            Answer.framed = address
            return f"http://127.0.0.1:{server.server_port}/"

        yield framing
        server.shutdown()


def test_another_page_cannot_frame_it(browser, address, elsewhere):
    page = browser.new_context().new_page()
    said = []
    page.on("console", lambda message: said.append(message.text))
    page.goto(elsewhere(address("brakes")))
    page.wait_for_timeout(500)
    frame = page.frames[1]
    assert "Vehicle" not in frame.content() and any("frame-ancestors" in words for words in said)
    page.context.close()


@pytest.mark.parametrize("number", [2, pytest.param(10, marks=pytest.mark.slow)])
def test_nothing_is_lost_or_mixed_when_the_program_is_killed_in_the_middle_of_an_edit(opened, number):
    port = free_port()
    process = start(port)
    try:
        pages = [opened(at=f"http://127.0.0.1:{port}/") for _ in range(number)]
        for i, page in enumerate(pages):
            field(page, "speed, V").fill(f"{21 + i} km/h")
            kept(page, f"{21 + i} km/h")
            field(page, "wheelbase, L").focus()
            page.keyboard.press("Control+a")
            page.keyboard.type(f"2.{10 + i} m")  # not yet sent: a field waits for a pause in typing
    finally:
        process.kill()
        process.wait(PATIENCE)
    process = start(port)
    try:
        for i, page in enumerate(pages):
            expect(shown(page, "Up to date.")).to_be_visible()
            expect(field(page, "speed, V")).to_have_value(f"{21 + i} km/h")
            expect(field(page, "wheelbase, L")).to_have_value(f"2.{10 + i} m")
    finally:
        stop(process)
