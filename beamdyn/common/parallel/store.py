"""A store of finished parts of a long computation: a folder of files named by hashes of the requests."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import pickle
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np

from beamdyn.common.results.files import ASIDE, write_text
from beamdyn.common.results.result import DamagedRecord, seal, unseal

# Packages whose classes have fields that equality leaves out and that change no result.
_PACKAGES = ("beamdyn", "brakes")
_MARKER = "store.json"  # file that tells a store from a folder with other content
_RECORD = re.compile(r"[0-9a-f]{32}\.json")  # name of the file of a record: see `fingerprint`
_REMEDY = "name a folder that does not exist yet, or an earlier store"


class Store:
    """A folder of records; each is written in one step, sealed by a checksum, and never changed.

    Opening it makes the folder, or checks that it is an earlier store and can be written.

    Parameters
    ----------
    path : str or Path
        The folder; its parents must exist.
    kind : str
        Kind of results: a store of another kind is refused.

    Raises
    ------
    ValueError
        If `path` is a file, holds anything else, or cannot be written.
    """

    def __init__(self, path: str | Path, kind: str) -> None:
        self.path, self.kind = Path(path), kind
        try:
            if self.path.exists() and not self.path.is_dir():
                raise ValueError(f"store = {str(self.path)!r} is a file; {_REMEDY}")
            self.path.mkdir(exist_ok=True)
            content = [p.name for p in self.path.iterdir() if not p.name.startswith(ASIDE)]
            if content and self._marked(content) != self.kind:
                raise ValueError(
                    f"store = {str(self.path)!r} holds something else than a {self.kind} "
                    f"({min(content)!r}, for instance); {_REMEDY}"
                )
            write_text(self.path / _MARKER, json.dumps({"kind": self.kind}))
        except OSError as error:
            reason = error.strerror or str(error)
            raise ValueError(f"store = {str(path)!r}: it cannot be written ({reason}); {_REMEDY}") from None

    def _marked(self, content: Sequence[str]) -> object:
        """Return the kind of results that the folder's marker file names.

        If that file is damaged, return this store's kind if all other files are records, else None.
        """
        try:
            return json.loads((self.path / _MARKER).read_bytes())["kind"]
        except (OSError, ValueError, LookupError, TypeError):
            records = [name for name in content if name != _MARKER]
            return self.kind if records and all(map(_RECORD.fullmatch, records)) else None

    def file(self, key: str) -> Path:
        """Return the path of the record with a key."""
        return self.path / f"{key}.json"

    def read(self, key: str) -> dict[str, Any] | None:
        """Read the record with a key; None if there is none.

        Raises
        ------
        DamagedRecord
            If the record is not as it was written.
        """
        try:
            text = self.file(key).read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise DamagedRecord(f"it cannot be read ({error.strerror})") from None
        record = unseal(text)
        if record.pop("key", None) != key:
            raise DamagedRecord("it is the record of another key: its file was renamed")
        return record

    def write(self, key: str, record: Mapping[str, Any]) -> None:
        """Store a record of JSON's types under a key; floats keep all their digits."""
        write_text(self.file(key), json.dumps(seal({**record, "key": key})))


# Keys ---------------------------------------------------------------------------------------------


def fingerprint(*values: object) -> str:
    """Compute a hash of values, the same in every process, and different if a single bit differs.

    Parameters
    ----------
    *values : object
        Numbers, strings, arrays, containers and dataclasses of them count by content, functions by name and
        code, anything else by its pickle.  In this package's dataclasses, fields that equality leaves out,
        such as a label, do not count; what a function calls and reads counts by its name alone.

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
    """Yield a value as bytes, which are different for different values."""
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
    """Return the items of a container; for anything else its pickle."""
    if isinstance(value, list | tuple):
        return list(value)
    if isinstance(value, dict):
        return [*value, *value.values()]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        ours = type(value).__module__.partition(".")[0] in _PACKAGES
        return [getattr(value, f.name) for f in dataclasses.fields(value) if f.compare or not ours]
    try:
        return [pickle.dumps(value, protocol=4)]
    except Exception as error:  # the kind of exception depends on the object
        raise ValueError(f"{value!r} cannot be stored: it cannot be pickled ({error})") from None


def _code(code: CodeType) -> Iterator[bytes]:
    """Yield the code of a function as bytes, independent of its place in the file."""
    yield code.co_code
    yield repr(code.co_names).encode()
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield repr(sorted(map(repr, constant)) if isinstance(constant, frozenset) else constant).encode()
