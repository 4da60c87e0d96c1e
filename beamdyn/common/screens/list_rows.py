"""Rows of a list on the page, which are kept while what stands in them changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from beamdyn.common.screens.lists import Cell, Item

Put = Callable[[Item, str, str], object]  # item, key of its cell, and text


class ItemRow:
    """The row of an item: its fields, and a button that removes it.

    A row is kept for other items with the same fields, since a new field would lose the focus, and a new
    button the click on it.

    Parameters
    ----------
    item : Item
        The item at first.
    put : callable
        Called with item, key and text when another text has been typed or chosen.
    remove : callable, optional
        Called with the item when it is to be removed; None if it cannot be.
    """

    def __init__(self, item: Item, put: Put, remove: Callable[[Item], object] | None) -> None:
        self._item, self._put = item, put
        self._remove = remove
        self._fields: dict[str, Any] = {}
        self._name: Any = None
        self._bin: Any = None
        short = len(item.cells) <= 3
        self._row: Any = ui.element("div").classes("listed" if short else "listed-part")
        with self._row:
            (self._make_short if short else self._make_long)()
        self._say_names()

    @property
    def texts(self) -> list[Any]:
        """The fields into which text is typed."""
        return [self._fields[cell.key] for cell in self._item.cells if not cell.options]

    def fits(self, item: Item) -> bool:
        """Whether its fields are those of an item."""
        return [*map(_kind, self._item.cells)] == [*map(_kind, item.cells)]

    def show(self, item: Item) -> None:
        """Show another item; a field whose text is the same as before keeps what is being typed."""
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
        """Remove it from the page."""
        self._row.delete()

    # Its parts ------------------------------------------------------------------------------------

    def _make_short(self) -> None:
        self._make_fields()
        self._make_bin()

    def _make_long(self) -> None:
        with ui.row().classes("w-full items-center no-wrap justify-between"):
            self._name = ui.label().classes("text-weight-medium")
            self._make_bin()
        with ui.element("div").classes("cells"):
            self._make_fields()

    def _make_fields(self) -> None:
        for cell in self._item.cells:
            made = self._select(cell) if cell.options else self._input(cell)
            made.props("dense outlined stack-label hide-hint hide-bottom-space")
            made.props["title"] = made.props["hint"] = cell.hint or cell.label
            self._fields[cell.key] = made

    def _make_bin(self) -> None:
        if (remove := self._remove) is not None:
            self._bin = ui.button(icon="delete", on_click=lambda: remove(self._item))
            self._bin.props("flat dense round size=sm")

    def _say_names(self) -> None:
        for key, field in self._fields.items():
            field.props["data-path"] = f"{self._item.id}.{key}"
            field.update()
        if self._name is not None:
            self._name.set_text(self._item.name)
        if self._bin is not None:
            self._bin.props["aria-label"] = self._bin.props["title"] = f"remove {self._item.name}"
            self._bin.update()

    def _select(self, cell: Cell) -> Any:
        return ui.select(
            _options(cell), value=_chosen(cell), label=cell.label,
            on_change=lambda e: self._typed(cell.key, e.value or ""),
        )  # fmt: skip

    def _input(self, cell: Cell) -> Any:
        field: Any = ui.input(cell.label, value=cell.text, placeholder=cell.usual)
        field.props("autocomplete=off spellcheck=false")

        def typed() -> None:
            self._typed(cell.key, field.value or "")
            field.set_value(self._text(cell.key))  # what is not taken goes back

        field.on("blur", typed)
        field.on("keydown.enter", typed)
        return field

    def _typed(self, key: str, text: str) -> None:
        if text != self._text(key):
            self._put(self._item, key, text)

    def _text(self, key: str) -> str:
        return next(cell.text for cell in self._item.cells if cell.key == key)


def _kind(cell: Cell) -> tuple[str, str, bool]:
    """The properties of a cell for which its field is made."""
    return cell.key, cell.label, bool(cell.options)


def _options(cell: Cell) -> dict[str, str]:
    return {option: option or cell.usual or "not given" for option in cell.options}


def _chosen(cell: Cell) -> str | None:
    return cell.text if cell.text in cell.options else None
