"""All figures that the README quotes, in one run: python -m benchmarks  (--save FILE: in parts)

Writes docs/measured.md, docs/tradeoff.md and the README's table of measurements, which repeats rows of the
first page.  It should run on a machine that does nothing else.  With --save, an interrupted run is resumed
after the last finished section; a file of other versions is refused.  The long samples (10 000 scenes and
more) have separate commands.
"""

from __future__ import annotations

import argparse
import platform
from concurrent.futures import ProcessPoolExecutor
from datetime import date
from importlib.metadata import version
from multiprocessing import get_context
from os import cpu_count
from pathlib import Path
from time import perf_counter

from beamdyn import __version__
from benchmarks import (
    bounds,
    brakes,
    extremes,
    frequencies,
    loads,
    motions,
    ratios,
    responses,
    screens,
    stated_frequency_errors,
    stated_load_errors,
    stated_physics_errors,
    stated_transient_errors,
    steady,
    study,
    sweep,
    tradeoff,
    transient,
)
from benchmarks.readme import write_between
from benchmarks.resumable import SavedRows
from benchmarks.rows import Row, show

PAGE = Path(__file__).parents[1] / "docs" / "measured.md"
SECTIONS = {
    "Frequencies": frequencies,
    "Many designs": study,
    "Responses": responses,
    "Loads along the span": loads,
    "Transients": transient,
    "Transients of records, ringing and abrupt motions": motions,
    "Steady response": steady,
    "Sweeps": sweep,
    "Over one stock run": ratios,
    "Guaranteed bounds, a sample": bounds,
    "Stated errors of frequencies, a sample": stated_frequency_errors,
    "Stated errors of frequencies with all physics, a sample": stated_physics_errors,
    "Stated errors of transients, a sample": stated_transient_errors,
    "Stated errors of loads along the span, a sample": stated_load_errors,
    "The whole range of inputs, a sample": extremes,
    "Brakes": brakes,
    "Screens of the interactive programs": screens,
}
_FIG_6 = "151 transients of 30 s (Fig. 6)"
_TABLE_3 = "2 modes at 0 and at 55 rad/s, tolerance 1e-05"
QUOTED = (
    "177 values of the power series, ritz: worst relative error",
    "177 values of the power series, fem: worst relative error",
    "five lowest, 20...200 functions, gamma 12: worst error",
    "locus of 1000 speeds, 3 modes [s]",
    f"{_TABLE_3}: time [s]",
    f"{_TABLE_3}: time-integration and modal truncation error",
    "5 modes, tolerance 1e-05: time [s]",
    "5 modes, tolerance 1e-05: time-integration and modal truncation error",
    "fastest of these with an error not below ours, over ours",
    "tolerance 1e-3 instead of 1e-10, 5 modes: times faster",
    "energy drift over 1e6 periods, 10 steps each",
    "1000 speeds x 3 modes, undamped [s]",
    f"{_FIG_6}, auto modes: wall time, 2 workers [s]",
    f"{_FIG_6}, auto modes: largest estimated modal truncation error",
    "virtual work of 10000 random mechanisms, scaled: largest",
    "stroke of the eeBrake, 100 positions with all reactions [ms]",
    "10000 designs through vehicle, kinematics and forces [s]",
)
_HEAD = """# Measured

Written by `python -m benchmarks` on {day} ({machine}), which also writes [tradeoff](tradeoff.md).
Versions: {versions}.  Other programs: [peers](peers.md), by `python -m benchmarks.peers`.

The last column has a published value, the bound that was set beforehand (some are missed), or of a sample
the size of the full run. Times are those of two cores, and scatter by a tenth.
"""


def describe_machine() -> tuple[str, str]:
    """Describe machine and versions of packages, on which the figures depend."""
    packages = ("numpy", "scipy", "scikit-fem")
    machine = (
        f"Python {platform.python_version()}, {platform.system()} {platform.machine()}, {cpu_count()} cores"
    )
    return machine, ", ".join([f"beamdyn {__version__}", *(f"{name} {version(name)}" for name in packages)])


def write_section(title: str, rows: list[Row]) -> str:
    """Write a table in Markdown."""
    lines = [f"\n## {title}\n", "| what | measured | bound or published |", "|---|---|---|"]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)]) + "\n"


def measure(title: str) -> list[Row]:
    """Measure the rows of a section, and print them with the computing time."""
    start = perf_counter()
    rows = show(title, *SECTIONS[title].PARTS)
    print(f"{title}: {perf_counter() - start:.0f} s", flush=True)
    return rows


def measure_apart(title: str) -> list[Row]:
    """Measure a section in a new process, so that memory and caches do not affect other sections."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(measure, title).result()


def quote_in_readme(page: str) -> None:
    """Copy the rows that the README quotes from the page to the README."""
    cells = [line.split(" | ") for line in page.splitlines() if line.startswith("| ")]
    measured = {row[0].removeprefix("| "): row[1] for row in cells}
    table = ["| what | measured |", "|---|---|", *(f"| {name} | {measured[name]} |" for name in QUOTED)]
    write_between("measured", table)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--save", type=Path, help="file of sections, to which a run adds what it lacks")
    machine, versions = describe_machine()
    saved = SavedRows(parser.parse_args().save, f"{machine}; {versions}")
    text = _HEAD.format(day=date.today().isoformat(), machine=machine, versions=versions)
    for title, module in SECTIONS.items():
        text += write_section(f"{title} (`{module.__name__}`)", saved.rows(title, measure_apart))
    PAGE.write_text(text, encoding="utf-8")
    quote_in_readme(text)
    tradeoff.main()
