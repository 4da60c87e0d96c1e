"""Transients, steady-state responses, energy harvesting and resonances, as tables and file columns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from rich.console import Group
from rich.text import Text

import beamdyn as bd
from beamdyn.analyses.results import of_modes
from beamdyn.common.edge.console import set_apart, table, table_of
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns
from beamdyn.common.results.pictures import Figure, figure_of
from beamdyn.common.results.statements import said_in
from beamdyn.common.words import supported
from beamdyn.equations.effects import modelled_directions, words_of_directions
from beamdyn.scene.motion.rolling import RollingWheel

_DIGITS = 6  # largest number of digits of a deflection: modal truncation errors exceed further digits
# Relative error that is assumed for a deflection whose error is not estimated.
_ASSUMED_ERROR = 5e-4
_WHERE_COMPUTED = "model_error_where_computed"
_LARGEST = "largest tip deflection"
_WORDS = {"amplitude": _LARGEST, "largest_deflection": _LARGEST, "sum_of_lines": "sum of the lines"}


# Transients -------------------------------------------------------------------------------------------


def transient_table(run: bd.Transient, window: tuple[float, float] | None = None) -> Group:
    """Make a table of a transient: largest deflections, their errors, and neglected effects."""
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
            "The time-integration error is not estimated: this integrator only limits single-step errors. "
            f"Estimated {modes}."
        )
    else:
        errors = f"Estimated time-integration error {unit.say(run.time_error, 1)}, {modes}."
    left_out = of_modes.said_of_model(run, run.left_out_effects.sentence("", "of the largest deflection"))
    return Group(shown, Text(errors), Text(left_out))


def time_of_peak(
    run: bd.Transient, start: float, end: float, direction: int | None = None
) -> tuple[float, float]:
    """Return the time [s] of the largest tip deflection in a window, and its error [s], a sampling step.

    The deflection is that in one `direction` (0: bending, 1: across), or the magnitude of both if None.  If
    the window contains fewer than two samples, return its centre and half its length.
    """
    inside = np.flatnonzero((run.t >= start) & (run.t <= end))
    if len(inside) < 2:
        return (start + end) / 2, (end - start) / 2
    size = np.hypot(run.tip, run.tip_across) if direction is None else (run.tip, run.tip_across)[direction]
    index = inside[np.abs(size[inside]).argmax()]
    return float(run.t[index]), float(np.diff(run.t[inside]).max())


def _peak_cells(run: bd.Transient, start: float, end: float, direction: int | None) -> tuple[Text, Text, str]:
    """Make cells of the largest tip deflection in a window: deflection, ratio to the length, and time [s].

    The deflection is that in one `direction` (0: bending, 1: across), or the magnitude of both if None.
    """
    size, per_si = run.peak(start, end, direction), run.display_units.length_unit().per_si
    error = _ASSUMED_ERROR * size if math.isnan(run.time_error) else run.time_error
    error += run.mode_error * run.largest if math.isfinite(run.mode_error) else 0.0
    beyond = float(run.model_error) * size
    deflection, ratio = (
        set_apart(supported(size * f, error * f, _DIGITS), beyond * f)
        for f in (per_si, 1 / run.scene.beam.length)
    )
    return deflection, ratio, supported(*time_of_peak(run, start, end, direction)) if size else "-"


def transient_csv(run: bd.Transient) -> Columns:
    """Make columns of the tip deflection over time, for each modelled direction, and the model error."""
    names = [f"tip_deflection_{direction}" for direction in of_modes.csv_directions(run.scene)]
    tips = zip(names or ["tip_deflection"], (run.tip, run.tip_across), strict=False)
    error = np.full(len(run.t), float(f"{float(run.model_error):.2g}"))
    return Columns(
        Column("time", run.t, "s"),
        *(Column(name, tip, "m") for name, tip in tips),
        Column("model_error_of_largest", error),
    )


# Deflections over speed -------------------------------------------------------------------------------


def _table_over_speeds(result: bd.SteadyResponse | bd.Sweep, columns: Columns, peaks_at: np.ndarray) -> Group:
    """Make a table with rows at some speeds and at the peaks, whose indices are `peaks_at`.

    The added column of statuses marks the peaks.
    """
    shown, high = of_modes.rows_worth_showing(np.array(result.status), peaks_at), {*peaks_at.tolist()}
    states = [f"{result.status[s]}, peak" if s in high else str(result.status[s]) for s in shown.tolist()]
    status = Column("status", states)
    title = columns.title + of_modes.selection_note(shown, result.speeds)
    note = of_modes.said_over_speeds(result)
    return table_of(Columns(*columns.at(shown).columns, status, title=title, note=note), result.display_units)


def _deflections(
    result: bd.SteadyResponse | bd.Sweep, error: np.ndarray, **sizes: np.ndarray
) -> Iterator[Column]:
    """Yield columns of speeds and of deflections; digits smaller than the model error are dimmed.

    `sizes` are the deflections [m] by the names of their columns, `error` is their absolute error [m].
    """
    words = dict(zip(of_modes.csv_directions(result.scene), words_of_directions(result.scene), strict=True))
    yield Column("speed", result.speeds, "rad/s", form=".8g")
    beyond, form = of_modes.between_speeds(result, result.model_error), partial(supported, most=_DIGITS)
    for name, size in sizes.items():
        head = _WORDS.get(name) or words[name.removeprefix("largest_")]
        yield Column(name, size, "m", "", error, beyond * np.abs(size), form, words=head)


def _by_direction(result: bd.SteadyResponse | bd.Sweep, sizes: Iterable[np.ndarray]) -> dict[str, np.ndarray]:
    """Return the largest deflections `sizes` of each direction by their column names: "largest_bending".

    The dictionary is empty if only one direction is modelled.
    """
    return {
        f"largest_{name}": size
        for name, size in zip(of_modes.csv_directions(result.scene), sizes, strict=False)
    }


def steady_table(result: bd.SteadyResponse) -> Group:
    """Make a table of a steady-state response at some of its speeds, including the peaks."""
    with np.errstate(divide="ignore"):
        peaks_at = peaks(np.log(result.amplitude), np.log(3))
    return _table_over_speeds(result, steady_columns(result), peaks_at)


def steady_columns(result: bd.SteadyResponse) -> Columns:
    """Make columns of the steady-state amplitude in each modelled direction, with errors and status."""
    directions = range(len(words_of_directions(result.scene)))
    error, each = result.error * result.bound, _by_direction(result, [*map(result.largest_tip, directions)])
    return Columns(
        *_deflections(result, error, amplitude=result.amplitude, **each, sum_of_lines=result.bound),
        Column("relative_error", result.error, words=None),
        Column(_WHERE_COMPUTED, _model_error_of(result), words=None),
        Column("growth_rate", result.growth_rate, "1/s", words=None),
        Column("growth_rate_error", result.growth_rate_error, "1/s", words=None),
        Column("status", result.status, words=None),
        title=f"Steady response, by harmonic balance with {result.provenance.method}",
    )


def sweep_table(result: bd.Sweep) -> Group:
    """Make a table of a sweep over speed at some of its speeds, including the peaks."""
    return _table_over_speeds(result, sweep_columns(result), sweep_peaks(result))


def sweep_columns(result: bd.Sweep) -> Columns:
    """Make columns of the largest deflection in each modelled direction, and its errors."""
    (start, end), each = result.window, _by_direction(result, result.peaks_by_direction.T)
    return Columns(
        *_deflections(result, result.peak_error, largest_deflection=result.peaks, **each),
        Column("time_error", result.time_error, "m", words=None),
        Column("mode_error", result.peak_error - result.time_error, "m", words=None),
        Column(_WHERE_COMPUTED, _model_error_of(result), words=None),
        title=f"Largest tip deflection in {start:g} to {end:g} s, by {result.provenance.method}",
    )


def sweep_peaks(result: bd.Sweep) -> np.ndarray:
    """Find the indices of peaks whose prominence is at least a quarter of the largest deflection."""
    return peaks(result.peaks, 0.25 * np.nanmax(result.peaks, initial=0.0))


def peaks(values: np.ndarray, prominence: float) -> np.ndarray:
    """Find indices of local maxima with a prominence (height above the higher valley beside it) or more.

    Values that are not finite are ignored.
    """
    from scipy.signal import find_peaks

    known = np.flatnonzero(np.isfinite(values))
    return known[find_peaks(values[known], prominence=prominence)[0]]


def _model_error_of(result: bd.SteadyResponse | bd.Sweep) -> np.ndarray:
    """Return the model error at each speed; nan if it was not computed."""
    at = np.isin(result.speeds, result.left_out_speeds)
    found = np.full(len(result.speeds), np.nan)
    found[at] = result.model_error if at.any() else np.nan
    return found


def harvest_columns(result: bd.Harvest) -> Columns:
    """Make columns of power, efficiency, voltage, current and strain over speed, with their errors."""
    of_power = result.error * np.abs(result.power)
    limit, electrodes = result.strain_limit, result.scene.beam.electrodes
    resistance = math.nan if electrodes is None else electrodes.resistance
    load = result.say_resistance() if isinstance(result, bd.BestResistance) else f"{resistance:.6g} ohm"
    resonant = ", ".join(result.say_speed(v) for v in result.resonances.tolist()) or "none"
    between = f"Resonances: {resonant} in this range." if len(result.speeds) > 1 else ""
    bears = "" if math.isinf(limit) else f"The layers bear a strain of {limit:g}."
    return Columns(
        Column("speed", result.speeds, "rad/s", form=".8g"),
        Column("power", result.power, "W", error=of_power),
        Column("efficiency", result.efficiency, error=result.error * result.efficiency),
        Column("voltage", result.voltage, "V", error=result.error * result.voltage),
        Column("current", result.current, "A", error=result.error * result.current),
        Column("strain", result.strain, error=result.strain_error),
        Column("largest_deflection", result.amplitude, "m", error=result.error * result.amplitude),
        *(replace(each, words=None) for each in _road_columns(result)),
        Column("input_power", result.input_power, "W", words=None),
        Column("relative_error", result.error, words=None),
        *_velocity(result),
        Column("status", result.status),
        title=f"Harvested with {load}, by harmonic balance with {result.provenance.method}",
        note=f"{between} {bears}".strip(),
    )


def _velocity(result: bd.Harvest) -> Iterator[Column]:
    """Yield the column of the vehicle's velocity, if the wheel rolls."""
    if isinstance(wheel := result.scene.motion, RollingWheel):
        yield Column("velocity", 3.6 * wheel.rolling_radius * result.speeds, "km/h", words=None)


