"""Placement of labels so that none covers another label, a symbol or the end of a line, or leaves the frame.

Each label has candidate positions around its anchor points.  The drawn lines and symbols are counted in a
grid of small cells; sums over rectangles of cells tell how much of them a candidate would cover.  The labels
are placed one by one, the most important first, each at its cheapest free candidate.  A label without a free
candidate takes the place of another label, if that label can move.  Nothing is random: the same drawing gives
the same places.

In shapes of arrays, n counts labels or other boxes, and k candidates or lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

_CELL = 2.5  # side of a grid cell [pt]
_APART = 2.0  # least distance between two texts [pt]
_GAP = 5.0  # distance from an anchor to its label [pt]
FAR = 18.0  # distance of a label from its anchor above which a line (leader) connects them [pt]
# Distances of candidate places from the anchor, in addition to the smallest distance [pt].
_STEPS = np.array([0.0, 5.0, 12.0, 22.0, 36.0, 54.0, 78.0, 110.0, 150.0])
_TURNS = 12  # number of directions around an anchor
# Costs of a candidate place, in [pt] of additional distance from the anchor:
_TURNED = 9.0  # cost of a direction at right angles to the preferred one [pt]
_NEXT = 5.0  # additional cost of each further anchor of a label, from the second one on [pt]
_COVERED = 120.0  # cost of a candidate place that lines of the drawing cover completely [pt]


@dataclass(frozen=True, eq=False)
class LabelRequest:
    """A label that needs a place on paper, where y points down and lengths are in [pt].

    Parameters
    ----------
    size : tuple of float
        Width and height of the label's text.
    anchors : ndarray, shape (points, 2)
        Points beside which the label may stand, the best first.
    towards : tuple of float
        Preferred direction from the anchor to the label; (0, 0) to put the label on the anchor.
    priority : int
        Labels of higher priority are placed first.
    """

    size: tuple[float, float]
    anchors: np.ndarray
    towards: tuple[float, float] = (0.0, 0.0)
    priority: int = 0


class Place(NamedTuple):
    """A placed label: centre (2,), anchor (2,), and distance between its box and the anchor [pt]."""

    centre: np.ndarray
    anchor: np.ndarray
    distance: float


@dataclass(frozen=True, eq=False)
class Obstacles:
    """Lines and symbols that are drawn already, and the frame; y points down, lengths are in [pt].

    Parameters
    ----------
    frame : tuple of float
        Left, top, right and bottom edge of the area in which labels must stand.
    lines : ndarray, shape (lines, 4)
        Line segments (x, y, x, y) that labels should not cover.
    points : ndarray, shape (points, 2)
        Centres of symbols, and ends of lines, that labels must not cover.
    reach : float
        Radius around the points that must stay free.
    """

    frame: tuple[float, float, float, float]
    lines: np.ndarray
    points: np.ndarray
    reach: float = 3.5

    @cached_property
    def _covered(self) -> np.ndarray:
        """Return the summed-area table (rows + 1, columns + 1) of the cells that lines cross."""
        start, way = self.lines[:, :2], self.lines[:, 2:] - self.lines[:, :2]
        # Number of points along each line: neighbours are at most one cell apart.
        counts = np.ceil(np.hypot(*way.T) / _CELL).astype(int) + 1
        which = np.repeat(np.arange(len(way)), counts)
        step = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
        part = step / np.maximum(counts[which] - 1, 1)
        return self._summed(start[which] + part[:, None] * way[which])

    @cached_property
    def _forbidden(self) -> np.ndarray:
        """Return the summed-area table (rows + 1, columns + 1) of cells near symbols and line ends.

        The cells lie within `reach` of a symbol or of the end of a line; no label may cover them.
        """
        side = np.linspace(-self.reach, self.reach, 2 * int(np.ceil(self.reach / _CELL)) + 1)
        dx, dy = (d.ravel() for d in np.meshgrid(side, side))
        around = self.points[:, None] + np.stack([dx, dy], axis=-1)[np.hypot(dx, dy) <= self.reach + 0.5]
        return self._summed(around.reshape(-1, 2))

    @cached_property
    def _cells(self) -> np.ndarray:
        """Return the numbers of columns and rows of grid cells in the frame."""
        left, top, right, bottom = self.frame
        return np.array([int((right - left) / _CELL) + 2, int((bottom - top) / _CELL) + 2])

    def _summed(self, points: np.ndarray) -> np.ndarray:
        cells = np.zeros(self._cells[::-1] + 1, dtype=np.int32)
        places = np.floor((points - self.frame[:2]) / _CELL).astype(int)
        column, row = places[((places >= 0) & (places < self._cells)).all(axis=1)].T
        cells[row + 1, column + 1] = 1
        return cells.cumsum(axis=0, out=cells).cumsum(axis=1, out=cells)

    def judge(self, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the fraction of each box (row) covered by lines, and whether it is clear of symbols."""
        x0, y0, x1, y1 = boxes.T
        return self._over(self._covered, boxes) * _CELL**2 / ((x1 - x0) * (y1 - y0)), self.is_free(boxes)

    def is_free(self, boxes: np.ndarray) -> np.ndarray:
        """Return whether each of the boxes (rows) lies within the frame and covers no symbol."""
        (left, top, right, bottom), (x0, y0, x1, y1) = self.frame, boxes.T
        inside = (x0 >= left) & (y0 >= top) & (x1 <= right) & (y1 <= bottom)
        return inside & (self._over(self._forbidden, boxes) == 0)

    def _over(self, sums: np.ndarray, boxes: np.ndarray) -> np.ndarray:
        """Sum over the cells in each of the boxes (rows), by the summed-area table at their corners."""
        low = np.clip(((boxes[:, :2] - self.frame[:2]) / _CELL).astype(np.intp), 0, self._cells)
        high = np.clip(((boxes[:, 2:] - self.frame[:2]) / _CELL).astype(np.intp) + 1, 0, self._cells)
        (c0, r0), (c1, r1) = low.T, high.T
        return sums[r1, c1] - sums[r0, c1] - sums[r1, c0] + sums[r0, c0]


