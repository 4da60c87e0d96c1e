"""Records in JSON that show damage: each has a schema version and a checksum of its content."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

SCHEMA = 1  # raised when older records can no longer be read


class DamagedRecord(ValueError):
    """A record that is damaged, was changed, or is of another schema; the message says which."""


def seal(content: Mapping[str, Any]) -> dict[str, Any]:
    """Add the schema version and a checksum.

    Parameters
    ----------
    content : mapping
        Values of JSON's types, without the keys "schema" and "checksum".

    Returns
    -------
    dict
        To be written as JSON, in any layout.
    """
    versioned = {**content, "schema": SCHEMA}
    return {**versioned, "checksum": _checksum(versioned)}


def unseal(text: str | bytes) -> dict[str, Any]:
    """Read a record.

    Parameters
    ----------
    text : str or bytes
        The JSON text of what `seal` made.

    Returns
    -------
    dict
        The content, as it was given to `seal`.

    Raises
    ------
    DamagedRecord
        If it is not that, to the last digit.
    """
    try:
        record = json.loads(text)
    except (ValueError, RecursionError):
        raise DamagedRecord("it is not valid JSON: damaged, or not whole") from None
    if not isinstance(record, dict) or "checksum" not in record:
        raise DamagedRecord("it has no checksum: an earlier version wrote it, or another program")
    if record.pop("checksum") != _checksum(record):
        raise DamagedRecord("its content does not match its checksum: it was changed after it was written")
    if (schema := record.pop("schema", None)) != SCHEMA:
        raise DamagedRecord(f"it has schema {schema}, and this version reads schema {SCHEMA}")
    return record


def _checksum(content: Mapping[str, Any]) -> str:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()
