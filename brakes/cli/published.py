"""The command that reproduces published results."""

from __future__ import annotations

from pathlib import Path

from beamdyn.common.edge.outputs import check_folder
from beamdyn.common.edge.program import NoAnswer, examples
from beamdyn.common.edge.varying import SomeFolder
from brakes.cli.answering import app


@app.command(help_epilogue=examples("brakes reproduce --output pictures"))
def reproduce(*, output: SomeFolder = Path("brakes-reproduce")) -> None:
    """Published numbers of brakes beside ours, what the papers' errors cost, and the pictures.

    Parameters
    ----------
    output
        Folder for the pictures; it is made in the current one if needed, and its pictures are replaced.
    """
    from beamdyn.common.edge.tables import console
    from brakes.reproduce import compare_all

    check_folder("output", output)
    screen = console()
    screen.print(f"Pictures go into the folder {output} (--output names another).\n")
    checked = compare_all(screen, output)
    unexpected = sum(not verdict.as_expected for verdict in checked)
    if unexpected:
        raise NoAnswer(f"{unexpected} of {len(checked)} verdicts are not as expected; see the tables")
    screen.print(
        f"\nAll {len(checked)} verdicts are as expected: agreement, but for what is explained above."
    )
