"""Measure all installed programs, print tables, write docs/peers.md, docs/peers.png and README's table."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from benchmarks.peers import calculix, exudyn, ours, page, pybmodes, stock, tables
from benchmarks.peers.measure import Point
from benchmarks.readme import write_between
from benchmarks.rows import markdown_table

PEERS: tuple[tables.Peer, ...] = (calculix, pybmodes, exudyn, stock)


def measured() -> list[Point]:
    """Measure beamdyn, then every program that is installed."""
    points = list(ours.points())
    for peer in PEERS:
        if peer.version() is not None:
            points += peer.points()
    return points


def main() -> None:
    points, console = measured(), Console(width=140)
    for head, body in (
        (tables.HEAD, tables.rows(points, PEERS)),
        (tables.TARGET_HEAD, tables.target_rows(points, PEERS)),
    ):
        table = Table(*head)
        for row in body:
            table.add_row(*map(escape, row))
        console.print(table)
    page.write_measurements(tables.markdown(points, ours, PEERS))
    targets = markdown_table(tables.TARGET_HEAD, tables.target_rows(points, PEERS))
    write_between("peers", targets.splitlines())
    tables.picture(points, page.DOCS / "peers.png")


if __name__ == "__main__":
    main()
