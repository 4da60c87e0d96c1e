"""Bases of results: data with a provenance, which can be shown and saved."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.results.columns import DisplayUnits, InDisplayUnits
from beamdyn.common.results.files import as_path, check_writable, write_text
from beamdyn.common.results.one_line import OneLine, brief, shortened, warned
from beamdyn.common.results.pictures import labelled
from beamdyn.common.results.shown_by import MEDIA
from beamdyn.common.results.snapshots import ReadOnlyArrays, decode, encode, make_read_only, nullified, plain

if TYPE_CHECKING:
    from pandas import DataFrame


# Records with a schema version and a checksum --------------------------------------------------------


SCHEMA = 1  # version of the format of stored results, raised when older records can no longer be read


class DamagedRecord(ValueError):
    """Raised for a record that is damaged, changed, or of another schema; the message says which."""


def seal(content: Mapping[str, Any]) -> dict[str, Any]:
    """Add the schema version and a checksum to a record.

    Parameters
    ----------
    content : mapping
        Values of JSON's types, without the keys "schema" and "checksum".

    Returns
    -------
    dict
        The record, to be written as JSON in any layout.
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
        If the text is not a record as `seal` made it, to the last digit.
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
        Names of cached properties to save with the result once they are computed; numbers and arrays are
        saved in any case.
    """

    kept: ClassVar[tuple[str, ...]] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings; complex numbers as [real, imaginary]."""
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return {f.name: plain(getattr(self, f.name)) for f in fields if f.repr}

    def loadable(self) -> Saved | None:
        """Return the result that `load` makes from this one's JSON; None if it makes none."""
        return self

    def to_json(self) -> str:
        """Return the result as JSON: the numbers of `to_dict` for any program, and all that `load` needs.

        Numbers that are not finite are null, but `load` gets them back.
        """
        values, result = nullified(self.to_dict()), self.loadable()
        record: dict[str, Any] = {}
        if result is not None:  # includes cached values, such as a truncation error
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
            If `path` is neither text nor a path.
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
            raise ValueError(f"{result!r} is none of beamdyn's or brakes' results")
        computed = {key: decode(value) for key, value in content["record"]["computed"].items()}
    except ValueError as error:
        raise ValueError(f"{path}: no result can be loaded: {error}; {remedy}") from None
    for key, value in computed.items():
        object.__setattr__(result, key, value)
    make_read_only(result)
    return result


Units = DisplayUnits | Mapping[str, str] | None
_MOST_PARTS = 6  # largest number of parts of a headline, if a class of results does not choose them


class Shown(OneLine, InDisplayUnits):
    """Base of dataclasses with tables and pictures; a method `plot` of theirs gets the option `label`.

    The tables are made by the views of the class's package: see `beamdyn.common.results.shown_by`.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "plot" in vars(cls):
            cls.plot = labelled(vars(cls)["plot"])  # pyright: ignore[reportAttributeAccessIssue]

    def headline(self) -> Iterable[str]:
        """Yield the parts of the result's one-line summary: main numbers with units, error, and cautions.

        By default, yield the first public fields, and how many warnings there are.
        """
        names = [f.name for f in dataclasses.fields(self) if f.repr]  # pyright: ignore[reportArgumentType]
        names = [name for name in names if name not in ("provenance", "warnings", "message")]
        for name in names[:_MOST_PARTS]:
            value = getattr(self, name)
            text = type(value).__name__ if dataclasses.is_dataclass(value) else brief(value)
            yield f"{name}={shortened(text, 30)}"
        yield warned(getattr(self, "warnings", ()))

    @property
    def plot_label(self) -> str:
        """Name of the result in a picture of several: the label of its scene."""
        return getattr(getattr(self, "scene", None), "label", "")

    def without_waiting(self) -> Any:
        """Return a copy without the parts that would have to be computed first; see `_repr_html_`."""
        return self

    def to_table(self, units: Units = None) -> str:
        """Return the table that the command prints, as text.

        Parameters
        ----------
        units : dict, optional
            Units in which it is shown, such as {"speed": "rpm", "length": "mm"}; see `in_units`.
        """
        return _views().text_of(_shown_in(self, units))

    def to_pandas(self, units: Units = None) -> DataFrame:
        """Return the columns of the CSV file as a data frame of pandas, indexed by what varies (speed).

        Its ``attrs`` hold the class, the label, the warnings and the provenance of the result.

        Parameters
        ----------
        units : dict, optional
            Units of columns, such as {"speed": "rpm", "length": "mm"}; see `in_units`.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        return _views().frame_of(_shown_in(self, units))

    def _repr_html_(self) -> str:
        """Return table and picture for notebooks, without parts that take long to compute."""
        return _views().html_of(self.without_waiting())


def _views() -> Any:
    """Import the module that shows results, named in `MEDIA`, only when it is needed."""
    return import_module(MEDIA[-1])


def _shown_in(result: Shown, units: Units) -> Shown:
    return result if units is None else result.in_units(**vars(DisplayUnits.of(units)))


__all__ = ["Provenance", "Result", "Units", "load", "plain"]


@dataclass(frozen=True)
class Provenance:
    """How a result was computed: version, method, comparison, and time.

    Parameters
    ----------
    version : str
        Version of beamdyn.
    method : str
        The discretization, with its size.
    compared_with : str
        The coarser discretization from which the error was estimated.
    wall_time : float
        Time taken [s].
    """

    version: str
    method: str
    compared_with: str
    wall_time: float

    @classmethod
    def since(cls, start: float, method: str, compared_with: str = "") -> Provenance:
        """Make the provenance of a result whose computation began at a time of `time.perf_counter` [s]."""
        return cls(__version__, method, compared_with, perf_counter() - start)


class Result(Shown, Saved, ReadOnlyArrays):
    """Base of the frozen results: dataclasses whose public fields are the answer.

    All fields, private ones (``field(repr=False)``) too, are data: numbers, strings, arrays, containers and
    dataclasses of them.  Then a result is pickled, saved and loaded; see `beamdyn.common.results.snapshots`.

    A result is one line in a console, a table with a picture in a notebook, and a data frame for whoever asks
    for one.  A subclass gives its `headline`, its `plot` if it has a picture, and an entry in the views of
    its package (see `common.results.shown_by`) with the functions that make its table and the rows of its
    CSV file.  What it does not give is made from its fields, whose units it may state.

    Attributes
    ----------
    field_units : dict of str to str
        For each unit the names of the fields that are in it, separated by spaces.
    """

    field_units: ClassVar[dict[str, str]] = {}
