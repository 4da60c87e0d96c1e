"""The panel of a screen that lists how the design differs from another one."""

from __future__ import annotations

from typing import Any

from nicegui import ui

from beamdyn.common.screens.comparison import (
    differences_html,
    headline_html,
    input_differences,
    result_differences,
)
from beamdyn.common.screens.open_document import Answered, OpenDocument
from beamdyn.common.screens.screens import Screen


class ComparisonPanel:
    """Tables of the inputs and results that differ; hidden while no other design is compared.

    Parameters
    ----------
    work : OpenDocument
        The document.
    screen : Screen
        Which of its screens.
    """

    def __init__(self, work: OpenDocument, screen: Screen) -> None:
        self.work, self.screen = work, screen
        self._fold: Any = ui.expansion("Compared", value=True).classes("w-full section").props("dense")
        with self._fold:
            self._said: Any = ui.label().classes("mistake")
            self._inputs: Any = ui.html("", sanitize=False).classes("w-full")
            self._results: Any = ui.html("", sanitize=False).classes("w-full")
        self._fold.set_visibility(False)

    def show(self, answered: Answered) -> None:
        """Compare an answer with that of the other design, if that has been solved."""
        other = self.work.other
        self._fold.set_visibility(other is not None)
        if other is None:
            return
        self._fold.set_text(f"Compared with {other.name}")
        there = self.work.compared.get(self.screen.name)
        self._said.set_text(self.work.not_compared.get(self.screen.name, ""))
        wanted = [entry for entry in self.work.inputs if entry.path in self.work.entries]
        inputs = [*input_differences(self.work.entries, other.entries, wanted)]
        self._inputs.set_content(differences_html(inputs, "inputs", other.name))
        results = [] if there is None else [*result_differences(answered.tables, there.tables)]
        self._results.set_content("" if there is None else differences_html(results, "results", other.name))


def headline_of(work: OpenDocument, screen: Screen, answered: Answered) -> str:
    """The most important results of an answer in HTML, beside those of the design it is compared with."""
    there = work.compared.get(screen.name)
    other = () if there is None else there.headline
    return headline_html(answered.headline, other, work.other.name if work.other else "")
