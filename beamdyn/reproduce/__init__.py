"""The published numbers again: each beside ours, with its deviation and a verdict."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure
from rich.console import Console

from beamdyn.common.comparison import Comparison
from beamdyn.common.edge.tables import comparison_table, progress_bar
from beamdyn.common.pictures import save_figure
from beamdyn.published import load
from beamdyn.reproduce import frequencies, motion, others
from beamdyn.reproduce.others import Summary
from beamdyn.transient.sweep import Sweep

_INTRODUCTION = """
A cantilever on the rim of a wheel points at the axis (input: Table 1 of the paper). Below, each number that
the paper prints stands beside ours, found by assumed modes (Ritz) and by finite elements (FE). They agree if
they differ by no more than the rounding of the printed value and our estimated error together. Of our numbers
only those digits are printed that the estimated error supports.
"""


def compare_all(screen: Console, folder: Path, tables: bool = False) -> list[Comparison | Summary]:
    """Print the comparisons and draw the figures.

    Parameters
    ----------
    screen : Console
        Where to print.
    folder : Path
        Where to draw.
    tables : bool
        Compare with the tables of other sources too.

    Returns
    -------
    list of Comparison and Summary
        All that was compared.
    """
    paper = load("lee_yoo_2019")
    screen.print(
        f"{paper['title']}\n{' and '.join(paper['authors'])}, {paper['journal']}, {paper['year']}",
        style="bold",
    )
    screen.print(_INTRODUCTION)
    with progress_bar("Fig. 6") as progress:
        swept = motion.sweep_of_speeds(progress)
    compared = _compare(screen, swept)
    for note in (*frequencies.notes(), *motion.notes()):
        screen.print(note)
    screen.print("")
    if others_too := [*others.summaries()] if tables else []:
        screen.print(others.summary_table(others_too))
    for path in draw(folder, swept):
        screen.print(f"drawn: {path}", soft_wrap=True)
    return [*compared, *others_too]


def _compare(screen: Console, swept: Sweep) -> list[Comparison]:
    """Print the tables, one a section of the paper."""
    compared: list[Comparison] = []
    for title, rows in sections(swept).items():
        made = [*rows]
        screen.print(comparison_table(title, made))
        compared += made
    return compared


def sections(swept: Sweep) -> dict[str, list[Comparison]]:
    """Comparisons by the titles of their tables."""
    return {
        "Table 2: first natural frequency, beam pointing inward [Hz]": [*frequencies.first_frequencies()],
        "Table 3: largest tip deflection in 20 to 30 s [mm]": [*motion.largest_deflections()],
        "Table 3, continued: steady amplitude at the same speed [mm]": [*motion.steady_amplitudes()],
        "Fig. 6: peaks over speed [rad/s]": [*motion.peaks_of_sweep(swept)],
        "Fig. 7: speeds of resonance [rad/s]": [*motion.resonances()],
        "Section 3.3: limits of the setting angle [deg]": [*frequencies.limits_of_setting_angle()],
        "Section 4: speed of buckling, beam pointing inward [rad/s]": [*frequencies.buckling_speed()],
    }


def draw(folder: Path, swept: Sweep) -> list[Path]:
    """Draw Fig. 4 to 9 into a folder, which is made if needed; files of the same names are replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    pictures: dict[int, Callable[[], Figure]] = {
        4: frequencies.fig_4,
        5: motion.fig_5,
        6: lambda: motion.fig_6(swept),
        7: motion.fig_7,
        8: frequencies.fig_8,
        9: frequencies.fig_9,
    }
    return [save_figure(picture(), folder / f"fig_{i}.png", force=True) for i, picture in pictures.items()]
