"""Texts in a picture that find a free place when it is drawn, whatever its size: none covers another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Text

_APART = 2.0  # least distance between two texts [px]
_MOST = 80  # largest number of places around a point that are tried for its text
_POINT = 5.0  # half the size of a marked point [px]
_ON_IT = np.zeros((1, 2))
# Directions, from a point, in which a place for its text is tried.
_WAYS = np.array([(1, 0.2), (-1, 0.2), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)])
_HALO: dict[str, Any] = {
    "boxstyle": "square,pad=0.1",
    "facecolor": "white",
    "alpha": 0.85,
    "edgecolor": "none",
}


class PlacedLabels(Artist):
    """Texts on axes, each at the first of its places where it covers no other.

    Near an edge it is moved into the axes; a text without a free place is left out.  Places are chosen anew
    whenever the picture is drawn.

    Parameters
    ----------
    ax : Axes
        The axes.
    """

    def __init__(self, ax: Axes) -> None:
        super().__init__()
        self.set_in_layout(False)  # texts lie within the axes, so that the layout needs no room for them
        self.set_zorder(6)
        self._texts: list[tuple[Text, np.ndarray, np.ndarray]] = []
        self._points = np.empty((0, 2))
        ax.add_artist(self)

    def add(self, text: str, places: np.ndarray, beside: bool = False, **style: Any) -> None:
        """Add a text; texts that are added first choose first.

        Parameters
        ----------
        text : str
            The text.
        places : ndarray, shape (n, 2)
            Places of its centre, in the units of the axes, the best first.
        beside : bool
            Whether the text stands beside its places, which are then marked points that no text may cover.
        **style
            Properties of the text, as for `matplotlib.text.Text`.
        """
        from matplotlib.text import Text

        assert self.axes is not None
        centred: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 9, "bbox": _HALO}
        made = Text(places[0, 0], places[0, 1], text, **centred | style)
        made.set_figure(self.axes.figure)
        made.set_transform(self.axes.transData)
        places = places[:: -(-len(places) // _MOST)]
        self._texts.append((made, places, _WAYS if beside else _ON_IT))
        if beside:
            self._points = np.vstack([self._points, places])

    def get_children(self) -> list[Artist]:
        """Return the texts."""
        return [text for text, *_ in self._texts]

    def draw(self, renderer: Any) -> None:
        """Place the texts, and draw them."""
        assert self.axes is not None
        frame, marked = self.axes.bbox, self.axes.transData.transform(self._points)
        ends = np.array([[frame.x0, frame.y0], [frame.x1, frame.y1]])
        taken = np.hstack([marked - _POINT, marked + _POINT])
        for text, places, ways in self._texts:
            text.set_visible(True)  # an invisible text has no size
            box = text.get_window_extent(renderer)
            half = np.array([box.width, box.height]) / 2 + _APART
            at = self.axes.transData.transform(places)[:, None] + ways * (half + _POINT)
            at = at.reshape(-1, 2)
            at = np.clip(at, ends[0] + half, np.maximum(ends[1] - half, ends[0] + half))
            boxes = np.hstack([at - half, at + half])
            free = (boxes[:, 2:] <= ends[1]).all(axis=1) & ~_overlap(boxes, taken)
            text.set_visible(bool(free.any()))
            if free.any():
                first = int(free.argmax())
                text.set_position(tuple(self.axes.transData.inverted().transform(at[first])))
                taken = np.vstack([taken, boxes[first]])
            text.draw(renderer)


def _overlap(boxes: np.ndarray, taken: np.ndarray) -> np.ndarray:
    """Decide whether boxes (n, 4) overlap any of others (m, 4), shape (n,)."""
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    each = np.all((low < taken[:, 2:]) & (taken[:, :2] < high), axis=-1)
    return np.asarray(np.any(each, axis=-1))
