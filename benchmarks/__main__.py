"""All figures that the README quotes, in one run.  Run: python -m benchmarks

Writes docs/measured.md; the README's tables repeat rows of it.  Takes a quarter of an hour, on a machine that
does nothing else.  The long samples (10 000 scenes and more) have commands of their own.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterator
from datetime import date
from importlib.metadata import version
from os import cpu_count
from pathlib import Path

from benchmarks import (
    beam_core,
    bounds,
    brakes,
    coverage,
    coverage_transients,
    extremes,
    steady,
    sweep,
    tradeoff,
    transient,
)
from benchmarks.beam_core import Row, show

PAGE = Path(__file__).parents[1] / "docs" / "measured.md"
SECTIONS: dict[str, tuple[Callable[[], Iterator[Row]], ...]] = {
    "Frequencies (`benchmarks.beam_core`)": beam_core.PARTS,
    "Transients (`benchmarks.transient`)": transient.PARTS,
    "Steady response (`benchmarks.steady`)": steady.PARTS,
    "Sweeps (`benchmarks.sweep`)": sweep.PARTS,
    "Guaranteed bounds, a sample (`benchmarks.bounds`)": bounds.PARTS,
    "Stated errors of frequencies, a sample (`benchmarks.coverage`)": coverage.PARTS,
    "Stated errors of transients, a sample (`benchmarks.coverage_transients`)": coverage_transients.PARTS,
    "The whole range of inputs, a sample (`benchmarks.extremes`)": extremes.PARTS,
    "Brakes (`benchmarks.brakes`)": brakes.PARTS,
}
_HEAD = """# Measured

Written by `python -m benchmarks` on {day} ({machine}), which also writes [tradeoff](tradeoff.md).
Versions: {versions}.  Other programs: [peers](peers.md), by `python -m benchmarks.peers`.
"""


def head() -> str:
    """What was run, where and when."""
    packages = ("beamdyn", "numpy", "scipy", "scikit-fem")
    machine = (
        f"Python {platform.python_version()}, {platform.system()} {platform.machine()}, {cpu_count()} cores"
    )
    versions = ", ".join(f"{name} {version(name)}" for name in packages)
    return _HEAD.format(day=date.today().isoformat(), machine=machine, versions=versions)


def section(title: str, rows: list[Row]) -> str:
    """A table in Markdown."""
    lines = [f"\n## {title}\n", "| what | measured | bound or published |", "|---|---|---|"]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)]) + "\n"


def main() -> None:
    text = head()
    for title, parts in SECTIONS.items():
        text += section(title, show(title, *parts))
        PAGE.write_text(text, encoding="utf-8")
    tradeoff.main()


if __name__ == "__main__":
    main()
