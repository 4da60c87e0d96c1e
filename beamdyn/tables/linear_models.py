"""Responses over frequency and matrices as tables for reading and as rows of CSV files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.digits import supported
from beamdyn.common.edge.tables import table
from beamdyn.linear_models.frequency_response import FrequencyResponse
from beamdyn.linear_models.matrices import Matrices
from beamdyn.linear_models.random_response import RandomResponse

_MOST_PEAKS = 8  # of a table
_DIGITS = 8  # most digits of a response


def response_table(result: FrequencyResponse) -> Group:
    """The largest response, and its other peaks."""
    size, error = np.abs(result.response), result.error
    rows = []
    for k in _peaks(size.max(axis=1)):
        column = int(size[k].argmax())
        phase = np.degrees(np.angle(result.response[k, column]))
        answers = f"{result.response_frequencies[k, column]:.6g}"
        value = supported(float(size[k, column]), float(error[k, column]), _DIGITS)
        rows.append((f"{result.frequencies[k]:.6g}", answers, value, f"{phase:.1f}"))
    title = f"{result.output} by {result.input} at {result.speed:.6g} rad/s, by {result.provenance.method}"
    heads = "frequency [Hz]", "answers at [Hz]", f"size [{result.unit}]", "phase [deg]"
    note = f"Largest of {len(result.frequencies)} frequencies, between which it may be larger; --csv has all."
    return Group(table(title, heads, rows, ()), Text(note))


def _peaks(size: np.ndarray) -> list[int]:
    """Indices of the largest local maxima, ends included, in order of frequency."""
    padded = np.concatenate([[-np.inf], size, [-np.inf]])
    top = np.flatnonzero((padded[1:-1] >= padded[:-2]) & (padded[1:-1] >= padded[2:]))
    return sorted(top[np.argsort(size[top])[::-1][:_MOST_PEAKS]].tolist())


def response_csv(result: FrequencyResponse) -> Iterator[Sequence[object]]:
    """Real and imaginary part, and error, of each harmonic, a row a frequency."""
    numbers = [f"_{h:+d}" if h else "" for h in result.harmonics.tolist()]
    names = [f"{name}{n}" for n in numbers for name in ("answer_Hz", "real", "imaginary", "error")]
    yield "frequency_Hz", *names
    each = [result.response_frequencies, np.real(result.response), np.imag(result.response), result.error]
    for frequency, row in zip(result.frequencies.tolist(), np.stack(each, axis=-1), strict=True):
        yield frequency, *row.ravel().tolist()


def random_table(result: RandomResponse) -> Group:
    """Root mean square of input and response, and the size of what is left out."""
    unit = result.unit and f" {result.unit}"
    parametric = result.parametric
    rows = [
        ("root mean square", f"{supported(result.rms, result.rms_error, _DIGITS)}{unit}"),
        ("its estimated error", f"{result.rms_error:.1g}{unit}"),
        ("three times that", f"{supported(3 * result.rms, 3 * result.rms_error, _DIGITS)}{unit}"),
        ("root mean square of the input", f"{result.input_rms:.6g} {result.input.rpartition('[')[2][:-1]}"),
        ("largest density at", f"{result.frequencies[int(result.psd.argmax())]:.6g} Hz"),
        ("stiffness varies by, left out", f"{parametric.stiffness_variation:.2g} (rms), relative"),
        ("which would raise it by some", f"{parametric.rms_change:.2g}, relative"),
    ]
    title = f"{result.output} by random {result.input} at {result.speed:.6g} rad/s"
    note = f"By {result.provenance.method}; --csv has the density over frequency."
    return Group(table(title, ("quantity", "value"), rows, (0,)), Text(note))


def random_csv(result: RandomResponse) -> Iterator[Sequence[object]]:
    """Density of the response and its error, a row a frequency."""
    yield "frequency_Hz", "psd", "psd_error"
    columns = result.frequencies, result.psd, result.psd_error
    yield from zip(*(column.tolist() for column in columns), strict=True)


_MATRICES = (
    "mass",
    "damping",
    "gyroscopic",
    "stiffness",
    "stiffness_by_axial_acceleration",
    "input_matrix",
)


def matrices_table(result: Matrices) -> Group:
    """What each coordinate is, with the diagonals of mass and stiffness."""
    rows = [
        (str(k + 1), name, f"{result.mass[k, k]:.6g}", f"{result.stiffness[k, k]:.6g}")
        for k, name in enumerate(result.coordinates)
    ]
    title = f"Equations at {result.speed:.6g} rad/s, by {result.provenance.method}"
    heads = "row", "coordinate", "mass, diagonal", "stiffness, diagonal"
    inputs = f"Inputs: {', '.join(result.inputs)}. --json and --csv have the matrices."
    return Group(table(title, heads, rows, (1,)), Text(inputs))


def matrices_csv(result: Matrices) -> Iterator[Sequence[object]]:
    """Every entry of every matrix, a row an entry; rows and columns count from 1."""
    yield "matrix", "row", "column", "value"
    for name in _MATRICES:
        for (row, column), value in np.ndenumerate(getattr(result, name)):
            yield name, row + 1, column + 1, float(value)
    for row, value in enumerate(result.static_load.tolist(), 1):
        yield "static_load", row, 1, value
