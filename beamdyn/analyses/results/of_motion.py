"""Motion in time, steady response and resonances, as tables for reading and as columns of files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.analyses.results.of_modes import (
    Cell,
    between_speeds,
    csv_directions,
    line_over_speeds,
    model_line,
    rows_worth_showing,
    selection_note,
    speed_column,
)
from beamdyn.common.edge.tables import set_apart, table, table_of
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, columns_of_rows
from beamdyn.common.results.digits import supported
from beamdyn.common.results.statements import said_in
from beamdyn.equations.effects import modelled_directions, words_of_directions

if TYPE_CHECKING:
    from beamdyn.steady.crossings import Crossings
    from beamdyn.steady.response import SteadyResponse
    from beamdyn.transient.sweep import Sweep
    from beamdyn.transient.transient import Transient

_DIGITS = 6  # most digits of a deflection, which the modal truncation error allows
_ASSUMED_ERROR = 5e-4  # relative error assumed for the digits of a deflection whose error is not estimated
_WHERE_COMPUTED = "model_error_where_computed"


# Transients -------------------------------------------------------------------------------------------


def transient_table(run: Transient, window: tuple[float, float] | None = None) -> Group:
    """Table of a transient: its largest deflections and errors, and what the model leaves out."""
    end, unit, names = run.path.end, run.display_units.length_unit(), modelled_directions(run.scene)
    windows = {"whole run": (run.path.start, end)}
    if window is not None:
        windows[f"{window[0]:g} to {window[1]:g} s"] = window
    directions = [("", None), *((f", {name}", i) for i, name in enumerate(names) if len(names) > 1)]
    rows = [
        (f"{name}{which}", *_peak_cells(run, *bounds, direction))
        for name, bounds in windows.items()
        for which, direction in directions
    ]
    title = f"Largest tip deflection in {end:g} s, by {run.provenance.method}"
    shown = table(title, ("", f"tip deflection [{unit.name}]", "over the length", "at [s]"), rows)
    size = unit.say(run.mode_error * run.largest, 1) if math.isfinite(run.mode_error) else "unknown"
    modes = f"modal truncation error {size}"
    if math.isnan(run.time_error):
        errors = (
            "The time-integration error is not estimated: this integrator bounds that of single steps only. "
            f"Estimated {modes}."
        )
    else:
        errors = f"Estimated time-integration error {unit.say(run.time_error, 1)}, {modes}."
    left_out = model_line(run, run.left_out_effects.sentence("", "of the largest deflection"))
    return Group(shown, Text(errors), left_out)


def time_of_peak(
    run: Transient, start: float, end: float, direction: int | None = None
) -> tuple[float, float]:
    """Time of the largest tip deflection in a window, and its uncertainty, the sampling interval [s].

    Of a window with less than two samples, its middle and half its length.
    """
    inside = np.flatnonzero((run.t >= start) & (run.t <= end))
    if len(inside) < 2:
        return (start + end) / 2, (end - start) / 2
    size = np.hypot(run.tip, run.tip_across) if direction is None else (run.tip, run.tip_across)[direction]
    index = inside[np.abs(size[inside]).argmax()]
    return float(run.t[index]), float(np.diff(run.t[inside]).max())


def _peak_cells(run: Transient, start: float, end: float, direction: int | None) -> tuple[Text, Text, str]:
    """Largest tip deflection in a window, over the length, and its time [s]."""
    size, per_si = run.peak(start, end, direction), run.display_units.length_unit().per_si
    error = _ASSUMED_ERROR * size if math.isnan(run.time_error) else run.time_error
    error += run.mode_error * run.largest if math.isfinite(run.mode_error) else 0.0
    beyond = float(run.model_error) * size
    deflection, ratio = (
        set_apart(supported(size * f, error * f, _DIGITS), beyond * f)
        for f in (per_si, 1 / run.scene.beam.length)
    )
    return deflection, ratio, supported(*time_of_peak(run, start, end, direction)) if size else "-"


def transient_csv(run: Transient) -> Columns:
    """Tip deflection over time, in both directions where two are modelled, and the largest's model error."""
    names = [f"tip_deflection_{direction}" for direction in csv_directions(run.scene)]
    tips = zip(names or ["tip_deflection"], (run.tip, run.tip_across), strict=False)
    error = np.full(len(run.t), float(f"{float(run.model_error):.2g}"))
    return Columns(
        Column("time", run.t, "s"),
        *(Column(name, tip, "m") for name, tip in tips),
        Column("model_error_of_largest", error),
    )


