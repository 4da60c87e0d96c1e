"""The command `reproduce`, which compares published results with computed ones."""

from __future__ import annotations

from pathlib import Path

from cyclopts import App

from beamdyn.common.edge.command_options import Flag, SomeFolder, check_folder
from beamdyn.common.edge.console import console
from beamdyn.common.edge.exit_codes import NoAnswer, examples
from beamdyn.reproduce import compare_all


def reproduce(*, output: SomeFolder = Path("beamdyn-reproduce"), tables: Flag = False) -> None:
    """Published numbers compared with computed ones; draws the paper's figures.

    Parameters
    ----------
    output
        Folder for the pictures; it is made in the current one if needed, and its pictures are replaced.
    tables
        Compare with the tables of beams and blades of other sources too; takes some twenty seconds.
    """
    check_folder("output", output)
    screen = console()
    screen.print(f"Pictures go into the folder {output} (--output names another).\n")
    checked = compare_all(screen, output, tables)
    unexpected = sum(not row.as_expected for row in checked)
    if unexpected:
        raise NoAnswer(f"{unexpected} of {len(checked)} verdicts are not as expected; see the tables")
    screen.print(
        f"\nAll {len(checked)} verdicts are as expected: agreement, but for the differences explained above."
    )
    if not tables:
        screen.print("beamdyn reproduce --tables compares with the tables of other sources, too.")


def add(app: App) -> None:
    """Add the command `reproduce` to a command line."""
    app.command(reproduce, help_epilogue=examples("beamdyn reproduce --output pictures"))