@dataclass(eq=False)
class _Candidates:
    """Free places of a label, the cheapest first: boxes (k, 4), anchors (k, 2) and distances (k,)."""

    boxes: np.ndarray
    anchors: np.ndarray
    distances: np.ndarray

    @cached_property
    def leaders(self) -> np.ndarray:
        """Return the leader lines from the boxes to their anchors, in rows."""
        nearest = np.clip(self.anchors, self.boxes[:, :2], self.boxes[:, 2:])
        return np.concatenate([nearest, self.anchors], axis=1)

    def place(self, i: int) -> Place:
        box = self.boxes[i]
        return Place((box[:2] + box[2:]) / 2, self.anchors[i], float(self.distances[i]))

    def first_free(self, boxes: np.ndarray, leaders: np.ndarray) -> int | None:
        """Return the index of the cheapest candidate that meets no label; None if there is none.

        The labels that have a place already are given by their boxes (n, 4), with the space around them, and
        by their leaders (m, 4).
        """
        own, far = self.boxes, np.flatnonzero(self.distances > FAR)
        meets = np.array(_overlap(own, boxes).any(axis=1) | _crossing(leaders, own).any(axis=0))
        meets[far] |= _crossing(self.leaders[far], boxes).any(axis=1)
        return None if meets.all() else int(meets.argmin())


_ANGLES = 2 * np.pi * np.arange(_TURNS) / _TURNS
_WAYS = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)], axis=-1)
_SPREAD = 1 / np.abs(_WAYS).clip(1e-9)
# Directions from the centre of a label's box to its corners.
_CORNERS = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
_AWAY = np.concatenate([_WAYS, _CORNERS / np.sqrt(2.0)])
# Cost [pt], by direction, of a place beside a point that the label should cover.
_BESIDE = np.repeat([0.0, 12.0], [_TURNS, len(_CORNERS)])


def _candidates(requests: Sequence[LabelRequest], obstacles: Obstacles) -> list[_Candidates]:
    """Make the candidate places of all labels: around each anchor, at several directions and distances."""
    counts = [len(request.anchors) for request in requests]
    anchors = np.concatenate([request.anchors for request in requests])
    half = np.repeat([request.size for request in requests], counts, axis=0) / 2
    towards = np.repeat(np.array([request.towards for request in requests], dtype=float), counts, axis=0)
    on_it: np.ndarray = np.hypot(*towards.T) == 0
    offsets, distances = _around(half, on_it)
    centres = (anchors[:, None, None] + offsets).reshape(len(anchors), -1, 2)
    boxes = np.concatenate([centres - half[:, None], centres + half[:, None]], axis=2).reshape(-1, 4)
    covered, free = obstacles.judge(boxes)
    nth = np.concatenate([np.arange(count) for count in counts])
    ways = towards / np.where(on_it, 1.0, np.hypot(*towards.T))[:, None]
    turned = np.where(on_it[:, None], _BESIDE, _TURNED * (1 - ways @ _AWAY.T))
    costs = (_STEPS[:, None] + turned[:, None] + _NEXT * nth[:, None, None]).ravel() + _COVERED * covered
    of_anchor = np.repeat(np.arange(len(anchors)), distances[0].size)
    of_label = np.repeat(np.arange(len(requests)), counts)[of_anchor]
    order = np.flatnonzero(free)
    order = order[np.lexsort((costs[order], of_label[order]))]  # by label, then by cost
    each = np.split(order, np.searchsorted(of_label[order], np.arange(1, len(requests))))
    return [_Candidates(boxes[some], anchors[of_anchor[some]], distances.ravel()[some]) for some in each]


