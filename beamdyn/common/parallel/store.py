"""A directory of finished parts of a long computation, one file each, named by a hash of the request."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import pickle
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np

_MARKER = "store.json"  # tells a store from a directory with other content
_UNFINISHED = ".part"  # suffix of a file that is still being written
_REMEDY = "name a directory that does not exist yet, or an earlier store"


class Store:
    """A directory of records; each is written in one step and never changed.

    Opening it makes the directory, or checks that it is an earlier store and can be written.

    Parameters
    ----------
    path : str or Path
        The directory; its parents must exist.
    kind : str
        What is stored: a store of another kind is refused.

    Raises
    ------
    ValueError
        If it is a file, holds anything else, or cannot be written.
    """

    def __init__(self, path: str | Path, kind: str) -> None:
        self.path, self.kind = Path(path), kind
        try:
            self._open()
        except OSError as error:
            reason = error.strerror or str(error)
            raise ValueError(f"store = {str(path)!r}: it cannot be written ({reason}); {_REMEDY}") from None

    def _open(self) -> None:
        if self.path.exists() and not self.path.is_dir():
            raise ValueError(f"store = {str(self.path)!r} is a file; {_REMEDY}")
        self.path.mkdir(exist_ok=True)
        content = [p.name for p in self.path.iterdir() if not p.name.endswith(_UNFINISHED)]
        if content and self._marked() != self.kind:
            raise ValueError(
                f"store = {str(self.path)!r} holds something else than a {self.kind} "
                f"({min(content)!r}, for instance); {_REMEDY}"
            )
        self._write(_MARKER, {"kind": self.kind})  # also shows that it can be written

    def _marked(self) -> object:
        return (self._read(_MARKER) or {}).get("kind")

    def read(self, key: str) -> dict[str, Any] | None:
        """The record of a key, None if there is none that can be read."""
        return self._read(f"{key}.json")

    def write(self, key: str, record: Mapping[str, Any]) -> None:
        """Keep a record of JSON's types under a key; floats keep all their digits."""
        self._write(f"{key}.json", record)

    def _read(self, name: str) -> dict[str, Any] | None:
        try:
            record = json.loads((self.path / name).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return record if isinstance(record, dict) else None

    def _write(self, name: str, record: Mapping[str, Any]) -> None:
        """Write aside and rename: a file of this name is whole, whenever the program ends."""
        handle, aside = tempfile.mkstemp(suffix=_UNFINISHED, dir=self.path)
        try:
            with open(handle, "w", encoding="utf-8") as file:
                json.dump(record, file)
                file.flush()
                os.fsync(handle)
            os.replace(aside, self.path / name)
        except BaseException:
            Path(aside).unlink(missing_ok=True)
            raise


# Keys ---------------------------------------------------------------------------------------------


def fingerprint(*values: object) -> str:
    """A hash of values: the same in every process, different if a single bit differs.

    Parameters
    ----------
    *values : object
        Numbers, strings, arrays, containers and dataclasses of them, by content; functions by name
        and code (of what they call and read by name only); anything else by its pickle.

    Returns
    -------
    str
        32 hexadecimal digits.

    Raises
    ------
    ValueError
        If a value cannot be pickled.
    """
    digest = hashlib.sha256()
    for piece in _pieces(values):
        digest.update(len(piece).to_bytes(8, "big") + piece)
    return digest.hexdigest()[:32]


def _pieces(value: Any) -> Iterator[bytes]:
    """A value as a sequence of bytes, different for different values."""
    value = value.item() if isinstance(value, np.generic) else value
    yield f"{type(value).__module__}.{type(value).__qualname__}".encode()
    if isinstance(value, float):
        yield value.hex().encode()
    elif value is None or isinstance(value, int | str | bytes):
        yield repr(value).encode()
    elif isinstance(value, np.ndarray) and value.dtype != object:
        yield f"{value.dtype.str} {value.shape}".encode()
        yield value.tobytes()
    elif isinstance(value, FunctionType):
        yield f"{value.__module__}.{value.__qualname__}".encode()
        yield from _code(value.__code__)
        yield from _pieces((value.__defaults__, value.__kwdefaults__))
    else:
        parts = _parts(value)
        yield str(len(parts)).encode()
        for part in parts:
            yield from _pieces(part)


def _parts(value: Any) -> list[Any]:
    """The items of a container; anything else as its pickle."""
    if isinstance(value, list | tuple):
        return list(value)
    if isinstance(value, dict):
        return [*value, *value.values()]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return [getattr(value, f.name) for f in dataclasses.fields(value)]
    try:
        return [pickle.dumps(value, protocol=4)]
    except Exception as error:  # which one depends on the object
        raise ValueError(f"{value!r} cannot be stored: it cannot be pickled ({error})") from None


def _code(code: CodeType) -> Iterator[bytes]:
    """The code of a function, independent of its place in the file."""
    yield code.co_code
    yield repr(code.co_names).encode()
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield repr(sorted(map(repr, constant)) if isinstance(constant, frozenset) else constant).encode()
