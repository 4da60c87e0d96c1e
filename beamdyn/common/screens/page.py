"""The page of an interactive program, one per client: its screens, files, designs, undo and redo."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from typing import Any

from nicegui import run, ui

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.browser_memory import LinkedDesign, call, named_designs, read_typed, refused_name
from beamdyn.common.screens.computations import FileMaking
from beamdyn.common.screens.dialogs import DesignsDialog, FileDialog, LinkDialog
from beamdyn.common.screens.examples import examples_of
from beamdyn.common.screens.form_entries import Entries
from beamdyn.common.screens.header import BLUE, RED, STYLE, Header, scripts_of
from beamdyn.common.screens.open_document import OpenDocument, OtherDesign
from beamdyn.common.screens.processes import RunsTasks
from beamdyn.common.screens.screen_view import ScreenView
from beamdyn.common.screens.screens import Document, Program, Screen

_CONNECTS = 10.0  # time after which a page whose browser has not connected is dropped [s]
_ANSWERS = 60.0  # time within which a browser must tell what it has stored [s]


def add_style_and_scripts(program: Program) -> None:
    """Add a program's style and scripts to every page of the process."""
    ui.add_css(STYLE, shared=True)
    ui.add_body_html(scripts_of(program.name), shared=True)


async def open_page(program: Program, solver: RunsTasks) -> None:
    """Make the page of a client when it connects: a client that never connects costs next to nothing.

    What the browser has stored is asked for first, so that nobody types into a form that is yet to change.
    """
    await ui.context.client.connected(timeout=_CONNECTS)
    try:
        stored = await ui.run_javascript(call("recallPage"), timeout=_ANSWERS)
    except TimeoutError:
        stored = None
    Page(program, solver).recall(json.loads(stored or "{}"))


