"""``docs/bounds.md`` in a docstring, which names a page of the repository, is a link to it on the site."""

from __future__ import annotations

import re

PAGE = re.compile(r"(?<![`/\w])docs/(\w+)\.md")


def link(app, what, name, obj, options, lines: list[str]) -> None:
    lines[:] = [PAGE.sub(r":doc:`\1 </\1>`", line) for line in lines]


def setup(app) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", link, priority=900)  # after numpydoc
    return {"parallel_read_safe": True, "parallel_write_safe": True}
