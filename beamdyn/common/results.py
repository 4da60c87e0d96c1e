"""Base of all results: provenance, and conversion to JSON."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np


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
    """Base of the frozen results: dataclasses whose public fields are the answer."""

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings; complex numbers as [real, imaginary]."""
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return {f.name: plain(getattr(self, f.name)) for f in fields if f.repr}

    def save(self, path: str | Path) -> None:
        """Write the result as JSON; numbers that are not finite are written as null.

        Raises
        ------
        FileExistsError
            If the file exists.
        """
        with open(path, "x", encoding="utf-8") as file:
            file.write(to_json(self.to_dict()))


def to_json(values: dict[str, Any]) -> str:
    """JSON text of a result's dictionary."""
    return json.dumps(_nullified(values), indent=1, allow_nan=False) + "\n"


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
