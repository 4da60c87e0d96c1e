"""Screens made of an analysis, and that of decks, in a real browser on a phone and a desk: a task on each."""

import re

import pytest

from tests.app.browsing import go, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

TASKS = {
    "Campbell": ("campbell.top_speed", "90 rad/s", "rotation"),
    "Compare": ("compare.measured", "65.23 Hz", "All agree to the digits of the data"),
    "Identify": ("identify.measured", "60 Hz", "The deviations that remain"),
    "Map": ("study.vary", "thickness=0.1:0.4:3 mm", "3 designs"),
    "Loads": ("loads.speed", "30 rad/s", "30 rad/s"),
    "Frequency response": ("response.frequencies", "50:80:7 Hz", "50 to 80 Hz"),
    "Random road": ("random.velocity", "60 km/h", "55.56 rad/s"),
    "Deck": ("deck.length", "30 m", "30 m"),
}
OFTEN = {"Compare", "Deck"}  # the others with the slow tests: each takes seconds
_TOO_WIDE = "document.documentElement.scrollWidth > innerWidth"
_CUT = """() => [...document.querySelectorAll('.tables table')].filter((t) => t.offsetParent).filter((t) =>
  t.getBoundingClientRect().right > t.closest('.numbers').getBoundingClientRect().right + 1 &&
  getComputedStyle(t.parentElement).overflowX == 'visible').length"""


@pytest.fixture(scope="module", params=[390, pytest.param(1440, marks=pytest.mark.slow)])
def wide(shared, request):
    """A page of `beamdyn app`, of a phone or a desk."""
    return shared("beamdyn", width=request.param)


@pytest.mark.parametrize(
    "name", [name if name in OFTEN else pytest.param(name, marks=pytest.mark.slow) for name in TASKS]
)
def test_an_option_is_changed_and_the_answer_follows(wide, name):
    path, text, said = TASKS[name]
    go(wide, name)
    expect(shown(wide, "Up to date.")).to_be_visible()
    entry = wide.locator(f"[data-path='{path}']").locator("visible=true").first
    entry.fill(text)
    entry.press("Tab")
    expect(shown(wide, re.compile(re.escape(said)))).to_be_visible()
    expect(shown(wide, "Up to date.")).to_be_visible()
    assert not wide.evaluate(_TOO_WIDE)
    assert wide.evaluate(_CUT) == 0
    expect(wide.locator("[data-document]:visible").get_by_role("img").first).to_be_visible()
