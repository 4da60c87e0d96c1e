"""Pictures of every screen of the interactive programs, and faults in its accessibility and layout.

Run: python -m benchmarks.screenshots [--folder DIR] [--program brakes|beamdyn] [--width 390]

Each screen at five widths, light and dark: serious findings of axe-core (where axe-playwright-python is
there), horizontal scrolling, controls that neither keyboard nor finger can reach, tables that are cut,
sentences over two columns, halves of a page that are empty for more than a third of its height, and code in
texts.
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

WIDTHS, SCHEMES = (390, 800, 1024, 1440, 1920), ("light", "dark")
PROGRAMS = {program.name: program for program in (BRAKES, BEAMDYN)}
_TO_TOP = "document.querySelectorAll('html, .left').forEach((e) => e.scrollTo(0, 0))"
NO_AXE = "axe-core: pip install axe-playwright-python"
_SERIOUS = ("serious", "critical")

_LEFT = (
    200  # Quasar's tabs can be stopped at again 30 ms after the focus has left them; keys outrun timers [ms]
)
_STEPS, _MOST = 12, 30  # number of Tab key presses between two checks for a full cycle, and most checks
_BEGIN = """() => {
  document.activeElement.blur();
  if (!window.reached) document.addEventListener("focusin", (event) => window.reached.push(event.target));
  window.reached = [];
}"""
_AROUND = "() => window.reached.indexOf(window.reached[0], 1) > 0"
# Script: names of visible controls that the Tab key did not reach; of tabs one is enough, as arrow keys reach
# the others.
_NOT_REACHED = """() => [...document.querySelectorAll(
  "button, input, textarea, a[href], summary, [role=slider], [role=tablist], [role=button], [role=switch]")]
  .filter((e) => e.checkVisibility({visibilityProperty: true}) && !e.disabled && e.type !== "file")
  .filter((e) => !window.reached.some((stop) => e.contains(stop) || stop.contains(e)))
  .map((e) => e.getAttribute("aria-label") || e.innerText || e.outerHTML.slice(0, 80))"""
# Script: names of controls that other elements cover at their centre, after the page has been scrolled there.
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

# Script: first words of visible tables that are wider than their container.
_CUT = """() => [...document.querySelectorAll("table")]
  .filter((e) => e.checkVisibility({visibilityProperty: true}))
  .filter((e) => [...e.getClientRects()].some((part) => part.width > e.parentElement.clientWidth + 1))
  .map((e) => `${Math.round(e.getBoundingClientRect().width)} px: ${e.innerText.slice(0, 60)}`)"""
# First words of sentences that begin in one column and end in another.
_SPLIT = """() => [...document.querySelectorAll(".tables p")]
  .filter((e) => e.getClientRects().length > 1).map((e) => e.innerText.slice(0, 60))"""
# Of the part beside the form, each half in which there is nothing over more than a third of the page's
# height; the form stays in sight, and needs no room of its own.
_EMPTY = """() => {
  const page = document.documentElement.scrollHeight;
  const right = [...document.querySelectorAll(".right")].find((e) => e.checkVisibility());
  if (!right) return [];  // on a phone its parts stand in the page itself
  const boxes = [...right.querySelectorAll("*")].map((e) => [...e.childNodes].some((n) => n.nodeType == 3
      && n.textContent.trim()) || e.matches("svg, img, canvas, table, button, input, .chart")
    ? e.getBoundingClientRect() : null).filter((box) => box && box.width > 1);
  const bottom = Math.max(...boxes.map((box) => box.bottom));
  const whole = right.getBoundingClientRect(), middle = whole.left + whole.width / 2;
  const gap = (beside) => {
    let [seen, most] = [whole.top, 0];
    for (const box of boxes.filter(beside).sort((a, b) => a.top - b.top)) {
      most = Math.max(most, box.top - seen);
      seen = Math.max(seen, box.bottom);
    }
    return Math.max(most, bottom - seen);
  };
  return [["left", gap((box) => box.left < middle)], ["right", gap((box) => box.right > middle)]]
    .filter(([, most]) => most > page / 3).map(([name, most]) => `${name} half over ${Math.round(most)} px`);
}"""
# Script: visible texts that contain code: a variable name, a call, an optional value of Python, or a list.
_CODE = """() => {
  const found = [], texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const said = texts.currentNode, around = said.parentElement;
    if (around.closest("script, style, textarea, .q-icon") || !around.checkVisibility()) continue;
    if (/\\b[a-z]+_\\w+\\b|\\b(None|True|False|nan|inf)\\b|\\w\\(\\w+=|\\['/.test(said.textContent))
      found.push(said.textContent.trim().slice(0, 80));
  }
  return found;
}"""


def serious_findings(page: Any) -> list[str] | None:
    """Return serious findings of axe-core: rule, count, first element; None if it is not installed."""
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
    """Return names of controls that the Tab key does not reach on its way around the page."""
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
    """Return the faults of the visible screen, by kind."""
    wide = page.evaluate("document.documentElement.scrollWidth")
    return {
        "axe-core": serious_findings(page) or [],
        "scrolls to": [f"{wide} px"] if wide > width else [],
        "not by keyboard": not_by_keyboard(page),
        "not by touch": page.evaluate(_NOT_BY_TOUCH),
        "cut": page.evaluate(_CUT),
        "split": page.evaluate(_SPLIT),
        "empty": page.evaluate(_EMPTY),
        "code": page.evaluate(_CODE),
    }


def pictures(program: Program, folder: Path, widths: Sequence[int] = WIDTHS) -> Iterator[Row]:
    """Take the pictures of a program, and yield the faults at each width."""
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
            page.wait_for_timeout(300)  # waits until gradual changes of colour have ended
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
