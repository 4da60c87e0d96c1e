"""Take the pictures of app.md anew, in Chromium: `python docs/draw_screens.py` (extras `app`, `browser`)."""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent))

from benchmarks.app_tasks import SIZE, perform  # noqa: E402
from benchmarks.served import browser, free_port, open_page, start, stop  # noqa: E402

TASKS = ("slope", "clamp", "resonance")
WIDTH = 1080


def first_screen(path: Path) -> None:
    """The first screen of the brakes, as it opens."""
    process = start(port := free_port())
    try:
        with browser() as made:
            open_page(made.new_context(viewport=SIZE), port).screenshot(path=path)
    finally:
        stop(process)


def keep(picture: Path, name: str) -> None:
    """Write a picture smaller, into the folder of the docs."""
    with Image.open(picture) as found:
        height = round(WIDTH * found.height / found.width)
        small = found.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
    small.quantize(256, Image.Quantize.MAXCOVERAGE).save(DOCS / name, optimize=True)


def main() -> None:
    with TemporaryDirectory() as name:
        folder = Path(name)
        first_screen(folder / "first.png")
        keep(folder / "first.png", "app.png")
        for row in perform(folder, TASKS):
            print(*row)
        for task in TASKS:
            keep(folder / f"{task}.png", f"app_{task}.png")


if __name__ == "__main__":
    main()
