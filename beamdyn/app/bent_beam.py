"""Drawing of a bent beam along its own axis, with its deflection to a stated scale."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.common.drawing.layout import round_below
from beamdyn.common.drawing.shapes import Drawing, DrawnShape, Label, Outline, Symbol

_DEEP = 0.012  # depth of the drawn beam over its length
_SHOWN = 0.22  # largest deflection drawn, over the length


def drawn_larger(largest: float, length: float) -> float:
    """Factor by which deflections are drawn larger, so that the largest one is seen: 1, 2, 5, 10, ...

    Parameters
    ----------
    largest : float
        The largest deflection [m].
    length : float
        Length of the beam [m].
    """
    if not 0 < largest < np.inf:
        return 1.0
    return round_below(_SHOWN * length / largest)


def bent_beam(
    x: np.ndarray,
    deflection: np.ndarray,
    title: str,
    label: str = "",
    envelope: Sequence[np.ndarray] = (),
    room: float = 0.0,
    scale: str = "",
) -> Drawing:
    """Draw a beam with its root at the left.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m], from 0 to its length.
    deflection : ndarray, shape (n,)
        Deflection as drawn [m].
    title : str
        Title.
    label : str
        Label at the tip.
    envelope : sequence of ndarray, shape (n,)
        Further deflections as drawn [m], in grey.
    room : float
        Largest deflection as drawn [m] for which to leave room.
    scale : str
        To which the deflection is drawn, in words.
    """
    length = float(x[-1])
    half = 0.5 * _DEEP * length
    wall = np.array([[0.0, -0.09 * length], [0.0, 0.09 * length]])
    back = np.array([-0.03 * length, -0.02 * length])
    ticks = wall[0] + np.linspace(0, 1, 7)[:, None] * (wall[1] - wall[0])
    edge = np.vstack([np.column_stack([x, deflection + half]), np.column_stack([x, deflection - half])[::-1]])
    corners = np.array([[0.0, -room], [1.1 * length, room]])
    shapes: list[DrawnShape] = [
        Outline([(0, 0), (length, 0)], "axis", 0.9, (5.0, 3.0)),
        *(Outline(np.column_stack([x, other]), "ghost", 1.4) for other in envelope),
        *(Outline([tick, tick + back], "ground", 0.9) for tick in ticks),
        Outline(wall, "ground", 2.4),
        Outline(edge, "beam", 1.2, closed=True, filled=True),
        Symbol("dot", (length, deflection[-1]), "mark", 5.0),
    ]
    tip = (length, float(deflection[-1]))
    labels = [Label(label, tip, "mark", (1.0, 0.4))] if label else []
    words = "A bent beam, drawn along its own axis, clamped at the left"
    return Drawing(shapes, labels, title, words, room=corners, scale=scale)