# Deflections over speed -------------------------------------------------------------------------------


def _deflections_table(
    result: SteadyResponse | Sweep,
    title: str,
    sizes: dict[str, np.ndarray],
    error: np.ndarray,
    status: Sequence[str] | np.ndarray,
    peaks_at: np.ndarray,
) -> Group:
    """Deflections [m] at some speeds, the peaks included; digits beyond the model error are dimmed."""
    unit, shown = result.display_units.length_unit(), rows_worth_showing(np.array(status), peaks_at)
    beyond, high = between_speeds(result, result.model_error), {*peaks_at.tolist()}
    columns: dict[str, Sequence[Cell]] = {**speed_column(result, result.speeds[shown])}
    for name, values in sizes.items():
        each = zip(*(row[shown].tolist() for row in (unit.of(values), unit.of(error), beyond)), strict=True)
        columns[f"{name} [{unit.name}]"] = [
            set_apart(supported(value, wrong, _DIGITS), relative * abs(value))
            for value, wrong, relative in each
        ]
    columns["status"] = [f"{status[s]}, peak" if s in high else str(status[s]) for s in shown.tolist()]
    made = table_of(title + selection_note(shown, result.speeds), columns, ("status",))
    return Group(made, line_over_speeds(result))


def steady_table(result: SteadyResponse) -> Group:
    """Table of a steady response at some of its speeds, the peaks included."""
    with np.errstate(divide="ignore"):
        peaks_at = peaks(np.log(result.amplitude), np.log(3))
    by_direction = dict(zip(words_of_directions(result.scene), largest_by_direction(result), strict=True))
    sizes = {"largest tip deflection": result.amplitude} | by_direction | {"sum of the lines": result.bound}
    title = f"Steady response, by harmonic balance with {result.provenance.method}"
    error = result.error * result.bound
    return _deflections_table(result, title, sizes, error, result.status, peaks_at)


def largest_by_direction(result: SteadyResponse) -> list[np.ndarray]:
    """Largest tip deflection in the direction of bending and across, where both are modelled."""
    return [result.largest_tip(direction) for direction in range(len(words_of_directions(result.scene)))]


def steady_csv(result: SteadyResponse) -> Columns:
    """Steady amplitude, also by direction where two are modelled, growth rate, errors, status over speed."""
    each = zip(csv_directions(result.scene), largest_by_direction(result), strict=True)
    return Columns(
        Column("speed", result.speeds, "rad/s"),
        Column("amplitude", result.amplitude, "m"),
        *(Column(f"largest_{direction}", size, "m") for direction, size in each),
        Column("sum_of_lines", result.bound, "m"),
        Column("relative_error", result.error),
        Column(_WHERE_COMPUTED, _model_error_of(result)),
        Column("growth_rate", result.growth_rate, "1/s"),
        Column("growth_rate_error", result.growth_rate_error, "1/s"),
        Column("status", result.status),
    )


def sweep_table(result: Sweep) -> Group:
    """Table of a sweep at some of its speeds, the peaks included."""
    start, end = result.window
    title = f"Largest tip deflection in {start:g} to {end:g} s, by {result.provenance.method}"
    each = zip(words_of_directions(result.scene), result.peaks_by_direction.T, strict=False)
    sizes = {"largest tip deflection": result.peaks, **dict(each)}
    return _deflections_table(result, title, sizes, result.peak_error, result.status, sweep_peaks(result))


def sweep_peaks(result: Sweep) -> np.ndarray:
    """Find the indices of the peaks of a sweep, more prominent than a quarter of its largest deflection."""
    return peaks(result.peaks, 0.25 * np.nanmax(result.peaks, initial=0.0))


