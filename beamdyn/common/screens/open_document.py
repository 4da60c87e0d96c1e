"""A document that one client has open: its entries and their history, latest answers, and mistakes."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from time import monotonic
from typing import TYPE_CHECKING, Any, NamedTuple

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.file_words import on_form
from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens.form_entries import Entries, by_field, heading_of, tables_of, toml_of
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.common.screens.screens import Document, Screen

if TYPE_CHECKING:
    from rich.console import RenderableType


_MOST = 200  # states that are kept
_TOGETHER = 1.0  # time within which changes of the same fields are one step [s]


class History:
    """The states that a design has had, and which of them is shown.

    Parameters
    ----------
    first : mapping
        The entries at first.
    """

    def __init__(self, first: Entries) -> None:
        self._states, self._place = [dict(first)], 0
        self._changed: frozenset[str] = frozenset()
        self._when = -1.0  # of the last change [s]

    def record(self, entries: Mapping[str, str], now: float | None = None) -> None:
        """Add a state, if it differs from the one shown; states after that are forgotten.

        Changes of the same fields in quick succession, as of a field that is typed into, are one step.

        Parameters
        ----------
        entries : mapping
            The state.
        now : float, optional
            Time of the change [s]; now if not given.
        """
        changed = differing(self._states[self._place], entries)
        if not changed:
            return
        when = monotonic() if now is None else now
        if changed == self._changed and when - self._when < _TOGETHER:
            del self._states[self._place :]
            self._place -= 1
            if not differing(self._states[self._place], entries):
                return
        self._changed, self._when = changed, when
        self._states = [*self._states[: self._place + 1], dict(entries)][-_MOST:]
        self._place = len(self._states) - 1

    def part(self) -> None:
        """Make the next change a step of its own, however soon it comes."""
        self._changed = frozenset()

    def go(self, steps: int) -> Entries | None:
        """Go so many steps forward, or back if negative; return that state, None if there is none."""
        if not 0 <= self._place + steps < len(self._states):
            return None
        self._place += steps
        self.part()
        return dict(self._states[self._place])

    @property
    def can_undo(self) -> bool:
        """Whether there is a state before."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a state after."""
        return self._place + 1 < len(self._states)


def differing(one: Mapping[str, str], other: Mapping[str, str]) -> frozenset[str]:
    """Paths of the entries that differ; an empty entry counts as one that is missing."""
    return frozenset(path for path in {*one, *other} if one.get(path, "") != other.get(path, ""))


_OPTION = re.compile(r"^# (\S+) = (.*)$", re.MULTILINE)  # in a file, as `OpenDocument.file` writes it


@dataclass(frozen=True)
class ShownAnswer:
    """An answer and what a screen shows of it.

    Parameters
    ----------
    answer : object
        The answer.
    tables : sequence of rich renderables
        Tables and sentences.
    notes : sequence of str
        Warnings and refusals, a sentence each.
    entries : dict
        The entries that were solved.
    headline : sequence of KeyResult
        The most important results.
    """

    answer: Any
    tables: Sequence[RenderableType]
    notes: Sequence[str]
    entries: Entries
    headline: Sequence[KeyResult] = ()


Outcome = ShownAnswer | Mapping[str, list[str]]  # an answer, or what is wrong, by field


class OtherDesign(NamedTuple):
    """A design that the open one is compared with: its name and entries."""

    name: str
    entries: Entries


