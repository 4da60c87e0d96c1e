"""Further drawings and tables of a screen, which fold out below its numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.sheet import Paper, Rows, lay_out
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.rendering import drawing, html, picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType


class FoldedPart(Protocol):
    """A part of a screen that folds out, and is made only then."""

    @property
    def title(self) -> str:
        """Title of the part."""
        ...

    def on_page(self, answer: Any) -> str:
        """The part in HTML, in the colours of the page."""
        ...

    def in_report(self, answer: Any) -> str:
        """The part in HTML, for a page that has no colours of its own."""
        ...


@dataclass(frozen=True)
class FoldedDrawings:
    """Drawings.

    Parameters
    ----------
    title : str
        Title of the drawings.
    rows : callable
        ``rows(answer)``: rows of drawings.
    """

    title: str
    rows: Callable[[Any], Rows]

    def on_page(self, answer: Any) -> str:
        """The drawings as SVG."""
        rows = self.rows(answer)
        paper = Paper.of_squares(rows)
        return element(lay_out(rows, paper), paper)

    def in_report(self, answer: Any) -> str:
        """The drawings as a picture."""
        rows = self.rows(answer)
        return picture(drawing(lambda: figure_of(rows, Paper.of_squares(rows))), self.title)


@dataclass(frozen=True)
class FoldedPicture:
    """A figure of matplotlib.

    Parameters
    ----------
    title : str
        Title of the part.
    draw : callable
        ``draw(answer)``: the figure.
    """

    title: str
    draw: Callable[[Any], Figure]

    def on_page(self, answer: Any) -> str:
        """The figure as a picture."""
        return picture(drawing(lambda: self.draw(answer)), self.title)

    def in_report(self, answer: Any) -> str:
        """Where the figure stands: a report has that of each screen anyway."""
        return "<p>It is the drawing above.</p>"


@dataclass(frozen=True)
class FoldedTable:
    """A table.

    Parameters
    ----------
    title : str
        Title of the part.
    table : callable
        ``table(answer)``: the table.
    """

    title: str
    table: Callable[[Any], RenderableType]

    def on_page(self, answer: Any) -> str:
        """The table."""
        return html([self.table(answer)])

    def in_report(self, answer: Any) -> str:
        """The table."""
        return self.on_page(answer)
