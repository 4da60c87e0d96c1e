"""docs/peers.md has two parts, each written by a command that leaves the other part as it is."""

from __future__ import annotations

from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "peers.md"
HEADING = "## Two directions of bending, twist, shear and rotary inertia\n"


def write_measurements(text: str, path: Path = PAGE) -> None:
    """Replace all that stands before the section on physics."""
    _, heading, section = path.read_text(encoding="utf-8").partition(HEADING)
    path.write_text(f"{text.rstrip()}\n\n{heading}{section}".rstrip() + "\n", encoding="utf-8")


def write_section(section: str, path: Path = PAGE) -> None:
    """Replace the section on physics, which begins with the heading."""
    measurements, _, _ = path.read_text(encoding="utf-8").partition(HEADING)
    path.write_text(f"{measurements.rstrip()}\n\n{section}", encoding="utf-8")
