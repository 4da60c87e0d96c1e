"""Direct changes of the page during a drag, since NiceGUI would render the whole page for each."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

_WRITTEN = ("innerHTML", "text", "value", "style", "class", "data-", "aria-")


class PageWriter:
    """A writer that changes elements of the page directly while a point or a slider is held.

    NiceGUI renders the page as a whole for each change that it is told: 10 to 40 ms where the form is long.
    It is told of what has been written when nothing is held any longer.

    Parameters
    ----------
    held : callable
        Returns whether a point or a slider is held.
    """

    def __init__(self, held: Callable[[], bool] = lambda: False) -> None:
        self._held = held
        self._untold: dict[int, Any] = {}
        self._unwritten: dict[int, dict[str, Any]] = {}

    @property
    def is_ahead(self) -> bool:
        """Whether something is held, or NiceGUI has not yet been told all that was written."""
        return self._held() or bool(self._untold)

    @contextmanager
    def writing(self, *elements: Any) -> Iterator[None]:
        """Write changes of elements, made within this context, directly into the page.

        Text, content, style, classes and attributes are written, and the text of a field, but no other
        property of a component.
        """
        elements = tuple(e for e in elements if "update" not in vars(e))  # others are written further out
        if not elements or not self.is_ahead:
            yield
            return
        before = {element: _written(element) for element in elements}
        for element in elements:
            element.update = partial(self.tell_later, element)
            element.run_method = _do_nothing  # without this, a field would ask the page for an update
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
        """Tell NiceGUI of a changed element once nothing is held."""
        self._untold[element.id] = element

    def synchronize(self) -> None:
        """Tell NiceGUI all that has been written."""
        untold, self._untold = self._untold, {}
        for element in untold.values():
            element.update()

    def write(self, element: Any, changed: dict[str, Any]) -> None:
        """Collect changes of an element; all that come before the next message are sent in it."""
        if changed and not self._unwritten:
            asyncio.get_running_loop().call_soon(self._send, element.client)
        if changed:
            self._unwritten.setdefault(element.id, {}).update(changed)

    def _send(self, client: Any) -> None:
        unwritten, self._unwritten = self._unwritten, {}
        client.run_javascript(f"writeChanges({json.dumps(unwritten)})")


def toggle(element: Any, name: str, on: bool) -> None:
    """Add a class to an element, or remove it."""
    element.classes(add=name if on else "", remove="" if on else name)


def _do_nothing(*_: Any, **__: Any) -> None:
    pass


def _written(element: Any) -> dict[str, Any]:
    """Return the properties of an element that can be written into the page."""
    style = ";".join(f"{name}:{value}" for name, value in element.style.items())
    text, classes = getattr(element, "text", None), " ".join(element.classes)
    known = {**element.props, "style": style, "class": classes, "text": text}
    return {name: value for name, value in known.items() if name.startswith(_WRITTEN) and value is not None}
