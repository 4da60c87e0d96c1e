"""``|tip|`` in a docstring is an absolute value, no substitution of reStructuredText."""

from __future__ import annotations

import re

BARS = re.compile(r"(?<![`\\|])\|(?=\S)([^|`\n]+?)\|(?!\|)")


def escape(app, what, name, obj, options, lines: list[str]) -> None:
    lines[:] = [BARS.sub(r"\|\1\|", line) for line in lines]


def setup(app) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", escape, priority=900)  # after numpydoc
    return {"parallel_read_safe": True, "parallel_write_safe": True}
