"""Drawings beside one another, row by row, and the size of their paper; lengths in [pt]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from beamdyn.common.drawing.layout import Fit, Frame, Layout, arrange, follow
from beamdyn.common.drawing.shapes import Drawing

Rows = Sequence[Sequence[Drawing]]
WIDTH = 680.0  # width of a sheet
_LOWEST, _HIGHEST = 300.0, 600.0  # heights of a row
_DETAIL = 0.65  # width of a detail over that of a drawing beside it
_AROUND = 100.0  # room for title, key and labels around what is drawn
_SQUARE = 320.0  # side of a drawing of its own [pt]


@dataclass(frozen=True)
class Paper:
    """Width of a sheet, and the height of each of its rows."""

    width: float
    heights: tuple[float, ...]

    @property
    def height(self) -> float:
        """Height of all rows together."""
        return sum(self.heights)

    @classmethod
    def of(cls, rows: Rows, width: float = WIDTH) -> Paper:
        """Paper for drawings, with the height of each row chosen by its drawings, within bounds."""
        return cls(width, tuple(_height(row, width) for row in rows))

    @classmethod
    def of_squares(cls, rows: Rows) -> Paper:
        """Paper with a square for each drawing, as for free-body diagrams."""
        return cls(_SQUARE * max(map(len, rows)), (_SQUARE,) * len(rows))


def _widths(row: Sequence[Drawing], width: float) -> list[float]:
    """Widths of the drawings of a row: even, but for details beside others."""
    parts = [_DETAIL if drawing.own_scale else 1.0 for drawing in row]
    return [width * part / sum(parts) for part in parts]


def _height(row: Sequence[Drawing], width: float) -> float:
    """Height of a row of drawings on paper of this width."""
    highest = 0.0
    for drawing, own in zip(row, _widths(row, width), strict=True):
        low, high = drawing.extent()
        across, up = high - low
        highest = max(highest, own * up / across if across else _HIGHEST)
    return min(max(highest + _AROUND, _LOWEST), _HIGHEST)


def frames_of(row: Sequence[Drawing], paper: Paper, number: int) -> list[Frame]:
    """Frames of the drawings of the row of this number, beside one another [pt]."""
    top, ends = sum(paper.heights[:number]), [0.0, *accumulate(_widths(row, paper.width))]
    return [(left, top, right, top + paper.heights[number]) for left, right in pairwise(ends)]


def lay_out(rows: Rows, paper: Paper, before: Layout | None = None) -> list[Layout]:
    """Layouts of drawings on paper; those of a row have one scale, but for details.

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
    """A layout at another scale, about the same middle of the drawing."""
    low, high = layout.drawing.extent()
    middle = (low + high) / 2
    x, y = layout.fit.to_paper(middle)
    return arrange(layout.drawing, layout.frame, Fit(scale, x - scale * middle[0], y + scale * middle[1]))
