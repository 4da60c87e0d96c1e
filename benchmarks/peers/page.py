"""The sections of docs/peers.md, each written by one command that leaves the others unchanged."""

from __future__ import annotations

from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "peers.md"
HEADING = "## Two directions of bending, twist, shear and rotary inertia\n"
LARGE_DEFLECTION = "## Large deflection\n"
IN_SPACE = "## Beams in space\n"
PIEZO = "## Piezoelectric layers\n"
HEADINGS = (HEADING, LARGE_DEFLECTION, IN_SPACE, PIEZO)  # headings of sections, in their order on the page


def write_measurements(text: str, path: Path = PAGE) -> None:
    """Replace all text of the page before the first section."""
    _, sections = _split(path.read_text(encoding="utf-8"))
    _write(path, text, sections)


def write_section(section: str, path: Path = PAGE) -> None:
    """Replace the section with the same heading, or insert it in the order of `HEADINGS`."""
    measurements, sections = _split(path.read_text(encoding="utf-8"))
    (heading,) = (heading for heading in HEADINGS if section.startswith(heading))
    _write(path, measurements, sections | {heading: section})


def _split(text: str) -> tuple[str, dict[str, str]]:
    """Split a page into the text before the sections, and the sections by their heading."""
    sections: dict[str, str] = {}
    for heading in reversed(HEADINGS):
        text, found, body = text.partition(heading)
        if found:
            sections[heading] = heading + body
    return text, sections


def _write(path: Path, measurements: str, sections: dict[str, str]) -> None:
    parts = (measurements, *(sections[heading] for heading in HEADINGS if heading in sections))
    path.write_text("\n\n".join(part.rstrip() for part in parts) + "\n", encoding="utf-8")