def _around(half: np.ndarray, on_it: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute candidate places of labels around n anchors, at s distances in t directions.

    Parameters
    ----------
    half : ndarray, shape (n, 2)
        Half the width and half the height of the label.
    on_it : ndarray of bool, shape (n,)
        Whether the label should stand on the anchor.

    Returns
    -------
    offsets : ndarray, shape (n, s, t, 2)
        Vectors from the anchor to the centres of the label.
    distances : ndarray, shape (n, s, t)
        Distances from the anchor to the edge of the label.
    """
    on_it = on_it[:, None, None]
    # Distance from the centre to the edge of the label's box, shape (anchors, directions).
    reach = (half[:, None] * _SPREAD).min(axis=2)
    out = np.where(on_it, _STEPS[:, None], _GAP + _STEPS[:, None] + reach[:, None])
    distances = np.where(on_it, np.maximum(out - reach[:, None], 0.0), _STEPS[:, None])
    aside = np.broadcast_to(_STEPS[:, None], (len(half), len(_STEPS), len(_CORNERS)))
    corners = (half[:, None, None] + (_GAP + _STEPS[:, None, None]) / np.sqrt(2.0)) * _CORNERS
    offsets = np.concatenate([out[..., None] * _WAYS, corners], axis=2)
    return offsets, np.concatenate([distances, aside], axis=2)


def _overlap(boxes: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return whether each box (k, 4) overlaps each of n others (n, 4), shape (k, n), for k boxes."""
    x0, y0, x1, y1 = boxes.T[..., None]
    left, top, right, bottom = others.T[:, None]
    return (x0 < right) & (left < x1) & (y0 < bottom) & (top < y1)


def _crossing(segments: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Return whether each of k line segments (k, 4) crosses each of n boxes (n, 4), shape (k, n)."""
    ax, ay, bx, by = segments.T[..., None]
    left, top, right, bottom = boxes.T[:, None]
    across, down = (np.where(way == 0, 1e-12, way) for way in (bx - ax, by - ay))
    one, two = (left - ax) / across, (right - ax) / across
    three, four = (top - ay) / down, (bottom - ay) / down
    enter = np.maximum(np.maximum(np.minimum(one, two), np.minimum(three, four)), 0.0)
    leave = np.minimum(np.minimum(np.maximum(one, two), np.maximum(three, four)), 1.0)
    return enter < leave


def place_labels(requests: Sequence[LabelRequest], obstacles: Obstacles) -> list[Place | None]:
    """Find places for labels that cover neither obstacles nor each other.

    Parameters
    ----------
    requests : sequence of LabelRequest
        The labels.
    obstacles : Obstacles
        Shapes that are drawn already.

    Returns
    -------
    list of Place or None
        The place of each label; None for a label without a free place.
    """
    if not requests:
        return []
    candidates = _candidates(requests, obstacles)
    places: list[Place | None] = [None] * len(requests)
    boxes, leaders = np.empty((0, 4)), np.empty((0, 4))  # of the labels that have a place
    for label in sorted(
        range(len(requests)), key=lambda i: (-requests[i].priority, len(candidates[i].boxes), i)
    ):
        of = candidates[label]
        if (best := of.first_free(boxes, leaders)) is not None:
            places[label] = of.place(best)
            boxes = np.vstack([boxes, of.boxes[best] + (-_APART, -_APART, _APART, _APART)])
            leaders = np.vstack([leaders, of.leaders[best : best + (of.distances[best] > FAR)]])
    return places


def keep_places(
    before: Sequence[Place | None], requests: Sequence[LabelRequest], obstacles: Obstacles
) -> list[Place | None] | None:
    """Move labels along with their anchor points; return None if a label then collides with anything.

    Parameters
    ----------
    before : sequence of Place
        Earlier places of the labels.
    requests : sequence of LabelRequest
        Labels as they are now.
    obstacles : Obstacles
        Shapes that are drawn now.

    Returns
    -------
    list of Place, or None
        None if a label had no place, or its place is not free any more: call `place_labels` then.
    """
    pairs = zip(before, requests, strict=True)
    places = []  # each label keeps its offset, now from the anchor nearest to its earlier one
    for place, request in pairs:
        if place is not None:
            anchor = request.anchors[np.hypot(*(request.anchors - place.anchor).T).argmin()]
            places.append(place._replace(centre=anchor + place.centre - place.anchor, anchor=anchor))
    if not places or len(places) < len(requests):
        return None if requests else []
    half = np.array([request.size for request in requests]) / 2
    centres, anchors = (np.array([getattr(p, key) for p in places]) for key in ("centre", "anchor"))
    boxes = np.hstack([centres - half, centres + half])
    apart = boxes + _APART * np.array([-1, -1, 1, 1])
    far = np.array([place.distance > FAR for place in places])
    leaders = np.hstack([np.clip(anchors, boxes[:, :2], boxes[:, 2:]), anchors])[far]
    meets = _overlap(boxes, apart)
    meets[far] |= _crossing(leaders, apart)
    np.fill_diagonal(meets, False)
    return [*places] if obstacles.is_free(boxes).all() and not meets.any() else None
