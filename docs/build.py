"""Build the site into build/site, offline: ``python docs/build.py`` (extra ``docs``); a warning is an error.

The validation manual is written anew, and the gallery run again, if what they follow from has changed; with
``-E`` everything is.
Then every link and every anchor within the site is followed, and nothing may come from a network.
"""

from __future__ import annotations

import re
import sys
from html import unescape
from pathlib import Path
from posixpath import dirname, join, normpath
from shutil import rmtree
from time import perf_counter
from urllib.parse import unquote, urlsplit

from sphinx.cmd.build import main as sphinx_build

DOCS = Path(__file__).resolve().parent
SITE = DOCS.parent / "build" / "site"
MADE = (SITE, DOCS / "gallery", DOCS / "reference" / "generated", DOCS / "validation" / "generated")
FETCHED = {("script", "src"), ("link", "href"), ("img", "src"), ("iframe", "src"), ("source", "src")}
# Sphinx writes all pages: quotes and brackets within values are escaped.
TAG = re.compile(r"<(\w+)\s([^>]*)>")
ATTRIBUTE = re.compile(r'(?<![\w-])(id|name|href|src)="([^"]*)"')


class Page:
    """Anchors of a page, its links, and what a browser fetches for it."""

    def __init__(self, text: str) -> None:
        self.anchors: set[str] = {""}
        self.links: set[str] = set()
        self.fetched: set[str] = set()
        for tag, attributes in TAG.findall(text):
            for key, value in ATTRIBUTE.findall(attributes):
                if key in ("id", "name"):
                    self.anchors.add(unescape(value))
                else:
                    (self.fetched if (tag, key) in FETCHED else self.links).add(unescape(value))


def find_mistakes(site: Path) -> list[str]:
    """Links to nothing, and files from a network, of all pages of a built site."""
    files = {path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()}
    names = sorted(name for name in files if name.endswith(".html") and not name.startswith("_static/"))
    pages = {name: Page((site / name).read_text(encoding="utf-8")) for name in names}
    found: list[str] = []
    for name, page in pages.items():
        found += [f"{name}: fetches {link}" for link in sorted(page.fetched) if urlsplit(link).netloc]
        links = sorted(page.links | page.fetched)
        found += [f"{name}: {link}" for link in links if is_dead(link, name, files, pages)]
    return found


def is_dead(link: str, name: str, files: set[str], pages: dict[str, Page]) -> bool:
    """Whether a link within the site, on the page of that name, leads nowhere."""
    split = urlsplit(link)
    if split.scheme or split.netloc:
        return False
    target = normpath(join(dirname(name), unquote(split.path))) if split.path else name
    return target not in files or (target in pages and unquote(split.fragment) not in pages[target].anchors)


def main() -> int:
    start = perf_counter()
    if "-E" in sys.argv:
        for made in MADE:
            rmtree(made, ignore_errors=True)
    failed = sphinx_build(["-W", "--keep-going", "-q", "-j", "auto", *sys.argv[1:], str(DOCS), str(SITE)])
    if failed:
        return failed
    mistakes = find_mistakes(SITE)
    print(*mistakes, sep="\n")
    pages = sum(1 for _ in SITE.rglob("*.html"))
    print(f"{SITE}: {pages} pages in {perf_counter() - start:.0f} s, {len(mistakes)} dead links")
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
