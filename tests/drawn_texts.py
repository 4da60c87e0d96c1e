"""The texts of a figure as they are drawn, and which of them overlap."""

from __future__ import annotations

from itertools import combinations
from unittest.mock import patch

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

TOUCHES = 1.0  # [px]: boxes of texts are rounded outward to whole ones


def drawn_texts(figure: Figure) -> list[tuple[str, tuple[float, float, float, float]]]:
    """Each text that is drawn, and its box x0, y0, x1, y1 [px]."""
    found, draw = [], Text.draw

    def note(text: Text, renderer) -> None:
        if text.get_visible() and text.get_text().strip():
            found.append((text.get_text(), text.get_window_extent(renderer).extents))
        draw(text, renderer)

    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # layouts settle
    with patch.object(Text, "draw", note):
        canvas.draw()
    return found


def overlapping(figure: Figure) -> list[tuple[str, str]]:
    """Pairs of texts whose boxes overlap."""
    return [
        (one, other)
        for (one, (a, b, c, d)), (other, (e, f, g, h)) in combinations(drawn_texts(figure), 2)
        if min(c, g) - max(a, e) > TOUCHES and min(d, h) - max(b, f) > TOUCHES
    ]
