"""What a torque hangs on: the friction, which a maker gives to a tenth, and the law of the pressure."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from brakes.answers.tables import format_number

PART = 0.1  # by which the friction of linings varies
ENDS = (1 - PART, 1 + PART)  # over the given friction


def doubt(at: Callable[[float], Any], torque: float, of_laws: Iterable[tuple[str, float]] = ()) -> str:
    """One sentence: the torque with less and more friction, and under other laws of the pressure.

    Parameters
    ----------
    at : callable
        ``at(0.9)`` is the result with 0.9 of the friction and the same force; it has `torque`.
    torque : float
        The torque [N m].
    of_laws : iterable of (str, float)
        Words and torque of other laws [N m].
    """
    ends = ", ".join(_said(at(part).torque, torque) for part in ENDS)
    others = (f"{words} {_said(found, torque)}" for words, found in of_laws)
    said = (f"friction -+{100 * PART:.0f} %: {ends}", *others)
    return f"At this force, torque {format_number(torque)} N m; " + "; ".join(said) + "."


def _said(other: float, torque: float) -> str:
    """A torque and its relative change."""
    if np.isnan(other):
        return "locks"
    change = f" ({100 * (other / torque - 1):+.1f} %)" if torque else ""
    return f"{format_number(other)} N m{change}"
