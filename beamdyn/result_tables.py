"""Reports for people: each result as a table, with the digits that its error leaves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.digits import supported
from beamdyn.common.edge.tables import table

if TYPE_CHECKING:
    from beamdyn.spectrum.critical import SettingAngleLimits
    from beamdyn.spectrum.modes import Locus, Modes
    from beamdyn.steady.resonance import Crossings
    from beamdyn.steady.response import SteadyResponse
    from beamdyn.transient.simulate import Transient
    from beamdyn.transient.sweep import Sweep

_SHOWN = 16  # rows of a locus, apart from those where a mode turns unstable


def modes_table(found: Modes) -> Group:
    """The table of natural modes."""
    rows = []
    size = np.abs(found.eigenvalue) * found.error  # absolute error of the eigenvalues
    for i, status in enumerate(found.status):
        frequency = supported(found.frequency[i], size[i] / (2 * np.pi)).replace("none", "-")
        growth = "0" if found.growth_rate[i] == 0 else supported(found.growth_rate[i], size[i])
        rows.append((str(i + 1), frequency, f"{found.error[i]:.0e}", growth, str(status)))
    title = f"Natural modes at {found.speed:.10g} rad/s, by {found.provenance.method}"
    return table(
        title, ("mode", "frequency [Hz]", "relative error", "growth rate [1/s]", "status"), rows, (4,)
    )


def locus_table(found: Locus) -> Group:
    """The table of a locus: some of its speeds, each frequency or, where there is none, the growth rate."""
    rows = []
    size = np.abs(found.eigenvalue) * found.error
    for s in (shown := _shown(found)):
        cells = [_cell(found, size, s, mode) for mode in range(found.frequency.shape[1])]
        sure = f"{found.confidence[s].min():.2f}"
        rows.append((f"{found.speeds[s]:.8g}", *cells, f"{found.error[s].max():.0e}", sure))
    heads = [f"mode {mode} [Hz]" for mode in range(1, found.frequency.shape[1] + 1)]
    title = f"Natural frequencies, by {found.provenance.method}{_part(shown, found.speeds)}"
    return table(title, ("speed [rad/s]", *heads, "largest error", "tracking"), rows, ())


def _shown(found: Locus) -> np.ndarray:
    """Indices of speeds for people: evenly spread, and those before and after a change of status."""
    count = len(found.speeds)
    spread = np.linspace(0, count - 1, min(count, _SHOWN)).round().astype(int)
    change = np.flatnonzero((found.status[1:] != found.status[:-1]).any(axis=1))[:_SHOWN]
    return np.unique(np.concatenate([spread, change, change + 1]))


def _cell(found: Locus, size: np.ndarray, s: int, mode: int) -> str:
    if found.status[s, mode] == "stable":
        return supported(found.frequency[s, mode], size[s, mode] / (2 * np.pi))
    return f"{found.status[s, mode]}, {found.growth_rate[s, mode]:+.3g} 1/s"


def limits_table(found: SettingAngleLimits) -> Group:
    """The table of setting-angle limits."""
    degrees = [supported(float(np.degrees(limit)), float(np.degrees(found.error))) for limit in found]
    meaning = (
        "below it the first frequency falls with speed; above it, it rises from rest",
        "below it the first frequency falls before the top speed; above it, it rises",
    )
    title = f"Setting-angle limits up to {found.top_speed:.10g} rad/s, by {found.provenance.method}"
    rows = zip(("first", "second"), degrees, meaning, strict=True)
    return table(title, ("limit", "angle [deg]", ""), rows, (0, 2))


# Motion in time and resonance -------------------------------------------------------------------------

_MODEL_DIGITS = 6  # most of a deflection: the modes that are left out allow no more
_UNKNOWN = 5e-4  # relative error with which a deflection of unknown error is shown


def transient_table(run: Transient, window: tuple[float, float] | None = None) -> Group:
    """The table of a transient: its largest deflections, its error, its warnings."""
    start, end = run.path.start, run.path.end
    stretches = {"whole run": (start, end)}
    if window is not None:
        stretches[f"{window[0]:g} to {window[1]:g} s"] = window
    rows = [(name, *_peak_cells(run, *stretch)) for name, stretch in stretches.items()]
    shown = table(
        f"Largest tip deflection in {end:g} s, by {run.provenance.method}",
        ("", "tip deflection [mm]", "over the length", "at [s]"),
        rows,
    )
    return Group(shown, Text(_errors(run)), *(Text(f"warning: {w}") for w in run.warnings))


def time_of_peak(run: Transient, start: float, end: float) -> tuple[float, float]:
    """Time of the largest tip deflection between two times, by the samples, and their distance [s]."""
    inside = np.flatnonzero((run.t >= start) & (run.t <= end))
    if len(inside) < 2:
        return (start + end) / 2, (end - start) / 2
    place = inside[np.abs(run.tip[inside]).argmax()]
    return float(run.t[place]), float(np.diff(run.t[inside]).max())


def _peak_cells(run: Transient, start: float, end: float) -> tuple[str, str, str]:
    size, length = run.peak(start, end), run.scene.beam.length
    error = _UNKNOWN * size if math.isnan(run.time_error) else run.time_error
    error += run.mode_error if math.isfinite(run.mode_error) else 0.0
    deflection, share = (supported(size * f, error * f, _MODEL_DIGITS) for f in (1e3, 1 / length))
    return deflection, share, supported(*time_of_peak(run, start, end)) if size else "-"


def _errors(run: Transient) -> str:
    """The two errors in words."""
    known = math.isfinite(run.mode_error)
    modes = (
        f"by the modes left out {1e3 * run.mode_error:.1g} mm" if known else "by the modes left out unknown"
    )
    if math.isnan(run.time_error):
        return (
            "The error in time is not estimated: this integrator bounds that of each step only. "
            f"Estimated error {modes}."
        )
    return f"Estimated error by the steps in time {1e3 * run.time_error:.1g} mm, {modes}."


def crossings_table(found: Crossings) -> Group:
    """The table of resonance speeds."""
    rows = [
        (
            supported(c.speed, c.error * c.speed),
            f"{c.line.name}: {c.line.multiple:.6g} times the speed",
            str(c.mode) if c.second_mode is None else f"{c.mode} and {c.second_mode}",
            supported(c.frequency, c.error * c.frequency),
            c.kind,
        )
        for c in found
    ]
    title = f"{len(rows) or 'No'} resonance speed{'s' * (len(rows) != 1)}, by {found.provenance.method}"
    return table(title, ("speed [rad/s]", "line", "mode", "frequency [Hz]", "kind"), rows, (1, 4))


def steady_table(found: SteadyResponse) -> Group:
    """The table of a steady response: some of its speeds, its peaks among them."""
    with np.errstate(divide="ignore"):
        summits = peaks(np.log(found.amplitude), np.log(3))
    shown = _shown_response(found.status, summits)
    error = found.error * found.bound
    sizes = [_millimetres(values, error) for values in (found.amplitude, found.bound)]
    columns = [_speed_cells(found.speeds), *sizes, _status_cells(found.status, summits)]
    title = f"Steady response, by harmonic balance with {found.provenance.method}"
    heads = ("speed [rad/s]", "largest tip deflection [mm]", "sum of the lines [mm]", "status")
    return table(title + _part(shown, found.speeds), heads, _rows(columns, shown), (3,))


def sweep_table(found: Sweep) -> Group:
    """The table of a sweep: some of its speeds, its peaks among them."""
    summits = sweep_peaks(found)
    shown = _shown_response(np.array(found.status), summits)
    sizes = _millimetres(found.peaks, found.time_error)
    columns = _speed_cells(found.speeds), sizes, _status_cells(found.status, summits)
    start, end = found.window
    title = f"Largest tip deflection in {start:g} to {end:g} s, by {found.provenance.method}"
    heads = ("speed [rad/s]", "largest tip deflection [mm]", "status")
    return table(title + _part(shown, found.speeds), heads, _rows(columns, shown), (2,))


def sweep_peaks(found: Sweep) -> np.ndarray:
    """Indices of the speeds at which a sweep peaks: by a quarter of its largest deflection."""
    return peaks(found.peaks, 0.25 * np.nanmax(found.peaks, initial=0.0))


def _speed_cells(speeds: np.ndarray) -> list[str]:
    return [f"{speed:.8g}" for speed in speeds]


def _millimetres(values: np.ndarray, error: np.ndarray) -> list[str]:
    pairs = zip(1e3 * values, 1e3 * error, strict=True)
    return [supported(float(v), float(e), _MODEL_DIGITS) for v, e in pairs]


def _status_cells(status: Iterable[str], summits: np.ndarray) -> list[str]:
    high = set(summits.tolist())
    return [f"{s}, peak" if i in high else str(s) for i, s in enumerate(status)]


def _rows(columns: Sequence[list[str]], shown: np.ndarray) -> Iterator[list[str]]:
    return ([column[s] for column in columns] for s in shown)


def _shown_response(status: np.ndarray, summits: np.ndarray) -> np.ndarray:
    """Indices of speeds for people: evenly spread, the peaks, and where the status changes."""
    spread = np.linspace(0, len(status) - 1, min(len(status), _SHOWN)).round().astype(int)
    change = np.flatnonzero(status[1:] != status[:-1])[:_SHOWN]
    return np.unique(np.concatenate([spread, summits[:_SHOWN], change, change + 1]))


def peaks(values: np.ndarray, prominence: float) -> np.ndarray:
    """Indices of the local maxima that stand out by so much; values that are not finite do not count."""
    from scipy.signal import find_peaks

    known = np.flatnonzero(np.isfinite(values))
    return known[find_peaks(values[known], prominence=prominence)[0]]


def _part(shown: np.ndarray, all_: np.ndarray) -> str:
    if len(shown) == len(all_):
        return ""
    return f" ({len(shown)} of {len(all_)} speeds; CSV and JSON have all)"
