"""A design in the address of the page: the text of its file, compressed; nothing in it is executed."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from beamdyn.common.edge.config import ConfigError

_LONGEST = 30_000  # characters of a link
_LARGEST = 200_000  # bytes of what it holds
_SOURCE = "the link"


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
        if len(packed) > _LONGEST or len(held.encode()) > _LARGEST:
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
        if len(packed) > _LONGEST:
            raise ConfigError(_SOURCE, [f"it is longer than {_LONGEST} characters"])
        held = _unpacked(packed)
        match held:
            case [str(document), str(text), dict(options)] if _is_text(options):
                return cls(document, text, options)
        raise _broken()


def _unpacked(packed: str) -> Any:
    try:
        raw = base64.b64decode(packed + "=" * (-len(packed) % 4), altchars=b"-_", validate=True)
        unpack = zlib.decompressobj()
        text = unpack.decompress(raw, _LARGEST)
        if unpack.unconsumed_tail or not unpack.eof:
            raise _broken()
        return json.loads(text)
    except (ValueError, zlib.error, RecursionError):
        raise _broken() from None


def _broken() -> ConfigError:
    return ConfigError(_SOURCE, ["it holds no design, or a part of it is missing: copy it again, whole"])


def _is_text(options: dict[Any, Any]) -> bool:
    return all(isinstance(value, str) for value in options.values())
