"""What the browser keeps for a page: the designs of a tab, what is being typed, named designs, the look.

The entries of a tab are stored by the program after each change, and each key stroke by the page itself: what
has been typed when the program or the tab ends is there again afterwards.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from beamdyn.common.app.form_entries import Entries
from beamdyn.common.app.reading import read_entry, unit_of, usual_unit
from beamdyn.common.edge.inputs import Input

_LONGEST = 80  # characters of a name
_MOST = 100  # named designs

# Width of a page below which drawings have narrow paper, as the rules of `look` have it.
_NARROW = "(max-width: 600px)"
# A key stroke in a field is kept until the program has stored it; a link that is put into the address of an
# open page is followed; the keys of undo and redo wait until what has been typed is on its way; a page that
# becomes narrow or wide says so.
SCRIPT = """<script type="module">
const typedKey = %(typed)s;
document.addEventListener("input", (event) => {
  const field = event.target.closest?.("[data-path]"), screen = event.target.closest?.("[data-document]");
  if (!field || !screen || event.target.value === undefined) return;
  const typed = JSON.parse(sessionStorage.getItem(typedKey) || "{}");
  (typed[screen.dataset.document] ??= {})[field.dataset.path] = event.target.value;
  sessionStorage.setItem(typedKey, JSON.stringify(typed));
});
matchMedia(%(narrow)s).addEventListener("change", (event) => emitEvent("narrow", event.matches));
window.addEventListener("hashchange", () => { if (location.hash.length > 1) location.reload(); });
document.addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.closest?.(".q-dialog")) return;
  const key = event.key.toLowerCase();
  const way = key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : "";
  if (!way) return;
  event.preventDefault();
  setTimeout(() => emitEvent(way), 150);
});
</script>"""


class BrowserMemory:
    """The scripts that store and read what belongs to a program.

    Parameters
    ----------
    program : str
        Its name.
    """

    def __init__(self, program: str) -> None:
        self._page, self._typed, self._designs, self._look = (
            json.dumps(f"{program}-{what}") for what in ("page", "typed", "designs", "look")
        )

    @property
    def script(self) -> str:
        """What the page runs on its own."""
        return SCRIPT % {"typed": self._typed, "narrow": json.dumps(_NARROW)}

    @property
    def recall(self) -> str:
        """Return as JSON what was stored, the look, the link in the address (taken from it), the width."""
        return (
            f"const kept = JSON.parse(sessionStorage.getItem({self._page}) || '{{}}');"
            f"kept.typed = JSON.parse(sessionStorage.getItem({self._typed}) || '{{}}');"
            f"kept.look = localStorage.getItem({self._look}); kept.link = location.hash;"
            f"kept.narrow = matchMedia({json.dumps(_NARROW)}).matches;"
            "if (location.hash) history.replaceState(null, '', location.pathname);"
            "return JSON.stringify(kept);"
        )

    def remember(self, stored: Mapping[str, Any], heard: Mapping[str, Mapping[str, str]]) -> str:
        """Store what is on the page; what was heard, by document and path, is kept as typed no longer."""
        return (
            f"sessionStorage.setItem({self._page}, {json.dumps(json.dumps(stored))});"
            f"const typed = JSON.parse(sessionStorage.getItem({self._typed}) || '{{}}');"
            f"for (const [document, fields] of Object.entries({json.dumps(heard)}))"
            " for (const [path, text] of Object.entries(fields))"
            " if (typed[document]?.[path] === text) delete typed[document][path];"
            f"sessionStorage.setItem({self._typed}, JSON.stringify(typed));"
        )

    @property
    def forget_typed(self) -> str:
        """Forget what was typed, when another design is shown."""
        return f"sessionStorage.removeItem({self._typed});"

    def keep_look(self, look: str) -> str:
        """Store whether the page is light or dark."""
        return f"localStorage.setItem({self._look}, {json.dumps(look)});"

    @property
    def designs(self) -> str:
        """Return the named designs, as JSON."""
        return f"return localStorage.getItem({self._designs});"

    def keep_design(self, name: str, document: str, entries: Mapping[str, str]) -> str:
        """Store a named design; return why not, if the browser has no room for it."""
        return self._with_designs(f"all[{json.dumps(name)}] = {json.dumps([document, dict(entries)])};")

    def drop_design(self, name: str) -> str:
        """Forget a named design."""
        return self._with_designs(f"delete all[{json.dumps(name)}];")

    def _with_designs(self, change: str) -> str:
        return (
            f"const all = JSON.parse(localStorage.getItem({self._designs}) || '{{}}'); {change}"
            f"try {{ localStorage.setItem({self._designs}, JSON.stringify(all)); return ''; }}"
            "catch (error) { return 'the browser has no room for it: delete another design'; }"
        )


def named_designs(stored: str | None) -> dict[str, tuple[str, Entries]]:
    """Document and entries by name, of what the browser has stored; what has another form is left out."""
    try:
        held = json.loads(stored or "{}")
    except ValueError:
        return {}
    found = {}
    for name, design in held.items() if isinstance(held, dict) else ():
        match design:
            case [str(document), dict(entries)] if all(isinstance(text, str) for text in entries.values()):
                found[name[:_LONGEST]] = document, entries
    return dict([*found.items()][:_MOST])


def refused_name(name: str, present: Mapping[str, object]) -> str:
    """Why a design cannot be kept under a name; empty if it can."""
    if not name.strip():
        return "give the design a name"
    if len(name) > _LONGEST:
        return f"give a name of at most {_LONGEST} characters"
    if len(present) >= _MOST and name not in present:
        return f"there are {_MOST} designs already: delete one"
    return ""


def read_typed(typed: Any, entries: Entries, inputs: list[Input]) -> Entries:
    """Entries with what was typed but not yet stored, read as the form reads it."""
    known = {entry.path: entry for entry in inputs}
    found = dict(entries)
    for path, text in typed.items() if isinstance(typed, dict) else ():
        if path in known and isinstance(text, str):
            unit = unit_of(entries.get(path, ""), known[path]) or usual_unit(known[path])
            found[path] = read_entry(text, known[path], unit).text
    return found
