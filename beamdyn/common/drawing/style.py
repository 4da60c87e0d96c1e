"""Colours of drawings by the role of each shape, on light and on dark ground."""

from __future__ import annotations

from typing import NamedTuple


class Ink(NamedTuple):
    """Colours of a role: of lines and letters, and of areas; on light and on dark ground."""

    line: str
    dark_line: str
    area: str = "none"
    dark_area: str = "none"


# Okabe and Ito's colours, which colour-blind people can tell apart; lighter on dark ground.
BLACK = Ink("#000000", "#f2f2f2", "#000000", "#f2f2f2")
BLUE = Ink("#0072b2", "#62b8ee", "#0072b2", "#62b8ee")
VERMILION = Ink("#c65000", "#ff9350", "#c65000", "#ff9350")
GREEN = Ink("#00805c", "#3ecfa0", "#00805c", "#3ecfa0")
GREY = Ink("#4d4d4d", "#c4c4c4", "#4d4d4d", "#c4c4c4")
AREA = 0.7  # opacity of areas: what lies behind is seen
INKS = {
    "paper": Ink("#ffffff", "#16191d", "#ffffff", "#16191d"),
    "text": Ink("#333333", "#dddddd"),
    "body": Ink("#80868f", "#969daa", "#dfe1e5", "#343a44"),
    "second": Ink("#8a8a8a", "#a0a0a0", "#f2f2f2", "#292d33"),
    "wheel": Ink("#595959", "#b5b5b5", "#c4c6ca", "#4b515b"),
    "ghost": Ink("#c9ccd1", "#4a5059"),
    "rim": Ink("#9a9683", "#8d8a78", "#f1ead2", "#3a3729"),
    "pin": Ink("#1a1a1a", "#eeeeee", "#ffffff", "#16191d"),
    "ground": Ink("#595959", "#b5b5b5", "#595959", "#b5b5b5"),
    "contact": Ink("#1a1a1a", "#eeeeee", "#1a1a1a", "#eeeeee"),
    "support": Ink("#8c8c8c", "#8c8c8c", "#8c8c8c", "#8c8c8c"),
    "axis": Ink("#7f7f7f", "#9b9b9b"),
    "dimension": GREY,
    "neutral": GREY,
    "spring": GREY,
    "cable": GREY,
    "load": BLACK,
    "force": BLACK,
    "weight": BLACK,
    "reaction": GREEN,
    "tension": BLUE,
    "compression": VERMILION,
    "normal": BLUE,
    "friction": VERMILION,
    "leading": BLUE,
    "trailing": VERMILION,
    "beam": Ink("#0072b2", "#62b8ee", "#cfe5f4", "#1d3d54"),
    "mark": BLACK,
    "other": Ink("#a0527f", "#e29bc4"),
    "inside": Ink("#a00000", "#ff6b6b"),
}


def ink(role: str) -> Ink:
    """Colours of a role; raises ValueError for one that is not known."""
    if role not in INKS:
        raise ValueError(f"role is {role!r}; it must be one of {', '.join(INKS)}")
    return INKS[role]


def colour(name: str) -> str:
    """A colour on light ground: of a role's lines by its name, of its areas by "ROLE-area"."""
    role = name.removesuffix("-area")
    return ink(role).line if name == role else ink(role).area
