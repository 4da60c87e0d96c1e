"""Five tasks that a user does with the interactive programs, without the manual.

Run: python -m benchmarks.app_tasks [--folder DIR] [--task NAME]

The tasks are performed in Chromium with the texts that a page shows.  Results, numbers of actions (a click, a
key or a typed text each) and times are printed, and a picture of each task is stored in the folder.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.rows import Row, show
from benchmarks.served import browser, free_port, go, open_page, start, stop

SIZE = {"width": 1440, "height": 1000}
_SETTLES = 250  # time after which a page has received an action [ms]
_HEADLINE = """() => {
  const it = [...document.querySelectorAll('dl.headline')].find((e) => e.offsetParent);
  return Object.fromEntries([...(it?.children ?? [])].map((e) =>
    [e.querySelector('dt').innerText, e.querySelector('dd').innerText]));
}"""
_ANSWERED = """() => {
  const it = [...document.querySelectorAll('.status[role=status]')].find((e) => e.offsetParent);
  return it && !it.innerText.startsWith('Computing');
}"""
_NEVER, _STEPS = "never", 40


@dataclass
class Person:
    """A simulated user at the page of a program, with a count of the user's actions.

    Parameters
    ----------
    page : Page
        Page of the browser.
    actions : int
        Number of clicks, keys pressed and texts typed.
    """

    page: Any
    actions: int = 0

    def goes_to(self, screen: str) -> None:
        """Choose a screen."""
        self.actions += 1
        go(self.page, screen)

    def presses(self, words: str, times: int = 1) -> None:
        """Press the button with given words."""
        for _ in range(times):
            self._does(lambda: self._seen(self.page.get_by_role("button", name=words, exact=True)).click())

    def types(self, path: str, text: str) -> None:
        """Type a text into a field, and leave the field."""

        def fill() -> None:
            made = self.field(path)
            made.fill(text)
            made.press("Tab")

        self._does(fill)

    def chooses(self, path: str, option: str) -> None:
        """Choose an option from a field's menu."""

        def choose() -> None:
            self.field(path).click()
            self._seen(self.page.get_by_role("option", name=option, exact=True)).click()

        self._does(choose)

    def moves(self, point: str, key: str) -> None:
        """Move a point of the drawing, or a slider, by a key."""
        made = self._seen(self.page.get_by_role("slider", name=point, exact=True))
        self._does(lambda: made.press(key))

    def reads(self, words: str) -> str:
        """Return a result, given by its words, from the results at the top of the screen."""
        return str(self.page.evaluate(_HEADLINE).get(words, ""))

    def sees(self, text: str) -> str:
        """Return the line of text on the visible page that contains given words."""
        return self._seen(self.page.get_by_text(text)).inner_text()

    def field(self, path: str) -> Any:
        """Return a field of the visible screen."""
        return self._seen(self.page.locator(f'[data-path="{path}"]'))

    def _seen(self, found: Any) -> Any:
        return found.locator("visible=true").first

    def _does(self, action: Callable[[], object]) -> None:
        self.actions += 1
        action()
        self.page.wait_for_timeout(_SETTLES)
        self.page.wait_for_function(_ANSWERED)


def find_the_slope(person: Person) -> str:
    """The slope at which the truck no longer stops: the slope's end is moved down and back in the drawing."""
    person.goes_to("Vehicle")
    last: dict[bool, str] = {}  # last slopes at which the truck stops, and does not stop
    for key in ("Shift+ArrowDown", "ArrowUp"):
        while (never := person.reads("stopping distance") == _NEVER) != key.endswith("Down"):
            last[never] = person.field("stop.slope").input_value()
            person.moves("end of the slope", key)
        last[never] = person.field("stop.slope").input_value()
    return f"stops on {last[False]}, never on {last[True]}"


def move_the_pivot(person: Person) -> str:
    """A pivot of a caliper is moved until both pads move alike."""
    point, ratio = "pivot of the arm of the right pad", "left pad over right, velocity"
    person.goes_to("Caliper")
    for key in ("ArrowRight", "ArrowLeft"):
        last = abs(float(person.reads(ratio)) - 1)
        for _ in range(_STEPS):
            person.moves(point, key)
            if (now := abs(float(person.reads(ratio)) - 1)) >= last:
                break
            last = now
    for x in ("26.8", "26.9", "26.89"):  # values between two steps of the arrow keys
        person.types("dimensions.side_pivot", f"{x}, 4")
    return f"{person.reads(ratio)} with the pivot at {person.field('dimensions.side_pivot').input_value()}"


