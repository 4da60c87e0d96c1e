"""The gallery's examples, run again when the site is built and the code that they ran has changed.

Sphinx-Gallery alone runs an example again when its own text has changed.
"""

from __future__ import annotations

import json
from pathlib import Path

from validation_pages import ROOT, data, hashes, modules

FOLDER = Path(__file__).parents[1] / "gallery"
RECORD = FOLDER / "sources.json"


def scenes() -> set[str]:
    """Files that examples read."""
    found = (path for kind in ("*.toml", "*.csv") for path in (ROOT / "examples").rglob(kind))
    return {path.relative_to(ROOT).as_posix() for path in found}


def recorded() -> dict[str, str]:
    """What the examples ran and read when they were run; nothing if that is not known."""
    return json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}


def forget(app) -> None:
    """Before the examples: let all be run unless code and data are those of their pictures."""
    known = recorded()
    if known and hashes(known) == known:
        return
    RECORD.unlink(missing_ok=True)  # until all have run
    for done in FOLDER.rglob("*.py.md5"):
        done.unlink()


def note(app) -> None:
    """After the examples: what they ran, and what those ran that were not run again."""
    FOLDER.mkdir(exist_ok=True)
    sources = modules() | data() | scenes() | recorded().keys()
    RECORD.write_text(json.dumps(hashes(sources), indent=1), encoding="utf-8")


def setup(app) -> dict[str, bool]:
    app.connect("builder-inited", forget, priority=400)  # the examples run at 500
    app.connect("builder-inited", note)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
