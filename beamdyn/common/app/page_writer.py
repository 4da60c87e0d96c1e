"""What follows a drag is written into the page at once, past the toolkit that looks through all of it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

# Writes changes of elements, by their numbers, where they are on the page; of their content what differs: for
# new nodes the browser and the toolkit look for style rules.  A field keeps its text itself.
SCRIPT = """<script>
{
  const put = (shown, name, value) => shown.getAttribute(name) === value || shown.setAttribute(name, value);
  const fill = (shown, wanted) => {
    const there = [...shown.childNodes], nodes = [...wanted.childNodes];
    nodes.forEach((node, i) => i < there.length ? become(there[i], node) : shown.append(node));
    there.slice(nodes.length).forEach((node) => node.remove());
  };
  const become = (shown, wanted) => {
    if (shown.nodeName !== wanted.nodeName) return shown.replaceWith(wanted);
    if (!wanted.attributes) return shown.data === wanted.data || (shown.data = wanted.data);
    for (const {name} of [...shown.attributes]) if (!wanted.hasAttribute(name)) shown.removeAttribute(name);
    for (const {name, value} of wanted.attributes) put(shown, name, value);
    fill(shown, wanted);
  };
  const parsed = document.createElement("template");
  window.writeChanges = (changes) => {
    for (const [id, changed] of Object.entries(changes)) {
      const shown = getHtmlElement(id);
      if (shown === null) continue;
      for (const [name, value] of Object.entries(changed)) {
        if (name === "innerHTML") {
          parsed.innerHTML = value;
          fill(shown, parsed.content);
        } else if (name === "text") shown.textContent = value;
        else if (name === "value") {
          Vue.toRaw(getElement(id).$data).inputValue = value;  // for when it is rendered again
          (shown.querySelector("input, textarea") ?? shown).value = value;
        } else if (name === "place") getElement(id).at = value;
        else if (name === "options") {
          getElement(id).chart?.setOption(value, {replaceMerge: ["series"], lazyUpdate: true});
        } else put(shown, name, value);
      }
    }
  };
}
</script>"""
_WRITTEN = ("innerHTML", "text", "value", "style", "class", "data-", "aria-")


class PageWriter:
    """Writes changes of elements into the page at once while a point or a slider is held.

    The toolkit renders a page as a whole, 10 to 40 ms where its form is long, for each change that it is
    told.  It is told of what has been written when nothing is held any longer.

    Parameters
    ----------
    held : callable
        Whether one is.
    """

    def __init__(self, held: Callable[[], bool] = lambda: False) -> None:
        self._held = held
        self._untold: dict[int, Any] = {}
        self._unwritten: dict[int, dict[str, Any]] = {}

    @property
    def is_ahead(self) -> bool:
        """Whether something is held, or there is what the toolkit has not been told."""
        return self._held() or bool(self._untold)

    @contextmanager
    def writing(self, *elements: Any) -> Iterator[None]:
        """Write the changes within of some elements, those of components but for the text of a field."""
        if not self.is_ahead:
            yield
            return
        before = {element: _written(element) for element in elements}
        for element in elements:
            element.update = partial(self.tell_later, element)
            element.run_method = _do_nothing  # by which a field asks for what it has been told
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
        """Tell the toolkit of an element when nothing is held any longer."""
        self._untold[element.id] = element

    def synchronize(self) -> None:
        """Tell the toolkit what has been written."""
        untold, self._untold = self._untold, {}
        for element in untold.values():
            element.update()

    def write(self, element: Any, changed: dict[str, Any]) -> None:
        """Write what has changed of an element, in one message with all else that has by then."""
        if changed and not self._unwritten:
            asyncio.get_running_loop().call_soon(self._send, element.client)
        if changed:
            self._unwritten.setdefault(element.id, {}).update(changed)

    def _send(self, client: Any) -> None:
        unwritten, self._unwritten = self._unwritten, {}
        client.run_javascript(f"writeChanges({json.dumps(unwritten)})")


def _do_nothing(*_: Any, **__: Any) -> None:
    pass


def _written(element: Any) -> dict[str, Any]:
    """What of an element can be written into the page."""
    style = ";".join(f"{name}:{value}" for name, value in element.style.items())
    text, classes = getattr(element, "text", None), " ".join(element.classes)
    known = {**element.props, "style": style, "class": classes, "text": text}
    return {name: value for name, value in known.items() if name.startswith(_WRITTEN) and value is not None}
