"""Pages of the built site at two widths, light and dark: pictures, and faults in layout and accessibility.

Run: python -m benchmarks.site_pages [--all] [--folder DIR] [--site build/site]

One page of each kind, or all: pages that scroll sideways, and serious findings of axe-core (where
axe-playwright-python is there).  docs/build.py builds the site.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from benchmarks.rows import Row, show
from benchmarks.screenshots import NO_AXE, SCHEMES, serious_findings
from benchmarks.served import ROOT, browser

SITE = ROOT / "build" / "site"
WIDTHS = (390, 1280)
OF_EACH_KIND = (  # patterns of names: for each, the first matching page is used
    "index.html",
    "tour.html",
    "eight_tasks.html",
    "tutorials/index.html",
    "tutorials/harvester.html",
    "gallery/index.html",
    "gallery/*/*.html",
    "input_files.html",
    "spread.html",
    "conventions.html",
    "architecture.html",
    "explanations/guaranteed_bound.html",
    "reference/index.html",
    "reference/generated/beamdyn.natural_modes.html",
    "reference/generated/beamdyn.Beam.html",
    "_modules/beamdyn/scene/beam.html",
    "validation/generated/overview.html",
    "validation/generated/inward_beam.html",
    "validation/generated/errata.html",
    "peers.html",
    "changelog.html",
    "genindex.html",
    "search.html",
)


def pages_of(site: Path, every: bool) -> list[Path]:
    """Return one page of each kind, or all pages with different titles."""
    if every:
        return sorted(path for path in site.rglob("*.html") if "_static" not in path.parts)
    return [sorted(site.glob(pattern))[0] for pattern in OF_EACH_KIND]


def faults(page: Any, width: int) -> Iterator[str]:
    """Yield the faults of the visible page."""
    wide = page.evaluate("document.documentElement.scrollWidth")
    if wide > width:
        yield f"scrolls to {wide} px"
    found = serious_findings(page)
    yield from [NO_AXE] if found is None else found


def look(paths: Sequence[Path], site: Path, folder: Path) -> Iterator[Row]:
    """Take the pictures, and yield the faults of each page at each width, in light and dark colours."""
    folder.mkdir(parents=True, exist_ok=True)
    with browser() as made:
        for width in WIDTHS:
            context = made.new_context(viewport={"width": width, "height": 900}, has_touch=width < 800)
            page = context.new_page()
            for path in paths:
                yield from _of_page(page, path, path.relative_to(site), width, folder)
            context.close()


def _of_page(page: Any, path: Path, place: Path, width: int, folder: Path) -> Iterator[Row]:
    page.goto(path.as_uri())
    for scheme in SCHEMES:
        page.emulate_media(color_scheme=scheme)
        page.wait_for_timeout(200)  # waits until gradual changes of colour have ended
        name = f"{place.with_suffix('').as_posix().replace('/', '-')}-{width}-{scheme}"
        page.screenshot(path=folder / f"{name}.png")
        yield name, "; ".join(faults(page, width)) or "nothing wrong", "nothing wrong"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--all", action="store_true", help="all pages, not one of each kind")
    parser.add_argument("--folder", type=Path, default=Path("build/site-pictures"))
    parser.add_argument("--site", type=Path, default=SITE)
    given = parser.parse_args()
    site = given.site.resolve()
    paths = pages_of(site, given.all)
    show(f"{len(paths)} pages of {site}", lambda: look(paths, site, given.folder))


if __name__ == "__main__":
    main()
