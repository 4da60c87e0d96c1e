"""The interactive program in a real browser: Debian's chromium, driven by playwright."""

import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = shutil.which("chromium")
ROOT = Path(__file__).parents[2]
pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium; on Debian: apt-get install chromium"),
]


def free_port():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


def start(port):
    """The program as a process of its own, when it answers."""
    command = [sys.executable, "-m", "brakes", "app", "--no-browser", "--port", str(port)]
    # With pytest's variables NiceGUI would think that it is tested from within.
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST", "NICEGUI"))}
    process = subprocess.Popen(
        command, cwd=ROOT, env=clean, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline and process.poll() is None:
        with socket.socket() as trial:
            if trial.connect_ex(("127.0.0.1", port)) == 0:
                return process
        time.sleep(0.1)
    process.kill()
    raise AssertionError("the program does not answer")


def stop(process):
    process.terminate()
    process.wait(20)


@pytest.fixture(scope="module")
def port():
    found = free_port()
    process = start(found)
    yield found
    stop(process)


@pytest.fixture(scope="module")
def browser():
    with sync_api.sync_playwright() as playwright:
        made = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield made
        made.close()


@pytest.fixture
def page(browser, port):
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    made = context.new_page()
    made.set_default_timeout(10_000)
    made.goto(f"http://127.0.0.1:{port}/")
    made.wait_for_selector("img.drawing")
    yield made
    context.close()


def drawing(page):
    return page.locator("img.drawing:visible").first.get_attribute("src")


def changed(page, before):
    page.wait_for_function("before => document.querySelector('img.drawing')?.src !== before", arg=before)


def test_every_screen_opens_and_shows_its_drawing(page):
    for name in ("Kinematics", "Internal forces", "Drum brake", "Caliper", "Vehicle"):
        page.get_by_role("tab", name=name).click()
        sync_api.expect(page.locator("img.drawing:visible")).to_be_visible()
        sync_api.expect(page.get_by_text("Up to date.").locator("visible=true")).to_be_visible()


def test_change_by_keyboard_mistake_and_remedy(page):
    before = drawing(page)
    speed = page.get_by_label("speed, V", exact=True).locator("visible=true")
    speed.focus()
    page.keyboard.press("Control+a")
    page.keyboard.type("25")
    sync_api.expect(page.get_by_text('stop.speed = "25": give a unit')).to_be_visible()
    sync_api.expect(page.locator(".greyed:visible")).to_have_count(1)
    assert drawing(page) == before
    page.keyboard.type(" km/h")
    sync_api.expect(page.locator(".greyed:visible")).to_have_count(0)
    sync_api.expect(page.get_by_role("tab", name="Internal forces (stale)")).to_have_count(0)
    assert drawing(page) != before


def test_stage_slider_by_keyboard_moves_the_shoes(page):
    page.get_by_role("tab", name="Kinematics").click()
    sync_api.expect(page.locator(".slider:visible")).to_be_visible()
    before = drawing(page)
    page.locator(".slider:visible [tabindex='0']").first.focus()
    for _ in range(5):
        page.keyboard.press("ArrowLeft")
    page.wait_for_timeout(500)
    assert drawing(page) != before


def test_save_open_and_report(page, tmp_path):
    page.get_by_label("wheelbase, L", exact=True).fill("2.0 m")
    page.wait_for_timeout(600)
    with page.expect_download() as saved:
        page.get_by_role("button", name="File").click()
        page.get_by_text("Save as TOML").click()
    file = tmp_path / "mine.toml"
    saved.value.save_as(file)
    assert 'wheelbase = "2.0 m"' in file.read_text(encoding="utf-8")
    file.write_text(file.read_text(encoding="utf-8").replace("2.0 m", "2.1 m"), encoding="utf-8")
    page.get_by_role("button", name="File").click()
    page.get_by_text("Open a TOML file", exact=True).click()
    page.locator("input[type=file]").set_input_files(file)
    sync_api.expect(page.get_by_label("wheelbase, L", exact=True)).to_have_value("2.1 m")
    with page.expect_download() as report:
        page.get_by_role("button", name="File").click()
        page.get_by_text("Report as HTML").click()
    report.value.save_as(tmp_path / "report.html")
    assert (tmp_path / "report.html").read_text(encoding="utf-8").count("data:image/svg+xml") == 3


def test_reload_keeps_the_design(page):
    page.get_by_label("wheelbase, L", exact=True).fill("2.2 m")
    page.wait_for_timeout(600)
    page.reload()
    sync_api.expect(page.get_by_label("wheelbase, L", exact=True)).to_have_value("2.2 m")


def test_open_page_survives_a_restart_of_the_program(browser):
    port = free_port()
    process = start(port)
    try:
        page = browser.new_page()
        page.goto(f"http://127.0.0.1:{port}/")
        page.get_by_label("wheelbase, L", exact=True).fill("2.3 m")
        page.wait_for_timeout(600)
    finally:
        stop(process)
    process = start(port)
    try:
        sync_api.expect(page.locator("img.drawing:visible")).to_be_visible(timeout=20_000)
        page.wait_for_timeout(3000)
        field = page.get_by_label("wheelbase, L", exact=True)
        sync_api.expect(field).to_have_value("2.3 m", timeout=10_000)
    finally:
        stop(process)


@pytest.mark.parametrize("width", [1280, 800])
def test_page_is_no_wider_than_the_window(page, width):
    page.set_viewport_size({"width": width, "height": 900})
    for name in ("Vehicle", "Internal forces", "Drum brake", "Caliper"):
        page.get_by_role("tab", name=name).click()
        page.wait_for_timeout(300)
        assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_nothing_but_this_computer_is_listened_to(port):
    host = next(
        (a[4][0] for a in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)), "127.0.0.1"
    )
    if host.startswith("127."):
        pytest.skip("this computer has no other address")
    with socket.socket() as trial:
        trial.settimeout(2)
        assert trial.connect_ex((host, port)) != 0
