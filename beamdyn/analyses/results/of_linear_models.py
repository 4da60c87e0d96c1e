"""Frequency responses, random responses and matrices, as tables and as columns of CSV files."""

from __future__ import annotations

from math import isfinite

import numpy as np
from rich.console import Group
from rich.text import Text

import beamdyn as bd
from beamdyn.common.edge.console import table, table_of
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, columns_of_rows
from beamdyn.common.results.one_line import rounded_up
from beamdyn.common.words import supported

_MOST_PEAKS = 8  # largest number of peaks in a table
_NO_WIDTH = "-"  # text in a table for a peak without a width
_DIGITS, _DIGITS_OF_WIDTH = 8, 4  # largest number of digits of a response, and of the width of a peak
_MATRICES = ("mass", "damping", "gyroscopic", "stiffness", "stiffness_by_axial_acceleration", "input_matrix")
_PAIRS = 6  # number of pole pairs whose errors are listed


def response_table(result: bd.FrequencyResponse) -> Group:
    """Make a table of the resonance peaks, and of the largest response at the given frequencies."""
    speed, peaks, rows = result.display_units.speed_unit().say(result.speed), result.peaks, []
    title = f"{result.output} by {result.input} at {speed}, by {result.provenance.method}"
    answers = peaks.frequency + peaks.harmonic * result.speed / (2 * np.pi)
    for k in sorted(np.argsort(peaks.size)[::-1][:_MOST_PEAKS].tolist()):
        at = supported(float(peaks.frequency[k]), float(peaks.frequency_error[k]), _DIGITS)
        size = supported(float(peaks.size[k]), float(peaks.size_error[k]), _DIGITS)
        size = size if np.isfinite(peaks.size[k]) else "unbounded"
        width, error = float(peaks.bandwidth[k]), float(peaks.bandwidth_error[k])
        width = _NO_WIDTH if np.isnan(width) else supported(width, error, _DIGITS_OF_WIDTH)
        rows.append((at, f"{answers[k]:.6g}", size, width))
    f, size = result.frequencies, np.abs(result.response)
    at = f"{f[0]:.6g} Hz" if len(f) == 1 else f"{f[0]:.6g} to {f[-1]:.6g} Hz"
    more = f"; the largest {_MOST_PEAKS} of {len(peaks)} are shown" if len(peaks) > _MOST_PEAKS else ""
    note = f"Peaks in {at}, located also between the {len(f)} given frequencies{more}."
    if any(row[-1] == _NO_WIDTH for row in rows):
        said = "no width, as on one side or both the response rises again before it falls to half the power"
        note += f" {_NO_WIDTH}: {said}."
    i, j = np.unravel_index(int(size.argmax()), size.shape)
    value = supported(float(size[i, j]), float(result.error[i, j]), _DIGITS)
    where = f"{f[i]:.6g} Hz, phase {np.degrees(np.angle(result.response[i, j])):.1f} deg"
    largest = f"Largest at the given frequencies: {value} {result.unit} at {where}; CSV has all."
    heads = "peak at [Hz]", "answers at [Hz]", f"size [{result.unit}]", "half-power bandwidth [Hz]"
    shown = [table(title, heads, rows, ()), Text(note)] if rows else [Text(title), Text(f"No peak at {at}.")]
    return Group(*shown, Text(largest))


def response_csv(result: bd.FrequencyResponse) -> Columns:
    """Make columns of real part, imaginary part and error of each harmonic, one row per frequency."""
    parts = np.real(result.response), np.imag(result.response), result.error
    each = [Column("frequency", result.frequencies, "Hz")]
    for k, harmonic in enumerate(result.harmonics.tolist()):
        number = f"{harmonic:+d}" if harmonic else ""
        each.append(Column("answer", result.response_frequencies[:, k], "Hz", number))
        named = zip(("real", "imaginary", "error"), parts, strict=True)
        each += (Column(name, part[:, k], result.unit, number) for name, part in named)
    return Columns(*each)


def random_table(result: bd.RandomResponse) -> Group:
    """Make a table of the root mean squares of input and response, and of the neglected effects."""
    unit, parametric = result.unit and f" {result.unit}", result.parametric
    rows = [
        ("root mean square", f"{supported(result.rms, result.rms_error, _DIGITS)}{unit}"),
        ("its estimated error", f"{result.rms_error:.1g}{unit}"),
        ("three times the rms", f"{supported(3 * result.rms, 3 * result.rms_error, _DIGITS)}{unit}"),
        ("root mean square of the input", f"{result.input_rms:.6g} {result.input.rpartition('[')[2][:-1]}"),
        ("largest density at", f"{result.frequencies[int(result.psd.argmax())]:.6g} Hz"),
        ("variation of stiffness, neglected", f"{parametric.stiffness_variation:.2g} (rms), relative"),
        ("by which the root mean square would rise", f"about {parametric.rms_change:.2g}, relative"),
    ]
    speed = result.display_units.speed_unit().say(result.speed)
    note = f"By {result.provenance.method}; CSV has the density over frequency."
    title = f"{result.output} by random {result.input} at {speed}"
    return Group(table(title, ("quantity", "value"), rows), Text(note))


def random_csv(result: bd.RandomResponse) -> Columns:
    """Make columns of the spectral density of the response and its error, one row per frequency."""
    unit = f"{squared(result.unit)} per Hz"
    return Columns(
        Column("frequency", result.frequencies, "Hz"),
        Column("psd", result.psd, unit),
        Column("psd_error", result.psd_error, unit),
    )


def squared(unit: str) -> str:
    """Return the square of a unit that is a product of powers: "m2/s4" for "m/s2"."""

    def square(factor: str) -> str:
        name = factor.rstrip("0123456789")
        return factor if not name else f"{name}{2 * int(factor[len(name) :] or 1)}"

    return "/".join(" ".join(map(square, part.split())) for part in unit.split("/"))


def matrices_table(result: bd.Matrices) -> Group:
    """Make a table of the coordinates, with the diagonals of the mass and stiffness matrices."""
    speed = result.display_units.speed_unit().say(result.speed)
    lowest = result.error[: 2 * _PAIRS : 2].tolist()
    of_pairs = ", ".join(rounded_up(each) if isfinite(each) else "not known" for each in lowest)
    errors = f"Relative errors of the lowest poles, pair by pair: {of_pairs}."
    columns = Columns(
        Column("row", range(1, len(result.coordinates) + 1)),
        Column("coordinate", result.coordinates),
        Column("mass, diagonal", result.mass.diagonal()),
        Column("stiffness, diagonal", result.stiffness.diagonal()),
        title=f"Equations at {speed}, by {result.provenance.method}",
        note=f"{errors} Inputs: {', '.join(result.inputs)}. JSON and CSV have the matrices.",
    )
    return table_of(columns, result.display_units)


def matrices_csv(result: bd.Matrices) -> Columns:
    """Make columns with one row for every entry of every matrix; indices start at 1."""
    parts = {name: getattr(result, name) for name in _MATRICES}
    parts |= {name: getattr(result, name)[:, None] for name in ("static_load", "error")}
    rows = (
        (name, row + 1, column + 1, float(value))
        for name, matrix in parts.items()
        for (row, column), value in np.ndenumerate(matrix)
    )
    return columns_of_rows(("matrix", "row", "column", "value"), rows)


VIEWS = {
    "FrequencyResponse": View(response_table, response_csv, 1),
    "Matrices": View(matrices_table, matrices_csv, 3),
    "RandomResponse": View(random_table, random_csv, 1),
}
