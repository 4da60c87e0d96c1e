"""Studies, sensitivities, trade-offs and Campbell diagrams, as tables for reading and as columns of files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import set_apart, table
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, column_named, columns_of_rows, name_in_heads
from beamdyn.common.results.digits import supported
from beamdyn.common.results.pictures import figure_of
from beamdyn.equations.effects import first_drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from beamdyn.studies.campbell.diagram import Campbell
    from beamdyn.studies.result import Study
    from beamdyn.studies.sensitivities.result import Sensitivities
    from beamdyn.studies.tradeoffs.measurements import Diagram
    from beamdyn.studies.tradeoffs.tradeoff import Tradeoff

_MOST_ROWS = 30  # rows of a table of a study
_DIGITS = 10  # most digits of a speed or frequency
_DIGITS_OF_DERIVATIVES, _BESIDE = 7, 4  # most digits, and answers beside one another
_RPM = 30 / np.pi  # revolutions per minute in a rad/s
_NEAR = 1e-3  # relative distance of a frequency from its upper bound, which is close
_MEASUREMENT = "family", "setting", "size", "relative_error", ("time", "s"), "in_front"


# Studies ----------------------------------------------------------------------------------------------


def study_table(result: Study, units: dict[str, tuple[str, float]] | None = None) -> Group:
    """Inputs and answers of some designs, spread evenly.

    Parameters
    ----------
    result : Study
        The study.
    units : dict, optional
        By input: the unit in which its values are shown, and that unit in SI; others are shown in SI.
    """
    columns, value, error, status = _flat(result)
    number = len(value)
    shown = np.linspace(0, number - 1, min(number, _MOST_ROWS)).round().astype(int)
    in_units = {each.name: (each.unit, 1.0) for each in result.inputs} | (units or {})
    inputs = [columns[name][shown] / in_units[name][1] for name in columns]
    heads = [f"{name} [{in_units[name][0]}]" if in_units[name][0] else name for name in columns]
    rows = (
        (*(f"{column[k]:.6g}" for column in inputs), *_answers(value[i], error[i], status[i]))
        for k, i in enumerate(shown)
    )
    own = [f"{label} [{result.unit}]" for label in result.labels or (result.question.kind.word,)]
    title = f"{number} design{'s' * (number > 1)}, by {result.provenance.method}"
    notes = [f"{len(shown)} of {number} designs are shown; --csv has all."] if len(shown) < number else []
    if judged := len(result.left_out_places):
        where, what = f"at the worst of {judged} design{'s' * (judged > 1)}", "number" * (len(own) > 1)
        notes.append(as_in_files(result.left_out_effects.sentence(what, where)))
    else:
        notes.append("What the model leaves out is not computed: no design has an answer.")
    return Group(table(title, (*heads, *own, "error"), rows, (), len(heads)), *map(Text, notes))


def _answers(value: np.ndarray, error: np.ndarray, status: np.ndarray) -> Iterator[str]:
    """Cells of the answers of a design, and of their largest error."""
    for number, wrong, state in zip(value, error, status, strict=True):
        yield supported(number, wrong * number, _DIGITS) if np.isfinite(number) else str(state)
    known = error[np.isfinite(value)]
    yield f"{known.max():.1g}" if known.size else "-"


def _flat(result: Study) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray]:
    """Inputs (N,) by name, and answers, errors and states (N, k) of all designs."""
    number = int(np.prod(result.shape))
    value, error, status = (each.reshape(number, -1) for each in (result.value, result.error, result.status))
    return result.designs.columns(), value, error, status


def study_csv(result: Study) -> Columns:
    """Inputs in SI, answers, relative errors and states, a row a design; the last input changes fastest."""
    columns, value, error, status = _flat(result)
    numbers = [_plain_name(label) for label in result.labels] or [""]
    units = {each.name: each.unit for each in result.inputs}
    inputs = (column_named(name.replace(".", "_"), each, units[name]) for name, each in columns.items())
    word = result.question.kind.word.replace(" ", "_")
    answers = (column_named(word, each, result.unit, n) for each, n in zip(value.T, numbers, strict=True))
    errors = (Column("relative_error", each, "", n) for each, n in zip(error.T, numbers, strict=True))
    states = (Column("status", each, "", n) for each, n in zip(status.T, numbers, strict=True))
    return Columns(*inputs, *answers, *errors, *states)


def _plain_name(label: str) -> str:
    """A label as a part of a head: a mode by its number, signs of combination frequencies in words."""
    label = label.replace("+", " plus ").replace("-", " minus ")
    return name_in_heads(label.removeprefix("mode "))


def sensitivities_table(result: Sensitivities) -> Group:
    """For each number its value, and of each answer the derivative and the relative change over its own."""
    values = [f"{a} {v:.6g} {result.unit}" for a, v in zip(result.answers, result.value, strict=True)]
    said = f"{'; '.join(values)}. Derivatives: in {result.unit} over the SI unit of the input."
    numbers = np.array([each.value for each in result.inputs])[:, None]
    with np.errstate(invalid="ignore"):
        error = result.error * np.abs(numbers / result.value)
    parts = {
        f"Derivatives, by {result.provenance.method}": (result.derivative, result.error),
        "Relative change over that of the input": (result.relative, error),
    }
    tables = [
        table(title, ("input", "value", *result.answers[shown]), _rows(result, *found, shown))
        for title, found in parts.items()
        for shown in (slice(k, k + _BESIDE) for k in range(0, len(result.answers), _BESIDE))
    ]
    return Group(*tables, Text(said if values else "There is no crossing."))


def _rows(
    result: Sensitivities, value: np.ndarray, error: np.ndarray, shown: slice
) -> Iterator[Sequence[str]]:
    """Rows of inputs with numbers of some answers."""
    for each, numbers, errors in zip(result.inputs, value[:, shown], error[:, shown], strict=True):
        cells = map(supported, numbers, errors, [_DIGITS_OF_DERIVATIVES] * len(numbers))
        yield each.name, f"{each.value:.6g} {each.unit}".rstrip(), *cells


def sensitivities_csv(result: Sensitivities) -> Columns:
    """A row for each number and answer: values in SI, derivative, its error, relative change."""
    rows = []
    for k, each in enumerate(result.inputs):
        columns = (result.answers, result.value, result.derivative[k], result.error[k], result.relative[k])
        for answer, *numbers in zip(*columns, strict=True):
            rows.append((each.name, each.unit, each.value, answer, *map(float, numbers)))
    heads = "input", "unit", "value", "answer", "answer_value", "derivative", "error", "relative"
    return columns_of_rows(heads, rows)


# Trade-offs -------------------------------------------------------------------------------------------


def diagram_table(diagram: Diagram) -> Group:
    """Cost of each digit, the Pareto front, and the reference of the errors."""
    rows = [
        (f"{d.error:.0e}", d.family, d.setting, f"{1e3 * d.time:.3g}", "" if i == 0 else f"{d.ratio:.2f}")
        for i, d in enumerate(diagram.per_digit)
    ]
    heads = ("error", "cheapest", "setting", "time [ms]", "over the digit before")
    sentences = (
        f"Pareto front: {diagram.summary}.",
        f"Error: of {diagram.error_of}.",
        f"Reference: {diagram.reference}; errors below {diagram.resolved:.0e} count as that.",
        *(f"Left out: {sentence}." for sentence in diagram.skipped),
        "",
    )
    title = diagram.title[:1].upper() + diagram.title[1:]
    return Group(table(title, heads, rows, (1, 2)), *map(Text, sentences))


def diagram_csv(diagram: Diagram) -> Columns:
    """The measurements of one diagram, one row each."""
    return columns_of_rows(_MEASUREMENT, _measurements(diagram))


def tradeoff_csv(result: Tradeoff) -> Columns:
    """All measurements, one row each."""
    rows = ((each.title, *row) for each in result.diagrams for row in _measurements(each))
    return columns_of_rows(("diagram", *_MEASUREMENT), rows)


def _measurements(diagram: Diagram) -> Iterator[Sequence[object]]:
    for m in diagram.measurements:
        yield m.family, m.setting, m.size, m.error, m.time, m in diagram.front


def _tradeoff_figure(result: Tradeoff) -> Figure:
    """All diagrams, two in a row."""
    rows = -(-len(result.diagrams) // 2)
    return figure_of(result.plot, (6.5 * min(2, len(result.diagrams)), 4.5 * rows))


# Campbell diagrams ------------------------------------------------------------------------------------


def campbell_tables(result: Campbell) -> Group:
    """Tables of the crossings, of the margins and of the bounds, those that there are."""
    tables = [_crossings_table(result)]
    tables += [_margins_table(result)] if result.margins else []
    return Group(*tables, *([_bounds_table(result)] if result.bounds else []))


def _of_scenes(result: Campbell, title: str, heads: Sequence[str], rows: Sequence[Sequence[str | Text]],
               words: Sequence[str]) -> Group:  # fmt: skip
    """A table whose rows begin with the label of a scene, which stands there if there are several."""
    first = 0 if len(result.labels) > 1 else 1
    heads = ("scene", *heads)[first:]
    left = [i for i, head in enumerate(heads) if head in ("scene", *words)]
    return table(title, heads, [row[first:] for row in rows], left)


def _crossings_table(result: Campbell) -> Group:
    (unit, factor), rows = result.display_units.speed_unit(), []
    two_planes = any(locus.scene.physics.planes == 2 for locus in result.loci)
    has_flap = any(name.startswith("flap") for names in result.names for name in names)
    model_errors = result.model_error if result.crossings else np.zeros(0)
    for c, model_error in zip(result.crossings, model_errors, strict=True):
        scene, speed = result.loci[result.labels.index(c.label)].scene, factor * c.speed
        share = f"{c.plane_share[first_drawn(scene)]:.3f}" if scene.physics.planes == 2 else "-"
        rows.append(
            (
                c.label,
                set_apart(supported(speed, c.error * speed, _DIGITS), model_error * speed),
                c.line.name,
                c.name,
                supported(c.frequency, c.error * c.frequency, _DIGITS),
                *([share] if two_planes else []),
                f"{c.confidence:.2f}",
                *([] if result.operating is None else ["yes" if c.operating else "no"]),
            )
        )
    number = f"{len(rows) or 'No'} crossing{'s' * (len(rows) != 1)}"
    top = f"{factor * result.loci[0].speeds[-1]:.6g} {unit}"
    title = f"{number} up to {top}, by {result.provenance.method}"
    share_head = ["share of flap" if has_flap else "share of bending"] if two_planes else []
    operating = [] if result.operating is None else ["operating"]
    heads = (f"speed [{unit}]", "line", "mode", "frequency [Hz]", *share_head, "tracking", *operating)
    shown = _of_scenes(result, title, heads, rows, ("line", "mode", "operating"))
    return Group(shown, Text(result.left_out_effects.sentence("crossing" if len(rows) > 1 else "")))


def _margins_table(result: Campbell) -> Group:
    unit, factor = result.display_units.speed_unit()
    rows = [
        (
            m.label,
            m.name,
            m.where,
            f"{factor * m.speed:.6g}",
            f"{m.frequency:.6g}",
            m.line.name,
            f"{100 * m.margin:+.1f} %" if m.margin else "crossed",
        )
        for m in result.margins
    ]
    heads = ("mode", "at", f"speed [{unit}]", "frequency [Hz]", "nearest line", "margin")
    title = "Margins: frequency of the nearest line over the natural frequency, less one"
    return _of_scenes(result, title, heads, rows, ("mode", "at", "nearest line"))


def _bounds_table(result: Campbell) -> Group:
    rows = []
    for label, found in result.bounds:
        for low, high, width in zip(found.lower, found.upper, found.width, strict=True):
            known = (f"{low:.10g}", f"{width:.0e}") if 0 < low <= high else ("-", "-")
            rows.append(
                (label, _name_below(result, label, found.speed, high), known[0], f"{high:.10g}", known[1])
            )
    at = f"{result.display_units.speed_unit().of(result.bounds[0][1].speed):.6g}"
    title = f"Guaranteed bounds at {at} {result.display_units.speed_unit().name}, of the model"
    heads = ("mode", "at least [Hz]", "at most [Hz]", "relative width")
    return _of_scenes(result, title, heads, rows, ("mode",))


def _name_below(result: Campbell, label: str, speed: float, high: float) -> str:
    """Name of the mode whose frequency at a speed is at an upper bound; "-" where none is near."""
    i = result.labels.index(label)
    locus = result.loci[i]
    distance = np.abs(locus.frequency[np.abs(locus.speeds - speed).argmin()] / high - 1)
    near = np.flatnonzero(distance < _NEAR)
    return result.names[i][near[distance[near].argmin()]] if near.size else "-"


def campbell_csv(result: Campbell) -> Columns:
    """Natural frequencies of all scenes over speed, one row a speed."""
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


def crossings_of_lines_csv(result: Campbell) -> Columns:
    """Crossings, one row each."""
    rows = (
        (c.label, c.line.name, c.line.multiple, c.mode, c.name, c.speed, c.speed * _RPM, c.frequency,
         c.error, c.confidence, *c.plane_share, c.operating)
        for c in result.crossings
    )  # fmt: skip
    heads = (
        "scene", "line", "multiple", "mode", "name", ("speed", "rad/s"), ("speed", "rpm"),
        ("frequency", "Hz"), "relative_error", "tracking_confidence", "share_bending", "share_across",
        "operating",
    )  # fmt: skip
    return columns_of_rows(heads, rows)


VIEWS = {
    "Campbell": View(campbell_tables, campbell_csv, 1, lambda result: figure_of(result.plot, (8.5, 6.0))),
    "Diagram": View(diagram_table, diagram_csv),
    "Sensitivities": View(sensitivities_table, sensitivities_csv, 1),
    "Study": View(study_table, study_csv),
    "Tradeoff": View(lambda result: Group(*map(diagram_table, result.diagrams)), tradeoff_csv, 3,
                     _tradeoff_figure),
}  # fmt: skip
