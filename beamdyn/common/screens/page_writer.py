"""Direct changes of the page during a drag, since NiceGUI would render the whole page at each change."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

_WRITTEN = ("innerHTML", "text", "value", "style", "class", "data-", "aria-")


class PageWriter:
    """Changes elements in the browser directly while the user holds a handle or a slider.

    NiceGUI, the web framework, renders the whole page at each change that it knows of, which takes 10 to 40
    ms for a long form.  Therefore it receives the changes only after the user releases the handle or slider.

    Parameters
    ----------
    held : callable
        Function that returns whether a handle or slider is held.
    """

    def __init__(self, held: Callable[[], bool] = lambda: False) -> None:
        self._held = held
        self._untold: dict[int, Any] = {}
        self._unwritten: dict[int, dict[str, Any]] = {}

    @property
    def is_ahead(self) -> bool:
        """Return whether a handle or slider is held, or NiceGUI has not yet received all changes."""
        return self._held() or bool(self._untold)

    @contextmanager
    def writing(self, *elements: Any) -> Iterator[None]:
        """In this context, write changes of elements directly into the page.

        Changes of text, content, style, classes, attributes and field texts are written; changes of other
        properties are not.
        """
        # An element whose `update` is already replaced belongs to an outer context, which writes its changes.
        elements = tuple(e for e in elements if "update" not in vars(e))
        if not elements or not self.is_ahead:
            yield
            return
        before = {element: _written(element) for element in elements}
        for element in elements:
            element.update = partial(self.tell_later, element)
            element.run_method = _do_nothing  # text fields call it to update the page
        try:
            yield
        finally:
            for element in elements:
                del element.update, element.run_method
        for element, was in before.items():
            now = _written(element).items()
            self.write(element, {name: value for name, value in now if was.get(name) != value})
        if not self._held():
            self.synchronize()

    def tell_later(self, element: Any) -> None:
        """Report a changed element to NiceGUI once no handle or slider is held."""
        self._untold[element.id] = element

    def synchronize(self) -> None:
        """Report all changes to NiceGUI."""
        untold, self._untold = self._untold, {}
        for element in untold.values():
            element.update()

    def write(self, element: Any, changed: dict[str, Any]) -> None:
        """Collect changes of an element, which are sent to the browser in one message."""
        if changed and not self._unwritten:
            asyncio.get_running_loop().call_soon(self._send, element.client)
        if changed:
            self._unwritten.setdefault(element.id, {}).update(changed)

    def _send(self, client: Any) -> None:
        unwritten, self._unwritten = self._unwritten, {}
        client.run_javascript(f"writeChanges({json.dumps(unwritten)})")


def toggle(element: Any, name: str, on: bool) -> None:
    """Add a CSS class to an element, or remove it."""
    element.classes(add=name if on else "", remove="" if on else name)


def _do_nothing(*_: Any, **__: Any) -> None:
    pass


def _written(element: Any) -> dict[str, Any]:
    """Return the properties of an element that can be written into the page."""
    style = ";".join(f"{name}:{value}" for name, value in element.style.items())
    text, classes = getattr(element, "text", None), " ".join(element.classes)
    known = {**element.props, "style": style, "class": classes, "text": text}
    return {name: value for name, value in known.items() if name.startswith(_WRITTEN) and value is not None}
