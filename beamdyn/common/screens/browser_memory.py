"""Data of a page that the browser holds: a tab's designs, what is being typed, named designs, look, links."""

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

_LONGEST = 80  # characters of a name
_MOST = 100  # named designs
_LONGEST_LINK, _LARGEST = 30_000, 200_000  # characters of a link, and bytes of what it holds
_SOURCE = "the link"


class BrowserMemory:
    """Scripts that store and read a program's data in the browser.

    Parameters
    ----------
    program : str
        Name of the program.
    """

    def __init__(self, program: str) -> None:
        self._page, self._typed, self._designs, self._look = (
            json.dumps(f"{program}-{what}") for what in ("page", "typed", "designs", "look")
        )

    @property
    def recall(self) -> str:
        """Script that returns, as JSON, what was stored, the look, the width, and the link in the address.

        It takes the link out of the address.
        """
        return (
            f"const kept = JSON.parse(sessionStorage.getItem({self._page}) || '{{}}');"
            f"kept.typed = JSON.parse(sessionStorage.getItem({self._typed}) || '{{}}');"
            f"kept.look = localStorage.getItem({self._look}); kept.link = location.hash;"
            "kept.narrow = narrowPage.matches;"
            "if (location.hash) history.replaceState(null, '', location.pathname);"
            "return JSON.stringify(kept);"
        )

    def remember(self, stored: Mapping[str, Any], heard: Mapping[str, Mapping[str, str]]) -> str:
        """Script that stores the content of the page.

        Parameters
        ----------
        stored : mapping
            The content.
        heard : mapping
            Texts of fields that the program has received, by document and path: they need no longer be kept
            as key strokes.
        """
        return (
            f"sessionStorage.setItem({self._page}, {json.dumps(json.dumps(stored))});"
            f"const typed = JSON.parse(sessionStorage.getItem({self._typed}) || '{{}}');"
            f"for (const [document, fields] of Object.entries({json.dumps(heard)}))"
            " for (const [path, text] of Object.entries(fields))"
            " if (typed[document]?.[path] === text) delete typed[document][path];"
            f"sessionStorage.setItem({self._typed}, JSON.stringify(typed));"
        )

    @property
    def forget_typed(self) -> str:
        """Script that forgets the key strokes, for when another design is shown."""
        return f"sessionStorage.removeItem({self._typed});"

    def keep_look(self, look: str) -> str:
        """Script that stores whether the page is light or dark."""
        return f"localStorage.setItem({self._look}, {json.dumps(look)});"

    @property
    def designs(self) -> str:
        """Script that returns the named designs, as JSON."""
        return f"return localStorage.getItem({self._designs});"

    def keep_design(self, name: str, document: str, entries: Mapping[str, str]) -> str:
        """Script that stores a named design, and returns "" or why the browser has no room for it."""
        return self._with_designs(f"all[{json.dumps(name)}] = {json.dumps([document, dict(entries)])};")

    def drop_design(self, name: str) -> str:
        """Script that deletes a named design."""
        return self._with_designs(f"delete all[{json.dumps(name)}];")

    def _with_designs(self, change: str) -> str:
        return (
            f"const all = JSON.parse(localStorage.getItem({self._designs}) || '{{}}'); {change}"
            f"try {{ localStorage.setItem({self._designs}, JSON.stringify(all)); return ''; }}"
            "catch (error) { return 'the browser has no room for it: delete another design'; }"
        )


def named_designs(stored: str | None) -> dict[str, tuple[str, Entries]]:
    """Document and entries of each named design that the browser has stored; malformed ones are left out."""
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
    """Why a design cannot be stored under a name; empty if it can."""
    if not name.strip():
        return "give the design a name"
    if len(name) > _LONGEST:
        return f"give a name of at most {_LONGEST} characters"
    if len(present) >= _MOST and name not in present:
        return f"there are {_MOST} designs already: delete one"
    return ""


def read_typed(typed: Any, entries: Entries, inputs: list[Input]) -> Entries:
    """Entries with the texts that were typed but not yet stored, read as the form reads them."""
    known = {entry.path: entry for entry in inputs}
    found = dict(entries)
    for path, text in typed.items() if isinstance(typed, dict) else ():
        if path in known and isinstance(text, str):
            unit = unit_of(entries.get(path, ""), known[path]) or usual_unit(known[path].quantity.unit)
            found[path] = read_entry(text, known[path], unit).text
    return found


@dataclass(frozen=True)
class LinkedDesign:
    """A design in a link.

    Parameters
    ----------
    document : str
        Name of the kind of file.
    text : str
        The file, as TOML.
    options : mapping
        Entries that are not part of the file.
    """

    document: str
    text: str
    options: Mapping[str, str]

    def as_fragment(self) -> str:
        """The part of an address after "#", of letters, digits, "-", "_" and "=".

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
        """The design in the part of an address after "#".

        Raises
        ------
        ConfigError
            If it holds none; the design itself is not checked.
        """
        packed = fragment.removeprefix("#").removeprefix("design=")
        if len(packed) > _LONGEST_LINK:
            raise ConfigError(_SOURCE, [f"it is longer than {_LONGEST_LINK} characters"])
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
