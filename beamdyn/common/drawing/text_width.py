"""Typesetting of symbols (italics, Greek letters, subscripts), and widths of texts in DejaVu Sans."""

from __future__ import annotations

import re
from functools import cache, lru_cache
from html import escape
from itertools import accumulate, takewhile
from typing import Any

_NAMES = "alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi rho sigma tau phi chi psi omega"
_GREEK: dict[str, str] = dict(zip(_NAMES.split(" "), "αβγδεζηθκλμνξρστφχψω", strict=True))


def typeset(symbol: str) -> str:
    """Typeset a symbol for labels of drawings: "α_1" for "alpha1".

    Parameters
    ----------
    symbol : str
        A letter, or the name of a Greek letter, and an index, such as "m_t", "a1" or "zeta_k".

    Returns
    -------
    str
        The letter, followed by an underscore and the index if there is one.
    """
    found = re.fullmatch(r"([^\W\d_]+)_?(\w*)", symbol)
    if found is None:
        return symbol
    letter, index = (_GREEK.get(part, part) for part in found.groups())
    return f"{letter}_{index}" if index else letter


def symbol_html(symbol: str) -> str:
    """Return a symbol, or a product of symbols such as "rho A", as HTML."""
    return " ".join(map(_html, symbol.split(" ")))


def _html(symbol: str) -> str:
    letter, _, index = typeset(symbol).partition("_")
    return f"<i>{escape(letter)}</i>" + (f"<sub>{escape(index)}</sub>" if index else "")


FAMILY = "'DejaVu Sans', Verdana, sans-serif"
LINE_HEIGHT = 1.22  # height of a line of text, as a multiple of the font size
SUBSCRIPT = 0.7  # size of a subscript, as a fraction of the font size
_EM = 2048  # length units of the font per em (the font size)


@cache
def _font() -> Any:
    """Load the font at such a size that widths are in the font's own length unit."""
    from matplotlib import get_data_path  # imported here, because matplotlib is slow to import
    from matplotlib.ft2font import FT2Font

    font = FT2Font(f"{get_data_path()}/fonts/ttf/DejaVuSans.ttf")
    font.set_size(_EM, 72)
    return font


@cache
def _letter_width(letter: str) -> float:
    """Return the width of a letter as a fraction of the font size; 1 for a letter that the font lacks."""
    known = _font().get_char_index(ord(letter))
    return _font().load_char(ord(letter)).linearHoriAdvance / 65536 / _EM if known else 1.0


@lru_cache(maxsize=4096)
def line_width(text: str) -> float:
    """Compute the width of a line of text as a multiple of the font size, without kerning."""
    return sum(map(_letter_width, text))


def symbol_width(symbol: str) -> float:
    """Compute the width of a symbol such as "N_1"; the part after the underscore is a subscript."""
    letter, _, index = symbol.partition("_")
    return line_width(letter) + SUBSCRIPT * line_width(index)


def text_size(text: str, size: float, symbol: str = "") -> tuple[float, float]:
    """Compute width and height of a text of one or more lines, with a symbol before the first line.

    Parameters
    ----------
    text : str
        The text.
    size : float
        Font size [pt].
    symbol : str
        Symbol written before the text.

    Returns
    -------
    width, height : float
        [pt]
    """
    first, *others = text.split("\n")
    before = symbol_width(symbol) + (line_width(" ") if first else 0.0) if symbol else 0.0
    widest = max(before + line_width(first), *map(line_width, others), 0.0)
    return size * widest, size * LINE_HEIGHT * (1 + len(others))


def wrapped(text: str, width: float, size: float) -> list[str]:
    """Break a text into lines no wider than `width` [pt]; a word that is wider is cut.

    Parameters
    ----------
    text : str
        The text, of one or more lines.
    width : float
        Largest width of a line [pt].
    size : float
        Font size [pt].
    """
    lines: list[str] = []
    for given in text.split("\n"):
        line = ""
        for word in given.split(" "):
            longer = f"{line} {word}" if line else word
            if line and size * line_width(longer) > width:
                lines.append(line)
                longer = word
            line = shortened(longer, width, size)
        lines.append(line)
    return lines


def shortened(text: str, width: float, size: float) -> str:
    """Cut a text that is wider than `width` [pt] at a font size [pt], and end it with dots."""
    if size * line_width(text) <= width:
        return text
    dots = line_width("…")
    ends = accumulate(map(line_width, text))
    return f"{text[: sum(1 for _ in takewhile(lambda end: size * (end + dots) <= width, ends))]}…"