# Points of the clamp [mm], its joints and loads: Hibbeler, Statics, 14th edition, problem 6-80.
_POINTS = {"A": "0 -40", "B": "0 0", "C": "20 20", "D": "40 54.641016", "E": "60 -40", "grip": "80 12"}
_PARTS: tuple[tuple[str, str, dict[str, str]], ...] = (
    ("pin", "pin.0", {"body": "arm", "at": "A"}),
    ("pin", "pin.1", {"body": "arm", "other": "handle", "at": "B"}),
    ("bar", "bar.0", {"body": "handle", "at": "C", "to": "D"}),
    ("force", "force.0", {"body": "handle", "at": "grip"}),
    ("force", "force.1", {"body": "arm", "at": "E", "direction": "90"}),
)


def build_a_clamp(person: Person) -> str:
    """A toggle clamp from nothing: bodies, points, joints and loads, then its stroke."""
    person.goes_to("Mechanism")
    person.presses("Start from nothing")
    person.types("bodies.0.name", "handle")
    person.presses("add body")
    person.types("bodies.1.name", "arm")
    person.presses("add point", len(_POINTS) - 2)
    person.types("points.F.name", "grip")
    for name, at in _POINTS.items():
        for axis, text in zip("xy", at.split(), strict=True):
            person.types(f"points.{name}.{axis}", text)
    for kind, path, cells in _PARTS:
        person.presses(f"add {kind}")
        for key, text in cells.items():
            (person.types if key == "direction" else person.chooses)(f"{path}.{key}", text)
    person.types("run.travel", "14")
    person.chooses("run.driver", "force 1")
    work = person.reads("force 2 at the end of the stroke")
    return f"force 2 is {work} at the end of the stroke; {person.sees('Statics:')}"


def choose_a_model(person: Person) -> str:
    """The cheapest model that keeps three digits for the harvester at 100 rad/s."""
    person.goes_to("Trade")
    person.types("trade.digits", "3")
    person.types("operation.speed", "100")
    return person.reads("cheapest, physics included")


def watch_the_resonance(person: Person) -> str:
    """The harvester's transient is played on the screen until it has passed the resonance."""
    person.goes_to("Transient")
    passes = person.reads("passes a resonance at")
    person.moves("time", "Home")
    person.presses("play time")
    passed = float(passes.split()[0])
    person.page.wait_for_function(
        "([wanted]) => [...document.querySelectorAll('.machine title')].some((it) => "
        "parseFloat(it.textContent.replace('At ', '')) > wanted)", arg=[passed]
    )  # fmt: skip
    person.presses("pause time")
    return f"at {passes}: {person.sees('the speed passes a resonance')}"


TASKS: dict[str, tuple[str, Callable[[Person], str]]] = {
    "slope": ("brakes", find_the_slope),
    "pivot": ("brakes", move_the_pivot),
    "clamp": ("brakes", build_a_clamp),
    "model": ("beamdyn", choose_a_model),
    "resonance": ("beamdyn", watch_the_resonance),
}


def perform(folder: Path, names: tuple[str, ...]) -> Iterator[Row]:
    """Perform tasks in the browser, and yield the result, number of actions and time of each."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        program, task = TASKS[name]
        process = start(port := free_port(), program)
        try:
            with browser() as made:
                person = Person(open_page(made.new_context(viewport=SIZE), port))
                begin = time.perf_counter()
                found = task(person)
                taken = time.perf_counter() - begin
                person.page.wait_for_timeout(4 * _SETTLES)
                person.page.screenshot(path=folder / f"{name}.png")
        finally:
            stop(process)
        yield f"{task.__doc__.split(':')[0].rstrip('.')}: {person.actions} actions, {taken:.0f} s", found, ""  # type: ignore[union-attr]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--folder", type=Path, default=Path("screenshots"))
    parser.add_argument("--task", choices=TASKS, action="append", help="may be repeated; all if not given")
    given = parser.parse_args()
    show("tasks", lambda: perform(given.folder, tuple(given.task or TASKS)))


if __name__ == "__main__":
    main()