def _road_columns(result: bd.Harvest) -> tuple[Column, ...]:
    """Make the columns of mean power and rms values on the random road; empty if there is no such road."""
    if (road := result.road) is None:
        return ()
    of_rms = road.error / 2
    return (
        Column("road_power", road.power, "W", error=road.error * road.power, words="mean power"),
        Column("road_voltage_rms", road.voltage, "V", error=of_rms * road.voltage, words="rms voltage"),
        Column("road_current_rms", road.current, "A", error=of_rms * road.current, words="rms current"),
        Column("road_strain_rms", road.strain, error=road.strain_error, words="rms strain"),
        Column(
            "road_deflection_rms", road.deflection, "m", error=road.deflection_error, words="rms deflection"
        ),
    )


def _harvest_tables(result: bd.Harvest) -> Group:
    """Make tables of harvesting in steady motion and on a random road, at some speeds and at the best one.

    The best speed is the one with the largest power.
    """
    shown = of_modes.rows_worth_showing(result.status, np.flatnonzero(result.speeds == result.best[0]))
    tables = [harvest_columns(result)]
    if result.road is not None:
        speed = Column("speed", result.speeds, "rad/s", form=".8g")
        title = f"Additionally on a random road, {result.road.roughness.words}"
        tables.append(Columns(speed, *_road_columns(result), title=title))
    few = of_modes.selection_note(shown, result.speeds)
    return Group(*(table_of(each.at(shown), result.display_units, each.title + few) for each in tables))


