"""Data that the browser stores: designs, unfinished input, named designs, light or dark theme; links."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens.form_entries import Entries, read_entry, unit_of, usual_unit

_LONGEST = 80  # largest number of characters in the name of a stored design
_MOST = 100  # largest number of designs stored under names
# Most characters in a link, and most bytes in the design that the link encodes.
_LONGEST_LINK, _LARGEST = 30_000, 200_000
_SOURCE = "the link"


def call(function: str, *given: Any) -> str:
    """Return a script that calls a function of page.js with JSON values, and returns its result."""
    return f"return {function}({', '.join(map(json.dumps, given))});"


def named_designs(stored: str | None) -> dict[str, tuple[str, Entries]]:
    """Return kind of file and field texts of the designs in the browser, by name; omit malformed ones."""
    try:
        held = json.loads(stored or "{}")
    except ValueError:
        return {}
    found = {}
    for name, design in held.items() if isinstance(held, dict) else ():
        match design:
            case [str(document), dict(entries)] if _are_texts(entries.values()):
                found[name[:_LONGEST]] = document, entries
    return dict([*found.items()][:_MOST])


def _are_texts(values: Iterable[object]) -> bool:
    return all(isinstance(value, str) for value in values)


def refused_name(name: str, present: Mapping[str, object]) -> str:
    """Return the reason why a design cannot be stored under a name; empty if it can.

    `present` contains the designs that are stored already, by name.
    """
    if not name.strip():
        return "give the design a name"
    if len(name) > _LONGEST:
        return f"give a name of at most {_LONGEST} characters"
    if len(present) >= _MOST and name not in present:
        return f"there are {_MOST} designs already: delete one"
    return ""


def read_typed(typed: Any, entries: Entries, inputs: list[Input]) -> Entries:
    """Return the field texts updated by texts typed but not yet stored, read as the form reads them."""
    known = {entry.path: entry for entry in inputs}
    found = dict(entries)
    for path, text in typed.items() if isinstance(typed, dict) else ():
        if path in known and isinstance(text, str):
            unit = unit_of(entries.get(path, ""), known[path]) or usual_unit(known[path].quantity.unit)
            found[path] = read_entry(text, known[path], unit).text
    return found


@dataclass(frozen=True)
class LinkedDesign:
    """A design that is encoded in the address of a link.

    Parameters
    ----------
    document : str
        Name of the kind of file.
    text : str
        The file, as TOML.
    options : mapping
        Field texts that are not part of the file.
    """

    document: str
    text: str
    options: Mapping[str, str]

    def as_fragment(self) -> str:
        """Encode the design as the part of an address after "#", with letters, digits, "-", "_" and "=" only.

        Raises
        ------
        ConfigError
            If the design is too large for an address.
        """
        held = json.dumps([self.document, self.text, dict(self.options)], ensure_ascii=False)
        packed = base64.urlsafe_b64encode(zlib.compress(held.encode(), 9)).decode().rstrip("=")
        if len(packed) > _LONGEST_LINK or len(held.encode()) > _LARGEST:
            raise ConfigError("this design", ["it is too large for a link: save it as a file"])
        return f"design={packed}"

    @classmethod
    def of_fragment(cls, fragment: str) -> LinkedDesign:
        """Decode the design in the part of an address after "#".

        Raises
        ------
        ConfigError
            If the fragment encodes no design; the values in the design are not checked.
        """
        packed = fragment.removeprefix("#").removeprefix("design=")
        if len(packed) > _LONGEST_LINK:
            raise ConfigError(_SOURCE, [f"it is longer than {_LONGEST_LINK} characters: use a file"])
        broken = ConfigError(
            _SOURCE, ["it holds no design, or a part of it is missing: copy it again, whole"]
        )
        try:
            raw = base64.b64decode(packed + "=" * (-len(packed) % 4), altchars=b"-_", validate=True)
            unpack = zlib.decompressobj()
            text = unpack.decompress(raw, _LARGEST)
            held = None if unpack.unconsumed_tail or not unpack.eof else json.loads(text)
        except (ValueError, zlib.error, RecursionError):
            raise broken from None
        match held:
            case [str(document), str(text), dict(options)] if _are_texts(options.values()):
                return cls(document, text, options)
        raise broken
