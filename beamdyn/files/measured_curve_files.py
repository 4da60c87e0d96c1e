"""Reading of measured time histories, peaks, loads along the span, responses and mode shapes.

In functions that read a text, `half` computes the rounding error of a number as written (see `Half`), and
`speed` is the rotational speed [rad/s] that the user has given, or None.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from beamdyn.common.edge.data_text import CsvColumn, CsvTable, DataText, check_places, plain_name, read_csv
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.files.program_tables import head_line
from beamdyn.linear.inputs_outputs import as_excitation, as_observation
from beamdyn.scene.measured_curves import (
    MeasuredCurves,
    MeasuredHistory,
    MeasuredLoads,
    MeasuredPeaks,
    MeasuredResponse,
)
from beamdyn.scene.measured_frequencies import MeasuredFrequencies

_SPREAD = "uncertainty"
_SPEED = {"speed": Quantity("rad/s")}
_SHAPE = re.compile(r"\s*(?:mode )?shape at ([\d.eE+-]+ *[\w/]+)\s*(?=[,;\t]|$)", re.IGNORECASE)
_OTHER_SHAPE = re.compile(r"\b(?:mode )?shape\b[^,;\t]*", re.IGNORECASE)
_RESPONSE = re.compile(r"\s*(.+?) (?:by|per) (.+?)\s*")
_MOST = 40  # largest number of mode shapes in a file
_REMEDY = 'rename your columns, as in --columns "{name} = {head}"'

Half = Callable[[str], float]  # a function that returns half a unit of the last digit of a number as written


class Frequency(Quantity):
    """A frequency in Hz, which may also be given as an angular frequency in rad/s."""

    def convert(self, given: object) -> float:
        """Convert a number with a unit to a frequency [Hz]."""
        if isinstance(given, str) and given.rstrip().endswith("rad/s"):
            return quantity(given, "rad/s") / (2 * math.pi)
        return super().convert(given)


def reader_of(text: DataText) -> Callable[..., MeasuredCurves | MeasuredFrequencies] | None:
    """Return the function that reads the curves in a text, by its column headings; None if there are none."""
    line = text.lines[head_line(text) - 1].lower()
    heads = {plain_name(re.sub(r"[\[(].*", "", cell)) for cell in re.split(r"[,;\t]", line)}
    if "time" in heads:
        return read_history
    if heads & set(map(plain_name, MeasuredPeaks.units)):
        return read_peaks
    if heads & {"position", "x"}:
        return read_shapes if "shape" in line else read_loads
    return read_response if "frequency" in heads and re.search(r" by ", line) else None


def read_history(text: DataText, half: Half, speed: float | None) -> MeasuredHistory:
    """Read time histories: a column of times, and at least one column such as "tip" or "root moment"."""
    if speed is not None:
        bound = "measured histories need no speed: the speed is that of the scene's motion"
        raise InvalidValue("speeds", speed, bound, "leave it out", "rad/s")
    table, columns = _read(text, MeasuredHistory)
    _check_ascending(table, "time", "s")
    return MeasuredHistory(table.named()["time"].values, **_values(table, columns, half))


def read_peaks(text: DataText, half: Half, speed: float | None) -> MeasuredPeaks:
    """Read peaks over speed: "speed [rad/s], from [s], to [s], largest tip [mm]"."""
    if speed is not None:
        raise InvalidValue("speeds", speed, "the file has speeds of its own", "leave it out", "rad/s")
    table, columns = _read(text, MeasuredPeaks, 1, "from", "to")
    _check_ascending(table, "speed", "rad/s")
    window = [_only(table, name, "the window") for name in ("from", "to")]
    if window[0] >= window[1]:
        raise text.refusal(table.lines[0], "expected a window that ends after it begins, found from >= to")
    return MeasuredPeaks(table.named()["speed"].values, window=window, **_values(table, columns, half))


def _check_ascending(table: CsvTable, name: str, unit: str) -> None:
    """Raise an error, with the line number, if a value [unit] is not greater than the one before."""
    values = table.named()[name].values
    if later := next((k for k in range(1, len(values)) if values[k] <= values[k - 1]), 0):
        found = f"{name} = {values[later]:g} {unit} follows {values[later - 1]:g} {unit}"
        raise table.text.refusal(table.lines[later], f"{found}; expected values that ascend")


def _only(table: CsvTable, name: str, what: str) -> float:
    """Return the only value of a column [SI unit]; raise an error if its values differ."""
    values = table.named()[name].values
    if other := next((k for k, value in enumerate(values) if value != values[0]), 0):
        raise table.text.refusal(
            table.lines[other], f"expected {what} to be the same in all lines, found another {name}"
        )
    return values[0]


def _speed(table: CsvTable, given: float | None) -> float | None:
    """Return the speed in the file [rad/s]; if the file has none, return the given speed or None."""
    if "speed" not in table.named():
        return given
    if given is not None:
        raise InvalidValue("speeds", given, "the file has a speed of its own", "leave it out", "rad/s")
    return _only(table, "speed", "one speed")


def read_loads(text: DataText, half: Half, speed: float | None) -> MeasuredLoads:
    """Read loads along the span: a column of positions, and at least one column such as "moment"."""
    table, columns = _read(text, MeasuredLoads)
    check_places(table, "position")
    at = _speed(table, speed)
    return MeasuredLoads(table.named()["position"].values, speed=at, **_values(table, columns, half))


def _read(
    text: DataText,
    kind: type[MeasuredHistory | MeasuredLoads | MeasuredPeaks],
    least_rows: int = 2,
    *times: str,
) -> tuple[CsvTable, list[CsvColumn]]:
    """Read a table of one kind of data, and its columns of values; `times` names further columns of times."""
    along, unit = kind.along
    known = {along: Quantity(unit, least=0.0)} | {name: Quantity("s", least=0.0) for name in times}
    known |= _SPEED if kind is MeasuredLoads else {}
    known |= {name: Quantity(unit) for name, unit in kind.units.items()}
    known |= {f"{name} {_SPREAD}": Quantity(unit, above=0.0) for name, unit in kind.units.items()}
    names = {plain_name(name): name for name in known} | ({"x": along} if along == "position" else {})
    table = read_csv(text, known, names, least_rows=least_rows)
    columns = [column for column in table.columns if column.name in kind.units]
    if not columns:
        others = [column.head for column in table.columns if not column.name]
        remedy = _REMEDY.format(name=next(iter(kind.units)), head=others[0] if others else "Head")
        said = f"expected a column such as {', '.join(kind.units)}; headings: {', '.join(others)}; {remedy}"
        raise text.refusal(table.head_line, said)
    return table, columns


def _values(table: CsvTable, columns: list[CsvColumn], half: Half) -> dict[str, Any]:
    """Return the constructor arguments that all classes of measured data have."""
    values, named = np.array([column.values for column in columns]).T, table.named()
    none = np.full(len(values), np.nan)
    spreads = [named.get(f"{column.name} {_SPREAD}") for column in columns]
    return {
        "value": values,
        "names": [column.name for column in columns],
        "uncertainty": np.array([none if each is None else each.values for each in spreads]).T,
        "rounding": np.array([[*map(half, c.written)] for c in columns]).T * [_size(c) for c in columns],
        "source": table.text.path.name,
    }


def _size(column: CsvColumn) -> float:
    """Return the size of a column's unit in SI units."""
    si = (MeasuredHistory.units | MeasuredPeaks.units | MeasuredLoads.units)[column.name]
    return quantity(f"1 {column.unit}", si) if si else 1.0


