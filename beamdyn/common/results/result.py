"""Base classes of results, which can be shown, saved and loaded, and state how they were computed."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.results.columns import DisplayUnits, InDisplayUnits
from beamdyn.common.results.files import as_path, check_writable, write_text
from beamdyn.common.results.one_line import OneLine
from beamdyn.common.results.pictures import labelled
from beamdyn.common.results.shown_by import MEDIA
from beamdyn.common.results.snapshots import ReadOnlyArrays, decode, encode, make_read_only, nullified, plain

if TYPE_CHECKING:
    from pandas import DataFrame


# Records with a schema version and a checksum --------------------------------------------------------


SCHEMA = 1  # version of the format of saved results; it changes when older files can no longer be read


class DamagedRecord(ValueError):
    """Raised for a record that was damaged or changed, or has another format; the message says which."""


def seal(content: Mapping[str, Any]) -> dict[str, Any]:
    """Add the version of the format and a checksum to a record.

    Parameters
    ----------
    content : mapping
        Values of JSON's types, without the keys "schema" and "checksum".

    Returns
    -------
    dict
        The record, which may be written as JSON with any line breaks and blanks.
    """
    versioned = {**content, "schema": SCHEMA}
    return {**versioned, "checksum": _checksum(versioned)}


def unseal(text: str | bytes) -> dict[str, Any]:
    """Read a record and verify its checksum.

    Parameters
    ----------
    text : str or bytes
        JSON text of a record made by `seal`.

    Returns
    -------
    dict
        The content that was given to `seal`.

    Raises
    ------
    DamagedRecord
        If the text is not a record made by `seal`, unchanged to the last digit.
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
    """Base of dataclasses that can be saved as JSON and loaded again.

    Attributes
    ----------
    kept : tuple of str
        Names of cached properties that are saved with the result if they have been computed; cached numbers
        and arrays are always saved.
    """

    kept: ClassVar[tuple[str, ...]] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings; complex numbers as [real, imaginary]."""
        return plain(self)

    def loadable(self) -> Saved | None:
        """Return the result that `load` would make from the JSON of this one; None if it cannot be loaded."""
        return self

    def to_json(self) -> str:
        """Return the result as JSON: the numbers of `to_dict` for any program, and all that `load` needs.

        Numbers that are not finite are written as null, but `load` restores them.
        """
        values, result = nullified(self.to_dict()), self.loadable()
        record: dict[str, Any] = {}
        if result is not None:  # `vars` includes cached values, such as a truncation error
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
        """Write the result as a JSON file, which `beamdyn.load` can read; see `to_json`.

        Parameters
        ----------
        path : str or Path
            File to write.
        force : bool
            Overwrite a file that exists.

        Raises
        ------
        ValueError
            If `path` is neither text nor a path.
        FileExistsError
            If the file exists and `force` is not set.
        OSError
            If it cannot be written.
        """
        write_text(check_writable(path, force=force), self.to_json())


def load(path: str | Path) -> Any:
    """Read a result that `Result.save` or the option ``--json`` of a command has written.

    The loaded result has the same class, numbers (to the last bit), scene and provenance as the saved one,
    and the same methods.  Only parts that are not data are missing, and their use raises an error: functions
    and classes defined by the user (a motion, a discretization, an integrator), and the interpolation by
    `solve_ivp`.  Pickling keeps these as well.

    Parameters
    ----------
    path : str or Path
        JSON file of a saved result.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        If `path` is neither text nor a path, or the file is damaged, was changed, holds no result, or was
        written by a version whose results had other fields.
    OSError
        If the file cannot be read.

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
    remedy = "compute the result again; any program that reads JSON can read its numbers"
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
            raise ValueError(f"{result!r} is none of beamdyn's or brakes' results")
        computed = {key: decode(value) for key, value in content["record"]["computed"].items()}
    except ValueError as error:
        raise ValueError(f"{path}: no result can be loaded: {error}; {remedy}") from None
    for key, value in computed.items():
        object.__setattr__(result, key, value)
    make_read_only(result)
    return result


Units = DisplayUnits | Mapping[str, str] | None


class Shown(OneLine, InDisplayUnits):
    """Base of dataclasses with tables and pictures; a method `plot` of a subclass gets the option `label`.

    The tables are made by the module that is registered for the package of the class: see
    `beamdyn.common.results.shown_by`.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "plot" in vars(cls):
            cls.plot = labelled(vars(cls)["plot"])  # pyright: ignore[reportAttributeAccessIssue]

    @property
    def plot_label(self) -> str:
        """Return the name of the result in a plot of several results: the label of its scene."""
        return getattr(getattr(self, "scene", None), "label", "")

    def without_waiting(self) -> Any:
        """Return a copy to display at once: parts that take long and are not computed yet are omitted."""
        return self

    def to_table(self, units: Units = None) -> str:
        """Return the table that the command of the analysis prints, as text.

        Parameters
        ----------
        units : dict, optional
            Display units, such as {"speed": "rpm", "length": "mm"}; see `in_units`.
        """
        return _views().text_of(_shown_in(self, units))

    def to_pandas(self, units: Units = None) -> DataFrame:
        """Return the columns of the CSV file as a pandas data frame; the index is the varied quantity.

        The ``attrs`` of the data frame hold the class, the label, the warnings and the provenance of the
        result.

        Parameters
        ----------
        units : dict, optional
            Display units of the columns, such as {"speed": "rpm", "length": "mm"}; see `in_units`.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        return _views().frame_of(_shown_in(self, units))

    def _repr_html_(self) -> str:
        """Return table and picture for notebooks, without parts whose computation takes long."""
        return _views().html_of(self.without_waiting())


def _views() -> Any:
    """Import the module that shows results, which `MEDIA` names, when it is first needed."""
    return import_module(MEDIA[-1])


def _shown_in(result: Shown, units: Units) -> Shown:
    return result if units is None else result.in_units(**vars(DisplayUnits.of(units)))


__all__ = ["Provenance", "Result", "Units", "load", "plain"]


@dataclass(frozen=True)
class Provenance:
    """How a result was computed: version, discretization, and computing time.

    Parameters
    ----------
    version : str
        Version of beamdyn.
    method : str
        The discretization, with its size.
    compared_with : str
        The coarser discretization from which the error was estimated.
    wall_time : float
        Computing time [s].
    """

    version: str
    method: str
    compared_with: str
    wall_time: float

    @classmethod
    def since(cls, start: float, method: str, compared_with: str = "") -> Provenance:
        """Make the record of a computation that began at `start`, a value of `time.perf_counter` [s]."""
        return cls(__version__, method, compared_with, perf_counter() - start)


class Result(Shown, Saved, ReadOnlyArrays):
    """Base of immutable results: dataclasses whose public fields are the computed quantities.

    All fields, including private ones (``field(repr=False)``), are data: numbers, strings, arrays, containers
    and dataclasses of them.  Therefore a result can be pickled, saved and loaded; see
    `beamdyn.common.results.snapshots`.

    A result is shown as one line in a console, and as a table with a picture in a notebook; it can be
    converted to a data frame.  A subclass defines `headline`, `plot` if it has a picture, and an entry in the
    views of its package (see `common.results.shown_by`) with the functions that make its table and the rows
    of its CSV file.  Defaults for these are made from the fields of the result, with the units in
    `field_units`.

    Attributes
    ----------
    field_units : dict of str to str
        For each unit, the names of the fields with this unit, separated by spaces.
    """

    field_units: ClassVar[dict[str, str]] = {}
