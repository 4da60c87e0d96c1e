"""Stability in periodic motion, as tables for reading and as columns of files."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group

from beamdyn.common.edge.tables import table, table_of
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, column_named, name_in_heads
from beamdyn.common.results.digits import supported_or_range
from beamdyn.studies.floquet.multipliers import STABLE, UNDECIDED

if TYPE_CHECKING:
    from beamdyn.studies.floquet.point import FloquetMultipliers
    from beamdyn.studies.floquet.stability_chart import StabilityChart
    from beamdyn.studies.floquet.stability_limits import StabilityLimits

_FEW_POINTS = 7  # of a curve in a table
_MOST_ROWS = 21  # values of the first number in a table
_SI: Mapping[str, tuple[str, float]] = {}


def multiplier_columns(result: FloquetMultipliers) -> Columns:
    """A row a multiplier: size, angle, error and sign."""
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
        note=f"Largest growth rate {rate} 1/s, error {errors[0]:.1g} 1/s of the modes that are kept, "
        f"{errors[1]:.1g} 1/s by those left out.",
    )


def _multiplier_table(result: FloquetMultipliers) -> Group:
    return table_of(multiplier_columns(result), result.display_units)


def chart_table(result: StabilityChart, units: Mapping[str, tuple[str, float]] = _SI) -> Group:
    """Where free motion is not stable along the second number, at some values of the first.

    Parameters
    ----------
    result : StabilityChart
        The chart.
    units : mapping, optional
        By input: the unit in which its values are shown, and that unit in SI; others are shown in SI.
    """
    names = [(each.name, *units.get(each.name, (each.unit, 1.0))) for each in result.inputs]
    (first, *_), (second, *_) = heads = [(f"{n} [{u}]" if u else n, u, size) for n, u, size in names]
    values = [each.values / size for each, (*_, size) in zip(result.inputs, heads, strict=True)]
    number = len(values[0])
    shown = np.linspace(0, number - 1, min(number, _MOST_ROWS)).round().astype(int)
    rows = [
        (
            f"{values[0][k]:.6g}",
            _where(result.status[k], values[1]),
            f"{result.growth_rate[k].max():.4g}",
            f"{result.growth_rate_error[k].max():.1g}",
        )
        for k in shown
    ]
    title = f"Where free motion grows, by {result.provenance.method}"
    return table(title, (first, f"not stable at {second}", "largest growth rate [1/s]", "error"), rows, (1,))


def _where(status: np.ndarray, values: np.ndarray) -> str:
    """Ranges of values without stability, in words."""
    said = []
    for state, group in groupby(zip(status.tolist(), values.tolist(), strict=True), lambda pair: pair[0]):
        within = [value for _, value in group]
        if state != STABLE:
            ends = " to ".join(dict.fromkeys(f"{each:.6g}" for each in (within[0], within[-1])))
            said.append(f"{ends} (undecided)" if state == UNDECIDED else ends)
    return ", ".join(said) or "-"


def chart_columns(result: StabilityChart) -> Columns:
    """A row a point: the two numbers, the verdict, growth rate, its error, and the largest multiplier."""
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


def limit_columns(result: StabilityLimits) -> Columns:
    """A row a point: its curve, the two numbers, the error and the multiplier that leaves the circle."""
    numbers = (
        column_named(name_in_heads(each.name), values, each.unit, words=each.name, form=".9g")
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
        note=f"Curves by the multiplier that leaves the unit circle: {kinds}." if kinds else "No limit.",
    )


def _limit_table(result: StabilityLimits) -> Group:
    """Some of the points, those of each curve evenly spread."""
    rows = [np.flatnonzero(result.curve == k) for k in np.unique(result.curve)]
    few = [each[np.unique(np.linspace(0, len(each) - 1, _FEW_POINTS).round().astype(int))] for each in rows]
    shown = np.concatenate([np.zeros(0, dtype=int), *few])
    return table_of(limit_columns(result).at(shown), result.display_units)


VIEWS = {
    "FloquetMultipliers": View(_multiplier_table, multiplier_columns, 1),
    "StabilityChart": View(chart_table, chart_columns, 2),
    "StabilityLimits": View(_limit_table, limit_columns, 1),
}
