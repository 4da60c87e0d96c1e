"""One person's designs and what is shown of them: entries, last good answers, mistakes, what is stale."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from beamdyn.common.app.form_entries import Entries, by_field, tables_of, toml_of
from beamdyn.common.app.screens import Document, Screen
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.program import NoAnswer


@dataclass(frozen=True)
class Answered:
    """A good answer, and the entries that it follows from."""

    answer: Any
    entries: Entries


@dataclass
class OpenDocument:
    """A document that is worked on: a state, which each client has for itself.

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
        """Put the text of a file in place of the design; raises `ConfigError`, and then nothing changes."""
        opened = self.document.opened(text, source)
        asked = {path: self.entries[path] for path in self.document.aside}
        self.entries, self.mistakes = opened | asked, {}

    def text(self) -> str:
        """The design as a TOML file, mistakes and all."""
        tables = tables_of(self.entries, self.inputs)
        return toml_of({name: value for name, value in tables.items() if name not in self.document.beside})

    def put(self, path: str, text: str) -> None:
        """Change one entry; where that changes which inputs there are, those that are gone are forgotten."""
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
        """Whether the answer shown is no longer that of the entries."""
        last = self.answered.get(screen.name)
        return last is None or last.entries != self.needed(screen)

    def outdated(self, screen: Screen) -> bool:
        """Whether there is an answer, but to other entries."""
        return screen.name in self.answered and self.stale(screen)

    def solve(self, screen: Screen) -> bool:
        """Answer anew; if that fails the last good answer stays, and `mistakes` says why."""
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
