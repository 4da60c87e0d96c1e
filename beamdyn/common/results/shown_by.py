"""Registry of the modules that show results, as results cannot import the modules above them."""

from __future__ import annotations

SHOWN_BY: dict[str, str] = {}  # module with `VIEWS` by package of a result's class, such as "beamdyn.modes"
MEDIA: list[str] = []  # the module that makes texts, data frames and pages of any result
