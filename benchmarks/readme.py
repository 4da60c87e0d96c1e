"""The tables of README.md that commands write, each between two comments."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"


def write_between(name: str, lines: Sequence[str], path: Path = README) -> None:
    """Replace the lines between ``<!-- NAME -->`` and ``<!-- end of NAME -->``."""
    start, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    before, found, rest = path.read_text(encoding="utf-8").partition(start)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise ValueError(f"{path}: there is no {start} with {end} after it")
    path.write_text("\n".join([before + start, "", *lines, "", end + after]), encoding="utf-8")