def peaks(values: np.ndarray, prominence: float) -> np.ndarray:
    """Find the indices of local maxima of at least a prominence; values that are not finite are skipped."""
    from scipy.signal import find_peaks

    known = np.flatnonzero(np.isfinite(values))
    return known[find_peaks(values[known], prominence=prominence)[0]]


def sweep_csv(result: Sweep) -> Columns:
    """Largest deflection, where two directions are modelled also in each, and its errors."""
    each = zip(csv_directions(result.scene), result.peaks_by_direction.T, strict=False)
    return Columns(
        Column("speed", result.speeds, "rad/s"),
        Column("largest_deflection", result.peaks, "m"),
        *(Column(f"largest_{direction}", peaks, "m") for direction, peaks in each),
        Column("time_error", result.time_error, "m"),
        Column("mode_error", result.peak_error - result.time_error, "m"),
        Column(_WHERE_COMPUTED, _model_error_of(result)),
    )


def _model_error_of(result: SteadyResponse | Sweep) -> np.ndarray:
    """Model error at each speed (S,); nan where it is not computed."""
    at = np.isin(result.speeds, result.left_out_speeds)
    found = np.full(len(result.speeds), np.nan)
    found[at] = result.model_error if at.any() else np.nan
    return found


# Resonances ---------------------------------------------------------------------------------------------


def crossings_table(result: Crossings) -> Group:
    """Table of resonance speeds, with the plane of each mode where two are modelled."""
    unit, words, rows = result.display_units.speed_unit(), words_of_directions(result.scene), []
    for c, beyond in zip(result, np.atleast_1d(result.model_error).tolist(), strict=False):
        speed = unit.of(c.speed)
        shares = [s for s in (c.plane_share, c.second_plane_share) if s is not None]
        planes = " and ".join(f"{100 * bending:.0f}, {100 * across:.0f}" for bending, across in shares)
        rows.append(
            (
                set_apart(supported(speed, c.error * speed), beyond * speed),
                f"{c.line.name}: {c.line.multiple:.6g} times the speed",
                str(c.mode) if c.second_mode is None else f"{c.mode} and {c.second_mode}",
                *([planes] if words else []),
                set_apart(supported(c.frequency, c.error * c.frequency), beyond * c.frequency),
                c.kind,
            )
        )
    number = f"{len(rows) or 'No'} resonance speed{'s' * (len(rows) != 1)}"
    title = f"{number}, by {result.provenance.method}. {said_in(result.display_units, result.extent)}"
    plane = [f"{', '.join(words)} [%]"] if words else []
    heads = (f"speed [{unit.name}]", "line", "mode", *plane, "frequency [Hz]", "kind")
    line = model_line(result, result.left_out_effects.sentence("resonance" if len(rows) > 1 else ""))
    return Group(table(title, heads, rows, (1, len(heads) - 1)), line)


def crossings_csv(result: Crossings) -> Columns:
    """Resonance speeds, one row each, with the plane of each mode where two are modelled."""
    directions = csv_directions(result.scene)
    shares = [f"{mode}share_{direction}" for mode in ("", "second_") for direction in directions]
    rows = []
    for c, model_error in zip(result, np.atleast_1d(result.model_error).tolist(), strict=False):
        second = "" if c.second_mode is None else c.second_mode
        values = *c.plane_share, *(c.second_plane_share or ("", ""))
        row = c.speed, c.error, model_error, c.frequency, c.line.name, c.line.multiple, c.mode, second, c.kind
        rows.append((*row, *values[: len(shares)]))
    first = ("speed", "rad/s"), "relative_error", "model_error", ("frequency", "Hz")
    return columns_of_rows((*first, "line", "multiple", "mode", "second_mode", "kind", *shares), rows)


VIEWS = {
    "Crossings": View(crossings_table, crossings_csv, 1),
    "SteadyResponse": View(steady_table, steady_csv, 1),
    "Sweep": View(sweep_table, sweep_csv, 1),
    "Transient": View(transient_table, transient_csv, 1),
}
