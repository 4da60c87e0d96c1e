"""Reports for people: numbers with the digits they deserve, tables, and comparisons with published values."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from rich import box
from rich.console import Console, Group
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from beamdyn.resonance import Crossings
    from beamdyn.spectrum import Locus, Modes
    from beamdyn.stability import SettingAngleLimits
    from beamdyn.steady import SteadyResponse
    from beamdyn.sweeps import Sweep
    from beamdyn.transient import Transient

_DIGITS = 10  # most that a table shows
_PIPE_WIDTH = 120  # of tables that go to a file or another program


def console() -> Console:
    """Where reports are printed: standard output, without markup."""
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    return Console(width=width, markup=False, highlight=False, emoji=False)


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """A bar with the remaining time on standard error, if that is a terminal: yields its progress."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    screen = Console(stderr=True)
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as bar:
        task = bar.add_task(what)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def supported(value: float, error: float, most: int = _DIGITS) -> str:
    """A number with the digits that its error leaves: half a unit of the last one is not below the error.

    Parameters
    ----------
    value : float
        The number.
    error : float
        Its absolute error.
    most : int
        Most significant digits.

    Returns
    -------
    str
        "0 ± error" where no digit is sure, "unresolved" where the error is not known.
    """
    if not math.isfinite(value):
        return "none" if math.isnan(value) else str(value)
    if not math.isfinite(error):
        return "unresolved"
    if value == 0 and error == 0:
        return "0"
    if 2 * error >= abs(value):
        return f"0 ± {abs(value) + error:.1g}"
    lead = math.floor(math.log10(abs(value)))
    decimals = most - 1 - lead
    if error > 0:
        decimals = min(decimals, math.floor(-math.log10(2 * error)))
    if decimals + lead < 0:
        return f"0 ± {abs(value) + error:.1g}"
    return f"{value:.{decimals}f}" if lead > -4 and decimals >= 0 else f"{value:.{decimals + lead}e}"


def table(
    title: str, columns: Sequence[str], rows: Iterable[Sequence[str]], left: Sequence[int] = (0,)
) -> Group:
    """A table of text.

    Parameters
    ----------
    title : str
        Above it.
    columns : sequence of str
        Headings.
    rows : iterable of sequences of str
        Cells; an empty row draws a line.
    left : sequence of int
        Columns that are flush left, such as words; numbers are flush right.

    Returns
    -------
    rich.console.Group
        The title and the table.
    """
    made = Table(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0))
    for i, heading in enumerate(columns):
        made.add_column(heading, justify="left" if i in left else "right", no_wrap=i not in left)
    for row in rows:
        if row:
            made.add_row(*row)
        else:
            made.add_section()
    return Group(Text(title, style="bold"), made)


@dataclass(frozen=True)
class Comparison:
    """A published value beside ours.

    Parameters
    ----------
    what : str
        What is compared.
    source : str
        Who published it.
    published : float or pair of floats
        The value, or the ends of the interval in which it is said to lie.
    ours : float
        Our value.
    error : float
        Its estimated absolute error.
    decimals : int
        Decimals printed by the source.
    reason : str
        Why the two are known to differ; empty where they should agree.
    """

    what: str
    source: str
    published: float | tuple[float, float]
    ours: float
    error: float
    decimals: int
    reason: str = ""

    @property
    def deviation(self) -> float:
        """Ours less the published value; of an interval, less the nearest of it."""
        ends = self.published if isinstance(self.published, tuple) else (self.published,) * 2
        return self.ours - min(max(self.ours, ends[0]), ends[1])

    @property
    def bound(self) -> float:
        """Largest deviation of values that agree: the source's rounding and our error."""
        rounding = 0.0 if isinstance(self.published, tuple) else 0.5 * 10.0**-self.decimals
        return rounding + self.error

    @property
    def agrees(self) -> bool:
        """Whether the deviation is within the bound."""
        return abs(self.deviation) <= self.bound

    @property
    def as_expected(self) -> bool:
        """Whether they agree, or differ for a known reason."""
        return self.agrees != bool(self.reason)

    @property
    def verdict(self) -> str:
        """In words."""
        if self.agrees:
            return "agrees" if not self.reason else "agrees, which is unexpected"
        return f"differs: {self.reason or 'unexpected'}"

    def cells(self) -> list[str]:
        """Its row of the table."""
        return [
            self.what,
            self.source,
            self._published(),
            supported(self.ours, self.error, 12) if self.error else f"{self.ours:.{self.decimals}f}",
            self._deviation(),
            self.verdict,
        ]

    def _published(self) -> str:
        ends = self.published if isinstance(self.published, tuple) else (self.published,)
        return " to ".join(f"{end:.{self.decimals}f}" for end in ends)

    def _deviation(self) -> str:
        if isinstance(self.published, tuple) and self.deviation == 0:
            return "inside"
        text = supported(self.deviation, self.error, 2)
        return text if self.deviation <= 0 or "±" in text else f"+{text}"


def comparison_table(title: str, rows: Iterable[Comparison]) -> Group:
    """The table of comparisons, with a line where the first two words of `what` change."""
    cells: list[list[str]] = []
    for row in rows:
        if cells and _topic(cells[-1][0]) != _topic(row.what):
            cells.append([])
        cells.append(row.cells())
    return table(
        title,
        ("what", "published by", "published", "ours", "deviation", "verdict"),
        cells,
        (0, 1, 5),
    )


def _topic(what: str) -> list[str]:
    return what.replace(",", "").split()[:2]


# Analyses -------------------------------------------------------------------------------------------

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
    return Group(shown, Text(_time_error(run)), *(Text(f"warning: {w}") for w in run.warnings))


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
    deflection, share = (supported(size * f, error * f, _MODEL_DIGITS) for f in (1e3, 1 / length))
    return deflection, share, supported(*time_of_peak(run, start, end)) if size else "-"


def _time_error(run: Transient) -> str:
    if math.isnan(run.time_error):
        return "The error in time is not estimated: this integrator bounds that of each step only."
    return (
        f"Estimated error by the steps in time: {1e3 * run.time_error:.1g} mm; "
        "that of modes left out is seen by asking for more."
    )


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
    return f" ({len(shown)} of {len(all_)} speeds; --csv or --json has all)"
