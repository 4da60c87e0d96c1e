"""Tables and a plot of the measurements of all programs."""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Iterator, Sequence
from datetime import date
from pathlib import Path
from textwrap import fill
from typing import Protocol

from beamdyn.common.results.pictures import Axes, Figure
from benchmarks.peers.measure import ALONE, CASES, DEFAULT, OURS, Point
from benchmarks.rows import markdown_table, time_text

MISSING = "not installed"
MARKERS = {  # markers and colours of the programs, equal in all panels
    OURS: ("o", "C0"),
    "CalculiX": ("s", "C1"),
    "pyBModes": ("^", "C2"),
    "Exudyn": ("D", "C3"),
    "solve_ivp": ("X", "C4"),
}
TITLE_WIDTH = 42  # number of characters of a title's line that fit the width of a panel
INTRODUCTION = """# Beside other programs

Written by `python -m benchmarks.peers` on {day} (Python {python}, {machine}), which installs nothing;
how to install the programs: [benchmarks/peers](../benchmarks/peers/README.md).
Versions: {versions}.

![Error against time](peers.png)
"""
NOTES = """## How it is measured

- All in one run. The shortest of several runs counts; programs of Python run with the default number of
  BLAS threads and with one, and the faster counts, ours like the others.
- "beamdyn faster by" is the peer's time over the shortest of beamdyn's that has an equal or smaller error in
  the same case: per speed of a locus of a thousand speeds, or for one speed by itself. Below 1 the peer is
  faster. "Target" is what we aimed at beforehand, at that setting. "Our default" is without `tolerance=`:
  errors of 1e-10 and less (5.7e-11 is what the harvester's reference, known to ten digits, can show).
- Errors are relative to the linear Euler-Bernoulli beam. CalculiX also models shear and rotary inertia of the
  solid, about 1e-5 here, and writes seven digits; Exudyn's cables deflect without limit of size. Part of what
  stands as their error is this difference of models. Exudyn tends to our result as its step becomes smaller.
- CalculiX's time is a whole run with the start of its process; pyBModes's a solution for one mode of a model
  already read; Exudyn's its solver alone; beamdyn's the whole call, with its estimate of the error.
"""


class Peer(Protocol):
    """Interface of a module that measures one program."""

    NAME: str
    BETTER: str
    TARGET: tuple[str, float] | None

    def version(self) -> str | None: ...

    def points(self) -> Iterator[Point]: ...


def ratio(point: Point, points: Sequence[Point], alone: bool = False, default: bool = False) -> float:
    """Return the program's time over our shortest time with at most its error; nan if there is none."""
    ours = [
        p.time
        for p in points
        if (p.case, p.program) == (point.case, OURS)
        and p.error <= point.error
        and p.setting.startswith(ALONE) == alone
        and (p.setting.endswith(DEFAULT) or not default)
    ]
    return point.time / min(ours) if ours else math.nan


def versions(peers: Sequence[Peer]) -> str:
    return ", ".join(f"{peer.NAME} {peer.version() or MISSING}" for peer in peers)


def rows(points: Sequence[Point], peers: Sequence[Peer]) -> Iterator[tuple[str, ...]]:
    """Yield case, program, setting, time, error and ratio; then the programs that are not installed."""
    for case in CASES:
        shown = case
        for point in (p for p in points if p.case == case):
            faster = ("", "") if point.program == OURS else ratios(point, points)
            yield shown, point.program, point.setting, time_text(point.time), f"{point.error:.1e}", *faster
            shown = ""
    for peer in peers:
        if peer.version() is None:
            yield "", peer.NAME, MISSING, "", "", "", ""


def ratios(point: Point, points: Sequence[Point]) -> tuple[str, str]:
    return times(ratio(point, points)), times(ratio(point, points, alone=True))


def target_rows(points: Sequence[Point], peers: Sequence[Peer]) -> Iterator[tuple[str, ...]]:
    """Yield for each program the ratio of its time to ours, at the target's setting and over all settings."""
    for peer in peers:
        by_setting = {p.setting: p for p in points if p.program == peer.NAME}
        if peer.TARGET is not None and by_setting:
            setting, target = peer.TARGET
            point, all_ratios = by_setting[setting], [ratio(p, points) for p in by_setting.values()]
            span = f"{times(min(all_ratios))} to {times(max(all_ratios))}"
            by_default = times(ratio(point, points, default=True))
            yield peer.NAME, setting, times(ratio(point, points)), f"{target:.0f}", by_default, span


def times(value: float) -> str:
    """Format a ratio of times in words."""
    return "" if math.isnan(value) else f"{value:.0f}" if value >= 10 else f"{value:.1g}"


HEAD = ("case", "program", "setting", "time", "error", "beamdyn faster by", "one by itself")
TARGET_HEAD = (
    "program",
    "at this setting",
    "beamdyn faster by",
    "target",
    "our default",
    "over all settings",
)


def markdown(points: Sequence[Point], ours: Peer, peers: Sequence[Peer]) -> str:
    """Return the text of the documentation page on other programs."""
    first = INTRODUCTION.format(
        day=date.today(),
        python=platform.python_version(),
        machine=f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        versions=f"{OURS} {ours.version()}, {versions(peers)}",
    )
    better = "\n".join(f"- {peer.NAME}: {peer.BETTER}." for peer in peers)
    parts = (
        first,
        markdown_table(HEAD, rows(points, peers)),
        markdown_table(TARGET_HEAD, target_rows(points, peers)),
        f"## Where they are better\n\n{better}\n",
        NOTES,
    )
    return "\n".join(parts)


def picture(points: Sequence[Point], path: Path) -> None:
    """Plot error against time, and save the plot to a file."""
    drawn(points).savefig(path, dpi=120)


def drawn(points: Sequence[Point]) -> Figure:
    """Plot error against time, in a panel for each case."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.4), layout="constrained")
    for ax, case in zip(figure.subplots(1, len(CASES)), CASES, strict=True):
        frame(ax, case, [p for p in points if p.case == case])
    return figure


def frame(ax: Axes, case: str, points: Sequence[Point]) -> None:
    """Plot error against time for a case; hollow markers stand for speeds solved one by one."""
    for program, alone in dict.fromkeys((p.program, p.setting.startswith(ALONE)) for p in points):
        own = [p for p in points if (p.program, p.setting.startswith(ALONE)) == (program, alone)]
        label, style = (f"{program}, {ALONE}", "none") if alone else (program, None)
        marker, colour = MARKERS[program]
        times, errors = [p.time for p in own], [p.error for p in own]
        ax.loglog(times, errors, marker, color=colour, label=label, fillstyle=style)
    ax.set(
        title=fill(case, TITLE_WIDTH),
        xlabel="time per speed [s]" if "frequency" in case else "time of the run [s]",
    )
    ax.title.set_fontsize("medium")
    ax.set_ylabel("relative error")
    ax.grid(alpha=0.3)
    if points:
        ax.legend()
