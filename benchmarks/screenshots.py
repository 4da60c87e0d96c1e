"""Pictures of every screen of the interactive programs, and what is wrong with it for its users.

Run: python -m benchmarks.screenshots [--folder DIR] [--program brakes|beamdyn] [--width 390]

Each screen at four widths, light and dark: serious findings of axe-core (where axe-playwright-python is
there), horizontal scrolling, and controls that neither keyboard nor finger can reach.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from beamdyn.app.program import BEAMDYN
from beamdyn.common.screens.screens import Program
from benchmarks.rows import Row, show
from benchmarks.served import browser, free_port, go, open_page, start, stop
from brakes.app.program import BRAKES

WIDTHS, SCHEMES = (390, 800, 1280, 1920), ("light", "dark")
PROGRAMS = {program.name: program for program in (BRAKES, BEAMDYN)}
_TO_TOP = "document.querySelectorAll('html, .left').forEach((e) => e.scrollTo(0, 0))"
NO_AXE = "axe-core: pip install axe-playwright-python"
_SERIOUS = ("serious", "critical")

_LEFT = (
    200  # Quasar's tabs can be stopped at again 30 ms after the focus has left them; keys outrun timers [ms]
)
_STEPS, _MOST = 12, 30  # of the Tab key between two looks whether it has come round, and looks
_BEGIN = """() => {
  document.activeElement.blur();
  if (!window.reached) document.addEventListener("focusin", (event) => window.reached.push(event.target));
  window.reached = [];
}"""
_AROUND = "() => window.reached.indexOf(window.reached[0], 1) > 0"
# Names of visible controls at which the Tab key has not stopped; of tabs one is enough, the others are
# reached from it by arrow keys.
_NOT_REACHED = """() => [...document.querySelectorAll(
  "button, input, textarea, a[href], summary, [role=slider], [role=tablist], [role=button], [role=switch]")]
  .filter((e) => e.checkVisibility({visibilityProperty: true}) && !e.disabled && e.type !== "file")
  .filter((e) => !window.reached.some((stop) => e.contains(stop) || stop.contains(e)))
  .map((e) => e.getAttribute("aria-label") || e.innerText || e.outerHTML.slice(0, 80))"""
# Names of controls that are covered where a finger would touch them, after the page has been scrolled there.
_NOT_BY_TOUCH = """() => [...document.querySelectorAll("button, input, textarea, [role=tab], .handle")]
  .filter((e) => e.checkVisibility({visibilityProperty: true}) && !e.disabled && e.type !== "file")
  .filter((e) => {
    e.scrollIntoView({block: "center", inline: "center"});
    const box = e.getBoundingClientRect();
    const hit = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
    return box.width > 1 && !(hit && (e.contains(hit)
      || e.closest(".q-field")?.contains(hit)
      || (e.matches(".handle") && hit.matches(".handle"))));
  }).map((e) => e.getAttribute("aria-label") || e.innerText || e.outerHTML.slice(0, 80))"""


def serious_findings(page: Any) -> list[str] | None:
    """Serious findings of axe-core: the rule, how often, and the first place; None where it is not there."""
    try:
        from axe_playwright_python.sync_playwright import Axe
    except ImportError:
        return None
    found = Axe().run(page).response["violations"]
    return [
        f"{rule['id']} x {len(rule['nodes'])}: {rule['nodes'][0]['target']}"
        for rule in found
        if rule["impact"] in _SERIOUS
    ]


def not_by_keyboard(page: Any) -> list[str]:
    """Names of controls that the Tab key does not come to, pressed until it has gone all around the page."""
    page.evaluate(_BEGIN)
    page.wait_for_timeout(_LEFT)
    for _ in range(_MOST):
        for _ in range(_STEPS):
            page.keyboard.press("Tab")
        if page.evaluate(_AROUND):
            break
    found = page.evaluate(_NOT_REACHED)
    page.evaluate("document.activeElement.blur()")
    return found


def faults(page: Any, width: int) -> dict[str, list[str]]:
    """What is wrong with the screen in front, by kind."""
    wide = page.evaluate("document.documentElement.scrollWidth")
    return {
        "axe-core": serious_findings(page) or [],
        "scrolls to": [f"{wide} px"] if wide > width else [],
        "not by keyboard": not_by_keyboard(page),
        "not by touch": page.evaluate(_NOT_BY_TOUCH),
    }


def pictures(program: Program, folder: Path, widths: Sequence[int] = WIDTHS) -> Iterator[Row]:
    """Take the pictures of a program, and yield what is wrong at each width."""
    folder.mkdir(parents=True, exist_ok=True)
    process = start(port := free_port(), program.name)
    try:
        with browser() as made:
            for width in widths:
                yield from _of_width(made, port, program, width, folder)
    finally:
        stop(process)


def _of_width(browser: Any, port: int, program: Program, width: int, folder: Path) -> Iterator[Row]:
    size = {"width": width, "height": 900}
    context = browser.new_context(viewport=size, has_touch=width < 800, bypass_csp=True)
    page = open_page(context, port)
    for screen in (screen for document in program.documents for screen in document.screens):
        go(page, screen.name)
        for scheme in SCHEMES:
            page.emulate_media(color_scheme=scheme)
            page.wait_for_timeout(300)  # colours change gradually
            name = f"{program.name}-{screen.name.lower().replace(' ', '-')}-{width}-{scheme}"
            page.evaluate(_TO_TOP)
            page.screenshot(path=folder / f"{name}.png")
            wrong = [f"{kind} {', '.join(said)}" for kind, said in faults(page, width).items() if said]
            yield name, "; ".join(wrong) or "nothing wrong", "nothing wrong"
    context.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--folder", type=Path, default=Path("screenshots"))
    parser.add_argument("--program", choices=PROGRAMS)
    parser.add_argument("--width", type=int, action="append", help="of the page [px]; may be repeated")
    given = parser.parse_args()
    widths = given.width or WIDTHS
    for name, program in PROGRAMS.items():
        if given.program in (None, name):
            show(name, lambda program=program: pictures(program, given.folder, widths))


if __name__ == "__main__":
    main()
