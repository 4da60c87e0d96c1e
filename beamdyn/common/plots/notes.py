"""Notes on pictures: what a reader of the picture alone must know."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from matplotlib.figure import Figure

_LETTERS = 15.0  # of a note, in an inch
_COLOUR = "#5a4200"


def note_below(figure: Figure, sentences: Sequence[str]) -> Figure:
    """Write sentences below the axes of a figure with constrained layout, which makes room for them.

    Parameters
    ----------
    figure : Figure
        The figure.
    sentences : sequence of str
        A paragraph each; nothing is written if there are none.

    Returns
    -------
    Figure
        The same.
    """
    width = int(_LETTERS * figure.get_size_inches()[0])
    lines = [line for sentence in sentences for line in textwrap.wrap(sentence, width)]
    if lines:
        figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=9, color=_COLOUR)
    return figure
