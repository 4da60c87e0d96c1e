"""Whether everybody can use the screens, in a real browser: axe-core, keyboard, finger, width of the page.

What is looked for and how, `benchmarks/screenshots.py` says, which makes pictures of the same.
"""

from importlib.util import find_spec

import pytest

from benchmarks.screenshots import NO_AXE, PROGRAMS, SCHEMES, WIDTHS, faults
from tests.app.browsing import go, shown
from tests.app.serving import IN_BROWSER, NO_PLAYWRIGHT, PATIENCE

sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
sync_api.expect.set_options(timeout=1e3 * PATIENCE)
no_axe = pytest.mark.skipif(find_spec("axe_playwright_python") is None, reason=NO_AXE)
pytestmark = [*IN_BROWSER, no_axe]

SCREENS = [(name, s.name) for name, p in PROGRAMS.items() for d in p.documents for s in d.screens]
USUAL = 1440  # width of the page in every run of the tests [px]


@pytest.fixture(scope="module")
def pages(shared):
    """A page for each program and width, made when it is asked for."""
    made = {}

    def of(program, width):
        if (program, width) not in made:
            made[program, width] = shared(program, width=width)
        return made[program, width]

    return of


@pytest.mark.parametrize("program, name", SCREENS)
@pytest.mark.parametrize(
    "width", [USUAL, *(pytest.param(w, marks=pytest.mark.slow) for w in WIDTHS if w != USUAL)]
)
def test_nothing_keeps_people_out(pages, width, program, name):
    page = pages(program, width)
    go(page, name)
    sync_api.expect(shown(page, "Up to date.")).to_be_visible()
    for scheme in SCHEMES:
        page.emulate_media(color_scheme=scheme)
        page.wait_for_timeout(300)  # colours change gradually, on a busy machine for longer
        page.wait_for_function("() => !document.getAnimations().some(it => it instanceof CSSTransition)")
        found = faults(page, width)
        del found["empty"]  # keeps nobody out; the benchmark tells it
        assert {kind: said for kind, said in found.items() if said} == {}, scheme


@pytest.mark.parametrize(
    "harm, kind",
    [
        ("it => { it.style.color = '#ccc'; it.style.background = '#ddd'; }", "axe-core"),
        ("it => { it.tabIndex = -1; }", "not by keyboard"),
        ("it => { it.style.pointerEvents = 'none'; }", "not by touch"),
        ("it => { it.style.width = '3000px'; }", "scrolls to"),
        ("it => { it.innerText = 'frequency_1'; }", "code"),
        ("() => document.querySelectorAll('table').forEach((e) => { e.style.width = '3000px'; })", "cut"),
        (
            "() => document.querySelectorAll('.tables p').forEach((e) => "
            "{ e.closest('.tables').style.columns = '2 10px'; e.parentElement.style.breakInside = "
            "e.style.breakInside = 'auto'; e.innerText = 'word '.repeat(3000); })",
            "split",
        ),
        (
            "() => document.querySelectorAll('.numbers').forEach((e) => { e.style.marginTop = '4e3px'; })",
            "empty",
        ),
    ],
)
def test_the_check_finds_what_keeps_people_out(opened, harm, kind):
    page = opened()
    page.get_by_role("button", name="download Vehicle as SVG").evaluate(harm)
    assert faults(page, USUAL)[kind]
