"""What is shown of a screen's answer: text out, no page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from beamdyn.common.rendering import csv_text, drawing, html, picture, png, svg

if TYPE_CHECKING:
    from beamdyn.common.app.documents import Screen

__all__ = ["csv_text", "drawn", "html", "picture", "png", "svg"]


def drawn(screen: Screen, answer: object, place: float) -> str:
    """The SVG of an answer, or the sentence why there is none."""
    return drawing(lambda: screen.draw(answer, place))
