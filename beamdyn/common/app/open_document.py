"""A document that one client has open: its entries, the latest answers, mistakes, and which are stale."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from beamdyn.common.app.form_entries import Entries, by_field, tables_of, toml_of
from beamdyn.common.app.screens import Document, Screen
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.program import NoAnswer


@dataclass(frozen=True)
class Answered:
    """An answer, and the entries that it belongs to."""

    answer: Any
    entries: Entries


@dataclass
class OpenDocument:
    """A document that a client has open; each client has its own.

    Parameters
    ----------
    document : Document
        What it is.
    """

    document: Document
    entries: Entries = field(init=False)
    answered: dict[str, Answered] = field(init=False, default_factory=dict)
    mistakes: dict[str, dict[str, list[str]]] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.entries = dict(self.document.base_entries)

    @property
    def inputs(self) -> list[Input]:
        """Descriptions of the inputs."""
        return self.document.inputs(self.entries)

    def open(self, text: str, source: str) -> None:
        """Replace the design by the text of a file; on `ConfigError` nothing changes."""
        opened = self.document.opened(text, source)
        options = {path: self.entries[path] for path in self.document.aside}
        self.entries, self.mistakes = opened | options, {}

    def text(self) -> str:
        """The design as TOML, including entries with mistakes."""
        tables = tables_of(self.entries, self.inputs)
        return toml_of({name: value for name, value in tables.items() if name not in self.document.beside})

    def put(self, path: str, text: str) -> None:
        """Change one entry; entries of inputs that no longer exist are dropped."""
        changed = self.entries | {path: text}
        self.entries = {entry.path: changed.get(entry.path, "") for entry in self.document.inputs(changed)}

    def needed(self, screen: Screen) -> Entries:
        """The entries that a screen's answer follows from."""
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

    def solve(self, screen: Screen) -> bool:
        """Solve the present entries; on failure the last answer is kept, and `mistakes` says why."""
        entries, inputs = self.needed(screen), self.inputs
        self.mistakes[screen.name] = {}
        try:
            answer = screen.solve(tables_of(entries, inputs, screen.needs))
        except (ValueError, ArithmeticError, NoAnswer) as error:
            self.mistakes[screen.name] = by_field(error, inputs)
        else:
            self.answered[screen.name] = Answered(answer, entries)
            return True
        return False
