"""Buttons that choose which of several solutions of an answer is drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from nicegui import ui


class BranchChoice:
    """Buttons that choose which branch of an answer is drawn; hidden where the answer has a single one.

    Parameters
    ----------
    chosen : callable
        Called when another branch has been chosen.
    """

    def __init__(self, chosen: Callable[[], object]) -> None:
        self._row: Any = ui.row().classes("items-center gap-2")
        with self._row:
            ui.label("Forces drawn:")
            self._toggle: Any = ui.toggle([], on_change=chosen)
            self._toggle.props('no-caps outline padding="xs md" role="group" aria-label="forces drawn"')
        self._row.set_visibility(False)

    def choose(self, answer: Any, branches: Mapping[str, Any]) -> Any:
        """The chosen branch of an answer: the first one until another is chosen."""
        names = [*branches]
        if names != self._toggle.options:
            kept = self._toggle.value if self._toggle.value in names else next(iter(names), None)
            self._toggle.set_options(names, value=kept)
        self._row.set_visibility(bool(names))
        return branches.get(self._toggle.value, answer)
