"""Measured data compared with a scene, identified parameters, and designs, as tables and file columns."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from rich.console import Group
from rich.text import Text

import beamdyn as bd
from beamdyn.common.edge.console import table, table_of
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, name_in_heads
from beamdyn.common.results.pictures import figure_of
from beamdyn.common.words import InputName, percent, supported
from beamdyn.studies.beside_data.curve_comparison import say
from beamdyn.studies.beside_data.single_numbers import say_value
from beamdyn.studies.designing.target import say_number

_DIGITS = 6  # largest number of digits of a computed frequency


def comparison_columns(result: bd.FrequencyComparison) -> Columns:
    """Make columns with one row per measured frequency: computed value, deviation, and whether they agree."""
    computed = result.computed
    relative = (("uncertainty", result.allowance), ("model error", result.model_error))
    said = [_percents(each / np.where(np.isnan(computed), result.measured, computed)) for _, each in relative]
    shapes = np.isfinite(result.likeness).any()
    return Columns(
        Column("label", result.label, words="measured"),
        Column("speed", result.speed, "rad/s"),
        Column("measured", result.measured, "Hz", words="value"),
        Column("computed", computed, "Hz", error=result.error, beyond=result.model_error, form=_computed),
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


def _computed(value: float, error: float) -> str:
    return supported(value, error, _DIGITS)


def _percents(values: np.ndarray, sign: str = "") -> list[str]:
    return [percent(float(value), sign) if np.isfinite(value) else "-" for value in values]


def _deviations(values: np.ndarray, in_digits: np.ndarray) -> list[str]:
    """Format deviations in percent; "in its digits" if computed and measured value agree in all digits."""
    return ["in its digits" if k else cell for k, cell in zip(in_digits, _percents(values, "+"), strict=True)]


def comparison_tables(result: bd.FrequencyComparison) -> Group:
    """Make tables of measured and computed frequencies, and of single inputs that may explain deviations."""
    parts = [table_of(comparison_columns(result), result.display_units, keys=2)]
    if result.explanations:
        rows = [
            (
                in_files(InputName(each.name)),
                in_files(say_value(each.given, each.unit, units=result.display_units)),
                in_files(say_value(each.value, each.unit, units=result.display_units)),
                each.left,
                "explains all" if each.explains else "does not",
            )
            for each in result.explanations
        ]
        heads = "number", "in the scene", "would be", "largest deviation left", ""
        parts.append(table("One number alone, fitted to all", heads, rows, (0, 1, 2, 4)))
    return Group(*parts)


def comparison_csv(result: bd.FrequencyComparison) -> Columns:
    """Make columns of the pairs of measured and computed frequencies."""
    columns = [column for column in comparison_columns(result).columns if len(column.values)]
    return Columns(*columns)


def curve_columns(result: bd.CurveComparison) -> Columns:
    """Make columns with one row per curve: largest values, deviations, and whether the curves agree."""
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
        title=f"Measured and computed curves over {result.along}, by {result.provenance.method}",
        note="\n".join(in_files(said, result.display_units) for said in result.sentences()),
    )


def _phase(phase: float) -> str:
    """Format a phase [rad] in degrees, rounded to a hundredth."""
    return f"{round(float(np.degrees(phase)), 2) + 0.0:.3g}"


def curve_csv(result: bd.CurveComparison) -> Columns:
    """Make columns of measured and computed curves, one row per time, speed, position or frequency.

    Complex curves have columns for magnitude and phase.  Columns for the allowed deviation and the error
    follow.
    """
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


def identification_tables(result: bd.Identification) -> Group:
    """Make tables of identified parameters with intervals, undetermined ones, and the fit to the data."""

    def said(value: float, unit: str) -> str:
        own = say_value(value, unit, units=result.display_units)
        return "not told" if np.isnan(value) else in_files(own)

    heads = "number", "in the scene", "found", "from", "to (95 %)"
    title = f"{result.counted()[:1].upper()}{result.counted()[1:]}, {result.solves} solves"
    notes = (Text(in_files(each, result.display_units)) for each in result.sentences())
    beside = comparison_columns(result.comparison)
    return Group(
        table(title, heads, _numbers(result, said), (0, 1, 2, 3, 4)),
        *notes,
        table_of(Columns(*beside.columns, title="With the numbers found"), result.display_units, keys=2),
    )


def _numbers(
    result: bd.Identification | bd.FoundDesign, said: Callable[[float, str], str]
) -> list[tuple[str, ...]]:
    """Make rows of parameters or design variables: name, value in the scene, value found, and its range.

    ``said(value, unit)`` formats a value in SI units.
    """
    each = zip(result.names, result.units, result.given, result.value, result.low, result.high, strict=True)
    return [
        (in_files(InputName(name)), *(said(float(value), unit) for value in values))
        for name, unit, *values in each
    ]


def numbers_csv(result: bd.Identification | bd.FoundDesign) -> Columns:
    """Make columns with one row per parameter or design variable, in SI units."""
    names = {"number": "names", "unit": "units"} | {n: n for n in ("given", "value", "low", "high")}
    return Columns(*(Column(head, getattr(result, name)) for head, name in names.items()))


def design_tables(result: bd.FoundDesign) -> Group:
    """Make tables of the design variables, and of targets and results, with sentences on the design."""

    def said(value: float, unit: str) -> str:
        return "-" if np.isnan(value) else in_files(say_number(value, unit), result.display_units)

    title = f"{'Design found' if result.found else 'Nearest design'}, {result.solves} solves"
    rows = [
        (
            in_files(target.says, result.display_units),
            said(float(value), target.kind.unit),
            f"{error:.1e}",
            "met" if met else "missed",
            ", ".join(f"{each:+.4g}" for each in relative),
        )
        for target, value, error, met, relative in zip(
            result.targets, result.reached, result.error, result.met, result.relative, strict=True
        )
    ]
    heads = (
        "target",
        "reached",
        "error",
        "",
        f"relative change per relative change of {', '.join(in_files(InputName(n)) for n in result.names)}",
    )
    return Group(
        table(title, ("number", "in the scene", "found", "from", "to"), _numbers(result, said), range(5)),
        table("What was wanted", heads, rows, (0, 1, 2, 3, 4)),
        *(Text(in_files(each, result.display_units)) for each in result.sentences()),
    )


def design_csv(result: bd.FoundDesign) -> Columns:
    """Make columns with one row per design variable: values in SI units, and derivatives of the results."""
    slopes = zip(result.targets, result.derivative, strict=True)
    more = (Column("derivative", each, number=name_in_heads(target.name)) for target, each in slopes)
    return Columns(*numbers_csv(result).columns, *more)


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
        identification_tables, numbers_csv, 1, lambda result: figure_of(result.plot, (8.5, 5.5))
    ),
    "FoundDesign": View(
        design_tables, design_csv, 1, lambda result: figure_of(result.plot, (8.5, 2.0 + len(result.names)))
    ),
}
