"""A task on every screen of both programs, in a real browser on a phone and a desk, and axe-core after it."""

import re

import pytest

from benchmarks.screenshots import PROGRAMS, serious_findings
from tests.app.browsing import go, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
expect = sync_api.expect
expect.set_options(timeout=1e3 * PATIENCE)
pytestmark = IN_BROWSER

# By program and screen: an input, what is typed there, and what the screen then says.
FRICTION = "brake.friction", "0.28", "friction 0.28"
TASKS = {
    "brakes": {
        "Vehicle": ("stop.speed", "10 km/h", "4.25"),  # v (0.5 + 0.3/2) s + v^2 / 2a, a from 20 km/h
        "Kinematics": ("brake.piston_bottom", "1 mm", "-1.0000 mm"),
        "Internal forces": ("forces.piston_force", "11 kN", "11000"),
        "Drum brake": FRICTION,
        "Band brake": FRICTION,
        "Block brake": FRICTION,
        "Cone brake": FRICTION,
        "Disc brake": FRICTION,
        "Multi-plate brake": FRICTION,
        "Sliding shoes": FRICTION,
        "Parking and grip": ("lever.force", "200 N", "force of 200 N"),
        "Caliper": ("run.finger", "80 N", "80 N on the hand lever"),
        "Mechanism": ("run.travel", "10 mm", "forces at 10 mm of hand"),
    },
    "beamdyn": {
        "Frequencies": ("options.top_speed", "140 rad/s", "at 140 rad/s"),
        "Rotor": ("mount.radius", "200 mm", "200"),
        "Mode shapes": ("operation.speed", "0 rad/s", "65.23 Hz"),
        "Steady response": ("options.modes", "1", "1 mode"),
        "Transient": ("run.end", "6 s", "deflection in 6 s"),
        "Trade": ("trade.digits", "2", "tolerance 1e-02"),
        "Frequency response": ("response.frequencies", "50:80:7 Hz", "50 to 80 Hz"),
        "Random road": ("random.velocity", "60 km/h", "55.56 rad/s"),
        "Loads": ("loads.speed", "30 rad/s", "30 rad/s"),
        "Map": ("study.vary", "thickness=0.1:0.4:3 mm", "3 designs"),
        "Compare": ("compare.measured", "65.23 Hz", "All agree to the digits of the data"),
        "Identify": ("identify.measured", "60 Hz", "52.13"),  # 50 mm (65.23/60)^(1/2)
        "Design": ("design.free", "thickness=0.1:0.5 mm", "0.245"),  # 0.2 mm 80 Hz/65.23 Hz
        "Campbell": ("campbell.top_speed", "90 rad/s", "rotation"),
        "Harvest": ("harvest.speeds", "60:90:2 km/h", "2 speeds"),
        "Best resistance": ("best_resistance.speed", "45 rad/s", "45 rad/s"),
        "Stability chart": (
            "stability_chart.vary",
            "speed=40:60:5 rad/s; motion.fluctuation=0:0.2:5",
            "25 points",
        ),
        "Stability limits": ("stability_limits.modes", "2", "2 modes"),
        "Deck": ("deck.length", "30 m", "30 m"),
    },
}
# Their answers take seconds, or their like is tried anyway.
SELDOM = {"Transient", "Trade", "Harvest", "Best resistance", "Stability chart", "Stability limits"}
SCREENS = [
    pytest.param(program, name, marks=[pytest.mark.slow] if name in SELDOM else [])
    for program, of_program in TASKS.items()
    for name in of_program
]
_TOO_WIDE = "document.documentElement.scrollWidth > innerWidth"
_CUT = """() => [...document.querySelectorAll('.tables table')].filter((t) => t.offsetParent).filter((t) =>
  t.getBoundingClientRect().right > t.closest('.numbers').getBoundingClientRect().right + 1 &&
  getComputedStyle(t.parentElement).overflowX == 'visible').length"""


@pytest.fixture(scope="module", params=[390, pytest.param(1440, marks=pytest.mark.slow)])
def pages(shared, request):
    """A page of each program, of a phone or a desk."""
    return {program: shared(program, width=request.param) for program in TASKS}


def test_every_screen_has_a_task():
    assert {name: [*each] for name, each in TASKS.items()} == {
        name: [screen.name for document in program.documents for screen in document.screens]
        for name, program in PROGRAMS.items()
    }


@pytest.mark.parametrize("program, name", SCREENS)
def test_an_input_is_changed_and_the_answer_follows(pages, program, name):
    page, (path, text, said) = pages[program], TASKS[program][name]
    go(page, name)
    expect(shown(page, "Up to date.")).to_be_visible()
    entry = page.locator(f"[data-path='{path}']").locator("visible=true").first
    entry.fill(text)
    entry.press("Tab")
    expect(shown(page, re.compile(re.escape(said)))).to_be_visible()
    expect(shown(page, "Up to date.")).to_be_visible()
    assert not page.evaluate(_TOO_WIDE)
    assert page.evaluate(_CUT) == 0
    expect(page.locator("[data-document]:visible").get_by_role("img").first).to_be_visible()
    assert not serious_findings(page)
