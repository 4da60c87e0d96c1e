"""Editors for lists of named items: buttons add and remove items, selection lists refer to other items."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import takewhile
from typing import Any

from nicegui import ui

from beamdyn.common.screens.lists import Cell, Entries, Item, ListGroup, Lists, gone_with
from beamdyn.common.screens.page_writer import PageWriter

Put = Callable[[Item, str, str], object]  # a function of an item, the key of a value, and the new text

_READ = 10_000  # time for which a notification is shown [ms]


class ItemRow:
    """The row of an item: its fields, and a button that removes the item.

    A row is reused for another item with the same fields, since a new field would lose the keyboard focus,
    and a new button would miss a click.

    Parameters
    ----------
    item : Item
        The item that is shown at first.
    put : callable
        Called with item, key and new text when the user has typed or chosen a text.
    remove : callable, optional
        Called with the item when the user removes it; None if it cannot be removed.
    """

    def __init__(self, item: Item, put: Put, remove: Callable[[Item], object] | None) -> None:
        self._item, self._put, self._remove = item, put, remove
        self._fields: dict[str, Any] = {}
        self._name: Any = None
        self._bin: Any = None
        short = len(item.cells) <= 3
        self._row: Any = ui.element("div").classes("listed" if short else "listed-part")
        with self._row:
            if not short:
                with ui.row().classes("w-full items-center no-wrap justify-between"):
                    self._name = ui.label().classes("text-weight-medium")
                    self._make_bin()
            with contextlib.nullcontext() if short else ui.element("div").classes("cells"):
                for cell in item.cells:
                    self._make_field(cell)
            if short:
                self._make_bin()
        self._say_names()

    def _make_bin(self) -> None:
        if (remove := self._remove) is not None:
            self._bin = ui.button(icon="delete", on_click=lambda: remove(self._item))
            self._bin.props("flat dense round size=sm")

    def _make_field(self, cell: Cell) -> None:
        """Make the field of a value: a selection list of its options, or a text field if it has no options.

        A text field is read when the user leaves it.
        """

        def text() -> str:
            return next(each.text for each in self._item.cells if each.key == cell.key)

        def typed() -> None:
            if (now := made.value or "") != text():
                self._put(self._item, cell.key, now)
            if not cell.options:
                made.set_value(text())  # a text that is not accepted is replaced by the previous one

        made: Any
        if cell.options:
            made = ui.select(_options(cell), value=_chosen(cell), label=cell.label, on_change=typed)
        else:
            made = ui.input(cell.label, value=cell.text, placeholder=cell.usual)
            made.props("autocomplete=off spellcheck=false").on("blur", typed).on("keydown.enter", typed)
        made.props("dense outlined stack-label hide-hint hide-bottom-space")
        made.props["title"] = made.props["hint"] = cell.hint or cell.label
        self._fields[cell.key] = made

    def _say_names(self) -> None:
        for key, field in self._fields.items():
            field.props["data-path"] = f"{self._item.id}.{key}"
            field.update()
        if self._name is not None:
            self._name.set_text(self._item.name)
        if self._bin is not None:
            self._bin.props["aria-label"] = self._bin.props["title"] = f"remove {self._item.name}"
            self._bin.update()

    @property
    def texts(self) -> list[Any]:
        """Return the fields into which the user types text."""
        return [self._fields[cell.key] for cell in self._item.cells if not cell.options]

    def fits(self, item: Item) -> bool:
        """Return whether the row's fields suit an item: same keys, same labels, same kinds of fields."""
        kinds = ([(c.key, c.label, bool(c.options)) for c in each.cells] for each in (self._item, item))
        return next(kinds) == next(kinds)

    def show(self, item: Item) -> None:
        """Show another item; a field whose text does not change keeps unfinished typing."""
        before, self._item = self._item, item
        for old, cell in zip(before.cells, item.cells, strict=True):
            field = self._fields[cell.key]
            if cell.options and cell.options != old.options:
                field.set_options(_options(cell), value=_chosen(cell))
            elif cell.text != old.text:
                field.set_value(_chosen(cell) if cell.options else cell.text)
        if (before.id, before.name) != (item.id, item.name):
            self._say_names()

    def delete(self) -> None:
        """Remove the row from the page."""
        self._row.delete()


