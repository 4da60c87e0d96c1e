"""The validation manual, written when the site is built without it; ``docs/build.py -E`` renews it."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

INDEX = Path(__file__).parents[1] / "validation" / "index.md"
FOLDER = INDEX.parent / "generated"


def write(app) -> None:
    wanted = re.findall(r"^generated/(\w+)$", INDEX.read_text(encoding="utf-8"), re.MULTILINE)
    if not all((FOLDER / f"{name}.md").exists() for name in wanted):
        from beamdyn import OutsideLinearTheory
        from benchmarks.validation_manual import write_pages

        with warnings.catch_warnings():  # where the papers leave linear theory, so does this
            warnings.simplefilter("ignore", OutsideLinearTheory)
            write_pages(FOLDER)


def setup(app) -> dict[str, bool]:
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
