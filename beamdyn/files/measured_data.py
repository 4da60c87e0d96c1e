"""Reading of measured values from CSV tables with units and from files of other programs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from os import PathLike

import numpy as np

from beamdyn.common.edge.data_text import (
    CsvColumn,
    CsvTable,
    DataText,
    number_at,
    plain_name,
    read_csv,
    read_data,
)
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.inputs.checks import InvalidValue, real_array
from beamdyn.common.results.files import as_path
from beamdyn.files.measured_curve_files import Frequency, reader_of
from beamdyn.files.program_tables import UNIVERSAL, as_table, universal_table
from beamdyn.scene.measured_curves import MeasuredCurves
from beamdyn.scene.measured_frequencies import MeasuredFrequencies

_MOST_SPEED = 1e5  # highest accepted speed [rad/s], 10^6 rpm: a higher one must have a wrong unit
_MOST = 40  # largest number of frequency columns
_SPEED, _OF_ALL = "speed", "uncertainty"
_KNOWN = {_SPEED: Quantity("rad/s", least=-_MOST_SPEED, most=_MOST_SPEED)}


_FREQUENCY = _SPREAD = Frequency("Hz", above=0.0)
_STEMS = ("frequency", "f", "mode", "flap", "edge", "lag", "chord", "bending", "torsion")
_SET_LIST = re.compile(r"\s*SET\s+TIME/FREQ\s+LOAD STEP\s+SUBSTEP\s+CUMULATIVE", re.IGNORECASE)
_SET = re.compile(r"\s*(\d+)\s+(\S+)\s+(\d+)\s+(\d+)\s+(\d+)\s*")


def read_measurements(
    path: str | PathLike[str],
    speeds: Sequence[float] | np.ndarray | None = None,
    columns: Mapping[str, str] | None = None,
) -> MeasuredFrequencies | MeasuredCurves:
    """Read measured values from a file of a laboratory or of another program.

    A CSV file has a line of column headings with units, which determine its kind: natural frequencies over
    speed ("speed [rpm], frequency 1 [Hz], torsion 1 [Hz], uncertainty [Hz]"), histories ("time [s], tip
    [mm]"), peaks over speed ("speed [rad/s], from [s], to [s], largest tip [mm]"), loads along the span
    ("position [m], moment [N m]"), a frequency response ("frequency [Hz], tip by tip force [mm/N], phase
    [deg]") or mode shapes ("position [mm], shape at 62.1 Hz").  Lists of modes and of variables of ANSYS
    (SET,LIST and PRVAR), output files of FAST and universal files (dataset 58, by pyuff) are read without
    changes.

    Parameters
    ----------
    path : str or path-like
        The file.
    speeds : sequence of float, optional
        Speeds [rad/s] of the rows, if a file of frequencies has none; or the single speed of loads, mode
        shapes or a response.  By default a single row and mode shapes are at rest, and loads and responses at
        the final speed of the scene's motion.
    columns : mapping of str to str, optional
        Heading of the file's column for each heading that this function knows: {"tip": "TipDxb1"}, with a
        unit if the file has none: {"tip by tip force [mm/N]": "UY_2"}.

    Returns
    -------
    MeasuredFrequencies (of natural frequencies or mode shapes), MeasuredHistory, MeasuredPeaks, MeasuredLoads
    or MeasuredResponse

    Raises
    ------
    ValueError
        At the first mistake; the message names file, line, and what was expected.

    References
    ----------
    The lists of ANSYS: Mechanical APDL Structural Analysis Guide, section 3.5.3; PRVAR: Command Reference.

    Examples
    --------
    >>> data = bd.read_measurements("examples/lee_yoo_table_2.csv")
    >>> data.frequency[:, 0]
    array([65.23 , 61.963, 50.907])
    """
    file = as_path("path", path, "a file")
    universal = file.suffix.lower() in UNIVERSAL and file.exists()
    return measurements_of(universal_table(file) if universal else read_data(file), speeds, columns)


def measurements_of(
    text: DataText,
    speeds: Sequence[float] | np.ndarray | None = None,
    columns: Mapping[str, str] | None = None,
) -> MeasuredFrequencies | MeasuredCurves:
    """Read measured values from the text of a file; speeds and columns are as for `read_measurements`."""
    given = None if speeds is None else real_array("speeds", speeds)
    head = next((k for k, line in enumerate(text.lines, 1) if _SET_LIST.match(line)), 0)
    if not head:
        text = as_table(text, _checked(columns))
        if (reader := reader_of(text)) is not None:
            return reader(text, half_unit, _one_speed(given))
    rows, written, labels, own, unit = _from_list(text, head) if head else _from_csv(text)
    at = _speeds(text, own.get(_SPEED), given, len(rows))
    spread = own.get(_OF_ALL, np.full(rows.shape, np.nan))
    halves = _half_digits(written, rows)
    return MeasuredFrequencies(rows, at, spread, halves, labels, source=text.path.name, speed_unit=unit)


def _checked(columns: Mapping[str, str] | None) -> Mapping[str, str]:
    """Return `columns`, or {} for None; raise an error unless it is a dictionary of texts."""
    if columns is None:
        return {}
    texts = isinstance(columns, Mapping) and all(
        isinstance(each, str) for each in (*columns, *columns.values())
    )
    if not texts:
        raise InvalidValue("columns", columns, "give a dictionary of texts", 'such as {"tip [mm]": "UY_2"}')
    return columns


def _one_speed(speeds: np.ndarray | None) -> float | None:
    """Return the single speed of loads, mode shapes or a response [rad/s]; None if none is given."""
    if speeds is not None and len(speeds) != 1:
        raise InvalidValue("speeds", speeds.tolist(), "curves of this kind are at one speed", "give one")
    return None if speeds is None else float(speeds[0])


_Read = tuple[np.ndarray, list[list[str]], tuple[str, ...], Mapping[str, np.ndarray], str]


def _speeds(text: DataText, own: np.ndarray | None, given: np.ndarray | None, count: int) -> np.ndarray:
    """Return the speeds of the rows: `own` from the file, else `given` by the caller, else 0 for one row."""
    if own is not None:
        if given is not None:
            raise InvalidValue(
                "speeds", given.tolist(), "the file has speeds of its own", "leave it out", "rad/s"
            )
        return own
    if given is None and count == 1:
        return np.zeros(1)
    if given is None or len(given) != count:
        found = "none" if given is None else str(len(given))
        said = f"expected a column 'speed [rpm]' or {count} speeds given with the file, found {found}"
        raise text.refusal(1, said)
    return given


def _half_digits(written: list[list[str]], values: np.ndarray) -> np.ndarray:
    """Compute half a unit of the last digit of each cell, in the unit of `values` (rows, columns)."""
    numbers = [[half_unit(cell) for cell in row] for row in written]
    sizes = [[abs(float(_plain(cell))) if cell else 1.0 for cell in row] for row in written]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.nan_to_num(np.array(numbers) * values / np.array(sizes))


def _plain(cell: str) -> str:
    return re.sub(r"[dDqQ]", "e", cell)


def half_unit(cell: str) -> float:
    """Compute half a unit of the last digit of a number as written; 0 for an empty cell."""
    if not cell:
        return 0.0
    mantissa, _, exponent = _plain(cell).lower().partition("e")
    return 0.5 * 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


# CSV ----------------------------------------------------------------------------------------------


def _from_csv(text: DataText) -> _Read:
    known, names = _KNOWN | {_OF_ALL: _SPREAD}, {plain_name(name): name for name in (_SPEED, "uncertainty")}
    names |= {"omega": _SPEED, "rotationspeed": _SPEED, "uncertainties": _OF_ALL}
    for stem, k in product(_STEMS, ("", *map(str, range(1, _MOST + 1)))):
        name = f"{stem} {k}".rstrip()
        known[name], names[plain_name(name)] = _FREQUENCY, name
        if k:
            of_one = f"{_OF_ALL} {k}"
            known[of_one], names[plain_name(of_one)] = _SPREAD, of_one
    table = read_csv(text, known, names, [name for name in known if name != _SPEED], least_rows=1)
    _check_columns(table)
    return _as_rows(table)


def _check_columns(table: CsvTable) -> None:
    """Raise an error for unknown columns, and for a table without frequencies."""
    if unknown := next((column.head for column in table.columns if not column.name), ""):
        known = "speed [rpm], frequency 1 [Hz], flap 1 [Hz], torsion 1 [Hz], uncertainty [Hz]"
        raise table.text.refusal(table.head_line, f"unknown column '{unknown}'; known are {known}")
    if not [*_of_frequency(table)]:
        found = ", ".join(column.head for column in table.columns)
        said = f"expected a column such as 'frequency 1 [Hz]'; the headings are {found}"
        raise table.text.refusal(table.head_line, said)


def _of_frequency(table: CsvTable) -> Iterator[CsvColumn]:
    """Yield the columns that contain frequencies."""
    yield from (c for c in table.columns if c.name != _SPEED and not c.name.startswith(_OF_ALL))


def _as_rows(table: CsvTable) -> _Read:
    """Return frequencies, cells, labels and further data, one row per speed, and the unit of speeds."""
    columns, named = [*_of_frequency(table)], table.named()
    rows, written = (
        np.array([c.values for c in columns]).T,
        [[*row] for row in zip(*(c.written for c in columns), strict=True)],
    )
    spread, own = np.full(rows.shape, np.nan), {}
    for k, column in enumerate(columns):
        of_one = named.get(f"{_OF_ALL} {column.name.rpartition(' ')[2]}", named.get(_OF_ALL))
        if of_one is not None:
            spread[:, k] = of_one.values
    labels = tuple(column.head for column in columns)
    # A column of frequencies without speeds is a list of modes at one speed.
    if len(columns) == 1 and len(rows) > 1 and _SPEED not in named:
        labels = tuple(f"{columns[0].head} {k}" for k in range(1, len(rows) + 1))
        rows, written, spread = rows.T, [[row[0] for row in written]], spread.T
    if _SPEED in named:
        own[_SPEED] = np.array(named[_SPEED].values)
    unit = named[_SPEED].unit if _SPEED in named else ""
    return rows, written, labels, own | {_OF_ALL: spread}, unit


# Lists of modes of ANSYS --------------------------------------------------------------------------


def _from_list(text: DataText, head: int) -> _Read:
    """Read the frequencies of each load step in a list of ANSYS, below its headings."""
    steps: dict[int, list[tuple[float, str]]] = {}
    for line in range(head + 1, len(text.lines) + 1):
        match = _SET.fullmatch(text.lines[line - 1])
        if match is None:
            if steps and text.lines[line - 1].strip():
                break
            continue
        value = number_at(text, line, match[2], "TIME/FREQ")
        if value <= 0:
            said = f"expected a frequency above 0, found {match[2]}; leave out rigid-body modes"
            raise text.refusal(line, said)
        steps.setdefault(int(match[3]), []).append((value, match[2]))
    if not steps:
        raise text.lacking("expected a line for each mode below SET TIME/FREQ LOAD STEP SUBSTEP CUMULATIVE")
    width = max(map(len, steps.values()))
    rows, written = np.full((len(steps), width), np.nan), [[""] * width for _ in steps]
    for i, modes in enumerate(steps.values()):
        rows[i, : len(modes)] = [value for value, _ in modes]
        written[i][: len(modes)] = [cell for _, cell in modes]
    return rows, written, tuple(f"set {k}" for k in range(1, width + 1)), {}, ""
