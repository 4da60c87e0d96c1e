"""The web page of an interactive program, one per client: screens, files, designs, undo and redo.

This module also contains the style and the scripts of the page, and its header bar.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Collection, Mapping, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from nicegui import run, ui

from beamdyn.common.drawing.svg import page_colours
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.rendering import STYLE as TABLES
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.browser_memory import LinkedDesign, call, named_designs, read_typed, refused_name
from beamdyn.common.screens.chart_options import chart_colours
from beamdyn.common.screens.computations import FileMaking
from beamdyn.common.screens.dialogs import DesignsDialog, FileDialog, LinkDialog
from beamdyn.common.screens.examples import examples_of
from beamdyn.common.screens.form_entries import Entries
from beamdyn.common.screens.open_document import History, OpenDocument, OtherDesign
from beamdyn.common.screens.processes import RunsTasks
from beamdyn.common.screens.screen_view import ScreenView
from beamdyn.common.screens.screens import Document, Program, Screen

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


_CONNECTS = 10.0  # time after which a page is deleted if no browser has connected to it [s]
_ANSWERS = 60.0  # time within which a browser must send the data that it has stored [s]


def add_style_and_scripts(program: Program) -> None:
    """Add the style and scripts of a program to every page of this process."""
    ui.add_css(STYLE, shared=True)
    ui.add_body_html(scripts_of(program.name), shared=True)


async def open_page(program: Program, solver: RunsTasks) -> None:
    """Make the page of a client only when its browser connects, which saves time if it never does.

    Data stored in the browser are restored first, so that no user types into a form that is about to change.
    """
    await ui.context.client.connected(timeout=_CONNECTS)
    try:
        stored = await ui.run_javascript(call("recallPage"), timeout=_ANSWERS)
    except TimeoutError:
        stored = None
    Page(program, solver).recall(json.loads(stored or "{}"))


class Page:
    """The web page of one client; pages share no data.

    Parameters
    ----------
    program : Program
        The program shown on the page.
    solver : RunsTasks
        Object that computes results in worker processes.
    """

    def __init__(self, program: Program, solver: RunsTasks) -> None:
        self.program, self.solver = program, solver
        self.works = {document.name: OpenDocument(document) for document in program.documents}
        self.panels: dict[str, ScreenView] = {}
        self.places: dict[str, tuple[Document, Screen]] = {
            screen.name: (document, screen) for document in program.documents for screen in document.screens
        }
        self._recalled = False  # whether stored data were read; until then, storing would overwrite them
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
        """Run a script on this page, even if the element whose event is handled was removed."""
        self._bar.client.run_javascript(script)

    @property
    def front(self) -> str:
        """Return the name of the screen that the page shows."""
        return str(self._bar.value)

    @property
    def current(self) -> tuple[Document, Screen]:
        """Return the document and the screen that the page shows."""
        return self.places[self.front]

    @property
    def work(self) -> OpenDocument:
        """Return the open document that the page shows."""
        return self.works[self.current[0].name]

    def _turned(self) -> None:
        """Show the screen that the user has chosen, scrolled to its top."""
        self._entered()
        self._remember()
        ui.run_javascript("window.scrollTo(0, 0)")

    def _entered(self) -> None:
        self.panels[self.front].enter()
        self._mark()
        if self.work.wants_other(self.current[1]):
            self.panels[self.front].comparison.solve()

    def _edited(self) -> None:
        """Update outdated screens, history and stored data after a change of field texts."""
        for panel in self.panels.values():
            panel.state()
        if not any(panel.dragged for panel in self.panels.values()):  # a whole drag is one undo step
            for work in self.works.values():
                work.history.record(work.entries)
        self._mark()
        self._remember()

    def _mark(self) -> None:
        stale = {name for name, (d, screen) in self.places.items() if self.works[d.name].outdated(screen)}
        self.header.mark(stale, self.work.history, self.work.other)

    def _bring(self, document: Document) -> None:
        """Show the new design of a kind of file, on its first screen unless one of its screens is shown."""
        if self.current[0] is not document:
            self._bar.set_value(document.screens[0].name)
        self._rebuild(document)

    def _rebuild(self, document: Document) -> None:
        if self.current[0] is document:  # other screens are updated when they are shown
            self.panels[self.front].rebuild()
        if self._recalled:
            self._run(call("forgetTyped"))
        self.panels[self.front].enter()
        self._edited()

    # Undo and redo ----------------------------------------------------------------------------------

    def undo(self) -> None:
        """Undo the last change of the design that is shown."""
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
        """Open the text of a file on the screens of the first `Document` that accepts it, or show the error.

        The screens that are shown are tried first.
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
        """Download the present design in a TOML file."""
        ui.download.content(self.work.file().encode(), f"{self.work.document.name}.toml")

    def report(self) -> None:
        """Download the HTML report on the present design, after all its screens are computed."""
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
        """Return to the initial design of the kind of file that is shown."""
        document = self.current[0]
        self.work.open(document.base, document.name)
        self._rebuild(document)

    async def link(self) -> None:
        """Show a link to the design that is shown; a design with errors has no link."""
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
        """Show the dialog with the named designs of this browser, and the examples."""
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
        """End the comparison of the present design with another design."""
        self.work.compare(None)
        for screen in self.current[0].screens:
            self.panels[screen.name].show()
        self._mark()

    # Restoring after a reload of the page, or a restart of the program ------------------------------

    def _remember(self, heard: Mapping[str, Mapping[str, str]] | None = None) -> None:
        """Store the field texts and the name of the shown screen in this browser tab.

        `heard` has the texts as the user typed them, by name of the document and path of the input; if not
        given, those of the shown screen are stored.
        """
        if not self._recalled:
            return
        designs = {name: work.entries for name, work in self.works.items()}
        if heard is None:
            heard = {self.current[0].name: self.panels[self.front].form.typed}
        self._run(call("rememberPage", {"front": self.front, "designs": designs}, heard))

    def recall(self, stored: Mapping[str, Any]) -> None:
        """Restore the data stored in the browser, and store every change from now on.

        Texts that the user has already changed are kept.  A form is built again only if restoring changed one
        of its texts.
        """
        self.header.show_look(stored.get("look") or "")
        self._be_narrow(stored.get("narrow") is True)
        typed, designs = stored.get("typed", {}), stored.get("designs", {})
        for name, work in self.works.items():  # restore unfinished texts before storing: it would drop them
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
        """Open the design that a link encodes, checked like a file."""
        try:
            design = LinkedDesign.of_fragment(fragment)
            work = self.works.get(design.document)
            if work is None:
                raise ConfigError("the link", [f"{self.program.name} cannot open {design.document[:40]}"])
            work.open(design.text, "the link")
        except ConfigError as error:
            return self._file.refuse(str(error))
        for path in work.document.aside:
            work.put(path, design.options.get(path, work.entries[path]))
        self._bring(work.document)

    def keep_look(self, look: str) -> None:
        """Store whether the page has the light or the dark theme."""
        self._run(call("keepLook", look))
