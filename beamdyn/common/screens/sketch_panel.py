"""A sketch beside the form that shows what its symbols mean; it can be folded."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nicegui import ui

from beamdyn.common.drawing.sheet import lay_out
from beamdyn.common.drawing.sketch import Sketcher, sketch_paper
from beamdyn.common.drawing.svg import element

STYLE = """
.sketch svg { width: 100%; max-width: 340px; height: auto; display: block; margin: 0 auto; }
.sketch .nicegui-expansion-content { display: block !important; padding: 0 !important; }
"""


class SketchPanel:
    """The sketch of a form, which can be folded; nothing is shown where there is none.

    Parameters
    ----------
    sketch : callable
        ``sketch(entries)``: rows of drawings.
    entries : mapping
        Entries of the form at first.
    shown : bool
        Whether it is unfolded.
    """

    def __init__(self, sketch: Sketcher, entries: Mapping[str, str], shown: bool) -> None:
        self._shown = shown
        self._fold: Any = None
        self._sketch = sketch
        if made := _drawn(sketch, entries):
            self._fold = ui.expansion("What the symbols mean", value=shown)
            with self._fold.classes("w-full section sketch").props("dense"):
                self._drawing: Any = ui.html(made, sanitize=False)

    def show(self, entries: Mapping[str, str]) -> None:
        """Show the sketch for other entries."""
        if self._fold is not None:
            self._drawing.set_content(_drawn(self._sketch, entries))

    @property
    def shown(self) -> bool:
        """Whether it is unfolded."""
        return bool(self._fold.value) if self._fold is not None else self._shown

    def fold(self) -> None:
        """Fold it."""
        self._shown = False
        if self._fold is not None:
            self._fold.close()


def _drawn(sketch: Sketcher, entries: Mapping[str, str]) -> str:
    """A sketch as an element of the page; "" where there is none."""
    rows = sketch(entries)
    if not rows:
        return ""
    paper = sketch_paper(rows)
    return element(lay_out(rows, paper), paper)
