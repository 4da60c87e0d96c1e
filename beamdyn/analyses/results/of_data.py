"""Own data beside a scene, as tables for reading and as columns of files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.tables import table, table_of
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, name_in_heads
from beamdyn.common.results.digits import percent
from beamdyn.common.results.pictures import figure_of
from beamdyn.studies.beside_data.curve_comparison import say
from beamdyn.studies.beside_data.single_numbers import say_value

if TYPE_CHECKING:
    from beamdyn.studies.beside_data.curve_comparison import CurveComparison
    from beamdyn.studies.beside_data.frequency_comparison import FrequencyComparison
    from beamdyn.studies.beside_data.identification import Identification


def comparison_columns(result: FrequencyComparison) -> Columns:
    """A row a measured frequency: the computed one, deviation, what may be off, and the verdict."""
    computed = result.computed
    relative = (("uncertainty", result.allowance), ("model error", result.model_error))
    said = [_percents(each / np.where(np.isnan(computed), result.measured, computed)) for _, each in relative]
    shapes = np.isfinite(result.likeness).any()
    return Columns(
        Column("label", result.label, words="measured"),
        Column("speed", result.speed, "rad/s"),
        Column("measured", result.measured, "Hz", words="value"),
        Column("computed", computed, "Hz", error=result.error, beyond=result.model_error),
        Column("mode", result.mode, cells=[str(k) if k else "-" for k in result.mode.tolist()]),
        Column("deviation", result.deviation, cells=_deviations(result.deviation, result.in_digits)),
        Column("allowance", result.allowance, "Hz", words=None),
        Column("allowance", (), cells=said[0], words="data may be off"),
        Column("error", result.error, "Hz", words=None),
        Column("model_error", result.model_error, "Hz", words=None),
        Column("model_error", (), cells=said[1], words="left out"),
        Column("likeness", result.likeness, form=".3f", words="shapes alike" if shapes else None),
        Column("verdict", result.verdict),
        title=f"Measured and computed frequencies, by {result.provenance.method}",
        note="\n".join(in_files(said, result.display_units) for said in result.sentences()),
    )


def _percents(values: np.ndarray, sign: str = "") -> list[str]:
    return [percent(float(value), sign) if np.isfinite(value) else "-" for value in values]


def _deviations(values: np.ndarray, in_digits: np.ndarray) -> list[str]:
    """Deviations in percent, but of a value that agrees in all digits that it has."""
    return ["in its digits" if k else cell for k, cell in zip(in_digits, _percents(values, "+"), strict=True)]


def comparison_tables(result: FrequencyComparison) -> Group:
    """The pairs, and the numbers that alone would come nearest."""
    columns = comparison_columns(result)
    parts = [table_of(columns, result.display_units, keys=2)]
    if result.explanations:
        rows = [
            (
                each.name,
                in_files(say_value(each.given, each.unit)),
                in_files(say_value(each.value, each.unit)),
                each.left,
                "explains all" if each.explains else "does not",
            )
            for each in result.explanations
        ]
        heads = "number", "in the scene", "would be", "largest deviation left", ""
        parts.append(table("One number alone, fitted to all", heads, rows, (0, 1, 2, 4)))
    return Group(*parts)


def comparison_csv(result: FrequencyComparison) -> Columns:
    """The pairs alone: columns of numbers."""
    columns = [column for column in comparison_columns(result).columns if len(column.values)]
    return Columns(*columns)


def curve_columns(result: CurveComparison) -> Columns:
    """A row a curve: its largest values, how far the whole differs, what may be off, and the verdict."""
    units = result.unit

    def sizes(values: np.ndarray) -> list[str]:
        return [in_files(say(float(value), unit)) for value, unit in zip(values, units, strict=True)]

    shift = {"time": ("behind [s]", f"{result.delay:.4g}"), "frequency": ("phase ahead [deg]", "")}
    head, late = shift.get(result.along, ("", ""))
    phases = [late or (_phase(value) if np.isfinite(value) else "-") for value in result.phase]
    at = result.places, np.arange(len(units))
    own = result.allowance[at] / np.where(result.peak == 0, np.inf, result.peak)
    return Columns(
        Column("name", result.name, words="curve"),
        Column("peak", (), cells=sizes(result.peak), words="largest measured"),
        Column("computed", (), cells=sizes(result.computed_peak), words="computed"),
        Column("deviation", (), cells=_deviations(result.deviation, result.in_digits)),
        Column("rms", (), cells=_percents(result.rms), words="whole differs by"),
        Column("phase", (), cells=phases, words=head or None),
        Column("allowance", (), cells=_percents(own), words="data may be off"),
        Column("model_error", (), cells=_percents(result.model_error), words="left out"),
        Column("verdict", result.verdict),
        title=f"Measured and computed over {result.along}, by {result.provenance.method}",
        note="\n".join(in_files(said, result.display_units) for said in result.sentences()),
    )


def _phase(phase: float) -> str:
    """A phase in degrees, to a hundredth."""
    return f"{round(float(np.degrees(phase)), 2) + 0.0:.3g}"


def curve_csv(result: CurveComparison) -> Columns:
    """A row a time, position or frequency: each curve as measured and computed, and what may be off."""
    units = {"time": "s", "speed": "rad/s", "position": "m", "frequency": "Hz"}
    columns = [Column(result.along, result.x, units[result.along])]
    for k, (name, unit) in enumerate(zip(result.name, result.unit, strict=True)):
        for what in ("measured", "computed"):
            values, number = getattr(result, what)[:, k], name_in_heads(name)
            responds = result.along == "frequency"
            columns.append(Column(what, np.abs(values) if responds else values, unit, number))
            if np.iscomplexobj(values):
                columns.append(Column(f"{what}_phase", np.angle(values), "rad", number))
        for what in ("allowance", "error"):
            columns.append(Column(what, getattr(result, what)[:, k], unit, name_in_heads(name)))
    return Columns(*columns)


def identification_tables(result: Identification) -> Group:
    """The numbers with their intervals, what is not told, and the data beside the scene found."""

    def said(value: float, unit: str) -> str:
        return "not told" if np.isnan(value) else in_files(say_value(value, unit))

    rows = [
        (name, *(said(float(value), unit) for value in values))
        for name, unit, *values in zip(
            result.names, result.units, result.given, result.value, result.low, result.high, strict=True
        )
    ]
    heads = "number", "in the scene", "found", "from", "to (95 %)"
    title = f"{result.counted()[:1].upper()}{result.counted()[1:]}, {result.solves} solves"
    notes = (Text(in_files(each, result.display_units)) for each in result.sentences())
    beside = comparison_columns(result.comparison)
    return Group(
        table(title, heads, rows, (0, 1, 2, 3, 4)),
        *notes,
        table_of(Columns(*beside.columns, title="With the numbers found"), result.display_units, keys=2),
    )


def identification_csv(result: Identification) -> Columns:
    """A row a number: its values in SI."""
    return Columns(
        Column("number", result.names),
        Column("unit", result.units),
        Column("given", result.given),
        Column("value", result.value),
        Column("low", result.low),
        Column("high", result.high),
    )


VIEWS = {
    "FrequencyComparison": View(
        comparison_tables, comparison_csv, 2, lambda result: figure_of(result.plot, (8.5, 5.5))
    ),
    "CurveComparison": View(
        lambda result: table_of(curve_columns(result), result.display_units, keys=1),
        curve_csv,
        1,
        lambda result: figure_of(result.plot, (8.5, 2.0 + 3.0 * len(result.name))),
    ),
    "Identification": View(
        identification_tables, identification_csv, 1, lambda result: figure_of(result.plot, (8.5, 5.5))
    ),
}
