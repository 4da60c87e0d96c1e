"""Reproduction of the published numbers: each beside ours, with its deviation and a verdict."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure
from rich.console import Console

from beamdyn.common.edge.progress import at_work
from beamdyn.common.edge.tables import comparison_table
from beamdyn.common.results.comparison import Comparison
from beamdyn.common.results.pictures import save_figure
from beamdyn.published import load
from beamdyn.reproduce import blades, frequencies, large_deflection, motion, others, printed_tables
from beamdyn.reproduce.entries import Summary
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
        Console to print on.
    folder : Path
        Folder for the figures.
    tables : bool
        Whether to compare with the tables of other sources too.

    Returns
    -------
    list of Comparison and Summary
        All comparisons, in the order of printing.
    """
    paper = load("lee_yoo_2019")
    screen.print(
        f"{paper['title']}\n{' and '.join(paper['authors'])}, {paper['journal']}, {paper['year']}",
        style="bold",
    )
    screen.print(_INTRODUCTION)
    with at_work("Fig. 6") as progress:
        fig_6_sweep = motion.run_sweep(progress)
    all_comparisons = _print_comparisons(screen, fig_6_sweep)
    for note in (*frequencies.notes(), *motion.notes(), *large_deflection.notes()):
        screen.print(note)
    screen.print("")
    checked = [*all_comparisons, *(_print_tables(screen) if tables else ())]
    for path in draw(folder, fig_6_sweep):
        screen.print(f"drawn: {path}", soft_wrap=True)
    return checked


def _print_tables(screen: Console) -> list[Comparison | Summary]:
    """Print the comparison with the tables of other sources."""
    papers, errata = printed_tables.compare_papers()
    summaries = [*papers, *others.summarize_sources(), *others.summarize_twisted()]
    screen.print(others.summary_table(summaries))
    screen.print(printed_tables.errata_table(errata))
    comparisons = [*blades.printed_by_bmodes()]
    screen.print(comparison_table("BModes Test01: what BModes prints itself [Hz]", comparisons))
    for note in (*blades.notes(), *printed_tables.sources(), ""):
        screen.print(note)
    return [*summaries, *comparisons]


def _print_comparisons(screen: Console, fig_6_sweep: Sweep) -> list[Comparison]:
    """Print the tables of comparisons, one per section of the paper."""
    all_comparisons: list[Comparison] = []
    for title, rows in sections(fig_6_sweep).items():
        comparisons = [*rows]
        screen.print(comparison_table(title, comparisons))
        all_comparisons += comparisons
    return all_comparisons


def sections(fig_6_sweep: Sweep) -> dict[str, list[Comparison]]:
    """Comparisons, by the titles of their tables."""
    return {
        "Table 2: first natural frequency, beam pointing inward [Hz]": [*frequencies.first_frequencies()],
        "Table 3: largest tip deflection in 20 to 30 s [mm]": [*motion.largest_deflections()],
        "Table 3, continued: steady amplitude at the same speed [mm]": [*motion.steady_amplitudes()],
        "Fig. 6: peaks over speed [rad/s]": [*motion.sweep_peak_comparisons(fig_6_sweep)],
        "Fig. 7: speeds of resonance [rad/s]": [*motion.resonances()],
        "Section 3.3: limits of the setting angle [deg]": [*frequencies.limits_of_setting_angle()],
        "Section 4: speed of buckling, beam pointing inward [rad/s]": [*frequencies.buckling_speed()],
        "Table 3 with large deflection: largest tip deflection in 20 to 30 s [mm]": [
            *motion.largest_deflections_of_bent_beam()
        ],
        "Fig. 8 and 9 with large deflection: first natural frequency [Hz]": [
            *large_deflection.first_frequencies()
        ],
        "Section 3.3 with large deflection: limits of the setting angle [deg]": [
            *large_deflection.limits_of_setting_angle()
        ],
    }


def draw(folder: Path, fig_6_sweep: Sweep) -> list[Path]:
    """Draw Fig. 4 to 9 into a folder, created if needed; existing files are replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    pictures: dict[int, Callable[[], Figure]] = {
        4: frequencies.fig_4,
        5: motion.fig_5,
        6: lambda: motion.fig_6(fig_6_sweep),
        7: motion.fig_7,
        8: frequencies.fig_8,
        9: frequencies.fig_9,
    }
    return [save_figure(picture(), folder / f"fig_{i}.png", force=True) for i, picture in pictures.items()]
