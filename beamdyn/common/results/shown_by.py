"""Registry of the modules that show results, as the core does not know the modules above it."""

from __future__ import annotations

SHOWN_BY: dict[str, str] = {}  # module with `VIEWS`, by the room of a result's class, such as "beamdyn.modes"
MEDIA: list[str] = []  # the module that makes texts, data frames and pages of any result
