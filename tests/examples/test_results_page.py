"""The Python of the page on results runs as it stands, and prints what stands below it."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import matplotlib
import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "results.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```\n+```text\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


def without_errors(text: str) -> str:
    """Estimates of errors that are rounding differ from machine to machine."""
    return re.sub(r"error <= [^,)]+", "error", text)


@pytest.mark.skipif(find_spec("pandas") is None, reason="pandas is not installed")
def test_blocks_print_what_stands_below_them(capsys: pytest.CaptureFixture[str]) -> None:
    matplotlib.use("Agg")
    assert len(BLOCKS) == PAGE.count("```python") == 4
    names: dict[str, object] = {}
    for code, printed in BLOCKS:
        exec(code, names)
        assert without_errors(capsys.readouterr().out) == without_errors(printed)
