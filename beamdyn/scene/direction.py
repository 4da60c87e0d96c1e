"""Words for the two directions in which a point of the beam moves, as inputs name them."""

from __future__ import annotations

from typing import Final, Literal

Direction = Literal["bending", "across"]
ALONG_BENDING: Final = "bending"
ACROSS: Final = "across"


def direction_of(direction: str) -> int:
    """0 for the direction of the bending angle, 1 for that across."""
    return 1 if direction == ACROSS else 0
