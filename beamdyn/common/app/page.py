"""The page of an interactive program, one per client: tabs, opening and saving files, HTML report."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from nicegui import ui

from beamdyn.common.app.document_report import report_of
from beamdyn.common.app.draggable_drawing import STYLE as BOARD
from beamdyn.common.app.open_document import OpenDocument
from beamdyn.common.app.screen_view import ScreenView
from beamdyn.common.app.screens import Document, Program, Screen
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.rendering import STYLE

_LARGEST = 200_000  # bytes of a file that is opened
_ANSWERS = 60.0  # how long a browser may take to say what it has stored [s]
_TOO_LARGE = f"the file is larger than {_LARGEST} bytes"
_LAYOUT = """
body { font-size: 15px; }
.nicegui-header { padding: 0 0.75rem; }
.nicegui-content { padding: 0.25rem 0.75rem 1rem; }
.q-tab-panel { padding: 0.5rem 0; }
.q-tab-panels, .q-tab-panel, .q-panel { overflow: visible; }
.screen { display: grid; grid-template-columns: minmax(270px, 330px) minmax(0, 1fr); gap: 1rem; width: 100%; }
.left { position: sticky; top: 44px; align-self: start; max-height: calc(100vh - 52px); overflow-y: auto;
  padding: 4px 6px 4px 4px; flex-wrap: nowrap; }