def _panels(result: bd.Harvest) -> Figure:
    """Draw the results of energy harvesting over speed, in several panels."""
    return figure_of(result.plot_panels, result.picture_size())


def harvest_over_time(result: bd.TransientHarvest) -> Columns:
    """Make columns of voltage, current, power, harvested energy and strain of the layers over time."""
    return Columns(
        Column("time", result.t, "s"),
        Column("voltage", result.voltage, "V"),
        Column("current", result.current, "A"),
        Column("power", result.power, "W"),
        Column("energy", result.energy, "J"),
        Column("strain", result.strain),
        title=f"Harvested in {result.run.path.end:g} s, by {result.provenance.method}",
    )


# Resonances ---------------------------------------------------------------------------------------------


def crossings_columns(result: bd.Crossings) -> Columns:
    """Make columns of resonance speeds, with the planes of the modes if two planes are modelled."""
    speed, frequency, error = (
        np.array([getattr(c, name) for c in result]) for name in ("speed", "frequency", "error")
    )
    model_error = np.atleast_1d(result.model_error)[: len(result)]
    second = ["" if c.second_mode is None else c.second_mode for c in result]
    modes = [f"{c.mode} and {c.second_mode}" if c.second_mode else f"{c.mode}" for c in result]
    lines = [f"{c.line.name}: {c.line.multiple:.6g} times the speed" for c in result]
    number = f"{len(result) or 'No'} resonance speed{'s' * (len(result) != 1)}"
    extent = said_in(result.display_units, result.extent)
    left_out = result.left_out_effects.sentence("resonance" if len(result) > 1 else "")
    return Columns(
        Column("speed", speed, "rad/s", error=error * speed, beyond=model_error * speed),
        Column("relative_error", error, words=None),
        Column("model_error", model_error, words=None),
        Column("frequency", frequency, "Hz", error=error * frequency, beyond=model_error * frequency),
        Column("line", [c.line.name for c in result], cells=lines),
        Column("multiple", [c.line.multiple for c in result], words=None),
        Column("mode", [c.mode for c in result], cells=modes),
        Column("second_mode", second, words=None),
        Column("kind", [c.kind for c in result]),
        *_shares(result),
        title=f"{number}, by {result.provenance.method}. {extent}",
        note=of_modes.said_of_model(result, left_out),
    )


def _shares(result: bd.Crossings) -> Iterator[Column]:
    """Yield columns of the energy fractions of both planes in each mode; tables show one, in percent."""
    head: str | None = f"{', '.join(words_of_directions(result.scene))} [%]"
    known = [[s for s in (c.plane_share, c.second_plane_share) if s is not None] for c in result]
    cells = [" and ".join(f"{100 * a:.0f}, {100 * b:.0f}" for a, b in shares) for shares in known]
    for of_mode, mode in enumerate(("", "second_")):
        for k, direction in enumerate(of_modes.csv_directions(result.scene)):
            values = [shares[of_mode][k] if len(shares) > of_mode else "" for shares in known]
            yield Column(f"{mode}share_{direction}", values, cells=cells, words=head)
            head = None


VIEWS = {
    "Crossings": View(None, crossings_columns, 1),
    "BestResistance": View(_harvest_tables, harvest_columns, 1, _panels),
    "Harvest": View(_harvest_tables, harvest_columns, 1, _panels),
    "SteadyResponse": View(steady_table, steady_columns, 1),
    "Sweep": View(sweep_table, sweep_columns, 1),
    "TransientHarvest": View(None, harvest_over_time, 1),
    "Transient": View(transient_table, transient_csv, 1),
}
