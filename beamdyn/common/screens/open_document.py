"""An input file that is open on a page: its field texts and their history, its results, and errors."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from functools import partial
from time import monotonic, perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.file_words import on_form
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.toml_text import toml_of
from beamdyn.common.results.one_line import few_digits
from beamdyn.common.screens.form_entries import Entries, by_field, heading_of, tables_of
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.common.screens.screens import Document, Screen

if TYPE_CHECKING:
    from rich.console import RenderableType


_MOST = 200  # largest number of earlier states of a design that undo can restore
_TOGETHER = 1.0  # time within which changes of the same fields are one step of undo [s]


class History:
    """The states that a design has had, for undo and redo, and the state that is shown.

    Parameters
    ----------
    first : mapping
        The field texts at first.
    """

    def __init__(self, first: Entries) -> None:
        self._states, self._place = [dict(first)], 0
        self._changed: frozenset[str] = frozenset()
        self._when = -1.0  # time of the last change [s]

    def record(self, entries: Mapping[str, str], now: float | None = None) -> None:
        """Add a state if it differs from the one shown, and discard the states after that one.

        Changes of the same fields in quick succession, such as typing into a field, are one step.

        Parameters
        ----------
        entries : mapping
            The field texts of the new state.
        now : float, optional
            Time of the change [s]; the present time if not given.
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
        """Make the next change a separate step of undo, however soon it comes."""
        self._changed = frozenset()

    def go(self, steps: int) -> Entries | None:
        """Go a number of steps forward, or back if negative; return the state there.

        If there is no such state, return None and stay.
        """
        if not 0 <= self._place + steps < len(self._states):
            return None
        self._place += steps
        self.part()
        return dict(self._states[self._place])

    @property
    def can_undo(self) -> bool:
        """Return whether there is an earlier state."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Return whether there is a later state."""
        return self._place + 1 < len(self._states)


def differing(one: Mapping[str, str], other: Mapping[str, str]) -> frozenset[str]:
    """Return the paths of field texts that differ; an empty text equals a missing one."""
    return frozenset(path for path in {*one, *other} if one.get(path, "") != other.get(path, ""))


# Pattern of an option in the comment at the start of a file written by `OpenDocument.file`.
_OPTION = re.compile(r"^# (\S+) = (.*)$", re.MULTILINE)


@dataclass(frozen=True)
class ShownAnswer:
    """A result, with the tables, notes and picture that a screen shows.

    Parameters
    ----------
    answer : object
        The result.
    tables : sequence of rich renderables
        Tables and sentences.
    notes : sequence of str
        Warnings and error messages, a sentence each.
    entries : dict
        The field texts for which the result was computed.
    headline : sequence of KeyResult
        The most important results.
    rest : float
        Computing time of everything except the drawing [s].
    is_whole : bool
        Whether tables and notes belong to this result; if not, they are made later.
    is_rough : bool
        Whether the result is preliminary: computed only for the drawing, by `Screen.coarser`.
    picture : str
        Picture in HTML, which is made together with a preliminary result; empty if there is none.
    """

    answer: Any
    tables: Sequence[RenderableType]
    notes: Sequence[str]
    entries: Entries
    headline: Sequence[KeyResult] = ()
    rest: float = 0.0
    is_whole: bool = True
    is_rough: bool = False
    picture: str = ""


Outcome = ShownAnswer | Mapping[str, list[str]]  # a result, or error messages by field


class OtherDesign(NamedTuple):
    """The design with which the open design is compared: its name and field texts."""

    name: str
    entries: Entries


