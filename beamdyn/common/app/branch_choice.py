"""A choice among several solutions of an answer: which of them is drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from nicegui import ui


class BranchChoice:
    """Buttons that say which branch is drawn, and choose another; not seen where there is one.

    Parameters
    ----------
    chosen : callable
        Called when another has been chosen.
    """

    def __init__(self, chosen: Callable[[], object]) -> None:
        self._row: Any = ui.row().classes("items-center gap-2")
        with self._row:
            ui.label("Forces drawn:")
            self._toggle: Any = ui.toggle([], on_change=chosen)
            self._toggle.props('no-caps outline padding="xs md" role="group" aria-label="forces drawn"')
        self._row.set_visibility(False)

    def choose(self, answer: Any, branches: Mapping[str, Any]) -> Any:
        """The branch of an answer that is chosen, the first of those that there are at first."""
        names = [*branches]
        if names != self._toggle.options:
            kept = self._toggle.value if self._toggle.value in names else next(iter(names), None)
            self._toggle.set_options(names, value=kept)
        self._row.set_visibility(bool(names))
        return branches.get(self._toggle.value, answer)
