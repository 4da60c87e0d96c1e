"""Studies, sensitivities, trade-offs and Campbell diagrams, as tables and as columns of files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

import beamdyn as bd
from beamdyn.analyses.results.of_data import VIEWS as OF_DATA
from beamdyn.analyses.results.of_stability import VIEWS as OF_STABILITY
from beamdyn.common.edge.console import table, table_of
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import (
    Column,
    Columns,
    ShownUnit,
    attributes,
    column_named,
    columns_of_rows,
    evenly_spread,
    name_in_heads,
)
from beamdyn.common.results.pictures import Figure, figure_of
from beamdyn.common.words import InputName, lower_bound, supported, upper_bound
from beamdyn.equations.effects import first_drawn

if TYPE_CHECKING:
    from beamdyn.studies.tradeoffs.measurements import Diagram

_MOST_ROWS = 30  # largest number of rows in the table of a study
_DIGITS = 10  # largest number of digits of a speed or frequency
# Largest number of digits of a derivative; largest number of results side by side in a table.
_DIGITS_OF_DERIVATIVES, _BESIDE = 7, 4
_RPM = 30 / np.pi  # revolutions per minute in one rad/s
# Relative distance of a frequency from its upper bound, below which it counts as close to the bound.
_NEAR = 1e-3
_MEASUREMENT = "family", "setting", "size", "relative_error", ("time", "s"), "in_front"


# Studies ----------------------------------------------------------------------------------------------


def study_table(result: bd.Study) -> Group:
    """Make a table of some designs, evenly spaced: inputs in the units as typed, and results."""
    columns, number, inputs = study_columns(result).columns, result.designs.count, len(result.inputs)
    shown = evenly_spread(number, _MOST_ROWS)
    typed = (result.typed_units.get(each.name, ShownUnit("", 1.0)) for each in result.inputs)
    pairs = zip(columns[:inputs], typed, strict=True)
    given = (column.times(unit.per_si, unit.name) for column, unit in pairs)
    known = np.where(np.isfinite(result.value), result.error, np.nan).reshape(number, -1)
    errors = ["-" if np.isnan(each).all() else f"{np.nanmax(each):.1g}" for each in known]
    notes = [f"{len(shown)} of {number} designs are shown; CSV has all."] if len(shown) < number else []
    if judged := len(result.left_out_places):
        where = f"at the worst of {judged} design{'s' * (judged > 1)}"
        what = "number" * (len(result.labels) > 1)
        notes.append(in_files(result.left_out_effects.sentence(what, where)))
    else:
        notes.append("The neglected effects are not estimated, as no design has an answer.")
    made = Columns(
        *given,
        *columns[inputs:],
        Column("error", (), cells=errors),
        title=f"{number} design{'s' * (number > 1)}, by {result.provenance.method}",
        note="\n".join(notes),
    )
    return table_of(made.at(shown), result.display_units, keys=inputs + (len(result.labels) or 1))


def study_columns(result: bd.Study) -> Columns:
    """Make columns with one row per design: inputs in SI units, results, errors, statuses.

    The last input varies fastest.
    """
    parts = (result.value, result.error, result.status)
    value, error, status = (each.reshape(result.designs.count, -1).T for each in parts)
    there = np.isfinite(value)
    absolute = np.where(there & (value != 0), error, 0.0) * np.where(there, np.abs(value), 0.0)
    kind, units = result.question.kind.word, {each.name: each.unit for each in result.inputs}
    numbers = [_plain_name(label) for label in result.labels] or [""]
    answers = zip(
        numbers, result.labels or (kind,), value, absolute, map(_without, value, status), strict=True
    )
    form = partial(supported, most=_DIGITS)
    word = kind.replace(" ", "_")
    return Columns(
        *(
            column_named(name.replace(".", "_"), each, units[name], words=in_files(InputName(name)))
            for name, each in result.designs.columns().items()
        ),
        *(
            column_named(word, each, result.unit, n, error=wrong, form=form, cells=cells, words=head)
            for n, head, each, wrong, cells in answers
        ),
        *(Column("relative_error", each, "", n, words=None) for each, n in zip(error, numbers, strict=True)),
        *(Column("status", each, "", n, words=None) for each, n in zip(status, numbers, strict=True)),
    )


def _without(value: np.ndarray, status: np.ndarray) -> list[str | None]:
    """Return the status of each design without a result, which gives the reason; None for others."""
    pairs = zip(value, status, strict=True)
    return [None if np.isfinite(number) else str(state) for number, state in pairs]


def _plain_name(label: str) -> str:
    """Return a label as part of a column heading: "1" for "mode 1", with words for plus and minus signs."""
    label = label.replace("+", " plus ").replace("-", " minus ")
    return name_in_heads(label.removeprefix("mode "))


def sensitivities_table(result: bd.Sensitivities) -> Group:
    """Make a table of input values, derivatives of each result, and relative changes."""
    values = [f"{a} {v:.6g} {result.unit}" for a, v in zip(result.answers, result.value, strict=True)]
    said = f"{'; '.join(values)}. Derivatives: in {result.unit} per SI unit of the input."
    numbers = np.array([each.value for each in result.inputs])[:, None]
    with np.errstate(invalid="ignore"):
        error = result.error * np.abs(numbers / result.value)
    parts = {
        f"Derivatives, by {result.provenance.method}": (result.derivative, result.error),
        "Relative change per relative change of the input": (result.relative, error),
    }
    tables = [
        table(title, ("input", "value", *result.answers[shown]), _rows(result, *found, shown))
        for title, found in parts.items()
        for shown in (slice(k, k + _BESIDE) for k in range(0, len(result.answers), _BESIDE))
    ]
    return Group(*tables, Text(said if values else "There is no crossing."))


def _rows(
    result: bd.Sensitivities, value: np.ndarray, error: np.ndarray, shown: slice
) -> Iterator[Sequence[str]]:
    """Yield a table row for each input: name, value, and a number for each of the results that are `shown`.

    `value` holds these numbers, `error` their absolute errors, both of shape (inputs, results).
    """
    for each, numbers, errors in zip(result.inputs, value[:, shown], error[:, shown], strict=True):
        cells = map(supported, numbers, errors, [_DIGITS_OF_DERIVATIVES] * len(numbers))
        yield in_files(InputName(each.name)), f"{each.value:.6g} {each.unit}".rstrip(), *cells


def sensitivities_csv(result: bd.Sensitivities) -> Columns:
    """Make columns with one row per input and result, all values in SI units.

    They include the derivative of the result with respect to the input, its error, and the relative change of
    the result per relative change of the input.
    """
    rows = []
    for k, each in enumerate(result.inputs):
        columns = (result.answers, result.value, result.derivative[k], result.error[k], result.relative[k])
        for answer, *numbers in zip(*columns, strict=True):
            rows.append((each.name, each.unit, each.value, answer, *map(float, numbers)))
    heads = "input", "unit", "value", "answer", "answer_value", "derivative", "error", "relative"
    return columns_of_rows(heads, rows)


# Trade-offs -------------------------------------------------------------------------------------------


_TIES = 3  # largest number of settings that are named as equally fast within the scatter of measured times


def diagram_table(diagram: Diagram) -> Group:
    """Tabulate the cheapest setting for each number of correct digits, with Pareto front and reference."""
    rows = [
        (
            f"{d.error:.0e}",
            d.family,
            d.setting,
            f"{1e3 * d.time:.3g}",
            "" if i == 0 else f"{d.ratio:.2f}",
            "; ".join(d.ties[:_TIES]) + f"; {len(d.ties) - _TIES} more" * (len(d.ties) > _TIES),
        )
        for i, d in enumerate(diagram.per_digit)
    ]
    heads = "error", "cheapest", "setting", "time [ms]", "over the digit before"
    sentences = (
        f"Pareto front: {diagram.summary}.",
        f"Error: of {diagram.error_of}.",
        f"Reference: {diagram.reference}; errors below {diagram.resolved:.0e} are not resolved.",
        *(f"Left out: {sentence}." for sentence in diagram.skipped),
        "",
    )
    title = diagram.title[:1].upper() + diagram.title[1:]
    return Group(
        table(title, (*heads, "as fast, within the scatter"), rows, (1, 2, 5)), *map(Text, sentences)
    )


def diagram_csv(diagram: Diagram) -> Columns:
    """Make columns of errors and computing times in one diagram."""
    return columns_of_rows(_MEASUREMENT, _measurements(diagram))


def tradeoff_csv(result: bd.Tradeoff) -> Columns:
    """Make columns of all measurements, with the name of the diagram."""
    rows = ((each.title, *row) for each in result.diagrams for row in _measurements(each))
    return columns_of_rows(("diagram", *_MEASUREMENT), rows)


def _measurements(diagram: Diagram) -> Iterator[Sequence[object]]:
    for m in diagram.measurements:
        yield m.family, m.setting, m.size, m.error, m.time, m in diagram.front


def _tradeoff_figure(result: bd.Tradeoff) -> Figure:
    """Draw all diagrams of error over computing time, two side by side."""
    rows = -(-len(result.diagrams) // 2)
    return figure_of(result.plot, (6.5 * min(2, len(result.diagrams)), 4.5 * rows))


# Campbell diagrams ------------------------------------------------------------------------------------


def campbell_tables(result: bd.Campbell) -> Group:
    """Make tables of crossings and, if there are any, of margins and of guaranteed bounds of frequencies."""
    parts = crossings_columns(result), *_margins(result), *_bounds(result)
    return Group(*(table_of(columns, result.display_units) for columns in parts))


def _scenes(result: bd.Campbell, labels: Sequence[str]) -> Column:
    """Make the column of scene names, which tables show if there are several scenes."""
    return Column("scene", labels, words="" if len(result.labels) > 1 else None)


def crossings_columns(result: bd.Campbell) -> Columns:
    """Make columns of the crossings.

    Of the energy fractions in both planes of bending, tables show that of the plane whose modes the diagram
    draws as solid curves.
    """
    found, number = result.crossings, len(result.crossings)
    speed, frequency, error = (
        np.array(attributes(found, name), dtype=float) for name in ("speed", "frequency", "error")
    )
    model_error = result.model_error if found else np.zeros(0)
    top = result.display_units.speed_unit().say(result.loci[0].speeds[-1])
    operating = ["yes" if c.operating else "no" for c in found]
    words = None if result.operating is None else ""
    return Columns(
        _scenes(result, attributes(found, "label")),
        Column("line", attributes(found, "line.name")),
        Column("multiple", attributes(found, "line.multiple"), words=None),
        Column("mode", attributes(found, "mode"), words=None),
        Column("name", attributes(found, "name"), words="mode"),
        Column("speed", speed, "rad/s", "", error * speed, model_error * speed),
        Column("speed", speed * _RPM, "rpm", words=None),
        Column("frequency", frequency, "Hz", error=error * frequency),
        Column("relative_error", error, words=None),
        Column("tracking_confidence", attributes(found, "confidence"), form=".2f", words="tracking"),
        *_shares(result),
        Column("operating", attributes(found, "operating"), cells=operating, words=words),
        title=f"{number or 'No'} crossing{'s' * (number != 1)} up to {top}, by {result.provenance.method}",
        note=result.left_out_effects.sentence("crossing" if number > 1 else ""),
    )


def _shares(result: bd.Campbell) -> Iterator[Column]:
    """Yield the two columns of each mode's energy fractions in the two planes of bending.

    Tables show only the fraction in the plane whose modes the diagram draws as solid curves.
    """
    scenes = [result.loci[result.labels.index(c.label)].scene for c in result.crossings]
    cells = [
        f"{c.plane_share[first_drawn(scene)]:.3f}" if scene.physics.planes == 2 else "-"
        for c, scene in zip(result.crossings, scenes, strict=True)
    ]
    flap = any(name.startswith("flap") for names in result.names for name in names)
    two_planes = any(locus.scene.physics.planes == 2 for locus in result.loci)
    head = f"share of {'flap' if flap else 'bending'}" if two_planes else None
    yield Column("share_bending", [c.plane_share[0] for c in result.crossings], cells=cells, words=head)
    yield Column("share_across", [c.plane_share[1] for c in result.crossings], words=None)


def _margins(result: bd.Campbell) -> Iterator[Columns]:
    if found := result.margins:
        sizes = [f"{100 * m.margin:+.1f} %" if m.margin else "crossed" for m in found]
        yield Columns(
            _scenes(result, attributes(found, "label")),
            Column("mode", attributes(found, "name")),
            Column("at", attributes(found, "where")),
            Column("speed", attributes(found, "speed"), "rad/s"),
            Column("frequency", attributes(found, "frequency"), "Hz"),
            Column("nearest line", attributes(found, "line.name")),
            Column("margin", (), cells=sizes),
            title="Margins: frequency of the nearest line of excitation / natural frequency, minus 1",
        )


def _bounds(result: bd.Campbell) -> Iterator[Columns]:
    if result.bounds:
        each = [(label, found.speed, high) for label, found in result.bounds for high in found.upper]
        low, high, width = (
            np.concatenate([getattr(found, name) for _, found in result.bounds])
            for name in ("lower", "upper", "width")
        )
        known = (low > 0) & (low <= high)
        yield Columns(
            _scenes(result, [label for label, _, _ in each]),
            Column("mode", [_mode_at_bound(result, *one) for one in each]),
            Column("at least", (), "Hz", cells=np.where(known, [*map(lower_bound, low)], "-").tolist()),
            Column("at most", high, "Hz", form=upper_bound),
            Column("relative width", (), cells=np.where(known, np.char.mod("%.0e", width), "-").tolist()),
            title=f"Guaranteed bounds of the model at {result.display_units.speed_unit().say(each[0][1])}",
        )


def _mode_at_bound(result: bd.Campbell, label: str, speed: float, high: float) -> str:
    """Return the name of the mode whose frequency is nearest to a guaranteed upper bound `high` [Hz].

    The modes are those of the scene named `label`, at the computed speed nearest to `speed` [rad/s].  Return
    "-" if no frequency is within 0.1 % of the bound.
    """
    i = result.labels.index(label)
    locus = result.loci[i]
    distance = np.abs(locus.frequency[np.abs(locus.speeds - speed).argmin()] / high - 1)
    near = np.flatnonzero(distance < _NEAR)
    return result.names[i][near[distance[near].argmin()]] if near.size else "-"


def campbell_csv(result: bd.Campbell) -> Columns:
    """Make columns of the natural frequencies of all scenes over speed, and of the tracking confidence."""
    names = [
        f"{label}: {name}" if label else name
        for label, modes in zip(result.labels, result.names, strict=True)
        for name in modes
    ]
    speeds = result.loci[0].speeds
    frequency = np.concatenate([locus.frequency for locus in result.loci], axis=1)
    confidence = np.concatenate([locus.confidence for locus in result.loci], axis=1)
    return Columns(
        Column("speed", speeds, "rad/s"),
        Column("speed", speeds * _RPM, "rpm"),
        *(Column(f"{name} [Hz]", each) for name, each in zip(names, frequency.T, strict=True)),
        *(Column(f"{name}, confidence", each) for name, each in zip(names, confidence.T, strict=True)),
    )


VIEWS = OF_DATA | OF_STABILITY | {
    "Campbell": View(campbell_tables, campbell_csv, 1, lambda result: figure_of(result.plot, (8.5, 6.0))),
    "Diagram": View(diagram_table, diagram_csv),
    "Sensitivities": View(sensitivities_table, sensitivities_csv, 1),
    "Study": View(
        study_table, study_columns, 0, lambda result: figure_of(result.plot_panels, result.picture_size())
    ),
    "Tradeoff": View(lambda result: Group(*map(diagram_table, result.diagrams)), tradeoff_csv, 3,
                     _tradeoff_figure),
}  # fmt: skip
