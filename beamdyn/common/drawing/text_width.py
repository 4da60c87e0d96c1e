"""Widths of texts, by the advance widths of DejaVu Sans, the font that comes with matplotlib."""

from __future__ import annotations

from functools import lru_cache
from itertools import accumulate, takewhile

FAMILY = "'DejaVu Sans', Verdana, sans-serif"
LINE_HEIGHT = 1.22  # over the size of the letters
SUBSCRIPT = 0.7  # size of a subscript over that of the letters
_EM = 2048  # units of the table in the size of the letters
_OTHER = 2048  # width of letters that the table lacks
_WIDTHS = {
    465: "′",
    563: "'",
    569: "ijlìíîï",
    604: "IJÌÍÎÏΙΪ",
    651: " ,.\xa0·‘’",
    690: "/:;\\|¦",
    693: "ίι",
    721: "f",
    739: "-\xad",
    765: "″",
    799: "()[]",
    803: "t",
    821: "!¡²³¹",
    842: "r",
    942: '"',
    965: "ªº",
    1024: "*_`§¨¯°´¸–∥",
    1059: "∂",
    1061: "“”",
    1067: "s∫",
    1075: "z",
    1087: "?¿",
    1107: "έε",
    1114: "ζ",
    1126: "cç",
    1141: "LΓ",
    1142: "ξ",
    1144: "ν",
    1178: "F",
    1183: "χ",
    1185: "ΰυ",
    1186: "k",
    1202: "ς",
    1207: "κ",
    1208: "•",
    1212: "vxyýÿγλ",
    1233: "πτ",
    1235: "PΡ",
    1239: "Þ",
    1251: "TYÝΤΥΫ",
    1253: "o«»ðòóôõöøδθο",
    1255: "aàáâãäå",
    1260: "eèéêë",
    1290: "ß",
    1294: "EÈÉÊËΕΞΣ",
    1298: "hnuñùúûüήησ",
    1300: "Sbdgpqþρ",
    1303: "$0123456789{}¢£¤¥µ¶μ",
    1305: "√",
    1307: "β",
    1343: "KΚ",
    1350: "άα",
    1351: "φψ",
    1380: "∑",
    1401: "AVÀÁÂÃÄÅΑΔΛ",
    1403: "XZΖΧ",
    1405: "BΒ",
    1423: "R",
    1430: "CÇ",
    1499: "UÙÚÛÜ",
    1532: "NÑΝ",
    1540: "HΗΠ",
    1565: "Ω",
    1577: "D",
    1587: "GÐ",
    1597: "&",
    1612: "OQÒÓÔÕÖØΘΟΦΨ",
    1675: "w",
    1706: "∞",
    1715: "ω",
    1716: "#+<=>^~¬±×÷−→←↑↓≤≥≈≠",
    1767: "MΜ",
    1784: "⊥",
    1836: "∠",
    1946: "%",
    1985: "¼½¾",
    1995: "mÆ",
    2011: "æ",
    2025: "W",
    2048: "@©®—…",
}
_OF_LETTER = {letter: width / _EM for width, letters in _WIDTHS.items() for letter in letters}


@lru_cache(maxsize=4096)
def line_width(text: str) -> float:
    """Width of a line over the size of its letters, without kerning."""
    return sum(_OF_LETTER.get(letter, _OTHER / _EM) for letter in text)


def symbol_width(symbol: str) -> float:
    """Width of a symbol such as "N_1", whose part behind the underscore is a subscript."""
    letter, _, index = symbol.partition("_")
    return line_width(letter) + SUBSCRIPT * line_width(index)


def text_size(text: str, size: float, symbol: str = "") -> tuple[float, float]:
    """Width and height of a text of one or more lines, behind a symbol in the first.

    Parameters
    ----------
    text : str
        The text.
    size : float
        Size of its letters [pt].
    symbol : str
        Symbol before it.

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
    """Lines of a text that are no wider than `width` [pt]; a word that is wider is cut.

    Parameters
    ----------
    text : str
        The text, of one or more lines.
    width : float
        Room for a line [pt].
    size : float
        Size of the letters [pt].
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
    """A text, cut to a width [pt] with dots at its end if it is longer, in letters of a size [pt]."""
    if size * line_width(text) <= width:
        return text
    dots = line_width("…")
    ends = accumulate(map(line_width, text))
    return f"{text[: sum(1 for _ in takewhile(lambda end: size * (end + dots) <= width, ends))]}…"