# Responses ----------------------------------------------------------------------------------------


def read_response(text: DataText, half: Half, speed: float | None) -> MeasuredResponse:
    """Read a frequency response with headings such as "frequency [Hz], tip by tip force [mm/N], phase [deg]".

    "tip by tip force" is the amplitude of an output, the tip deflection, divided by that of an input, the tip
    force.  The column of phases is optional.
    """
    known = {"frequency": Frequency("Hz", least=0.0), "phase": Quantity("rad")} | _SPEED
    table = read_csv(text, known, {name: name for name in known})
    others = [column for column in table.columns if not column.name]
    if len(others) != 1:
        said = f"expected one column such as 'tip by tip force [mm/N]', found {len(others)}"
        raise text.refusal(table.head_line, said)
    (column,), named = others, table.named()
    size, output, input = _response_head(table, column)
    _check_response(table, column)
    return MeasuredResponse(
        named["frequency"].values,
        size * np.array(column.values),
        named["phase"].values if "phase" in named else None,
        output,
        input,
        _speed(table, speed),
        rounding=size * np.array([*map(half, column.written)]),
        source=text.path.name,
    )


def _check_response(table: CsvTable, column: CsvColumn) -> None:
    """Raise an error, with the line number, if frequencies do not ascend or an amplitude is below 0."""
    _check_ascending(table, "frequency", "Hz")
    if (below := next((k for k, value in enumerate(column.values) if value < 0), None)) is not None:
        found = f"{column.head} = {column.values[below]:g}"
        said = f"{found}: an amplitude is 0 or more; put its sign into the phase"
        raise table.text.refusal(table.lines[below], said)


