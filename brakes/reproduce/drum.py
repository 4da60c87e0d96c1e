"""Report on the drum brake of Vardanyan et al. (2019): Table 1, the errors in it, and the right numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure
from rich.console import Group

from beamdyn.common.edge.tables import table
from beamdyn.common.plots.curves import grid
from beamdyn.common.results.pictures import COLOURS
from brakes.drawings.drum import brake_figure
from brakes.drum import BrakeResult
from brakes.published import load
from brakes.reproduce import drum_as_printed as as_printed
from brakes.reproduce.common import Cell, Heads, Row, errata_table, rows_table, step

_SYMBOLS = (
    "A pmax: width times radius times largest pressure; K, S, C: integrals of sin, sin^2, sin cos;\n"
    "n = c S - b C and d = r K - b S - c C: arms of the normal and of the friction forces about the pin"
)


def title() -> str:
    """Title and authors of the paper."""
    paper = load("vardanyan_2019")
    return f"{paper['title']}\n{', '.join(paper['authors'])}, {paper['year']}"


def introduction() -> str:
    """What is computed, in one paragraph."""
    return (
        "Torques of two shoes in a drum over the arc of the lining. The printed equations (12) and (15) do "
        "not give the printed table: what does is an effective arm rho with another constant, and (15) with "
        "the other sign of mu b1."
    )


HEADS: Heads = (("arc [deg]",), ("rho [mm]", "MT1 [N m]", "MT2 [N m]"))


def rows() -> list[Row]:
    """Compare Table 1 cell by cell; the last row has the largest difference of the torques."""
    paper, ours = load("vardanyan_2019")["table_1"], as_printed.table_1()
    columns = {"effective_arm": 1e3, "first_torque": 1.0, "second_torque": 1.0}
    compared = []
    for i, arc in enumerate(paper["arc"]["value"]):
        cells = (
            _cell(paper[name]["printed"][i], unit * float(getattr(ours, name)[i]))
            for name, unit in columns.items()
        )
        compared.append(Row((f"{arc}",), tuple(cells)))
    compared.append(
        Row(("largest MT2 - MT1 [N m]",), (_cell(paper["difference"]["printed"], ours.difference),))
    )
    return compared


def _cell(printed: str, ours: float) -> Cell:
    return Cell(printed, ours, step(printed))


def tables() -> Iterator[Group]:
    """Make Table 1, the corrected table, and the table of errata."""
    *body, _ = rows()
    yield rows_table("Table 1: effective arm and torques, as printed", *HEADS, body)
    yield _corrected_table()
    heading = f"What is wrong in the paper, and what follows at its longest arc (80 deg)\n{_SYMBOLS}"
    yield errata_table(heading, as_printed.errata())


def summary() -> Iterator[str]:
    """What follows for a brake engineer, a paragraph each."""
    printed, right = as_printed.table_1(), corrected()
    total = printed.first_torque + printed.second_torque
    short, long = (float(total[i] / right.torque[i]) for i in (0, -1))
    second, trailing = float(printed.second_torque[-1]), float(right.shoes[1].torque[-1])
    yield (
        f"Do not use Table 1. Its total torque is {100 * short:.0f} % of the right one at 10 deg and "
        f"{100 * long:.0f} % at 80 deg; it rises with the arc, where at a given force the right one falls. "
        "The paper's second shoe is self-energising as well; in fact it trails, and gives "
        f"{trailing:.3g} in place of {second:.4g} N m. The leading shoe locks at a friction of "
        f"{float(right.shoes[0].locking_friction[-1]):.3g}; the paper's condition for that, (18), has "
        "no root."
    )
    yield _on_pressure(right)


def _on_pressure(right: BrakeResult) -> str:
    """What the paper's assumption on the pressure adds."""
    pivot = as_printed.corrected(as_printed.table_1().arc, "pivot")
    pairs = zip(right.shoes, pivot.shoes, strict=True)
    more = max(float(np.max(axis.c_star / turning.c_star)) for axis, turning in pairs) - 1
    return (
        "The right numbers here keep the paper's pressure (2), which vanishes on the axis. That of a shoe "
        "which turns about its pin vanishes on the line to the pin. The axis overstates the C* of a shoe by "
        f"up to {100 * more:.1f} %; the total at 80 deg is {pivot.torque[-1]:.4g} in place of "
        f"{right.torque[-1]:.4g} N m. `brakes drum` takes the pin unless the file says otherwise."
    )


def notes() -> Iterator[str]:
    """Remarks below the tables."""
    last = rows()[-1].cells[0]
    yield f"Largest MT2 - MT1: printed {last.printed}, ours {last.ours:.3f} N m; {last.verdict}."


def corrected() -> BrakeResult:
    """Solve the paper's brake by the right mechanics, at the arcs of Table 1."""
    return as_printed.corrected(as_printed.table_1().arc)


def _corrected_table() -> Group:
    printed, right = as_printed.table_1(), corrected()
    total = printed.first_torque + printed.second_torque
    columns = [
        np.degrees(printed.arc),
        1e3 * right.shoes[0].effective_arm,
        right.shoes[0].torque,
        right.shoes[1].torque,
        right.torque,
        total,
        total / right.torque,
    ]
    formats = ("{:.0f}", "{:.3f}", "{:.3f}", "{:.3f}", "{:.3f}", "{:.3f}", "{:.3f}")
    lines = ([f.format(x) for f, x in zip(formats, row, strict=True)] for row in zip(*columns, strict=True))
    heads = ("arc [deg]", "rho", "leading", "trailing", "total", "printed total", "printed / right")
    title = "The same brake by the corrected mechanics, with the paper's pressure: rho [mm], torques [N m]"
    return table(title, heads, lines, ())


def pictures() -> dict[str, Figure]:
    """Draw the pictures, by the names of their files."""
    return {
        "drum_forces": brake_figure(as_printed.corrected(float(as_printed.table_1().arc[-1]))),
        "drum_torque_over_arc": over_arc(),
    }


def over_arc() -> Figure:
    """Draw the torques over the arc, as printed and corrected."""
    printed, right = as_printed.table_1(), corrected()
    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    ax = figure.subplots()
    arc = np.degrees(printed.arc)
    lines = (
        ("corrected: total", right.torque, COLOURS[6], "-"),
        ("leading shoe", right.shoes[0].torque, COLOURS[0], "-"),
        ("trailing shoe", right.shoes[1].torque, COLOURS[2], "-"),
        ("as printed: total", printed.first_torque + printed.second_torque, COLOURS[6], "--"),
        ("MT2", printed.second_torque, COLOURS[2], "--"),
        ("MT1", printed.first_torque, COLOURS[0], "--"),
    )
    for label, values, colour, style in lines:
        marker = "o" if style == "--" else ""
        ax.plot(arc, values, style, color=colour, marker=marker, markersize=4, linewidth=1.7, label=label)
    grid(ax)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("arc of the lining [deg]")
    ax.set_ylabel("torque at 1000 N on each shoe [N m]")
    ax.legend(fontsize=9, ncols=2, loc="upper right")
    ax.set_title("Torque over the arc: Table 1 as printed, and corrected", fontsize=11)
    return figure
