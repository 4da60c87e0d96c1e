"""The screen for blades from other programs: input file, contents, and the scene made from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from beamdyn.app.scene_form import first_frequency
from beamdyn.common.edge.config import ConfigError, parse, validated
from beamdyn.common.edge.data_text import DataText
from beamdyn.common.edge.inputs import Lines, Quantity, Section, describe, of_file
from beamdyn.common.plots.axes_and_lines import panels, set_up_axes
from beamdyn.common.results.one_line import number
from beamdyn.common.results.pictures import COLOURS, figure_of
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.common.screens.screens import Document, FoldedPart, FollowingFile, Screen
from beamdyn.files.decks.deck import Deck, is_deck, read_deck_text
from beamdyn.files.decks.deck_tables import audit_rows, deck_tables

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SOURCE = Path("file")  # name of the input text in messages
_DRAWN = {
    "mass_per_length": "mass [kg/m]",
    "bending_stiffness": "EI flap [N m2]",
    "second_bending_stiffness": "EI edge [N m2]",
}


class DeckInput(Section):
    """[deck]: the text of a blade's file, and lengths that the file may lack."""

    text: Annotated[
        str,
        Lines(
            meaning="text of a file of ElastoDyn, FAST 7, BeamDyn or BModes, or a table with units in its "
            "headings; open it with the button File, or paste it here"
        ),
    ]
    length: Annotated[
        float | None, Quantity("m", symbol="L", meaning="length, where the file lacks it", above=0)
    ] = None
    hub_radius: Annotated[
        float | None,
        Quantity("m", symbol="r", meaning="distance of root from axis, where the file lacks it", least=0),
    ] = None


class _DeckFile(Section):
    deck: DeckInput


def solve(tables: Mapping[str, Any]) -> Deck:
    """Read the blade from the input file in the form."""
    given = validated(_DeckFile, {"deck": tables.get("deck", {})}, "deck").deck
    with of_file({name: f"deck.{name}" for name in ("length", "hub_radius")}):
        return read_deck_text(_lines(given.text), given.length, given.hub_radius)


def _lines(text: str) -> DataText:
    return DataText.of(_SOURCE, text)


def _tables_of_file(text: str, source: str) -> dict[str, Any]:
    """Return the form's tables for a file: another program's blade file, or a file saved by this screen."""
    if is_deck(_lines(text)):
        return {"deck": {"text": text}}
    return parse(text, source)


def _check(text: str, source: str) -> None:
    if not _tables_of_file(text, source).get("deck"):
        raise ConfigError(source, ["expected a table [deck], or a file of another program"])


def draw(deck: Deck, _: float = 0.0) -> Figure:
    """Draw mass and stiffness along the blade."""
    x, drawn = _along(deck)

    def plot(ax: Axes | None = None) -> Axes:
        ax, places = panels(len(drawn), ax, columns=1)
        for k, (place, (name, values)) in enumerate(zip(places, drawn.items(), strict=True)):
            set_up_axes(place, "from the root [m]" if place is places[-1] else "", name)
            place.plot(x, values, color=COLOURS[k], marker=".", linewidth=1.8)
            if np.min(values) > 0:
                place.set_yscale("log")
        return ax

    return figure_of(plot, (8.0, 2.4 * len(drawn)))


def _along(deck: Deck) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return positions [m] along a blade, and its properties by name with unit."""
    blade, matrices = deck.blade, deck.blade.matrices
    if matrices is None:
        columns = {words: blade.columns[name] for name, words in _DRAWN.items() if name in blade.columns}
        return blade.stations * blade.length, columns
    diagonals = matrices.mass[:, 0, 0], matrices.stiffness[:, 5, 5], matrices.stiffness[:, 4, 4]
    return matrices.stations * blade.length, dict(zip(_DRAWN.values(), diagonals, strict=True))


def headline(deck: Deck) -> Iterator[KeyResult]:
    """Yield kind of file, length and mass of a blade."""
    yield KeyResult("file", deck.kind)
    yield KeyResult("length", number(deck.scene.beam.length, "m"))
    yield KeyResult("mass", number(deck.audit.mass, "kg"))


def _scene(deck: Deck) -> str:
    return f"<pre>{escape(deck.scene_text())}</pre>"


def _for_screens(deck: Deck) -> str:
    """Return the scene file with options for the screens: a speed of half the first angular frequency."""
    speed = f"{first_frequency(deck.scene) / 2:.2g} rad/s"
    return f"# options.top_speed = {speed}\n# operation.speed = {speed}\n{deck.scene_text()}"


DECK_SCREEN = Screen(
    "Deck",
    "A blade in a file of another program: its data, warnings on them, and the scene made from it.",
    ("deck",),
    ("deck",),
    solve,
    tables=deck_tables,
    draw=draw,
    notes=lambda deck: [str(said) for said in deck.audit.warnings],
    rows=lambda deck: (("what", "value", "unit"), *audit_rows(deck.audit)),
    headline=headline,
    picture=lambda deck, _: draw(deck),
    follows=FollowingFile("Open its scene", _for_screens),
    more=(FoldedPart("The scene as a file for the other screens and the commands", _scene, _scene),),
)
DECK = Document(
    "deck",
    (files("beamdyn.app") / "deck.toml").read_text(encoding="utf-8"),
    lambda _: describe(DeckInput, "deck."),
    _check,
    (DECK_SCREEN,),
    read=_tables_of_file,
    headings={"deck": "File of a blade"},
)
