"""Reproduction of published numbers: each beside the number computed here, and whether the two agree."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from beamdyn.common.edge.console import at_work, comparison_table
from beamdyn.common.edge.reports import draw_pictures, print_heading
from beamdyn.common.results.comparison import Comparison
from beamdyn.reproduce import blades, inward_beam, inward_beam_figures, printed_tables
from beamdyn.reproduce.entries import Summary

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
        Whether to also compare with the tables of other sources.

    Returns
    -------
    list of Comparison and Summary
        All comparisons, in the order of printing.
    """
    print_heading(screen, inward_beam.PAPER, " and ")
    screen.print(_INTRODUCTION)
    with at_work("Fig. 6") as progress:
        fig_6_sweep = inward_beam.run_sweep(progress)
    checked: list[Comparison | Summary] = []
    for title, comparisons in inward_beam.sections(fig_6_sweep).items():
        screen.print(comparison_table(title, comparisons))
        checked += comparisons
    for note in (*inward_beam.notes(), ""):
        screen.print(note)
    if tables:
        checked += _print_tables(screen)
    draw_pictures(screen, folder, inward_beam_figures.pictures(fig_6_sweep))
    return checked


def _print_tables(screen: Console) -> list[Comparison | Summary]:
    """Print the comparison with the tables of other sources."""
    papers, errata = printed_tables.compare_papers()
    summaries = [*papers, *printed_tables.summarize(printed_tables.reference_entries)]
    screen.print(printed_tables.summary_table(summaries))
    screen.print(printed_tables.errata_table(errata))
    comparisons = [*blades.printed_by_bmodes()]
    screen.print(comparison_table("BModes Test01: what BModes prints itself [Hz]", comparisons))
    for note in (*blades.notes(), *printed_tables.sources(), ""):
        screen.print(note)
    return [*summaries, *comparisons]
