"""In a real browser: speeds in sentences on the screen, and what is typed just before a reload."""

import re

import pytest

from tests.app.browsing import field, go, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER


def test_steady_response_names_separate_speeds_one_by_one(opened):
    """Two resonances of the rolling harvester, between which the tip hardly moves, are no range of speeds."""
    page = opened("beamdyn")
    go(page, "Steady response")
    said = shown(page, re.compile(r"the tip moves by [\d.]+ lengths at "))
    expect(said).to_be_visible()
    ranges = re.findall(r"([\d.]+) to ([\d.]+) rad/s", said.inner_text())
    assert len(ranges) == 2
    assert all(float(high) - float(low) < 1 for low, high in ranges)  # a peak each; between them are 16 rad/s


@pytest.mark.parametrize("wait", [0, 20, 60])
def test_entry_typed_just_before_a_reload_is_kept(opened, wait):
    page = opened("beamdyn")
    go(page, "Transient")
    box = field(page, "length, L")
    box.fill("57 mm")
    page.wait_for_timeout(wait)
    page.reload()
    go(page, "Transient")
    expect(field(page, "length, L")).to_have_value("57 mm")
