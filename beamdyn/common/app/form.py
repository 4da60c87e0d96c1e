"""A form made from the descriptions of inputs: a field for each, with its symbol, unit, bounds and help."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from nicegui import ui

from beamdyn.common.app.form_entries import has_rows, in_unit, toml_value, units_for
from beamdyn.common.app.screens import Drag
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.units import show

_NOT_GIVEN = "not given"


class Form:
    """The fields of some tables.

    Parameters
    ----------
    inputs : sequence of Input
        What to ask for.
    sections : sequence of str
        Tables shown, in this order; "" for inputs outside any.
    entries : mapping
        What stands in the fields at first.
    changed : callable
        Called with path and text when a field changes.
    drags : sequence of Drag
        Sliders below fields.
    """

    def __init__(
        self,
        inputs: Sequence[Input],
        sections: Sequence[str],
        entries: Mapping[str, str],
        changed: Callable[[str, str], object],
        drags: Sequence[Drag] = (),
    ) -> None:
        self.fields: dict[str, Any] = {}
        self._tables: dict[str, Any] = {}
        self._changed = changed
        self._drags = {drag.path: drag for drag in drags}
        for section in sections:
            chosen = [entry for entry in inputs if _table(entry.path) == section]
            if chosen:
                self._section(section, chosen, entries)

    def _section(self, section: str, inputs: Sequence[Input], entries: Mapping[str, str]) -> None:
        given = any(entries.get(entry.path, "") for entry in inputs)
        usual = all(_default(entry) != _NOT_GIVEN for entry in inputs)
        heading = f"[{section}]" if section else "general"
        table = ui.expansion(heading, value=given or usual or not section).classes("w-full section")
        with table.props("dense"):
            for entry in inputs:
                with ui.element("div"):
                    self._field(entry, entries.get(entry.path, ""))
        self._tables[section] = table

    def _field(self, entry: Input, text: str) -> None:
        made = self._select(entry, text) if _options(entry) else self._input(entry, text)
        made.without_auto_validation()  # mistakes are marked by the answer, not by the field
        made.classes("w-full").props(
            f'dense outlined stack-label hide-hint hide-bottom-space data-path="{entry.path}"'
        )
        made.props["hint"] = help_of(entry)
        self.fields[entry.path] = made
        if (drag := self._drags.get(entry.path)) is not None:
            self._slider(drag, entry, made)

    def _slider(self, drag: Drag, entry: Input, field: Any) -> None:
        """A slider that writes into a field and follows what is written there, limited to its range."""

        def place() -> float | None:
            given = in_unit(field.value or "", entry.quantity.unit, drag.unit).partition(" ")[0]
            try:
                return min(max(float(given), drag.low), drag.high)
            except ValueError:
                return None

        def write(at: float | None) -> None:
            if at is not None and at != place():  # else it has followed the field
                field.set_value(f"{at:g} {drag.unit}")

        start = place()
        made = ui.slider(
            min=drag.low, max=drag.high, step=drag.step, value=drag.low if start is None else start,
            on_change=lambda e: write(e.value),
        )  # fmt: skip
        made.props(f'dense aria-label="{label(entry)} [{drag.unit}]"').classes("q-px-md")
        field.on_value_change(lambda: None if (at := place()) is None else made.set_value(at))

    def _select(self, entry: Input, text: str) -> Any:
        options = {option: option.replace("_", " ") for option in _options(entry)}
        if not entry.required:
            default = _default(entry)
            options = {"": default if default == _NOT_GIVEN else f"{_NOT_GIVEN}: {default}", **options}
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
            placeholder="" if entry.required else _default(entry),
            on_change=lambda e: self._changed(entry.path, e.value or ""),
        ).props("debounce=200 autocomplete=off spellcheck=false")
        units = units_for(entry.quantity.unit)
        if len(units) > 1:
            with field.add_slot("append"):
                self._units(entry, field, units)
        return field

    def _units(self, entry: Input, field: Any, units: Sequence[str]) -> None:
        """A button whose menu converts the field's value to another unit; made at the first click."""

        def put(unit: str) -> None:
            field.set_value(in_unit(field.value or "", entry.quantity.unit, unit))

        def choose() -> None:
            button.clear()
            with button, ui.menu(value=True).props("auto-close"):
                for unit in units:
                    ui.menu_item(unit, partial(put, unit))

        button = ui.button(icon="straighten", on_click=choose)
        button.props(f'flat dense round size=sm aria-label="unit of {_words(entry)}"')

    def shows(self, entries: Mapping[str, str]) -> bool:
        """Whether these entries stand in the fields."""
        return all((field.value or "") == entries.get(path, "") for path, field in self.fields.items())

    def mark(self, mistakes: Mapping[str, Sequence[str]]) -> None:
        """Mark the fields with mistakes, clear the others, and open folded tables with a mistake."""
        for path, field in self.fields.items():
            said = mistakes.get(path)
            field.error = " ".join(said) if said else None
            if said:
                self._tables[_table(path)].open()


def _lines(*given: Any, **more: Any) -> Any:
    """A text field that grows with its lines."""
    return ui.textarea(*given, **more).props("autogrow")


def label(entry: Input) -> str:
    """Name and symbol of an input."""
    symbol = entry.quantity.symbol
    return f"{_words(entry)}, {symbol}" if symbol and symbol != entry.name else _words(entry)


def help_of(entry: Input) -> str:
    """Meaning, unit and bounds, and whether it may be left out."""
    return entry.help if entry.required else f"{entry.help}; not required"


def _words(entry: Input) -> str:
    """Its name, after that of the tables within its table."""
    return (entry.path.partition(".")[2] or entry.path).replace(".", " ").replace("_", " ")


def _table(path: str) -> str:
    return path.partition(".")[0] if "." in path else ""


def _options(entry: Input) -> tuple[str, ...]:
    if entry.kind is bool:
        return ("true", "false")
    few = all(isinstance(choice, str | int) for choice in entry.choices)
    return tuple(str(choice) for choice in entry.choices) if entry.choices and few else ()


def _default(entry: Input) -> str:
    """The default value, as a user would type it."""
    if entry.default is None or entry.default in ("", [], ()):
        return _NOT_GIVEN
    value, unit = entry.default, entry.quantity.unit
    if value == math.inf and entry.quantity.infinite:
        return entry.quantity.infinite
    if isinstance(value, tuple):
        return toml_value([_said(number, unit) for number in value])
    if isinstance(value, bool) or not isinstance(value, int | float):
        return show(value).strip('"')
    return _said(value, unit)


def _said(number: float, unit: str) -> str:
    """A number with its unit; short lengths in millimetres."""
    if unit == "m" and abs(number) < 1:
        number, unit = 1e3 * number, "mm"
    return f"{number:.6g} {unit}".rstrip()
