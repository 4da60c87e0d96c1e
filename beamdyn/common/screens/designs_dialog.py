"""The dialog of named designs and examples: keep, open, compare, delete."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from nicegui import ui

from beamdyn.common.screens.examples import Example
from beamdyn.common.screens.form_entries import Entries

Designs = Mapping[str, tuple[str, Entries]]


@dataclass(frozen=True)
class DesignActions:
    """What can be done with designs.

    Parameters
    ----------
    keep : callable
        ``keep(name)`` stores the open design under a name; returns "", or why it cannot.
    open, compare : callable
        Called with name, document and entries of a design.
    delete : callable
        Called with the name of a design.
    """

    keep: Callable[[str], Any]
    open: Callable[[str, str, Entries], object]
    compare: Callable[[str, str, Entries], object]
    delete: Callable[[str], Any]


class DesignsDialog:
    """A dialog that lists designs.

    Parameters
    ----------
    do : DesignActions
        Actions of its buttons.
    """

    def __init__(self, do: DesignActions) -> None:
        self._do = do
        with ui.dialog() as self._dialog, ui.card().classes("designs"):
            ui.html("Designs", tag="h2", sanitize=False)
            with ui.row().classes("items-center w-full no-wrap"):
                self._name: Any = ui.input("name for this design").classes("grow").props("dense outlined")
                ui.button("Keep", on_click=self._keep).props("no-caps")
            self._said: Any = ui.label().classes("mistake").props('role="alert"')
            self._list: Any = ui.column().classes("w-full gap-0")
            ui.button("Close", on_click=self._dialog.close).props("flat no-caps")

    def show(self, kept: Designs, examples: Sequence[Example], document: str) -> None:
        """Open the dialog; only designs of the document in front can be compared."""
        self._said.set_text("")
        self._list.clear()
        with self._list:
            ui.html("Kept in this browser", tag="h3", sanitize=False)
            if not kept:
                ui.label("None yet.").classes("status")
            for name, (kind, entries) in kept.items():
                self._row(name, kind, lambda entries=entries: entries, kind == document, deletes=True)
            ui.html("Examples", tag="h3", sanitize=False)
            for example in examples:
                kind = example.document.name
                opened = partial(example.document.opened, example.text, example.name)
                self._row(example.title, kind, opened, kind == document)
        self._dialog.open()

    def _row(
        self,
        name: str,
        kind: str,
        entries: Callable[[], Entries],
        comparable: bool,
        deletes: bool = False,
    ) -> None:
        with ui.row().classes("items-center w-full no-wrap design"):
            with ui.column().classes("grow gap-0"):
                ui.label(name)
                ui.label(kind).classes("status")
            self._button("Open", name, lambda: self._do.open(name, kind, entries()))
            if comparable:
                self._button("Compare", name, lambda: self._do.compare(name, kind, entries()))
            if deletes:
                self._button("Delete", name, partial(self._delete, name), closes=False)

    def _button(self, word: str, name: str, act: Callable[[], object], closes: bool = True) -> None:
        async def run() -> None:
            if closes:
                self._dialog.close()
            if hasattr(made := act(), "__await__"):
                await made  # type: ignore[misc]

        button = ui.button(word, on_click=run).props("flat dense no-caps")
        button.props["aria-label"] = f"{word} {name}"

    async def _keep(self) -> None:
        self._said.set_text(await self._do.keep(self._name.value or ""))

    async def _delete(self, name: str) -> None:
        await self._do.delete(name)