@dataclass
class OpenDocument:
    """An input file that is open on the page of one client; clients do not share it.

    Parameters
    ----------
    document : Document
        The kind of file, and the screens for it.
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
        """Compare the open design with another design; None ends the comparison."""
        self.other = other
        self.compared.clear()

    def wants_other(self, screen: Screen) -> bool:
        """Return whether the compared design still has to be computed for a screen."""
        return self.other is not None and screen.name not in self.compared

    def other_answer(self, screen: Screen) -> ShownAnswer | None:
        """Return the result of the compared design; None if there is none."""
        found = self.compared.get(screen.name)
        return found if isinstance(found, ShownAnswer) else None

    def go(self, steps: int) -> bool:
        """Undo if `steps` is negative, redo if it is positive; return whether there was such a step."""
        entries = self.history.go(steps)
        if entries is None:
            return False
        self._replace_entries(entries)
        return True

    @property
    def inputs(self) -> list[Input]:
        """Return the descriptions of the inputs that exist for the present field texts."""
        return self.document.inputs(self.entries)

    @property
    def idle(self) -> set[str]:
        """Return the paths of inputs that are not given, and have no effect for the present field texts."""
        return {path for path in self.document.idle(self.entries) if not self.entries.get(path, "").strip()}

    def open(self, text: str, source: str) -> None:
        """Replace the design by the text of a file; if this raises `ConfigError`, nothing changes."""
        opened = self.document.opened(text, source)
        kept = dict(_OPTION.findall(text))
        options = {path: kept.get(path, self.entries[path]) for path in self.document.aside}
        self.entries, self.mistakes = opened | options, {}
        self.history.part()

    def show(self, entries: Mapping[str, str]) -> None:
        """Replace the design by stored field texts."""
        self._replace_entries({path: str(text) for path, text in entries.items()})
        self.mistakes = {}
        self.history.part()

    def recall(self, stored: Mapping[str, object]) -> bool:
        """Restore stored texts, but keep those that the user has changed; return whether any text changed."""
        base = self.document.base_entries
        changed = {path: text for path, text in self.entries.items() if base.get(path) != text}
        before = self.entries
        self._replace_entries({path: str(text) for path, text in stored.items()} | changed)
        return self.entries != before

    def text(self) -> str:
        """Return the design as TOML, including invalid texts."""
        tables = tables_of(self.entries, self.inputs)
        return toml_of({name: value for name, value in tables.items() if name not in self.document.beside})

    def file(self) -> str:
        """Return the design as the text of a TOML file.

        Options of the screens, which are not part of the design, are in comments, from which `open` restores
        them.
        """
        options = "".join(f"# {path} = {self.entries[path]}\n" for path in self.document.aside)
        return "\n".join(filter(None, (options, self.text())))

    def put(self, path: str, text: str) -> None:
        """Change the text of one field; drop the texts of inputs that this change removes from the form."""
        self._replace_entries(self.entries | {path: text})

    def _replace_entries(self, entries: Entries) -> None:
        """Replace the field texts; ignore texts whose path is not the path of an input."""
        self.entries = {entry.path: entries.get(entry.path, "") for entry in self.document.inputs(entries)}

    def needed(self, screen: Screen) -> Entries:
        """Return the field texts on which the result of a screen depends."""
        return {
            path: text.strip()
            for path, text in self.entries.items()
            if text.strip() and path.partition(".")[0] in screen.needs
        }

    def stale(self, screen: Screen) -> bool:
        """Return whether a screen lacks a complete result for the present field texts."""
        return not self.drawn(screen) or not self.answered[screen.name].is_whole

    def drawn(self, screen: Screen) -> bool:
        """Return whether a screen has a complete or preliminary result for the present field texts."""
        last = self.answered.get(screen.name)
        return last is not None and last.entries == self.needed(screen)

    def outdated(self, screen: Screen) -> bool:
        """Return whether the result of a screen is for earlier field texts."""
        return screen.name in self.answered and self.stale(screen)

    def attempt(self, screen: Screen, for_drawing: bool = False, drawn: ShownAnswer | None = None) -> Outcome:
        """Compute a screen's result for the present field texts, without storing the result or errors.

        Parameters
        ----------
        screen : Screen
            The screen to compute.
        for_drawing : bool
            Whether to compute only what the drawing needs, without tables and notes; otherwise everything is
            computed, including slow parts such as the model error.
        drawn : ShownAnswer, optional
            Preliminary result for the same field texts, which is completed.
        """
        entries, inputs = self.needed(screen), self.inputs
        with on_form(partial(heading_of, headings=self.document.headings)):
            try:
                return self._answer(screen, for_drawing, drawn)
            except (ValueError, ArithmeticError, NoAnswer) as error:
                if for_drawing:  # the preliminary computation may fail although the full one succeeds
                    return self.attempt(screen)
                return by_field(error, inputs, entries)

    def _answer(self, screen: Screen, for_drawing: bool, drawn: ShownAnswer | None) -> ShownAnswer:
        entries, start = self.needed(screen), perf_counter()
        tables = tables_of(entries, self.inputs, screen.needs)
        coarse = screen.coarser(tables)
        if for_drawing:
            answer, is_rough = screen.solve(coarse), coarse is not tables
            with few_digits() if is_rough else nullcontext():
                headline = [*(screen.quick_headline or screen.headline)(answer)]
            return ShownAnswer(answer, (), (), entries, headline, 0.0, False, is_rough)
        answer = screen.solve(tables) if drawn is None or drawn.is_rough else drawn.answer
        start = perf_counter() if coarse is tables else start
        shown, notes, headline = [*screen.tables(answer)], [*screen.notes(answer)], [*screen.headline(answer)]
        return ShownAnswer(answer, shown, notes, entries, headline, perf_counter() - start)

    def keep(self, screen: Screen, outcome: Outcome) -> bool:
        """Store the outcome of a computation: a result, or errors; return whether it is a result.

        Errors are stored in addition to the last result, which remains.
        """
        found = isinstance(outcome, ShownAnswer)
        if found:
            self.answered[screen.name] = outcome
        self.mistakes[screen.name] = {} if found else dict(outcome)
        return found

    def solve(self, screen: Screen) -> bool:
        """Compute the result for the present field texts, and store the result or, if it fails, the errors.

        Return whether the computation gave a result.
        """
        return self.keep(screen, self.attempt(screen))