@dataclass
class OpenDocument:
    """A document that a client has open; each client has its own.

    Parameters
    ----------
    document : Document
        The kind of document.
    """

    document: Document
    entries: Entries = field(init=False)
    answered: dict[str, ShownAnswer] = field(init=False, default_factory=dict)
    mistakes: dict[str, dict[str, list[str]]] = field(init=False, default_factory=dict)
    other: OtherDesign | None = field(init=False, default=None)
    compared: dict[str, Outcome] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.entries = dict(self.document.base_entries)
        self.history = History(self.entries)

    def compare(self, other: OtherDesign | None) -> None:
        """Compare with another design from now on, or with none."""
        self.other = other
        self.compared.clear()

    def wants_other(self, screen: Screen) -> bool:
        """Whether the other design has not been solved yet for a screen."""
        return self.other is not None and screen.name not in self.compared

    def other_answer(self, screen: Screen) -> ShownAnswer | None:
        """The answer to the other design, if it has one."""
        found = self.compared.get(screen.name)
        return found if isinstance(found, ShownAnswer) else None

    def go(self, steps: int) -> bool:
        """Undo if `steps` is negative, redo if it is positive; say whether there was such a step."""
        entries = self.history.go(steps)
        if entries is None:
            return False
        self._replace_entries(entries)
        return True

    @property
    def inputs(self) -> list[Input]:
        """Descriptions of the inputs."""
        return self.document.inputs(self.entries)

    @property
    def idle(self) -> set[str]:
        """Paths of inputs that have no effect beside the others, and are not given."""
        return {path for path in self.document.idle(self.entries) if not self.entries.get(path, "").strip()}

    def open(self, text: str, source: str) -> None:
        """Replace the design by the text of a file; on `ConfigError` nothing changes."""
        opened = self.document.opened(text, source)
        kept = dict(_OPTION.findall(text))
        options = {path: kept.get(path, self.entries[path]) for path in self.document.aside}
        self.entries, self.mistakes = opened | options, {}
        self.history.part()

    def show(self, entries: Mapping[str, str]) -> None:
        """Replace the design by entries that were kept earlier."""
        self._replace_entries({path: str(text) for path, text in entries.items()})
        self.mistakes = {}
        self.history.part()

    def recall(self, stored: Mapping[str, object]) -> bool:
        """Take up entries from an earlier page, but for those changed since; say whether any differed."""
        base = self.document.base_entries
        changed = {path: text for path, text in self.entries.items() if base.get(path) != text}
        before = self.entries
        self._replace_entries({path: str(text) for path, text in stored.items()} | changed)
        return self.entries != before

    def text(self) -> str:
        """The design as TOML, including entries with mistakes."""
        tables = tables_of(self.entries, self.inputs)
        return toml_of({name: value for name, value in tables.items() if name not in self.document.beside})

    def file(self) -> str:
        """The design as a TOML file, below comments with the options of the screens, which `open` reads."""
        options = "".join(f"# {path} = {self.entries[path]}\n" for path in self.document.aside)
        return "\n".join(filter(None, (options, self.text())))

    def put(self, path: str, text: str) -> None:
        """Change one entry; entries of inputs that no longer exist are dropped."""
        self._replace_entries(self.entries | {path: text})

    def _replace_entries(self, entries: Entries) -> None:
        """Replace the entries by these, as far as there are inputs for them."""
        self.entries = {entry.path: entries.get(entry.path, "") for entry in self.document.inputs(entries)}

    def needed(self, screen: Screen) -> Entries:
        """The entries that a screen's answer depends on."""
        return {
            path: text.strip()
            for path, text in self.entries.items()
            if text.strip() and path.partition(".")[0] in screen.needs
        }

    def stale(self, screen: Screen) -> bool:
        """Whether there is no answer to the present entries."""
        last = self.answered.get(screen.name)
        return last is None or last.entries != self.needed(screen)

    def outdated(self, screen: Screen) -> bool:
        """Whether there is an answer, but to earlier entries."""
        return screen.name in self.answered and self.stale(screen)

    def attempt(self, screen: Screen, for_drawing: bool = False) -> Outcome:
        """Solve the present entries, but keep neither the answer nor what is wrong.

        Parameters
        ----------
        screen : Screen
            The screen.
        for_drawing : bool
            Whether to solve as far as the drawing needs it, without tables and notes; else all, also what
            takes time, such as the model error.
        """
        entries, inputs = self.needed(screen), self.inputs
        with on_form(partial(heading_of, headings=self.document.headings)):
            try:
                return self._answer(screen, for_drawing)
            except (ValueError, ArithmeticError, NoAnswer) as error:
                return by_field(error, inputs, entries)

    def _answer(self, screen: Screen, for_drawing: bool) -> ShownAnswer:
        entries = self.needed(screen)
        tables = tables_of(entries, self.inputs, screen.needs)
        if for_drawing:
            answer = screen.solve(screen.coarser(tables))
            headline = (screen.quick_headline or screen.headline)(answer)
            return ShownAnswer(answer, (), (), entries, [*headline])
        answer = screen.solve(tables)
        shown, notes = [*screen.tables(answer)], [*screen.notes(answer)]
        return ShownAnswer(answer, shown, notes, entries, [*screen.headline(answer)])

    def keep(self, screen: Screen, outcome: Outcome) -> bool:
        """Keep an answer; or keep the last one and say in `mistakes` why there is no other."""
        found = isinstance(outcome, ShownAnswer)
        if found:
            self.answered[screen.name] = outcome
        self.mistakes[screen.name] = {} if found else dict(outcome)
        return found

    def solve(self, screen: Screen) -> bool:
        """Solve the present entries; on failure the last answer is kept, and `mistakes` says why."""
        return self.keep(screen, self.attempt(screen))
