"""Files of the repository outside docs/ as pages of the site, and links to them.

A page listed here stands in docs/ as a sentence with a link, for who reads the repository; on the site it
has the file's contents.
"""

from __future__ import annotations

import re
from os.path import relpath
from pathlib import Path

DOCS = Path(__file__).parents[1]
ROOT = DOCS.parent
FILES = {  # page of the site: file of the repository
    "contributing": "CONTRIBUTING.md",
    "changelog": "CHANGELOG.md",
    "benchmarks": "benchmarks/README.md",
    "peers_install": "benchmarks/peers/README.md",
}
PAGES = {ROOT / file: DOCS / f"{page}.md" for page, file in FILES.items()} | {
    ROOT / "examples": DOCS / "examples.md",
    ROOT / "README.md": DOCS / "index.md",
}
LINK = re.compile(r"(\]\()([^)#\s:]+)(#[^)\s]*)?(?=\))")


def move_links(text: str, file: Path, page: Path) -> str:
    """Links of a file in Markdown, seen from a page of the site: to pages where there are, else to files."""

    def moved(match: re.Match[str]) -> str:
        target = (file.parent / match[2]).resolve()
        target = PAGES.get(target, target)
        if not target.exists():
            return match[0]  # the build names it
        return match[1] + relpath(target, page.parent) + (match[3] or "")

    return LINK.sub(moved, text)


def read(app, docname: str, source: list[str]) -> None:
    page = Path(app.env.doc2path(docname))
    if page.suffix != ".md":
        return
    file = page
    if docname in FILES:
        file = ROOT / FILES[docname]
        app.env.note_dependency(str(file))
        source[0] = file.read_text(encoding="utf-8")
    source[0] = move_links(source[0], file, page)


def setup(app) -> dict[str, bool]:
    app.connect("source-read", read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
