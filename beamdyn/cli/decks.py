"""The command `import`, which reads blade files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beamdyn.analyses.options import Text
from beamdyn.analyses.values import parse_quantity, parse_speed
from beamdyn.common.edge.command_options import Flag, Outputs
from beamdyn.common.edge.console import show, table
from beamdyn.common.edge.exit_codes import warn
from beamdyn.common.results.files import check_writable, write_text
from beamdyn.files.decks.deck import Deck, read_deck
from beamdyn.files.decks.deck_tables import deck_tables

EXAMPLE = 'beamdyn import examples/blade_stations.csv --length "40 m" --hub-radius "1 m"'

DeckFile = Annotated[Path, Parameter(name="FILE")]
Output = Annotated[Path | None, Parameter(name=("--output", "-o"))]
PolynomialFile = Annotated[Path | None, Parameter(name="--polynomials")]


def import_deck(
    file: DeckFile,
    /,
    *,
    output: Output = None,
    length: Text | None = None,
    hub_radius: Text | None = None,
    polynomials: PolynomialFile = None,
    speed: Text | None = None,
    force: Flag = False,
) -> None:
    """Read a blade of ElastoDyn, FAST 7, BeamDyn or BModes, or a CSV table, and write it as a scene.

    Parameters
    ----------
    file
        A blade file or the main file of ElastoDyn, FAST 7, OpenFAST or BeamDyn, a .bmi or section properties
        of BModes, or a CSV table with units in its headings, such as "r [m], mass [kg/m], EI flap [N m2]".
    output
        Write the scene into this TOML file, which the other commands read; without it, the command only
        prints the audit: mass, centre and moments of the blade, with warnings on odd data.
    length
        Length of the blade with its unit, where the file does not say it (TipRad - HubRad).
    hub_radius
        Distance of the root from the axis of rotation with its unit, where the file does not say it.
    polynomials
        Write polynomials of the mode shapes into this file, in the format of ElastoDyn's blade files.
    speed
        Rotational speed for these mode shapes, with its unit; default: that in the file, or 0.
    force
        Overwrite a file that exists.
    """
    outputs = Outputs(force=force)
    outputs.check(file, output=output, polynomials=polynomials)
    at = None if speed is None else parse_speed("--speed", speed)
    if at is not None and polynomials is None:
        raise ValueError(f'--speed = "{speed}": it needs --polynomials; give both, or leave it out')
    deck = read_with(file, length, hub_radius)
    outputs.check(*deck.sources, output=output, polynomials=polynomials)
    show(deck_tables(deck))
    if output is not None:
        deck.write_scene(output, force)
        show([f"Written: {output}, for beamdyn modes {output} and the other commands."])
    if polynomials is not None:
        _write_polynomials(deck, polynomials, at, force)
    warn("beamdyn", deck.audit.warnings)


def _write_polynomials(deck: Deck, path: Path, speed: float | None, force: bool) -> None:
    """Write the polynomials of the mode shapes into a file, and print how well they fit."""
    fitted = deck.fit_mode_polynomials(speed)
    lines = [line for each in fitted for line in each.lines()]
    write_text(check_writable(path, force=force), "\n".join([*lines, ""]))
    rows = [(each.mode, f"{each.difference:.4f}", f"{each.frequency:.5g}") for each in fitted]
    show([table(f"Written: {path}", ("mode", "largest difference from it", "frequency [Hz]"), rows)])


def read_with(file: Path, length: str | None, hub_radius: str | None) -> Deck:
    """Read a blade file with the options --length and --hub-radius."""
    given = {
        name: None if text is None else parse_quantity(f"--{name.replace('_', '-')}", text, "m")
        for name, text in {"length": length, "hub_radius": hub_radius}.items()
    }
    return read_deck(file, **given)
