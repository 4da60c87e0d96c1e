"""The bar at the head of the page: title of the program, screens, undo and redo, designs, files, look."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from html import escape
from typing import Any, Protocol

from nicegui import ui

from beamdyn.common.screens.comparison import OtherDesign
from beamdyn.common.screens.history import History

_LOOKS = {"": ("brightness_auto", None), "light": ("light_mode", False), "dark": ("dark_mode", True)}


class Commands(Protocol):
    """Actions of the buttons of the bar."""

    def undo(self) -> None:
        """Take the last change back."""
        ...

    def redo(self) -> None:
        """Make it again."""
        ...

    async def designs(self) -> None:
        """Show named designs and examples."""
        ...

    def stop_comparing(self) -> None:
        """Show the open design alone."""
        ...

    def keep_look(self, look: str) -> None:
        """Store whether the page is light or dark."""
        ...


class Header:
    """The bar, with a tab for each screen.

    Parameters
    ----------
    title : str
        Title of the program.
    screens : sequence of str
        Names of its screens.
    turned : callable
        Called when another screen has been chosen.
    files : mapping
        Entries of the menu of files, and the function that each calls.
    do : Commands
        Actions of the other buttons.
    """

    def __init__(
        self,
        title: str,
        screens: Sequence[str],
        turned: Callable[[], object],
        files: Mapping[str, Callable[[], object]],
        do: Commands,
    ) -> None:
        self._do = do
        self._look = ""
        self._dark = ui.dark_mode(None)
        first: Any = screens[0]
        self.tabs: Any
        with ui.header().classes("items-center gap-1 q-py-none"):
            ui.html(escape(title), tag="h1", sanitize=False)
            with ui.tabs(value=first, on_change=turned).props(
                "dense no-caps shrink stretch inline-label outside-arrows mobile-arrows"
            ) as self.tabs:
                self._tabs: dict[str, Any] = {name: ui.tab(name, label=name) for name in screens}
            ui.space()
            self._buttons(files)

    def _buttons(self, files: Mapping[str, Callable[[], object]]) -> None:
        self._compared: Any = ui.button(on_click=self._do.stop_comparing, icon="close")
        self._compared.props("flat dense no-caps color=white").set_visibility(False)
        self._undo = _icon("undo", "Undo (Ctrl-Z)", self._do.undo)
        self._redo = _icon("redo", "Redo (Ctrl-Shift-Z)", self._do.redo)
        self._light = _icon(_LOOKS[""][0], "", self._next_look)
        self.show_look("")
        ui.button("Designs", on_click=self._do.designs).props("flat dense no-caps color=white")
        with ui.button("File").props("flat dense no-caps color=white"), ui.menu().props("auto-close"):
            for words, act in files.items():
                ui.menu_item(words, act)

    def mark(self, stale: Collection[str], history: History, other: OtherDesign | None) -> None:
        """Show which screens are stale, what can be undone, and which design is compared."""
        for name, tab in self._tabs.items():
            tab.props["label"] = f"{name} (stale)" if name in stale else name
            tab.update()
        self._undo.set_enabled(history.can_undo)
        self._redo.set_enabled(history.can_redo)
        self._compared.set_visibility(other is not None)
        if other is not None:
            self._compared.set_text(f"Compared with {other.name[:24]}")
            self._compared.props["aria-label"] = f"Stop comparing with {other.name}"

    def _next_look(self) -> None:
        looks = [*_LOOKS]
        self.show_look(looks[(looks.index(self._look) + 1) % len(looks)])
        self._do.keep_look(self._look)

    def show_look(self, look: str) -> None:
        """Show the page "light" or "dark", or as the system prefers ("")."""
        self._look = look if look in _LOOKS else ""
        icon, self._dark.value = _LOOKS[self._look]
        words = f"colours: {self._look or 'as the system'}"
        self._light.props(f'icon={icon} aria-label="{words}" title="{words}"')


def _icon(icon: str, words: str, act: Callable[[], object]) -> Any:
    made = ui.button(icon=icon, on_click=act).props("flat dense color=white")
    return made.props(f'aria-label="{words}" title="{words}"')
