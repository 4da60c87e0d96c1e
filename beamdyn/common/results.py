"""Base of all results: provenance, conversion to JSON, and back."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from beamdyn.common.files import as_path, check_writable, write_text
from beamdyn.common.records import seal, unseal
from beamdyn.common.snapshots import decode, encode


@dataclass(frozen=True)
class Provenance:
    """How a result was computed.

    Parameters
    ----------
    version : str
        Version of beamdyn.
    method : str
        The discretization, with its size.
    compared_with : str
        The coarser one from which the error was estimated.
    wall_time : float
        Time taken [s].
    """

    version: str
    method: str
    compared_with: str
    wall_time: float


class Result:
    """Base of the frozen results: dataclasses whose public fields are the answer.

    All fields, private ones (``field(repr=False)``) too, are data: numbers, strings, arrays, containers and
    dataclasses of them.  Then a result is pickled, saved and loaded; see `beamdyn.common.snapshots`.
    """

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings; complex numbers as [real, imaginary]."""
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return {f.name: plain(getattr(self, f.name)) for f in fields if f.repr}

    def loadable(self) -> Result | None:
        """The result that `load` makes of this one's JSON; None if it makes none."""
        return self

    def to_json(self) -> str:
        """The result as JSON: the numbers of `to_dict` for any program, and all that `load` needs.

        Numbers that are not finite are null, but `load` gets them back.
        """
        values, result = _nullified(self.to_dict()), self.loadable()
        record = {} if result is None else {"record": _record_of(result)}
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
    """
    file = as_path("path", path)
    try:
        content = unseal(file.read_bytes())
        if "record" in content:
            return _result_from(content["record"])
        reason = "it has numbers only"
    except ValueError as error:
        reason = str(error)
    remedy = "compute the result again; any JSON reader gets its numbers"
    raise ValueError(f"{path}: no result can be loaded: {reason}; {remedy}")


def _record_of(result: Result) -> dict[str, Any]:
    """The fields, and the computed values that the result has kept, such as a modal truncation error."""
    names = {f.name for f in dataclasses.fields(result)}  # pyright: ignore[reportArgumentType]
    kept = {
        key: encode(value) for key, value in vars(result).items() if key not in names and _is_number(value)
    }
    return {"result": encode(result), "computed": kept}


def _result_from(record: Any) -> Result:
    result = decode(record["result"])
    if not isinstance(result, Result):
        raise ValueError(f"{result!r} is none of beamdyn's or brakes'")
    for key, value in record["computed"].items():
        object.__setattr__(result, key, decode(value))
    return result


def _is_number(value: object) -> bool:
    return isinstance(value, bool | int | float | np.generic | np.ndarray)


def plain(value: Any) -> Any:
    """A value as JSON's types, with complex numbers as pairs and numbers that are not finite kept."""
    if isinstance(value, np.ndarray):
        value = np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value
        return value.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value) if f.repr}
    if isinstance(value, tuple | list):
        return [plain(v) for v in value]
    if isinstance(value, dict):
        return {str(key): plain(v) for key, v in value.items()}
    if isinstance(value, complex):
        return [value.real, value.imag]
    return value


def _nullified(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _nullified(v) for key, v in value.items()}
    if isinstance(value, list):
        return [_nullified(v) for v in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
