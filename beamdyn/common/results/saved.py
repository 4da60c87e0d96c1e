"""Results in files: JSON that shows damage, with all that makes the result again."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.results.files import as_path, check_writable, write_text
from beamdyn.common.results.read_only import make_read_only
from beamdyn.common.results.snapshots import decode, encode, nullified, plain

# Records with a schema version and a checksum --------------------------------------------------------


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


# Results ---------------------------------------------------------------------------------------------


class Saved:
    """Base of dataclasses that are written as JSON, and loaded.

    Attributes
    ----------
    kept : tuple of str
        What is computed when asked for, and saved with the result once it is; numbers are anyway.
    """

    kept: ClassVar[tuple[str, ...]] = ()

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings; complex numbers as [real, imaginary]."""
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return {f.name: plain(getattr(self, f.name)) for f in fields if f.repr}

    def loadable(self) -> Saved | None:
        """The result that `load` makes of this one's JSON; None if it makes none."""
        return self

    def to_json(self) -> str:
        """The result as JSON: the numbers of `to_dict` for any program, and all that `load` needs.

        Numbers that are not finite are null, but `load` gets them back.
        """
        values, result = nullified(self.to_dict()), self.loadable()
        record: dict[str, Any] = {}
        if result is not None:  # also what it has computed and kept, such as a truncation error
            names = {f.name for f in dataclasses.fields(result)}  # pyright: ignore[reportArgumentType]
            computed = {key: value for key, value in vars(result).items() if key not in names}
            kept = {
                key: encode(value)
                for key, value in computed.items()
                if isinstance(value, bool | int | float | np.generic | np.ndarray) or key in result.kept
            }
            record = {"record": {"result": encode(result), "computed": kept}}
        return json.dumps(seal(values | record), indent=1, allow_nan=False) + "\n"

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write the result as JSON, from which `beamdyn.load` makes it again; see `to_json`.

        Parameters
        ----------
        path : str or Path
            File to write.
        force : bool
            Overwrite a file that exists.

        Raises
        ------
        ValueError
            If the path is none.
        FileExistsError
            If the file exists and `force` is not set.
        OSError
            If it cannot be written.
        """
        write_text(check_writable(path, force=force), self.to_json())


def load(path: str | Path) -> Any:
    """Read a result that `Result.save` or the option ``--json`` of a command has written.

    It has the class, the numbers (to the bit), the scene and the provenance of the one that was written, and
    does what that one does.  Only what is no data is missing, and an error says so where it is used:
    functions and classes of the user's own (of a motion, a discretization, an integrator), and the
    interpolation by `solve_ivp`.  A pickle keeps these as well.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        If the path is none, or the file is damaged, was changed, holds no result, or was written by a
        version whose results had other fields.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> modes = bd.natural_modes(bd.Scene(strip), modes=1)
    >>> file = Path(mkdtemp()) / "modes.json"
    >>> _ = modes.save(file)
    >>> bool((bd.load(file).frequency == modes.frequency).all())
    True
    """
    file = as_path("path", path)
    remedy = "compute the result again; any JSON reader gets its numbers"
    try:
        text = file.read_bytes()
    except OSError as error:
        reason = "there is no such file" if isinstance(error, FileNotFoundError) else error.strerror
        remedy = "give one that save or --json has written"
        raise type(error)(f"{file}: no result can be loaded: {reason}; {remedy}") from None
    try:
        content = unseal(text)
        if "record" not in content:
            raise ValueError("it has numbers only")
        result = decode(content["record"]["result"])
        if not isinstance(result, Saved):
            raise ValueError(f"{result!r} is none of beamdyn's or brakes'")
        computed = {key: decode(value) for key, value in content["record"]["computed"].items()}
    except ValueError as error:
        raise ValueError(f"{path}: no result can be loaded: {error}; {remedy}") from None
    for key, value in computed.items():
        object.__setattr__(result, key, value)
    make_read_only(result)
    return result
