"""Symbols of quantities as they are set: letters slanted, Greek ones as such, what marks them lowered."""

from __future__ import annotations

import re
from html import escape

_NAMES = "alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi rho sigma tau phi chi psi omega"
_GREEK: dict[str, str] = dict(zip(_NAMES.split(" "), "αβγδεζηθκλμνξρστφχψω", strict=True))


def typeset(symbol: str) -> str:
    """A symbol as labels of drawings take it, such as "α_1" of "alpha1".

    Parameters
    ----------
    symbol : str
        A letter, or the name of a Greek one, with what marks it behind it, such as "m_t", "a1" or "zeta_k".
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
