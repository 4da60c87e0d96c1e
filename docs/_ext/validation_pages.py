"""The validation manual, written when the site is built without it; ``docs/build.py -E`` renews it."""

from __future__ import annotations

import warnings
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "validation" / "generated"


def write(app) -> None:
    if not (FOLDER / "overview.md").exists():
        from beamdyn import OutsideLinearTheory
        from benchmarks.validation_manual import write_pages

        with warnings.catch_warnings():  # where the papers leave linear theory, so does this
            warnings.simplefilter("ignore", OutsideLinearTheory)
            write_pages(FOLDER)


def setup(app) -> dict[str, bool]:
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
