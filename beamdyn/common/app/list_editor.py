"""Lists of named things on the page: added and removed by buttons, joined by choosing names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from nicegui import ui

from beamdyn.common.app.brush import Brush
from beamdyn.common.app.lists import Cell, Entries, Item, ListGroup, Lists

STYLE = """
.listed { display: flex; gap: 4px; align-items: start; width: 100%; }
.listed > .q-field { flex: 1 1 0; min-width: 0; }
.listed-part { border-left: 3px solid #0072B2; padding-left: 6px; width: 100%; }
.listed-part .cells { display: grid; grid-template-columns: 1fr 1fr; gap: 4px 6px; }
.left .lists .nicegui-expansion-content { display: flex; flex-direction: column; gap: 6px; }
.advice { border-left: 4px solid #0072B2; padding-left: 0.5rem; width: 100%; }
.advice:empty { display: none; }
"""


class ListEditor:
    """The lists of a screen.

    Parameters
    ----------
    lists : Lists
        What they are.
    entries : mapping
        What stands in them at first.
    changed : callable
        Called with all entries after a change.
    brush : Brush
        What writes into the fields while something is held.
    """

    def __init__(
        self,
        lists: Lists,
        entries: Mapping[str, str],
        changed: Callable[[Entries], object],
        brush: Brush,
    ) -> None:
        self._lists, self._entries, self._changed, self._brush = lists, dict(entries), changed, brush
        self._fields: dict[tuple[str, str], Any] = {}
        self._folded: set[str] = set()
        self._quiet = False
        with ui.column().classes("lists w-full gap-1"):
            ui.button("Start from nothing", icon="note_add", on_click=self._empty).props("flat dense no-caps")
            self._said: Any = ui.column().classes("advice gap-1").props('role="status" aria-live="polite"')
            self._groups: Any = ui.column().classes("w-full gap-1")
        self._make()
        self._advise()

    def show(self, entries: Mapping[str, str]) -> None:
        """Make other entries stand in the lists, and say what is missing."""
        self.follow(entries)
        self._advise()

    def follow(self, entries: Mapping[str, str]) -> None:
        """Make other entries stand in the lists, which are made again only if their things are others."""
        self._entries = dict(entries)
        cells = {
            (item.id, cell.key): cell
            for group in self._lists.groups(entries)
            for item in group.items
            for cell in item.cells
        }
        if {place: _kind(cell) for place, cell in cells.items()} != self._kinds:
            return self._make()
        others = {self._fields[place]: cell.text for place, cell in cells.items()}
        others = {field: text for field, text in others.items() if field.value != text}
        self._quiet = True
        with self._brush.stroke(*others):
            for field, text in others.items():
                field.set_value(text)
        self._quiet = False

    def _make(self) -> None:
        self._fields, self._kinds = {}, {}
        self._groups.clear()
        with self._groups:
            for group in self._lists.groups(self._entries):
                self._group(group)

    def _advise(self) -> None:
        sentences = self._lists.advice(self._entries)
        self._said.clear()
        with self._said:
            for sentence in sentences:
                ui.label(sentence)

    def _group(self, group: ListGroup) -> None:
        fold = ui.expansion(group.heading, value=group.heading not in self._folded)
        fold.on_value_change(lambda e: self._fold(group.heading, e.value))
        with fold.classes("w-full section").props("dense"):
            ui.label(group.about).classes("status")
            for item in group.items:
                self._item(group, item)
            with ui.row().classes("gap-1"):
                for kind, words in group.kinds.items():
                    ui.button(words, icon="add", on_click=partial(self._add, kind)).props(
                        f'outline dense no-caps size=sm aria-label="add {words}"'
                    )

    def _fold(self, heading: str, is_open: bool) -> None:
        if is_open:
            self._folded.discard(heading)
        else:
            self._folded.add(heading)

    def _item(self, group: ListGroup, item: Item) -> None:
        short = len(item.cells) <= 3
        with ui.element("div").classes("listed" if short else "listed-part"):
            if short:
                self._cells(item)
                if group.kinds:
                    self._bin(item)
                return
            with ui.row().classes("w-full items-center no-wrap justify-between"):
                ui.label(item.name).classes("text-weight-medium")
                self._bin(item)
            with ui.element("div").classes("cells"):
                self._cells(item)

    def _cells(self, item: Item) -> None:
        for cell in item.cells:
            made = self._select(item, cell) if cell.options else self._input(item, cell)
            made.props(
                f'dense outlined stack-label hide-hint hide-bottom-space data-path="{item.id}.{cell.key}"'
            )
            made.props["title"] = made.props["hint"] = cell.hint or cell.label
            self._fields[item.id, cell.key] = made
            self._kinds[item.id, cell.key] = _kind(cell)

    def _bin(self, item: Item) -> None:
        button = ui.button(icon="delete", on_click=partial(self._remove, item))
        button.props("flat dense round size=sm")
        button.props["aria-label"] = button.props["title"] = f"remove {item.name}"

    def _select(self, item: Item, cell: Cell) -> Any:
        options = {option: option or cell.usual or "not given" for option in cell.options}
        value = cell.text if cell.text in options else None
        return ui.select(
            options, value=value, label=cell.label,
            on_change=lambda e: self._put(item, cell.key, e.value or ""),
        )  # fmt: skip

    def _input(self, item: Item, cell: Cell) -> Any:
        field = ui.input(cell.label, value=cell.text, placeholder=cell.usual)
        field.props("autocomplete=off spellcheck=false")

        def put() -> None:
            self._put(item, cell.key, field.value or "")

        field.on("blur", put)
        field.on("keydown.enter", put)
        return field

    def _put(self, item: Item, key: str, text: str) -> None:
        if not self._quiet:
            self._take(self._lists.put(self._entries, item, key, text))

    def _add(self, kind: str) -> None:
        self._take(self._lists.add(self._entries, kind))

    def _remove(self, item: Item) -> None:
        self._take(self._lists.remove(self._entries, item))

    def _empty(self) -> None:
        self._take(self._lists.empty(self._entries))

    def _take(self, entries: Entries) -> None:
        if entries == self._entries:
            return self.show(entries)  # what was typed and not taken goes back
        self.show(entries)
        self._changed(entries)


def _kind(cell: Cell) -> tuple[str, tuple[str, ...], str]:
    """What of a cell its field is made for."""
    return cell.label, cell.options, cell.text if cell.key == "name" else ""
