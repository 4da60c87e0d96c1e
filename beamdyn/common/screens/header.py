"""Style and scripts of the page, and its header bar: screens, undo and redo, designs, files, theme."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from nicegui import ui

from beamdyn.common.drawing.svg import page_colours
from beamdyn.common.edge.rendering import STYLE as TABLES
from beamdyn.common.screens.chart_options import chart_colours
from beamdyn.common.screens.open_document import History, OtherDesign

BLUE, RED = "#0072B2", "#8c1c00"
_HERE = files("beamdyn.common.screens")
_DARK = "body.body--dark"
STYLE = (
    TABLES
    + page_colours(":root")
    + chart_colours(":root")
    + page_colours(_DARK, dark=True)
    + chart_colours(_DARK, dark=True)
    + (_HERE / "page.css").read_text(encoding="utf-8")
)


def scripts_of(program: str) -> str:
    """Return the scripts of a program's page as HTML.

    Parameters
    ----------
    program : str
        Name of the program.
    """
    script = (_HERE / "page.js").read_text(encoding="utf-8")
    named = f"window.programName = {json.dumps(program)};"
    return f'<script>{named}</script>\n<script type="module">\n{script}</script>'


_LOOKS = {"": ("brightness_auto", None), "light": ("light_mode", False), "dark": ("dark_mode", True)}


class Header:
    """The header bar of the page, with a tab for each screen.

    Parameters
    ----------
    title : str
        Title of the program.
    screens : sequence of str
        Names of the screens of the program.
    turned : callable
        Called when the user has chosen another screen.
    files : mapping
        Entries of the file menu, with the function that each entry calls.
    do : object
        The page: an object with the methods `undo`, `redo`, `designs`, `stop_comparing` and `keep_look`.
    """

    def __init__(
        self,
        title: str,
        screens: Sequence[str],
        turned: Callable[[], object],
        files: Mapping[str, Callable[[], object]],
        do: Any,
    ) -> None:
        self._do, self._dark = do, ui.dark_mode(None)
        first: Any = screens[0]
        with ui.header().classes("items-center gap-1 q-py-none"):
            ui.html(escape(title), tag="h1", sanitize=False)
            self.tabs: Any = ui.tabs(value=first, on_change=turned)
            with self.tabs.props("dense no-caps shrink stretch inline-label outside-arrows mobile-arrows"):
                self._tabs: dict[str, Any] = {name: ui.tab(name, label=name) for name in screens}
            ui.space()
            self._compared: Any = ui.button(on_click=do.stop_comparing, icon="close")
            self._compared.props("flat dense no-caps color=white").set_visibility(False)
            self._undo = _icon("undo", "Undo (Ctrl-Z)", do.undo)
            self._redo = _icon("redo", "Redo (Ctrl-Shift-Z)", do.redo)
            self._light = _icon("", "", self._next_look)
            self.show_look("")
            ui.button("Designs", on_click=do.designs).props("flat dense no-caps color=white")
            with ui.button("File").props("flat dense no-caps color=white"), ui.menu().props("auto-close"):
                for words, act in files.items():
                    ui.menu_item(words, act)

    def mark(self, stale: Collection[str], history: History, other: OtherDesign | None) -> None:
        """Show which screens are outdated, whether undo and redo are possible, and the compared design."""
        for name, tab in self._tabs.items():
            label = f"{name} (stale)" if name in stale else name
            if tab.props["label"] != label:  # setting an unchanged property would render the page again
                tab.props["label"] = label
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
        """Set the theme of the page: "light", "dark", or "" for the setting of the system."""
        self._look = look if look in _LOOKS else ""
        icon, self._dark.value = _LOOKS[self._look]
        words = f"colours: {self._look or 'as the system'}"
        self._light.props(f'icon={icon} aria-label="{words}" title="{words}"')


def _icon(icon: str, words: str, act: Callable[[], object]) -> Any:
    made = ui.button(icon=icon, on_click=act).props("flat dense color=white")
    return made.props(f'aria-label="{words}" title="{words}"')
