"""Arrows of forces, drawn to one scale, for free-body diagrams."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamdyn.common.drawing.shapes import Arrow, Drawing, DrawnShape, Label, Outline, arc

_FORCES = 3  # priority of the labels of forces
_HEAD = 12  # number of points, of 41 along an arc, that the arrowhead covers


@dataclass(eq=False)
class ForceArrows:
    """A drawing under construction, to which forces are added as arrows drawn to one scale.

    Parameters
    ----------
    scale : float
        Length of an arrow per newton [m/N].
    least : float
        Length [m] below which an arrow is drawn ten or a hundred times as long; its label then says so.
    shapes, labels : list
        Shapes and labels added so far; lengths in m.
    """

    scale: float
    least: float = 0.0
    shapes: list[DrawnShape] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)

    def add(self, at: Any, vector: np.ndarray, symbol: str, role: str, *, ends_here: bool = False) -> None:
        """Add the arrow of a force, with its symbol and magnitude at the free end.

        Parameters
        ----------
        at : array of two floats
            Point of application [m].
        vector : ndarray, shape (2,)
            The force [N].
        symbol : str
            Symbol of the force, such as "N_1".
        role : str
            Role that gives its colour: a name in `beamdyn.common.drawing.strokes`.
        ends_here : bool
            Whether the arrow ends at `at`, as for a force that pushes, instead of starting there.
        """
        start = np.asarray(at, dtype=float)
        length = self.scale * float(np.hypot(*vector))
        longer = 10.0 ** np.ceil(np.log10(self.least / length)) if 0 < length < self.least else 1.0
        end = start + longer * self.scale * np.asarray(vector)
        if ends_here:
            start, end = 2 * start - end, start
        self.shapes.append(Arrow(start, end, role, symbol, 2.0))
        free, along = (start, start - end) if ends_here else (end, end - start)
        places = np.stack([free, (start + end) / 2])
        said = force_size(vector) + (f" (arrow x {longer:.0f})" if longer > 1 else "")
        self.labels.append(Label(said, places, role, (along[0], along[1]), symbol, priority=_FORCES))

    def drawing(self, title: str, words: str, key: Mapping[str, str]) -> Drawing:
        """Make the drawing with a title, a description in words, and the meaning of its colours."""
        shapes, labels = tuple(self.shapes), tuple(self.labels)
        return Drawing(shapes, labels, title, words, newton=self.scale, key=key)


def force_size(vector: np.ndarray) -> str:
    """Format the magnitude of a force, such as "3.44 kN"."""
    size = float(np.hypot(*vector))
    return f"{size / 1e3:.3g} kN" if size >= 1e3 else f"{size:.3g} N"


def on_rim(radius: float, alpha: np.ndarray) -> np.ndarray:
    """Return points on a circle at angles from straight down [rad], positive to the right: shape (..., 2)."""
    return radius * np.stack([np.sin(alpha), -np.cos(alpha)], axis=-1)


def rotation(radius: float, half: float, sense: float) -> list[DrawnShape]:
    """Make the arrow of a rotation about the origin, above it; it points clockwise for a sense of 1.

    Parameters
    ----------
    radius : float
        Radius of the arc [m].
    half : float
        Half of the angle of the arc [rad].
    sense : float
        1 for a clockwise rotation, -1 for an anticlockwise one.
    """
    points = arc((0, 0), radius, np.pi / 2 + half * sense, np.pi / 2 - half * sense)
    shaft = Outline(points[: 2 - _HEAD], "neutral", 1.5)
    return [shaft, Arrow(points[-_HEAD], points[-1], "neutral", width=2.0)]
