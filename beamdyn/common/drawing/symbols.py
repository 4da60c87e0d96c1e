"""Typesetting of symbols: letters in italics, names of Greek letters as these, indices as subscripts."""

from __future__ import annotations

import re
from html import escape

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
        The letter, and behind an underscore the index, if there is one.
    """
    found = re.fullmatch(r"([^\W\d_]+)_?(\w*)", symbol)
    if found is None:
        return symbol
    letter, index = (_GREEK.get(part, part) for part in found.groups())
    return f"{letter}_{index}" if index else letter


def symbol_html(symbol: str) -> str:
    """A symbol, or a product of some such as "rho A", as HTML."""
    return " ".join(map(_html, symbol.split(" ")))


def _html(symbol: str) -> str:
    letter, _, index = typeset(symbol).partition("_")
    return f"<i>{escape(letter)}</i>" + (f"<sub>{escape(index)}</sub>" if index else "")
