"""Where results are shown: modules that the packages name, as the core knows none of those above it."""

from __future__ import annotations

SHOWN_BY: dict[str, str] = {}  # module with `VIEWS` by where a class stands, such as "beamdyn.modes"
MEDIA: list[str] = []  # the module that makes texts, data frames and pages of any result
