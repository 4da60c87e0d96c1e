"""A document that one client has open: its entries, the latest answers, mistakes, and what is stale."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.program import NoAnswer
from beamdyn.common.screens.comparison import OtherDesign
from beamdyn.common.screens.form_entries import Entries, by_field, tables_of, toml_of
from beamdyn.common.screens.history import History
from beamdyn.common.screens.screens import Document, KeyResult, Screen

if TYPE_CHECKING:
    from rich.console import RenderableType


_OPTION = re.compile(r"^# (\S+) = (.*)$", re.MULTILINE)  # in a file, as `OpenDocument.file` writes it


@dataclass(frozen=True)
class Answered:
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


@dataclass(frozen=True)
class OpenEntries:
    """Entries to be solved; it shares no mutable state, so that another thread may solve it.

    Parameters
    ----------
    screen : Screen
        The screen.
    entries : mapping
        The entries that its answer depends on.
    inputs : sequence of Input
        Descriptions of the inputs.
    """

    screen: Screen
    entries: Entries
    inputs: Sequence[Input] = field(compare=False)

    def solve(self) -> Answered | Mapping[str, list[str]]:
        """The whole answer, also what takes time, such as its model error; or what is wrong, by field."""
        try:
            answer = self.screen.solve(tables_of(self.entries, self.inputs, self.screen.needs))
            tables, notes = [*self.screen.tables(answer)], [*self.screen.notes(answer)]
            headline = [*self.screen.headline(answer)]
        except (ValueError, ArithmeticError, NoAnswer) as error:
            return by_field(error, self.inputs, self.entries)
        return Answered(answer, tables, notes, self.entries, headline)

    def glance(self) -> Answered | Mapping[str, list[str]]:
        """The answer as far as the drawing needs it, without tables and notes; or what is wrong, by field."""
        try:
            tables = tables_of(self.entries, self.inputs, self.screen.needs)
            answer = self.screen.solve(self.screen.coarser(tables))
            headline = [*(self.screen.quick_headline or self.screen.headline)(answer)]
        except (ValueError, ArithmeticError, NoAnswer) as error:
            return by_field(error, self.inputs, self.entries)
        return Answered(answer, (), (), self.entries, headline)


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
    answered: dict[str, Answered] = field(init=False, default_factory=dict)
    mistakes: dict[str, dict[str, list[str]]] = field(init=False, default_factory=dict)

    other: OtherDesign | None = field(init=False, default=None)
    compared: dict[str, Answered] = field(init=False, default_factory=dict)
    not_compared: dict[str, str] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.entries = dict(self.document.base_entries)
        self.history = History(self.entries)

    def compare(self, other: OtherDesign | None) -> None:
        """Compare with another design from now on, or with none."""
        self.other = other
        self.compared.clear()
        self.not_compared.clear()

    def wants_other(self, screen: Screen) -> bool:
        """Whether the other design has not been solved yet for a screen."""
        known = screen.name in self.compared or screen.name in self.not_compared
        return self.other is not None and not known

    def keep_other(self, screen: Screen, outcome: Answered | Mapping[str, list[str]]) -> None:
        """Keep the other design's answer, or why there is none."""
        if isinstance(outcome, Answered):
            self.compared[screen.name] = outcome
        else:
            sentences = [each for said in outcome.values() for each in said]
            self.not_compared[screen.name] = " ".join(sentences)

    def go(self, steps: int) -> bool:
        """Undo if `steps` is negative, redo if it is positive; say whether there was such a step."""
        entries = self.history.go(steps)
        if entries is None:
            return False
        self._take(entries)
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
        self._take({path: str(text) for path, text in entries.items()})
        self.mistakes = {}
        self.history.part()

    def recall(self, stored: Mapping[str, object]) -> bool:
        """Take up entries from an earlier page, but for those changed since; say whether any differed."""
        base = self.document.base_entries
        changed = {path: text for path, text in self.entries.items() if base.get(path) != text}
        before = self.entries
        self._take({path: str(text) for path, text in stored.items()} | changed)
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
        self._take(self.entries | {path: text})

    def _take(self, entries: Entries) -> None:
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

    def attempt(self, screen: Screen) -> OpenEntries:
        """The present entries, to be solved."""
        return OpenEntries(screen, self.needed(screen), self.inputs)

    def keep(self, screen: Screen, outcome: Answered | Mapping[str, list[str]]) -> bool:
        """Keep an answer; or keep the last one and say in `mistakes` why there is no other."""
        found = isinstance(outcome, Answered)
        if found:
            self.answered[screen.name] = outcome
        self.mistakes[screen.name] = {} if found else dict(outcome)
        return found

    def solve(self, screen: Screen) -> bool:
        """Solve the present entries; on failure the last answer is kept, and `mistakes` says why."""
        return self.keep(screen, self.attempt(screen).solve())
