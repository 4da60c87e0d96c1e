"""Forms made from descriptions of inputs: a field per input, with symbol, unit, bounds and help."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import Any

from nicegui import ui

from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens import form_entries
from beamdyn.common.screens.controls import DragSlider
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.screen_parts import Drag, Preset
from beamdyn.common.screens.screens import Screen

# Smallest number of optional fields that are folded into "more".  A table without given values is unfolded
# only if it has at most this number of fields, all with default values.
_FEW = 3


class Form:
    """The input fields of a screen, in a group per table of the file.

    Parameters
    ----------
    work : OpenDocument
        The open input file, whose texts are in the fields at first.
    screen : Screen
        The screen that contains the form.
    inputs : sequence of Input
        Inputs; those in the tables of the screen have a field.
    changed : callable
        Called with the path of the input and the new text when a field changes.
    hold : callable
        Called with True when the user takes hold of a slider, with False when the user releases it.
    writer : PageWriter
        Object that updates the fields while a handle or slider is held.

    Attributes
    ----------
    typed : dict
        Last text typed into each field, by path of the input.
    """

    def __init__(
        self,
        work: OpenDocument,
        screen: Screen,
        inputs: Sequence[Input],
        changed: Callable[[str, str], object],
        hold: Callable[[bool], object],
        writer: PageWriter,
    ) -> None:
        self._changed, self._hold, self._held, self._writer = changed, hold, False, writer
        self.fields: dict[str, Any] = {}
        self.typed: dict[str, str] = {}
        self._inputs = {entry.path: entry for entry in inputs}
        self._units: dict[str, str] = {}  # units of numbers typed without a unit, by path of the input
        self._tables: dict[str, Any] = {}
        self._places: dict[str, Any] = {}  # HTML elements that contain the fields, by path of the input
        self._rest: dict[str, Any] = {}  # foldable parts of tables, by path of the inputs in them
        self._drags = {drag.path: drag for drag in screen.drags}
        for section in screen.sections:
            chosen = [entry for entry in inputs if form_entries.table_of(entry.path) == section]
            if chosen:
                presets = [preset for preset in screen.presets if preset.table == section]
                self._section(section, chosen, presets, work)

    def _section(
        self, section: str, chosen: Sequence[Input], presets: Sequence[Preset], work: OpenDocument
    ) -> None:
        """Make the part of the form for one table of the file.

        Fields that are required, have a text or have a slider come first; the others are folded if there are
        several.
        """
        entries, drags = work.entries, self._drags
        first = [e for e in chosen if e.required or e.path in drags or entries.get(e.path, "")]
        rest = [entry for entry in chosen if entry not in first]
        usual = len(chosen) <= _FEW and all(
            form_entries.default_words(entry) != form_entries.NOT_GIVEN for entry in chosen
        )
        table = ui.expansion(
            form_entries.heading_of(section, work.document.headings),
            value=bool(first) or usual or not section,
        )
        with table.classes("w-full section").props("dense"):
            for preset in presets:
                self._preset(preset)
            self._fields(first, entries)
            if first and len(rest) >= _FEW:
                with ui.expansion(f"{len(rest)} more").classes("w-full rest").props("dense") as folded:
                    self._fields(rest, entries)
                self._rest |= dict.fromkeys((entry.path for entry in rest), folded)
            else:
                self._fields(rest, entries)
        self._tables[section] = table

    def _fields(self, chosen: Sequence[Input], entries: Mapping[str, str]) -> None:
        for entry in chosen:
            with ui.element("div") as self._places[entry.path]:
                self._field(entry, entries.get(entry.path, ""))

    def _preset(self, preset: Preset) -> None:
        """Make a selection list whose choices each fill in several fields, such as those of a material.

        When the list is opened, it shows the choice that matches the texts of the fields.
        """

        def fill(choice: str | None) -> None:
            for path, text in preset.choices.get(choice or "", {}).items():
                if path in self.fields:
                    self.fields[path].set_value(text)

        def text(path: str) -> str:
            return self._read(path).text if path in self.fields else ""

        made = ui.select([*preset.choices], label=preset.words, on_change=lambda e: fill(e.value))
        made.classes("w-full").props(f'dense outlined stack-label aria-label="{preset.words}"')
        made.on("popup-show", lambda: made.set_value(preset.chosen(text)))

    def _field(self, entry: Input, text: str) -> None:
        made = self._select(entry, text) if form_entries.options_of(entry) else self._input(entry, text)
        made.without_auto_validation()  # errors are shown after the computation, not by the field itself
        made.classes("w-full").props(
            f'dense outlined stack-label hide-hint hide-bottom-space data-path="{entry.path}"'
        )
        made.props["hint"] = form_entries.help_of(entry)
        if entry.quantity.symbol:
            made.add_slot("label", form_entries.label_html(entry))
        self.fields[entry.path] = made
        if entry.path in self._drags:
            self._slider(self._drags[entry.path], entry, made)

    def _slider(self, drag: Drag, entry: Input, field: Any) -> None:
        """Make a slider that writes into a field, and moves when the text of the field changes."""

        def place() -> float | None:
            text = self._read(entry.path).text
            given = form_entries.in_unit(text, entry.quantity, drag.unit).partition(" ")[0]
            try:
                return min(max(float(given), drag.low), drag.high)
            except ValueError:
                return None

        def write(at: float | None) -> None:
            if at is not None and at != place():  # write nothing if the slider only follows the field
                field.set_value(f"{at:g} {drag.unit}".rstrip())

        def hold(held: bool) -> None:
            if held != self._held:
                self._held = held
                self._hold(held)

        def follow(at: float, done: bool) -> None:
            if not done:
                hold(True)
            with self._writer.writing(field, made):
                write(at)
            if done:
                hold(False)

        start, ends = place(), {"min": drag.low, "max": drag.high}
        at = drag.low if start is None else start
        made = DragSlider(follow, **ends, step=drag.step, value=at, on_change=lambda e: write(e.value))
        unit = f" [{drag.unit}]" if drag.unit else ""
        made.props(f'dense aria-label="{form_entries.label(entry)}{unit}"').classes("q-px-md")

        def follow_field() -> None:
            """Move the slider to the value in the field, unless the user holds the slider."""
            if (at := place()) is not None:
                (made.set_value(at) if self._held else made.put(at, self._writer))

        field.on_value_change(follow_field)

    def _select(self, entry: Input, text: str) -> Any:
        options = {option: option.replace("_", " ") for option in form_entries.options_of(entry)}
        if not entry.required:
            default = form_entries.default_words(entry)
            options = {
                "": default if default == form_entries.NOT_GIVEN else f"{form_entries.NOT_GIVEN}: {default}",
                **options,
            }
        made = ui.select(options, value=text if text in options else None, label=form_entries.label(entry))
        return made.on_value_change(lambda e: self._changed(entry.path, e.value or ""))

    def _input(self, entry: Input, text: str) -> Any:
        usual, several = form_entries.default_words(entry), form_entries.has_rows(entry)
        field: Any = (ui.textarea if several else ui.input)(
            form_entries.label(entry),
            value=text,
            placeholder="" if entry.required else usual,
            on_change=lambda e: self._heard(entry, e.value or ""),
        )
        field.props("debounce=20 autocomplete=off spellcheck=false" + " autogrow" * several)

        def tidy() -> None:  # called when the user leaves the field; shows the text as understood
            read = self._read(entry.path)
            if read.remark and not field.error:
                field.set_value(read.text)

        field.on("blur", tidy)
        given = form_entries.unit_of(text, entry) or form_entries.unit_of(usual, entry)
        self._units[entry.path] = given or form_entries.usual_unit(entry.quantity.unit)
        units = form_entries.units_of(entry)
        if len(units) > 1:
            with field.add_slot("append"):
                self._unit_button(entry, field, units)
        return field

    def _heard(self, entry: Input, typed: str) -> None:
        """Read the text of a field after the user or the program changed it; show how it is understood."""
        self.typed[entry.path] = typed
        read, field = self._read(entry.path), self.fields[entry.path]
        self._units[entry.path] = form_entries.unit_of(read.text, entry) or self._units[entry.path]
        _set_property(field, "hint", read.remark or form_entries.help_of(entry))
        _set_property(
            field, "suffix", self._units[entry.path] if form_entries.is_bare(field.value or "") else ""
        )
        self._changed(entry.path, read.text)

    def _read(self, path: str) -> form_entries.Reading:
        """Return how the form understands the text of a field."""
        typed = self.fields[path].value or ""
        return form_entries.read_entry(typed, self._inputs[path], self._units.get(path, ""))

    def _unit_button(self, entry: Input, field: Any, units: Sequence[str]) -> None:
        """Make a button with a menu of units; choosing one converts the value in the field.

        The menu is filled at the first click.
        """

        def put(unit: str) -> None:
            self._units[entry.path] = unit
            field.set_value(form_entries.in_unit(self._read(entry.path).text, entry.quantity, unit))

        def choose() -> None:
            button.clear()
            with button, ui.menu(value=True).props("auto-close"):
                for unit in units:
                    ui.menu_item(unit, partial(put, unit))

        button = ui.button(icon="straighten", on_click=choose)
        button.props(f'flat dense round size=sm aria-label="unit of {form_entries.name_words(entry)}"')

    def put(self, entries: Mapping[str, str]) -> None:
        """Show the given texts in the fields; fields that show them already are not changed."""
        for path, field in self.fields.items():
            if self._read(path).text != entries.get(path, ""):
                field.set_value(entries.get(path, ""))
                if entries.get(path, "") and path in self._rest:
                    self._rest[path].open()

    def write(self, texts: Mapping[str, str]) -> None:
        """Write texts into fields, also while something is dragged; ignore paths without a field."""
        fields = {path: self.fields[path] for path in texts if path in self.fields}
        with self._writer.writing(*fields.values()):
            for path, field in fields.items():
                field.set_value(texts[path])

    def hide(self, paths: Collection[str]) -> None:
        """Hide the fields of the given paths, and tables without visible fields; show all other fields."""
        shown = {form_entries.table_of(path) for path in self.fields if path not in paths}
        for path, place in self._places.items():
            place.set_visibility(path not in paths)
        for section, table in self._tables.items():
            table.set_visibility(section in shown)

    def mark(self, mistakes: Mapping[str, Sequence[str]]) -> None:
        """Mark the fields with errors, clear all other marks, and unfold tables with errors."""
        for path, field in self.fields.items():
            said = mistakes.get(path)
            field.error = " ".join(said) if said else None
            if said:
                self._unfold(path)

    def _unfold(self, path: str) -> None:
        """Unfold the table that contains a field, and the foldable part with the field."""
        self._tables[form_entries.table_of(path)].open()
        if path in self._rest:
            self._rest[path].open()


def _set_property(field: Any, name: str, words: str) -> None:
    """Set a property of a field only if it changes, as setting it makes the page render again."""
    if field.props.get(name, "") != words:
        field.props[name] = words
