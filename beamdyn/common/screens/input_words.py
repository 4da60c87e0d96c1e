"""Name, meaning, choices and default of an input, in the words of the form."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from html import escape

from beamdyn.common.drawing.symbols import symbol_html
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.units import show
from beamdyn.common.screens.form_entries import toml_value

NOT_GIVEN = "not given"
_KEY = re.compile(r"\[(\w+)\] (\w+) = ")


def label(entry: Input) -> str:
    """Name and symbol of an input."""
    symbol = entry.quantity.symbol
    return f"{name_words(entry)}, {symbol}" if symbol and symbol != entry.name else name_words(entry)


def label_html(entry: Input) -> str:
    """The label as HTML, with the symbol typeset as in a sketch."""
    words, _, symbol = label(entry).rpartition(", ")
    return f"{escape(words)}, {symbol_html(symbol)}" if words else escape(symbol)


def help_of(entry: Input) -> str:
    """Meaning, unit and bounds, and whether it may be left out."""
    return entry.help if entry.required else f"{entry.help}; not required"


def name_words(entry: Input) -> str:
    """Name of an input in words, with the names of tables nested in its table before it."""
    return (entry.path.partition(".")[2] or entry.path).replace(".", " ").replace("_", " ")


def table_of(path: str) -> str:
    """Name of the table that holds an input; "" outside any."""
    return path.partition(".")[0] if "." in path else ""


def heading_of(section: str, headings: Mapping[str, str]) -> str:
    """Heading of a table of the form."""
    return headings.get(section, section.replace("_", " ").capitalize() or "General")


def as_on_form(sentence: str, inputs: Sequence[Input], headings: Mapping[str, str]) -> str:
    """A sentence with tables and keys of a file, "[physics] shear = true", as the form calls them."""
    tables = {table_of(entry.path) for entry in inputs}

    def named(found: re.Match[str]) -> str:
        if found[1] not in tables:
            return found[0]
        return f"{heading_of(found[1], headings)}: {found[2].replace('_', ' ')} = "

    return _KEY.sub(named, sentence)


def options_of(entry: Input) -> tuple[str, ...]:
    """The words or numbers from which an input is chosen; none where it is typed."""
    if entry.kind is bool:
        return ("true", "false")
    few = all(isinstance(choice, str | int) for choice in entry.choices)
    return tuple(str(choice) for choice in entry.choices) if entry.choices and few else ()


def default_words(entry: Input) -> str:
    """The default value, as a user would type it."""
    if entry.default is None or entry.default in ("", [], ()):
        return NOT_GIVEN
    value, unit = entry.default, entry.quantity.unit
    if value == math.inf and entry.quantity.infinite:
        return entry.quantity.infinite

    def in_words(number: float) -> str:
        short = unit == "m" and abs(number) < 1
        return f"{1e3 * number:.6g} mm" if short else f"{number:.6g} {unit}".rstrip()

    if isinstance(value, tuple):
        return toml_value([in_words(number) for number in value])
    if isinstance(value, bool) or not isinstance(value, int | float):
        return show(value).strip('"')
    return in_words(value)
