"""The dialog that shows a link to the open design, to be copied."""

from __future__ import annotations

import json
from typing import Any

from nicegui import ui


class LinkDialog:
    """A dialog with a link, or with the reason why there is none."""

    def __init__(self) -> None:
        with ui.dialog() as self._dialog, ui.card().classes("designs"):
            ui.html("Link to this design", tag="h2", sanitize=False)
            self._link: Any = ui.input("link").classes("w-full").props("readonly outlined dense")
            self._said: Any = ui.label().classes("mistake").props('role="alert"')
            ui.label(
                "The address holds the whole design. It opens wherever this program runs at the same address."
            ).classes("status")
            with ui.row():
                self._copy: Any = ui.button("Copy").props("no-caps")
                ui.button("Close", on_click=self._dialog.close).props("flat no-caps")
        field = json.dumps(f"#{self._link.html_id}")
        take = f"document.querySelector({field})"  # the field itself: attributes stand there
        self._copy.on(
            "click",
            js_handler=f"""() => {{
                const own = {take}; const field = own.matches('input') ? own : own.querySelector('input');
                field.select(); navigator.clipboard?.writeText(field.value); }}""",
        )

    async def show(self, fragment: str) -> None:
        """Show the link with this part after "#"."""
        address = await ui.run_javascript("return location.origin + location.pathname;", timeout=10)
        self._put(f"{address}#{fragment}", "")

    def refuse(self, sentence: str) -> None:
        """Say why there is no link."""
        self._put("", sentence)

    def _put(self, link: str, sentence: str) -> None:
        self._link.set_value(link)
        self._said.set_text(sentence)
        self._copy.set_enabled(bool(link))
        self._dialog.open()