class Page:
    """The page of one client; nothing in it is shared with another.

    Parameters
    ----------
    program : Program
        The program that the page belongs to.
    solver : RunsTasks
        Solver that makes the answers.
    """

    def __init__(self, program: Program, solver: RunsTasks) -> None:
        self.program, self.solver = program, solver
        self.works = {document.name: OpenDocument(document) for document in program.documents}
        self.panels: dict[str, ScreenView] = {}
        self.places: dict[str, tuple[Document, Screen]] = {
            screen.name: (document, screen) for document in program.documents for screen in document.screens
        }
        self._recalled = False  # until stored data are restored nothing is stored, as it would replace them
        ui.colors(primary=BLUE, secondary="#444444", negative=RED)
        files = {
            "Open a file": lambda: self._file.ask(),
            "Save as TOML": self.save,
            "Report as HTML": self.report,
            "Link to this design": self.link,
            "Back to the base case": self.reset,
        }
        self.header = Header(program.title, [*self.places], self._turned, files, self)
        self._bar = self.header.tabs
        first = next(iter(self.places))
        with ui.tab_panels(self._bar, value=first).classes("w-full").props("animated=false"):
            for name, (document, screen) in self.places.items():
                with ui.tab_panel(name) as panel:
                    panel.props["data-document"] = document.name
                    self.panels[name] = ScreenView(
                        self.works[document.name], screen, self._edited, self.open, solver
                    )
        self._making = FileMaking()
        self._designs = DesignsDialog(self._keep, self._open_design, self._compare, self._drop)
        self._link, self._file = LinkDialog(), FileDialog(self.open)
        self._entered()
        ui.on("undo", self.undo)
        ui.on("redo", self.redo)
        ui.on("typed", lambda event: self._run(f"heard({int(event.args)})"))
        ui.on("narrow", lambda event: self._be_narrow(event.args is True))
        self._bar.client.on_delete(lambda: [each.close() for each in (self._making, *self.panels.values())])

    def _run(self, script: str) -> None:
        """Run a script in the page's own client, since the element whose event is handled may be gone."""
        self._bar.client.run_javascript(script)

    @property
    def front(self) -> str:
        """Name of the screen in front: the one that the page shows."""
        return str(self._bar.value)

    @property
    def current(self) -> tuple[Document, Screen]:
        """The document and screen in front."""
        return self.places[self.front]

    @property
    def work(self) -> OpenDocument:
        """The open document in front."""
        return self.works[self.current[0].name]

    def _turned(self) -> None:
        """Show the screen that was chosen, from its top."""
        self._entered()
        self._remember()
        ui.run_javascript("window.scrollTo(0, 0)")

    def _entered(self) -> None:
        self.panels[self.front].enter()
        self._mark()
        if self.work.wants_other(self.current[1]):
            self.panels[self.front].comparison.solve()

    def _edited(self) -> None:
        """Update which screens are stale, the history and the stored data, after a change of entries."""
        for panel in self.panels.values():
            panel.state()
        if not any(panel.dragged for panel in self.panels.values()):  # a whole drag counts as one step
            for work in self.works.values():
                work.history.record(work.entries)
        self._mark()
        self._remember()

    def _mark(self) -> None:
        stale = {name for name, (d, screen) in self.places.items() if self.works[d.name].outdated(screen)}
        self.header.mark(stale, self.work.history, self.work.other)

    def _bring(self, document: Document) -> None:
        """Bring to the front a document whose design has been replaced."""
        if self.current[0] is not document:
            self._bar.set_value(document.screens[0].name)
        self._rebuild(document)

    def _rebuild(self, document: Document) -> None:
        if self.current[0] is document:  # other screens are updated when they come to the front
            self.panels[self.front].rebuild()
        if self._recalled:
            self._run(call("forgetTyped"))
        self.panels[self.front].enter()
        self._edited()

    # Undo and redo ----------------------------------------------------------------------------------

    def undo(self) -> None:
        """Undo the last change of the design in front."""
        self._go(-1)

    def redo(self) -> None:
        """Redo the change that was undone last."""
        self._go(1)

    def _go(self, steps: int) -> None:
        if self.work.go(steps):
            self._run(call("forgetTyped"))
            self.panels[self.front].enter()
            self._edited()

    # Files ------------------------------------------------------------------------------------------

    def open(self, text: str, name: str) -> None:
        """Open the text of a file as the first document that accepts it, or show the parser's message.

        The document in front is tried first.
        """
        front = self.current[0]
        accepting = (each for each in (front, *self.program.documents) if each.accepts(text))
        document = next(accepting, front)
        try:
            self.works[document.name].open(text, name)
        except ConfigError as error:
            return self._file.refuse(str(error))
        self._bring(document)
        self._file.close()
        ui.notify(f"{name} is open")

    def save(self) -> None:
        """Download the design in front as TOML."""
        ui.download.content(self.work.file().encode(), f"{self.work.document.name}.toml")

    def report(self) -> None:
        """Download the HTML report on the document in front, when all its screens have been solved."""
        document = self.current[0]
        self._making.want(f"{document.name}.html", lambda: asyncio.ensure_future(self._report_on(document)))

    async def _report_on(self, document: Document) -> str:
        sweeps = []
        for screen in document.screens:
            self.panels[screen.name].enter()
            await self.panels[screen.name].settled()
        for screen in document.screens:
            sweep = self.panels[screen.name].sweep
            if sweep is not None and (shown := sweep.report()):
                sweeps.append((screen.name, *shown))
        self._mark()
        work = self.works[document.name]
        title = work.entries.get("title", "").strip() or f"{self.program.title}: {document.name}"
        given = dict(work.entries), dict(work.answered), title, sweeps
        return await self.solver.submit(page_tasks.report, document, document.screens[0], *given)

    def reset(self) -> None:
        """Return to the base design of the document in front."""
        document = self.current[0]
        self.work.open(document.base, document.name)
        self._rebuild(document)

    async def link(self) -> None:
        """Show a link to the design in front; a design with mistakes has none."""
        work = self.work
        try:
            work.document.opened(work.text(), "this design")
            options = {path: work.entries[path] for path in work.document.aside}
            fragment = LinkedDesign(work.document.name, work.text(), options).as_fragment()
        except ConfigError as error:
            return self._link.refuse(str(error))
        await self._link.show(fragment)

    # Designs ----------------------------------------------------------------------------------------

    async def designs(self) -> None:
        """Show the named designs of this browser, and the examples."""
        stored = await ui.run_javascript(call("namedDesigns"), timeout=_ANSWERS)
        kept = {name: found for name, found in named_designs(stored).items() if found[0] in self.works}
        self._kept = kept
        examples = await run.io_bound(examples_of, self.program) or ()
        self._designs.show(kept, examples, self.current[0])

    async def _keep(self, name: str) -> str:
        sentence = refused_name(name, self._kept)
        if not sentence:
            made = call("putDesign", name.strip(), [self.work.document.name, self.work.entries])
            sentence = str(await ui.run_javascript(made, timeout=_ANSWERS))
        if not sentence:
            await self.designs()
        return sentence

    async def _drop(self, name: str) -> None:
        await ui.run_javascript(call("putDesign", name), timeout=_ANSWERS)
        await self.designs()

    def _open_design(self, name: str, kind: str, entries: Entries) -> None:
        work = self.works[kind]
        work.show(work.document.base_entries | dict.fromkeys(work.entries, "") | entries)
        self._bring(work.document)
        ui.notify(f"{name} is open")

    def _compare(self, name: str, kind: str, entries: Entries) -> None:
        self.works[kind].compare(OtherDesign(name, entries))
        self._entered()

    def stop_comparing(self) -> None:
        """Stop comparing the design in front with another."""
        self.work.compare(None)
        for screen in self.current[0].screens:
            self.panels[screen.name].show()
        self._mark()

    # Over a reload, or a restart of the program -----------------------------------------------------

    def _remember(self, heard: Mapping[str, Mapping[str, str]] | None = None) -> None:
        """Store the entries and the name of the screen in front in this tab of the browser."""
        if not self._recalled:
            return
        designs = {name: work.entries for name, work in self.works.items()}
        if heard is None:
            heard = {self.current[0].name: self.panels[self.front].form.typed}
        self._run(call("rememberPage", {"front": self.front, "designs": designs}, heard))

    def recall(self, stored: Mapping[str, Any]) -> None:
        """Restore what the browser stored, and store every change from now on.

        A form that shows its design already is left alone.
        """
        self.header.show_look(stored.get("look") or "")
        self._be_narrow(stored.get("narrow") is True)
        typed, designs = stored.get("typed", {}), stored.get("designs", {})
        for name, work in self.works.items():  # unfinished input is restored before any design is stored
            entries = designs.get(name, work.document.base_entries)
            if work.recall(read_typed(typed.get(name), entries, work.document.inputs(entries))):
                self._rebuild(work.document)
        if stored.get("front") in self.places:
            self._bar.set_value(stored["front"])
        if stored.get("link"):
            self._follow(str(stored["link"]))
        self._recalled = True
        self._remember(stored.get("typed"))

    def _be_narrow(self, narrow: bool) -> None:
        for panel in self.panels.values():
            panel.be_narrow(narrow)

    def _follow(self, fragment: str) -> None:
        """Open the design in a link, checked like a file."""
        try:
            design = LinkedDesign.of_fragment(fragment)
            work = self.works.get(design.document)
            if work is None:
                raise ConfigError("the link", [f"{self.program.name} has no {design.document[:40]}"])
            work.open(design.text, "the link")
        except ConfigError as error:
            return self._file.refuse(str(error))
        for path in work.document.aside:
            work.put(path, design.options.get(path, work.entries[path]))
        self._bring(work.document)

    def keep_look(self, look: str) -> None:
        """Store whether the page is light or dark."""
        self._run(call("keepLook", look))
