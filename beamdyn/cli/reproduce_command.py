"""The command `reproduce`, which compares published results with computed ones."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from beamdyn.common.edge.command_options import Flag, SomeFolder
from beamdyn.common.edge.reports import report_verdicts
from beamdyn.reproduce import compare_all

EXAMPLE = "beamdyn reproduce --output pictures"


def reproduce(*, output: SomeFolder = Path("beamdyn-reproduce"), tables: Flag = False) -> None:
    """Published numbers compared with computed ones; draws the paper's figures.

    Parameters
    ----------
    output
        Folder for the pictures; it is created if it does not exist, and pictures in it are replaced.
    tables
        Compare with the tables of beams and blades of other sources too; takes some twenty seconds.
    """
    screen = report_verdicts(partial(compare_all, tables=tables), output)
    if not tables:
        screen.print("beamdyn reproduce --tables compares with the tables of other sources, too.")
