"""In a real browser: numbers for earlier entries are not taken for those of the present entries."""

import pytest

from tests.app.browsing import field, go, shown, unfold
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

# At each picture in which they have changed: text of a field, status, opacity of the headline, and its mark.
WATCH = """(path) => {
  const seen = (wanted) => [...document.querySelectorAll(wanted)].filter((it) => it.offsetParent);
  window.painted = [];
  const look = () => {
    const [number] = seen(".headline dd"), [typed] = seen(`[data-path="${path}"]`);
    const status = seen("[role=status].status, .newer").map((it) => it.innerText).join();
    const mark = getComputedStyle(number.previousSibling, "::after").content;
    const now = [typed.value, status, getComputedStyle(number).opacity, mark];
    if (JSON.stringify(now) !== JSON.stringify(painted.at(-1))) painted.push(now);
    requestAnimationFrame(look);
  };
  look();
}"""


def is_honest(picture, text):
    """Whether a number for other entries than these is grey, with a word, and not called up to date."""
    typed, status, opacity, word = picture
    return typed == text or (
        "Stale: for the entries before." in status and float(opacity) < 0.5 and "stale" in word
    )


@pytest.mark.parametrize(
    "program, screen, label, path, bad, good",
    [
        ("beamdyn", "Frequencies", "length, L", "beam.length", "300", "51"),
        ("brakes", "Mechanism", "travel", "run.travel", "13 x", "13"),
        ("brakes", "Vehicle", "speed, V", "stop.speed", "-5", "21"),
    ],
)
def test_number_for_the_entries_before_is_grey_at_once(opened, program, screen, label, path, bad, good):
    page = opened(program)
    go(page, screen)
    expect(shown(page, "Up to date.")).to_be_visible()
    page.evaluate(WATCH, path)
    before = page.evaluate("painted[0][0]")
    box = page.locator(f'[data-path="{path}"]:visible')
    box.focus()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(bad)
    page.keyboard.press("Enter")  # by which a list takes it
    expect(shown(page, "Refused. Stale: for the entries before.")).to_be_visible()
    expect(page.locator(".shown:visible")).to_have_css("opacity", "0.45")
    painted = page.evaluate("painted")
    assert painted[-1][0] == bad and [picture for picture in painted if not is_honest(picture, before)] == []
    box.press("Control+a")
    page.keyboard.insert_text(good)
    page.keyboard.press("Enter")
    expect(shown(page, "Up to date.")).to_be_visible()
    expect(page.locator(".stale:visible, .greyed:visible, .typed:visible")).to_have_count(0)


def test_name_in_a_list_that_is_not_left_yet_is_no_entry_yet(page):
    go(page, "Mechanism")
    expect(shown(page, "Up to date.")).to_be_visible()
    name = page.locator("[data-path='points.A.name']:visible")
    name.fill("pivot")
    page.wait_for_timeout(500)
    expect(shown(page, "Stale: for the entries before.")).to_be_visible()
    expect(page.get_by_text("Up to date.").locator("visible=true")).to_have_count(0)
    name.press("Enter")
    expect(shown(page, "Up to date.")).to_be_visible()


@pytest.mark.parametrize("width", [1280, 390])
def test_refusal_is_seen_at_the_field_that_was_changed(opened, width):
    page = opened("beamdyn", width=width)
    length = field(page, "length, L")
    length.fill("300")
    said = "the cause is beam.length, changed from 50 mm: change either"
    marked = page.locator(".q-field--error:visible")
    expect(marked).to_have_count(1)
    expect(marked).to_contain_text(said)
    assert marked.locator("[data-path]").get_attribute("data-path") == "beam.length"
    page.evaluate("window.scrollTo(0, 0)")
    summary = page.locator(".said .mistake", has_text=said)
    if width == 390:  # the field is out of sight
        expect(summary).to_be_in_viewport()
    else:
        expect(summary).to_be_hidden()
        expect(marked).to_be_in_viewport()


def test_a_hinge_turns_over_at_any_speed(opened):
    page = opened("beamdyn")
    unfold(page, "rest", "mount.root_stiffness")
    field(page, "root stiffness, k").fill("0")
    expect(shown(page, "give the hinge a spring, or let the beam point outward")).to_be_visible()
    expect(page.locator(".headline:visible div", has_text="critical speed")).to_contain_text("0 rad/s")
    expect(page.locator(".q-field--error:visible")).to_have_count(0)


# Types into a field as a person does, and goes to another screen as soon as the page says that it computes.
LEAVE = """([path, text, other]) => {
  const seen = (wanted) => [...document.querySelectorAll(wanted)].filter((it) => it.offsetParent);
  const [typed] = seen(`[data-path="${path}"]`), [status] = seen("[role=status].status");
  new MutationObserver((_, observer) => {
    if (status.innerText.includes("Up to date.")) return;
    observer.disconnect();
    [...document.querySelectorAll("[role=tab]")].find((tab) => tab.innerText === other).click();
  }).observe(status, {characterData: true, childList: true, subtree: true});
  typed.focus();
  typed.select();
  document.execCommand("insertText", false, text);
}"""


def test_screen_left_while_it_computes_is_up_to_date_on_return(opened):
    page = opened("beamdyn")
    expect(shown(page, "Up to date.")).to_be_visible()
    page.evaluate(LEAVE, ["beam.length", "51 mm", "Steady response"])
    expect(page.get_by_role("tab", name="Steady response")).to_have_attribute("aria-selected", "true")
    expect(shown(page, "Up to date.")).to_be_visible()
    go(page, "Frequencies")
    expect(field(page, "length, L")).to_have_value("51 mm")
    expect(shown(page, "Up to date.")).to_be_visible()
