"""Lists of named items on the page: added and removed by buttons, joined by choosing names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import takewhile
from typing import Any

from nicegui import ui

from beamdyn.common.screens.list_rows import ItemRow, Put
from beamdyn.common.screens.lists import Entries, Item, ListGroup, Lists, gone_with
from beamdyn.common.screens.page_writer import PageWriter

_READ = 10_000  # how long a notice stays [ms]

STYLE = """
.listed { display: flex; gap: 4px; align-items: start; width: 100%; }
.listed > .q-field { flex: 1 1 0; min-width: 0; }
.listed-part { border-left: 3px solid #0072B2; padding-left: 6px; width: 100%; }
.listed-part .cells { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 4px 6px; }
.left .lists .nicegui-expansion-content { display: flex; flex-direction: column; gap: 6px; }
.lists .rows { gap: 6px; }
.lists .rows:empty { display: none; }
.advice { border-left: 4px solid #0072B2; padding-left: 0.5rem; width: 100%; }
.advice:empty { display: none; }
"""


class GroupRows:
    """A group of items on the page: their rows, and buttons that add one.

    Parameters
    ----------
    group : ListGroup
        The group.
    put : callable
        Called with item, key and text of a cell that changes.
    add : callable
        Called with the kind of item to add.
    remove : callable
        Called with the item to remove.
    """

    def __init__(
        self, group: ListGroup, put: Put, add: Callable[[str], object], remove: Callable[[Item], object]
    ) -> None:
        self._put, self._remove = put, remove if group.kinds else None
        self._rows: list[ItemRow] = []
        with ui.expansion(group.heading, value=True).classes("w-full section").props("dense"):
            ui.label(group.about).classes("status")
            self._place: Any = ui.column().classes("w-full rows")
            with ui.row().classes("gap-1"):
                for kind, words in group.kinds.items():
                    ui.button(words, icon="add", on_click=partial(add, kind)).props(
                        f'outline dense no-caps size=sm aria-label="add {words}"'
                    )
        self.show(group.items)

    @property
    def texts(self) -> list[Any]:
        """The fields into which text is typed."""
        return [field for row in self._rows for field in row.texts]

    def show(self, items: Sequence[Item]) -> None:
        """Show these items; rows are kept as far as their fields fit."""
        kept = sum(
            1 for _ in takewhile(lambda pair: pair[0].fits(pair[1]), zip(self._rows, items, strict=False))
        )
        for row in self._rows[kept:]:
            row.delete()
        del self._rows[kept:]
        for row, item in zip(self._rows, items, strict=False):
            row.show(item)
        with self._place:
            self._rows += [ItemRow(item, self._put, self._remove) for item in items[kept:]]


class ListEditor:
    """The lists of a screen.

    Parameters
    ----------
    lists : Lists
        The lists.
    now : callable
        Returns all present entries, also those that other fields have written.
    changed : callable
        Called with all entries after a change.
    writer : PageWriter
        Writes into the fields while something is held.
    """

    def __init__(
        self,
        lists: Lists,
        now: Callable[[], Entries],
        changed: Callable[[Entries], object],
        writer: PageWriter,
    ) -> None:
        self._lists, self._now, self._changed, self._writer = lists, now, changed, writer
        with ui.column().classes("lists w-full gap-1"):
            ui.button("Start from nothing", icon="note_add", on_click=self._empty).props("flat dense no-caps")
            self._said: Any = ui.column().classes("advice gap-1").props('role="status" aria-live="polite"')
            with ui.column().classes("w-full gap-1"):
                self._groups = [
                    GroupRows(group, self._put, self._add, self._remove) for group in lists.groups(now())
                ]
        self._advise(now())

    def show(self, entries: Mapping[str, str]) -> None:
        """Show other entries in the lists, and say what is missing."""
        self.follow(entries)
        self._advise(entries)

    def follow(self, entries: Mapping[str, str]) -> None:
        """Show other entries in the lists."""
        with self._writer.writing(*(field for rows in self._groups for field in rows.texts)):
            for rows, group in zip(self._groups, self._lists.groups(entries), strict=True):
                rows.show(group.items)

    def _advise(self, entries: Mapping[str, str]) -> None:
        sentences = self._lists.advice(entries)
        self._said.clear()
        with self._said:
            for sentence in sentences:
                ui.label(sentence)

    def _put(self, item: Item, key: str, text: str) -> None:
        self._take(self._lists.put(self._now(), item, key, text))

    def _add(self, kind: str) -> None:
        self._take(self._lists.add(self._now(), kind))

    def _remove(self, item: Item) -> None:
        before, left = self._now(), self._lists.remove(self._now(), item)
        self._take(left)
        if gone := gone_with(item, self._lists.groups(before), self._lists.groups(left)):
            said = f"Removed along with {item.name}: {', '.join(gone)}. Undo brings all back."
            ui.notify(said, timeout=_READ, close_button="Close")

    def _empty(self) -> None:
        self._take(self._lists.empty(self._now()))

    def _take(self, entries: Entries) -> None:
        if entries != self._now():
            self.show(entries)
            self._changed(entries)
