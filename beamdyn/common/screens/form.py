"""A form made from the descriptions of inputs: a field for each, with its symbol, unit, bounds and help."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any

from nicegui import ui

from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens.drag_slider import DragSlider
from beamdyn.common.screens.form_entries import has_rows, in_unit, units_of
from beamdyn.common.screens.input_words import (
    NOT_GIVEN,
    default_words,
    heading_of,
    help_of,
    label,
    label_html,
    name_words,
    options_of,
    table_of,
)
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.reading import Reading, is_bare, read_entry, unit_of, usual_unit
from beamdyn.common.screens.screens import Drag


class Form:
    """The fields of some tables.

    Parameters
    ----------
    inputs : sequence of Input
        Inputs, each with a field.
    sections : sequence of str
        Tables shown, in this order; "" for inputs outside any.
    entries : mapping
        Texts of the fields at first, by path.
    changed : callable
        Called with path and text when a field changes.
    drags : sequence of Drag
        Sliders below fields.
    hold : callable
        Called with True when a slider is taken hold of, with False when it is let go.
    headings : mapping
        Headings of tables, where one that is made from the table's name does not serve.
    writer : PageWriter
        Writes into the fields while something is held.

    Attributes
    ----------
    typed : dict
        Text that was typed last into each field, by path.
    """

    def __init__(
        self,
        inputs: Sequence[Input],
        sections: Sequence[str],
        entries: Mapping[str, str],
        changed: Callable[[str, str], object],
        drags: Sequence[Drag] = (),
        hold: Callable[[bool], object] = lambda _: None,
        headings: Mapping[str, str] = MappingProxyType({}),
        writer: PageWriter | None = None,
    ) -> None:
        self._writer = writer or PageWriter()
        self.fields: dict[str, Any] = {}
        self.typed: dict[str, str] = {}
        self._inputs = {entry.path: entry for entry in inputs}
        self._units: dict[str, str] = {}  # units of bare numbers, by path
        self._headings = headings
        self._tables: dict[str, Any] = {}
        self._places: dict[str, Any] = {}  # places of the fields
        self._changed = changed
        self._hold, self._held = hold, False
        self._drags = {drag.path: drag for drag in drags}
        for section in sections:
            chosen = [entry for entry in inputs if table_of(entry.path) == section]
            if chosen:
                self._section(section, chosen, entries)

    def _section(self, section: str, inputs: Sequence[Input], entries: Mapping[str, str]) -> None:
        given = any(entries.get(entry.path, "") for entry in inputs)
        usual = all(default_words(entry) != NOT_GIVEN for entry in inputs)
        heading = heading_of(section, self._headings)
        table = ui.expansion(heading, value=given or usual or not section).classes("w-full section")
        with table.props("dense"):
            for entry in inputs:
                with ui.element("div") as self._places[entry.path]:
                    self._field(entry, entries.get(entry.path, ""))
        self._tables[section] = table

    def _field(self, entry: Input, text: str) -> None:
        made = self._select(entry, text) if options_of(entry) else self._input(entry, text)
        made.without_auto_validation()  # mistakes are marked by the answer, not by the field
        made.classes("w-full").props(
            f'dense outlined stack-label hide-hint hide-bottom-space data-path="{entry.path}"'
        )
        made.props["hint"] = help_of(entry)
        if entry.quantity.symbol:
            made.add_slot("label", label_html(entry))
        self.fields[entry.path] = made
        if (drag := self._drags.get(entry.path)) is not None:
            self._slider(drag, entry, made)

    def _slider(self, drag: Drag, entry: Input, field: Any) -> None:
        """A slider that writes into a field and follows what is written there, limited to its range."""

        def place() -> float | None:
            text = self._read(entry.path).text
            given = in_unit(text, entry.quantity, drag.unit).partition(" ")[0]
            try:
                return min(max(float(given), drag.low), drag.high)
            except ValueError:
                return None

        def write(at: float | None) -> None:
            if at is not None and at != place():  # otherwise it has followed the field
                field.set_value(f"{at:g} {drag.unit}".rstrip())

        def follow(at: float, done: bool) -> None:
            if not done:
                self._be_held(True)
            with self._writer.writing(field, made):
                write(at)
            if done:
                self._be_held(False)

        start = place()
        made = DragSlider(
            follow, min=drag.low, max=drag.high, step=drag.step, value=drag.low if start is None else start,
            on_change=lambda e: write(e.value),
        )  # fmt: skip
        unit = f" [{drag.unit}]" if drag.unit else ""
        made.props(f'dense aria-label="{label(entry)}{unit}"').classes("q-px-md")
        field.on_value_change(lambda: None if (at := place()) is None else made.set_value(at))

    def _be_held(self, held: bool) -> None:
        if held != self._held:
            self._held = held
            self._hold(held)

    def _select(self, entry: Input, text: str) -> Any:
        options = {option: option.replace("_", " ") for option in options_of(entry)}
        if not entry.required:
            default = default_words(entry)
            options = {"": default if default == NOT_GIVEN else f"{NOT_GIVEN}: {default}", **options}
        value = text if text in options else None
        return ui.select(
            options,
            value=value,
            label=label(entry),
            on_change=lambda e: self._changed(entry.path, e.value or ""),
        )

    def _input(self, entry: Input, text: str) -> Any:
        made = _lines if has_rows(entry) else ui.input
        field = made(
            label(entry),
            value=text,
            placeholder="" if entry.required else default_words(entry),
            on_change=lambda e: self._heard(entry, e.value or ""),
        ).props("debounce=100 autocomplete=off spellcheck=false")
        field.on("blur", lambda: self._tidy(entry))
        self._units[entry.path] = (
            unit_of(text, entry) or unit_of(default_words(entry), entry) or usual_unit(entry)
        )
        units = units_of(entry)
        if len(units) > 1:
            with field.add_slot("append"):
                self._unit_button(entry, field, units)
        return field

    def _heard(self, entry: Input, typed: str) -> None:
        """Read a text that was typed or written into a field, and show how it was read."""
        self.typed[entry.path] = typed
        read = self._read(entry.path)
        self._units[entry.path] = unit_of(read.text, entry) or self._units[entry.path]
        self._remark(entry, read)
        self._changed(entry.path, read.text)

    def _read(self, path: str) -> Reading:
        """The text of a field, as it is read."""
        typed = self.fields[path].value or ""
        return read_entry(typed, self._inputs[path], self._units.get(path, ""))

    def _remark(self, entry: Input, read: Reading) -> None:
        field = self.fields[entry.path]
        field.props["hint"] = read.remark or help_of(entry)
        field.props["suffix"] = self._units[entry.path] if is_bare(field.value or "") else ""

    def _tidy(self, entry: Input) -> None:
        """Replace a field's text by what was read from it, when the field is left."""
        read, field = self._read(entry.path), self.fields[entry.path]
        if read.remark and not field.error:
            field.set_value(read.text)

    def _unit_button(self, entry: Input, field: Any, units: Sequence[str]) -> None:
        """A button whose menu converts the field's value to another unit; made at the first click."""

        def put(unit: str) -> None:
            self._units[entry.path] = unit
            field.set_value(in_unit(self._read(entry.path).text, entry.quantity, unit))

        def choose() -> None:
            button.clear()
            with button, ui.menu(value=True).props("auto-close"):
                for unit in units:
                    ui.menu_item(unit, partial(put, unit))

        button = ui.button(icon="straighten", on_click=choose)
        button.props(f'flat dense round size=sm aria-label="unit of {name_words(entry)}"')

    def shows(self, entries: Mapping[str, str]) -> bool:
        """Whether these entries stand in the fields."""
        return all(self._read(path).text == entries.get(path, "") for path in self.fields)

    def put(self, entries: Mapping[str, str]) -> None:
        """Show these entries; fields that show theirs already are left alone."""
        for path, field in self.fields.items():
            if self._read(path).text != entries.get(path, ""):
                field.set_value(entries.get(path, ""))

    def write(self, texts: Mapping[str, str]) -> None:
        """Write texts into their fields, also during a drag; paths without a field are passed over."""
        fields = {path: self.fields[path] for path in texts if path in self.fields}
        with self._writer.writing(*fields.values()):
            for path, field in fields.items():
                field.set_value(texts[path])

    def hide(self, paths: Collection[str]) -> None:
        """Hide these fields, and tables that have no others; show the rest."""
        shown = {table_of(path) for path in self.fields if path not in paths}
        for path, place in self._places.items():
            place.set_visibility(path not in paths)
        for section, table in self._tables.items():
            table.set_visibility(section in shown)

    def mark(self, mistakes: Mapping[str, Sequence[str]]) -> None:
        """Mark the fields with mistakes, clear the others, and open folded tables with a mistake."""
        for path, field in self.fields.items():
            said = mistakes.get(path)
            field.error = " ".join(said) if said else None
            if said:
                self._tables[table_of(path)].open()


def _lines(*given: Any, **more: Any) -> Any:
    """A text field that grows with its lines."""
    return ui.textarea(*given, **more).props("autogrow")