def _options(cell: Cell) -> dict[str, str]:
    return {option: option or cell.usual or "not given" for option in cell.options}


def _chosen(cell: Cell) -> str | None:
    return cell.text if cell.text in cell.options else None


class GroupRows:
    """The rows of a group of items, and buttons that add an item.

    Parameters
    ----------
    group : ListGroup
        The group.
    put : callable
        Called with item, key and new text when a value changes.
    add : callable
        Called with the kind of item to add.
    remove : callable
        Called with the item to remove.
    """

    def __init__(
        self, group: ListGroup, put: Put, add: Callable[[str], object], remove: Callable[[Item], object]
    ) -> None:
        self._put, self._remove = put, remove if group.kinds else None
        self.rows: list[ItemRow] = []
        with ui.expansion(group.heading, value=True).classes("w-full section").props("dense"):
            ui.label(group.about).classes("status")
            self._place: Any = ui.column().classes("w-full rows")
            with ui.row().classes("gap-1"):
                for kind, words in group.kinds.items():
                    button = ui.button(words, icon="add", on_click=partial(add, kind))
                    button.props(f'outline dense no-caps size=sm aria-label="add {words}"')
        self.show(group.items)

    def show(self, items: Sequence[Item]) -> None:
        """Show the given items; reuse rows whose fields suit them."""
        pairs = zip(self.rows, items, strict=False)
        kept = [*takewhile(lambda pair: pair[0].fits(pair[1]), pairs)]
        for row in self.rows[len(kept) :]:
            row.delete()
        for row, item in kept:
            row.show(item)
        with self._place:
            new = [ItemRow(item, self._put, self._remove) for item in items[len(kept) :]]
        self.rows = [*self.rows[: len(kept)], *new]


class ListEditor:
    """The editor for all lists of a screen.

    Parameters
    ----------
    lists : Lists
        The lists.
    now : callable
        Returns the texts of all fields, including those outside the lists.
    changed : callable
        Called with the texts of all fields after a change.
    writer : PageWriter
        Object that updates the fields while a handle or slider is held.
    """

    def __init__(
        self,
        lists: Lists,
        now: Callable[[], Entries],
        changed: Callable[[Entries], object],
        writer: PageWriter,
    ) -> None:
        self._lists, self._now, self._changed, self._writer = lists, now, changed, writer

        def empty() -> None:
            self._replace_entries(lists.empty(now()))

        def put(item: Item, key: str, text: str) -> None:
            self._replace_entries(lists.put(now(), item, key, text))

        def add(kind: str) -> None:
            self._replace_entries(lists.add(now(), kind))

        with ui.column().classes("lists w-full gap-1"):
            ui.button("Start from nothing", icon="note_add", on_click=empty).props("flat dense no-caps")
            self._said: Any = ui.column().classes("advice gap-1").props('role="status" aria-live="polite"')
            with ui.column().classes("w-full gap-1"):
                self._groups = [GroupRows(each, put, add, self._remove) for each in lists.groups(now())]
        self._advise(now())

    def show(self, entries: Mapping[str, str]) -> None:
        """Show the field texts in the lists, and say which items are missing."""
        self.follow(entries)
        self._advise(entries)

    def follow(self, entries: Mapping[str, str]) -> None:
        """Show the field texts in the lists; do not change the advice on missing items."""
        rows = [row for group in self._groups for row in group.rows]
        with self._writer.writing(*(field for row in rows for field in row.texts)):
            for shown, group in zip(self._groups, self._lists.groups(entries), strict=True):
                shown.show(group.items)

    def _advise(self, entries: Mapping[str, str]) -> None:
        sentences = self._lists.advice(entries)
        self._said.clear()
        with self._said:
            for sentence in sentences:
                ui.label(sentence)

    def _remove(self, item: Item) -> None:
        before, left = self._now(), self._lists.remove(self._now(), item)
        self._replace_entries(left)
        if gone := gone_with(item, self._lists.groups(before), self._lists.groups(left)):
            said = f"Removed along with {item.name}: {', '.join(gone)}. Undo brings all back."
            ui.notify(said, timeout=_READ, close_button="Close")

    def _replace_entries(self, entries: Entries) -> None:
        if entries != self._now():
            self.show(entries)
            self._changed(entries)