def _response_head(table: CsvTable, column: CsvColumn) -> tuple[float, str, str]:
    """Return the SI unit of a response, and the names of its output and input."""
    said = f"expected a heading such as 'tip by tip force [mm/N]', found '{column.head}'"
    if (match := _RESPONSE.fullmatch(column.head)) is None:
        raise table.text.refusal(table.head_line, said)
    try:
        seen, drive = as_observation("output", match[1]), as_excitation("input", match[2])
    except ValueError as error:
        raise table.text.refusal(table.head_line, f"{said}: {error}") from None
    for sign in re.finditer(r"/| per ", column.unit):  # positions at which the unit of the input may begin
        above, below = (
            part.strip(" ()") for part in (column.unit[: sign.start()], column.unit[sign.end() :])
        )
        try:
            size = quantity(f"1 {above}", seen.unit) if seen.unit else _plain_unit(above)
            return size / quantity(f"1 {below}", drive.unit), match[1], match[2]
        except (InvalidInput, ValueError):
            continue
    expected = f"expected a unit like [{seen.unit or '1'} per {drive.unit}] for {column.head}"
    raise table.text.refusal(table.head_line, f"{expected}, found [{column.unit}]")


def _plain_unit(unit: str) -> float:
    """Return the size of a dimensionless unit: 1 for "" and "-", else the positive number that is given.

    A ValueError is raised for any other text.
    """
    size = 1.0 if unit in ("", "-") else float(unit)
    if not 0 < size < math.inf:
        raise ValueError(unit)
    return size


# Mode shapes --------------------------------------------------------------------------------------


def read_shapes(text: DataText, half: Half, speed: float | None) -> MeasuredFrequencies:
    """Read mode shapes: a column of positions, and a column per mode, such as "shape at 62.1 Hz"."""
    line = head_line(text)
    given = _SHAPE.findall(text.lines[line - 1])
    if len(given) > _MOST:
        raise text.refusal(line, f"expected at most {_MOST} shapes, found {len(given)}")
    numbers = iter(range(1, _MOST + 1))
    heads = _SHAPE.sub(lambda _: f" shape {next(numbers)}", text.lines[line - 1])
    other = next((o for o in _OTHER_SHAPE.findall(heads) if not re.fullmatch(r"shape \d+", o)), "")
    if other or not given:
        raise text.refusal(line, f"expected headings such as 'shape at 62.1 Hz', found '{other or heads}'")
    known = (
        {"position": Quantity("m", least=0.0)}
        | _SPEED
        | {f"shape {k}": Quantity() for k in range(1, _MOST + 1)}
    )
    names = {plain_name(name): name for name in known} | {"x": "position"}
    laid = replace(text, lines=(*text.lines[: line - 1], heads, *text.lines[line:]))
    table = read_csv(laid, known, names)
    check_places(table, "position")
    try:
        frequency = [Frequency("Hz", above=0.0).parse(each) for each in given]
    except InvalidInput as error:
        raise text.refusal(line, f"shape at {error.value}: {error.bound}") from None
    written = [re.sub(r"[^\d.]*$", "", each.split()[0]) for each in given]
    halves = [half(cell) * f / float(cell) for cell, f in zip(written, frequency, strict=True)]
    named = table.named()
    return MeasuredFrequencies(
        [frequency],
        [_speed(table, speed) or 0.0],
        rounding=[halves],
        labels=[f"shape {k}" for k in range(1, len(given) + 1)],
        positions=named["position"].values,
        shapes=[named[f"shape {k}"].values for k in range(1, len(given) + 1)],
        source=text.path.name,
    )