.right { min-width: 0; }
.section { border: 1px solid #c8c8c8; border-radius: 4px; flex: none; }
.section .q-item__label { font-weight: 600; }
.section .nicegui-expansion-content { gap: 0.5rem; padding: 0.5rem 0.75rem 0.75rem; }
.left .nicegui-expansion-content { display: grid;
  grid-template-columns: repeat(auto-fill, minmax(200px, 1fr)); align-items: start; }
.section .q-field__messages { line-height: 1.25; }
.status { font-size: 0.85rem; color: #444; }
.mistake { color: #8c1c00; font-weight: 600; border-left: 4px solid #8c1c00; padding-left: 0.5rem; }
.mistake:empty { display: none; }
.warning { color: #5a4200; border-left: 4px solid #E69F00; padding-left: 0.5rem; }
.greyed { opacity: 0.45; filter: grayscale(1); }
.slider { padding: 0 4.5rem; }
.slider .q-slider__marker-labels { white-space: nowrap; }
.drawing-frame { overflow-x: auto; }
.drawing { max-width: 1000px; min-width: 480px; max-height: 72vh; object-fit: contain;
  object-position: left; }
:focus-visible { outline: 3px solid #0072B2; outline-offset: 1px; }
.q-header :focus-visible { outline-color: white; outline-offset: -3px; }
#popup { top: 0; bottom: auto; left: 0; right: 0; margin: 0; padding: 1rem; border: 0; border-radius: 0;
  background: #8c1c00; color: white; text-align: center; }
body:has(#popup[aria-hidden="false"]) #app { opacity: 0.5; pointer-events: none;
  transition: opacity 0.5s 2s; }
@media (max-width: 1000px) {
  .screen { grid-template-columns: minmax(0, 1fr); }
  .left { position: static; max-height: 42vh; border-bottom: 1px solid #c8c8c8; }
}
"""
# NiceGUI shows its element "popup" while it tries to reach the program; these are other words for it.
_STOPPED = """<script type="module">
const notice = document.getElementById("popup");
notice.setAttribute("role", "alert");
notice.textContent = `The program has stopped. Start "{name} app --port ${{location.port}}" again: `
  + "this page goes on by itself.";
</script>"""


class Page:
    """What one client sees; nothing in it is shared with another.

    Parameters
    ----------
    program : Program
        What it is.
    """

    def __init__(self, program: Program) -> None:
        self.program = program
        self.works = {document.name: OpenDocument(document) for document in program.documents}
        self.panels: dict[str, ScreenView] = {}
        self.places: dict[str, tuple[Document, Screen]] = {
            screen.name: (document, screen) for document in program.documents for screen in document.screens
        }
        self._tabs: dict[str, Any] = {}
        self._recalled = False  # until then nothing is stored: it would replace what is to be restored
        ui.add_css(_LAYOUT + STYLE + BOARD)
        ui.colors(primary="#0072B2", secondary="#444444", negative="#8c1c00")
        ui.add_body_html(_STOPPED.format(name=program.name))
        ui.page_title(program.title)
        self._header()
        self._body()

    def _header(self) -> None:
        first: Any = next(iter(self.places))  # a tab goes by its name
        self._bar: Any
        with ui.header().classes("items-center gap-2 no-wrap q-py-none"):
            with ui.tabs(value=first, on_change=self._turned).props(
                "dense no-caps shrink stretch"
            ) as self._bar:
                for name in self.places:
                    self._tabs[name] = ui.tab(name, label=name)
            ui.space()
            with ui.button("File").props("flat no-caps color=white"), ui.menu().props("auto-close"):
                ui.menu_item("Open a TOML file", self._ask)
                ui.menu_item("Save as TOML", self.save)
                ui.menu_item("Report as HTML", self.report)
                ui.menu_item("Back to the base case", self.reset)

    def _body(self) -> None:
        with (
            ui.tab_panels(self._bar, value=next(iter(self.places))).classes("w-full").props("animated=false")
        ):
            for name, (document, screen) in self.places.items():
                with ui.tab_panel(name):
                    self.panels[name] = ScreenView(self.works[document.name], screen, self._edited)
        with ui.dialog() as self._dialog, ui.card():
            ui.label("Open a TOML file, as the commands read it")
            self._upload: Any = ui.upload(
                label="TOML file", on_upload=self._opened, auto_upload=True, max_file_size=_LARGEST,
                max_files=1,
                on_rejected=lambda: self._refuse(_TOO_LARGE),
            ).props('accept=".toml" aria-label="TOML file"')  # fmt: skip
            self._refused: Any = (
                ui.label().classes("mistake").props('role="alert"').style("white-space: pre-line")
            )
            ui.button("Close", on_click=self._dialog.close).props("flat no-caps")
        self._entered()

    @property
    def front(self) -> str:
        """Name of the screen that is in front."""
        return str(self._bar.value)

    @property
    def current(self) -> tuple[Document, Screen]:
        """The document and screen that are in front."""
        return self.places[self.front]

    def _turned(self) -> None:
        """Another screen has been chosen: scroll to its top."""
        self._entered()
        self._remember()
        ui.run_javascript("window.scrollTo(0, 0)")

    def _entered(self) -> None:
        self.panels[self.front].enter()
        self._marks()

    def _edited(self) -> None:
        """Update which screens are stale after a change."""
        for panel in self.panels.values():
            panel.state()
        self._marks()
        self._remember()

    def _marks(self) -> None:
        for name, (document, screen) in self.places.items():
            stale = self.works[document.name].outdated(screen)
            self._tabs[name].props["label"] = f"{name} (stale)" if stale else name
            self._tabs[name].update()

    def _rebuild(self, document: Document) -> None:
        for screen in document.screens:
            self.panels[screen.name].rebuild()
        self.panels[self.front].enter()
        self._edited()

    # Files ------------------------------------------------------------------------------------------

    def _ask(self) -> None:
        self._refused.set_text("")
        self._upload.reset()
        self._dialog.open()

    async def _opened(self, event: Any) -> None:
        name, content = event.file.name, await event.file.read()
        if len(content) > _LARGEST:  # whatever the browser has let through
            return self._refuse(_TOO_LARGE)
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            return self._refuse(f"{name}: it is not text in UTF-8; give a TOML file")
        self.open(text, name)

    def open(self, text: str, name: str) -> None:
        """Open the text of a file as the document that accepts it, or show the parser's message."""
        document = self._kind_of(text)
        try:
            self.works[document.name].open(text, name)
        except ConfigError as error:
            return self._refuse(str(error))
        self._rebuild(document)
        if self.current[0] is not document:
            self._bar.set_value(document.screens[0].name)
        self._dialog.close()
        ui.notify(f"{name} is open")

    def _kind_of(self, text: str) -> Document:
        """The first document that accepts a text, else the one in front."""
        for document in self.program.documents:
            try:
                document.opened(text, "")
            except ConfigError:
                continue
            return document
        return self.current[0]

    def _refuse(self, sentence: str) -> None:
        self._refused.set_text(sentence)

    def save(self) -> None:
        """Download the design in front as TOML."""
        document = self.current[0]
        ui.download.content(self.works[document.name].text().encode(), f"{document.name}.toml")

    async def report(self) -> None:
        """Download the HTML report on the document in front, when all its screens have been solved."""
        document = self.current[0]
        for screen in document.screens:
            self.panels[screen.name].enter()
            await self.panels[screen.name].settled()
        self._marks()
        work = self.works[document.name]
        title = f"{self.program.title}: {document.name}"
        ui.download.content(report_of(work, title).encode(), f"{document.name}.html")

    def reset(self) -> None:
        """Return to the base design."""
        document = self.current[0]
        self.works[document.name].open(document.base, document.name)
        self._rebuild(document)

    # Over a reload, or a restart of the program -----------------------------------------------------

    @property
    def _key(self) -> str:
        return json.dumps(f"{self.program.name}-page")

    def _remember(self) -> None:
        """Store the entries and the name of the front screen in this tab of the browser."""
        if not self._recalled:
            return
        designs = {name: work.entries for name, work in self.works.items()}
        stored = json.dumps({"front": self.front, "designs": designs})
        # by the page's own client: the field that has changed may be gone, of a form that was made anew
        self._bar.client.run_javascript(f"sessionStorage.setItem({self._key}, {json.dumps(stored)})")

    async def recall(self) -> None:
        """Restore what the browser stored, and store every change from now on."""
        await ui.context.client.connected()
        try:
            stored = await ui.run_javascript(f"return sessionStorage.getItem({self._key})", timeout=_ANSWERS)
        except TimeoutError:
            stored = None
        self._restore(json.loads(stored or "{}"))
        self._recalled = True
        self._remember()

    def _restore(self, stored: Mapping[str, Any]) -> None:
        """Put stored designs into the forms; a form that shows its design already is left alone."""
        for name, entries in stored.get("designs", {}).items():
            if (work := self.works.get(name)) is not None and work.recall(entries):
                self._rebuild(work.document)
        if stored.get("front") in self.places:
            self._bar.set_value(stored["front"])
