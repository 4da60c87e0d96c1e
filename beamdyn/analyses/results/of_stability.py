"""Stability of periodic motion, as tables and as columns of files."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby

import numpy as np
from rich.console import Group

import beamdyn as bd
from beamdyn.common.edge.console import table, table_of
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.views import View
from beamdyn.common.inputs.described import VariedInput
from beamdyn.common.results.columns import Column, Columns, column_named, evenly_spread, name_in_heads
from beamdyn.common.words import InputName, supported_or_range
from beamdyn.studies.floquet.multipliers import STABLE, UNDECIDED

_FEW_POINTS = 7  # number of points of each curve in a table
_MOST_ROWS = 21  # largest number of values of the first input in a table
_SI: Mapping[str, tuple[str, float]] = {}


def multiplier_columns(result: bd.FloquetMultipliers) -> Columns:
    """Make columns with one row per Floquet multiplier: magnitude, angle, error and Krein sign.

    For a result without multipliers, make columns of the growth rate and its error.
    """
    if not len(result.multipliers):
        rate, error = np.array([result.growth_rate]), np.array([result.growth_rate_error])
        return Columns(
            Column("growth_rate", rate, "1/s", error=error, words="growth rate"),
            Column("growth_rate_error", error, "1/s", form=".1e", words="error"),
            title=f"{result.status}, by {result.provenance.method}",
            note=f"The modes left out change the growth rate by {result.mode_error:.1g} 1/s.",
        )
    size, value = np.abs(result.multipliers), result.multipliers
    errors = result.growth_rate_error, result.mode_error
    rate = supported_or_range(result.growth_rate, sum(errors), 6)
    return Columns(
        Column("multiplier", np.arange(1, len(size) + 1)),
        Column("size", size, error=result.multiplier_errors, form=".10g"),
        Column("angle", np.angle(value), "rad", form=".6f"),
        Column("error", result.multiplier_errors, form=".1e"),
        Column("krein_sign", result.krein_sign.astype(int), words="Krein sign"),
        title=f"{result.status}: multipliers over {result.period:.6g} s, by {result.provenance.method}",
        note=f"Largest growth rate {rate} 1/s; its error: {errors[0]:.1g} 1/s for the modes that are kept, "
        f"{errors[1]:.1g} 1/s by the modes left out.",
    )


def chart_table(result: bd.StabilityChart, units: Mapping[str, tuple[str, float]] = _SI) -> Group:
    """Make a table of unstable ranges of the second input, for values of the first input.

    Parameters
    ----------
    result : StabilityChart
        The stability chart.
    units : mapping, optional
        For some inputs, by name: display unit, and the size of this unit in SI; others are shown in SI units.
    """
    names = [(_words(each), *units.get(each.name, (each.unit, 1.0))) for each in result.inputs]
    (first, *_), (second, *_) = heads = [(f"{n} [{u}]" if u else n, u, size) for n, u, size in names]
    values = [each.values / size for each, (*_, size) in zip(result.inputs, heads, strict=True)]
    rows = [
        (
            f"{values[0][k]:.6g}",
            _where(result.status[k], values[1]),
            f"{result.growth_rate[k].max():.4g}",
            f"{result.growth_rate_error[k].max():.1g}",
        )
        for k in evenly_spread(len(values[0]), _MOST_ROWS)
    ]
    title = f"Where free motion grows, by {result.provenance.method}"
    return table(title, (first, f"not stable at {second}", "largest growth rate [1/s]", "error"), rows, (1,))


def _words(varied: VariedInput) -> str:
    """Return the name of an input: its path as in files and commands, or its field's name in a form."""
    return in_files(InputName(varied.name))


def _where(status: np.ndarray, values: np.ndarray) -> str:
    """Format the ranges of values at which the motion is unstable or undecided."""
    said = []
    for state, group in groupby(zip(status.tolist(), values.tolist(), strict=True), lambda pair: pair[0]):
        within = [value for _, value in group]
        if state != STABLE:
            ends = " to ".join(dict.fromkeys(f"{each:.6g}" for each in (within[0], within[-1])))
            said.append(f"{ends} (undecided)" if state == UNDECIDED else ends)
    return ", ".join(said) or "-"


def chart_columns(result: bd.StabilityChart) -> Columns:
    """Make columns with one row per point: both inputs, status, growth rate and largest multiplier."""
    grids = np.meshgrid(*(each.values for each in result.inputs), indexing="ij")
    numbers = (
        column_named(name_in_heads(each.name), grid.ravel(), each.unit, words=each.name)
        for each, grid in zip(result.inputs, grids, strict=True)
    )
    return Columns(
        *numbers,
        Column("status", result.status.ravel()),
        Column("growth_rate", result.growth_rate.ravel(), "1/s", error=result.growth_rate_error.ravel()),
        Column("growth_rate_error", result.growth_rate_error.ravel(), "1/s", form=".1e"),
        Column("spectral_radius", result.spectral_radius.ravel()),
        Column("period", result.period.ravel(), "s"),
    )


def limit_columns(result: bd.StabilityLimits) -> Columns:
    """Make columns with one row per point: curve, both inputs, error, and multiplier on the unit circle."""
    numbers = (
        column_named(name_in_heads(each.name), values, each.unit, words=_words(each), form=".9g")
        for each, values in zip(result.chart.inputs, result.place.T, strict=True)
    )
    kinds = ", ".join(f"{k}: {kind}" for k, kind in enumerate(result.kinds, 1))
    return Columns(
        Column("curve", result.curve),
        *numbers,
        Column("error", result.error, form=".0e", words="error over the range"),
        Column("multiplier_real", np.real(result.multiplier), form=".6f"),
        Column("multiplier_imaginary", np.imag(result.multiplier), form=".6f"),
        title=f"Limits of stability, {result.provenance.method}",
        note=f"Kinds of curves, by the multiplier on the unit circle: {kinds}." if kinds else "No limit.",
    )


def _limit_table(result: bd.StabilityLimits) -> Group:
    """Make a table of some evenly spaced points of each curve."""
    rows = [np.flatnonzero(result.curve == k) for k in np.unique(result.curve)]
    few = [each[evenly_spread(len(each), _FEW_POINTS)] for each in rows]
    shown = np.concatenate([np.zeros(0, dtype=int), *few])
    return table_of(limit_columns(result).at(shown), result.display_units)


VIEWS = {
    "FloquetMultipliers": View(None, multiplier_columns, 1),
    "StabilityChart": View(chart_table, chart_columns, 2),
    "StabilityLimits": View(_limit_table, limit_columns, 1),
}
