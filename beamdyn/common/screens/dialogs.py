"""Dialogs of the page: open a file, list of named designs and examples, and link to a design."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from nicegui import ui

from beamdyn.common.screens.examples import Example
from beamdyn.common.screens.form_entries import Entries
from beamdyn.common.screens.screens import Document

_LARGEST = 200_000  # largest size of an opened file in bytes
_TOO_LARGE = f"the file is larger than {_LARGEST} bytes"


class FileDialog:
    """A dialog that opens a TOML file, or shows why the file cannot be opened.

    Parameters
    ----------
    opened : callable
        Called with the text and the name of the chosen file.
    """

    def __init__(self, opened: Callable[[str, str], object]) -> None:
        self._opened = opened
        with ui.dialog() as self._dialog, ui.card():
            ui.label("Open a file, as the commands read it")
            self._upload: Any = ui.upload(
                label="file", on_upload=self._uploaded, auto_upload=True, max_file_size=_LARGEST,
                max_files=1, on_rejected=lambda: self._said.set_text(_TOO_LARGE),
            ).props('aria-label="file"')  # fmt: skip
            self._said: Any = ui.label().classes("mistake").props('role="alert"')
            self._said.style("white-space: pre-line")
            ui.button("Close", on_click=self._dialog.close).props("flat no-caps")

    def ask(self) -> None:
        """Open the dialog in which the user chooses a file."""
        self._upload.reset()
        self.refuse("")

    def refuse(self, sentence: str) -> None:
        """Show why a file cannot be opened, and keep the dialog open."""
        self._said.set_text(sentence)
        self._dialog.open()

    def close(self) -> None:
        """Close the dialog."""
        self._dialog.close()

    async def _uploaded(self, event: Any) -> None:
        name, content = event.file.name, await event.file.read()
        if len(content) > _LARGEST:  # checked again: the browser's check can be bypassed
            return self._said.set_text(_TOO_LARGE)
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            return self._said.set_text(f"{name}: it is not text in UTF-8; give a text file")
        self._opened(text, name)


class DesignsDialog:
    """A dialog that lists named designs and examples.

    Parameters
    ----------
    keep : callable
        ``keep(name)`` stores the open design under a name; it returns "", or the reason if it fails.
    open, compare : callable
        Called with the name of a design, the name of its kind of file, and its field texts.
    delete : callable
        Called with the name of a design.
    """

    def __init__(
        self,
        keep: Callable[[str], Any],
        open: Callable[[str, str, Entries], object],
        compare: Callable[[str, str, Entries], object],
        delete: Callable[[str], Any],
    ) -> None:
        self._open, self._compare, self._delete = open, compare, delete

        async def store() -> None:
            self._said.set_text(await keep(name.value or ""))

        with ui.dialog() as self._dialog, ui.card().classes("designs"):
            ui.html("Designs", tag="h2", sanitize=False)
            with ui.row().classes("items-center w-full no-wrap"):
                name: Any = ui.input("name for this design").classes("grow").props("dense outlined")
                ui.button("Keep", on_click=store).props("no-caps")
            self._said: Any = ui.label().classes("mistake").props('role="alert"')
            self._list: Any = ui.column().classes("w-full gap-0")
            ui.button("Close", on_click=self._dialog.close).props("flat no-caps")

    def show(
        self, kept: Mapping[str, tuple[str, Entries]], examples: Sequence[Example], document: Document
    ) -> None:
        """Show named designs and examples; only designs for the screens of `document` can be compared.

        An example opens on the screens of `document` if they can read its file; else on its own screens.
        """
        self._said.set_text("")
        self._list.clear()
        with self._list:
            ui.html("Kept in this browser", tag="h3", sanitize=False)
            if not kept:
                ui.label("None yet.").classes("status")
            for name, (kind, entries) in kept.items():
                self._row(name, kind, lambda entries=entries: entries, kind == document.name, deletes=True)
            ui.html("Examples", tag="h3", sanitize=False)
            for example in examples:
                own = document if example.document.check is document.check else example.document
                opened = partial(own.opened, example.text, example.name)
                self._row(example.title, own.name, opened, own is document)
        self._dialog.open()

    def _row(
        self, name: str, kind: str, entries: Callable[[], Entries], comparable: bool, deletes: bool = False
    ) -> None:
        def button(word: str, act: Callable[[], object], closes: bool = True) -> None:
            async def run() -> None:
                if closes:
                    self._dialog.close()
                if hasattr(made := act(), "__await__"):
                    await made  # type: ignore[misc]

            ui.button(word, on_click=run).props("flat dense no-caps").props["aria-label"] = f"{word} {name}"

        with ui.row().classes("items-center w-full no-wrap design"):
            with ui.column().classes("grow gap-0"):
                ui.label(name)
                ui.label(kind).classes("status")
            button("Open", lambda: self._open(name, kind, entries()))
            if comparable:
                button("Compare", lambda: self._compare(name, kind, entries()))
            if deletes:
                button("Delete", partial(self._delete, name), closes=False)


class LinkDialog:
    """A dialog with the link to a design, or with the reason why there is no link."""

    def __init__(self) -> None:
        with ui.dialog() as self._dialog, ui.card().classes("designs"):
            ui.html("Link to this design", tag="h2", sanitize=False)
            self._link: Any = ui.input("link").classes("w-full").props("readonly outlined dense")
            self._said: Any = ui.label().classes("mistake").props('role="alert"')
            ui.label(
                "The link contains the whole design. It works wherever this program runs at the same address."
            ).classes("status")
            with ui.row():
                self._copy: Any = ui.button("Copy").props("no-caps")
                ui.button("Close", on_click=self._dialog.close).props("flat no-caps")
        field = json.dumps(f"#{self._link.html_id}")
        # The element with the id `field` is the input field itself, or contains it.
        take = f"document.querySelector({field})"
        self._copy.on(
            "click",
            js_handler=f"""() => {{
                const own = {take}; const field = own.matches('input') ? own : own.querySelector('input');
                field.select(); navigator.clipboard?.writeText(field.value); }}""",
        )

    async def show(self, fragment: str) -> None:
        """Show a link, given its part after "#"."""
        address = await ui.run_javascript("return location.origin + location.pathname;", timeout=10)
        self._show_link(f"{address}#{fragment}", "")

    def refuse(self, sentence: str) -> None:
        """Show the reason why there is no link."""
        self._show_link("", sentence)

    def _show_link(self, link: str, sentence: str) -> None:
        self._link.set_value(link)
        self._said.set_text(sentence)
        self._copy.set_enabled(bool(link))
        self._dialog.open()
