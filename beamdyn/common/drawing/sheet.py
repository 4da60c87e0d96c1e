"""Sheets: drawings beside one another, row by row, and the size of their paper; lengths in [pt]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from beamdyn.common.drawing.layout import Fit, Frame, Layout, arrange, follow
from beamdyn.common.drawing.shapes import Drawing

Rows = Sequence[Sequence[Drawing]]
WIDTH = 680.0  # width of a sheet [pt]
_LOWEST, _HIGHEST = 300.0, 600.0  # least and largest height of a row [pt]
_DETAIL = 0.65  # width of a detail over that of a drawing beside it
_AROUND = 100.0  # room for title, key and labels around a drawing [pt]
_SQUARE = 320.0  # side of a square for a single drawing [pt]


@dataclass(frozen=True)
class Paper:
    """Width of a sheet, and the height of each of its rows [pt]."""

    width: float
    heights: tuple[float, ...]

    @property
    def height(self) -> float:
        """Height of all rows together [pt]."""
        return sum(self.heights)

    @classmethod
    def of(cls, rows: Rows, width: float = WIDTH) -> Paper:
        """Make paper for drawings; the height of each row follows from its drawings, within bounds."""
        return cls(width, tuple(_height(row, width) for row in rows))

    @classmethod
    def of_squares(cls, rows: Rows) -> Paper:
        """Make paper with a square for each drawing, as for free-body diagrams."""
        return cls(_SQUARE * max(map(len, rows)), (_SQUARE,) * len(rows))


def _widths(row: Sequence[Drawing], width: float) -> list[float]:
    """Divide the width among the drawings of a row: evenly, but less for details beside others."""
    parts = [_DETAIL if drawing.own_scale else 1.0 for drawing in row]
    return [width * part / sum(parts) for part in parts]


def _height(row: Sequence[Drawing], width: float) -> float:
    """Compute the height of a row of drawings on paper of a given width."""
    highest = 0.0
    for drawing, own in zip(row, _widths(row, width), strict=True):
        low, high = drawing.extent()
        across, up = high - low
        highest = max(highest, own * up / across if across else _HIGHEST)
    return min(max(highest + _AROUND, _LOWEST), _HIGHEST)


def frames_of(row: Sequence[Drawing], paper: Paper, number: int) -> list[Frame]:
    """Return the frames of the drawings of row `number`, beside one another [pt]."""
    top, ends = sum(paper.heights[:number]), [0.0, *accumulate(_widths(row, paper.width))]
    return [(left, top, right, top + paper.heights[number]) for left, right in pairwise(ends)]


def lay_out(rows: Rows, paper: Paper, before: Layout | None = None) -> list[Layout]:
    """Lay out drawings on paper; those of a row have one scale, except for details.

    Parameters
    ----------
    rows : sequence of sequences of Drawing
        The drawings.
    paper : Paper
        The paper.
    before : Layout, optional
        Last layout of the first drawing, while something moves: its scale is kept, and its labels as far as
        their places are free.
    """
    layouts: list[Layout] = []
    for number, row in enumerate(rows):
        frames = frames_of(row, paper, number)
        held = [before if not layouts and i == 0 else None for i in range(len(row))]
        made = [
            arrange(drawing, frame) if kept is None else follow(drawing, frame, kept)
            for drawing, frame, kept in zip(row, frames, held, strict=True)
        ]
        scale = min((each.fit.scale for each in made if not each.drawing.own_scale), default=0.0)
        free = [held[0] is not None or each.drawing.own_scale for each in made]
        layouts += [
            each if is_free or each.fit.scale == scale else _at_scale(each, scale)
            for each, is_free in zip(made, free, strict=True)
        ]
    return layouts


def _at_scale(layout: Layout, scale: float) -> Layout:
    """Lay out a drawing again at another scale, about the same middle."""
    low, high = layout.drawing.extent()
    middle = (low + high) / 2
    x, y = layout.fit.to_paper(middle)
    return arrange(layout.drawing, layout.frame, Fit(scale, x - scale * middle[0], y + scale * middle[1]))
