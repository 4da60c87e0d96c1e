"""Registry of the modules that show results: results cannot import them, as these modules import results."""

from __future__ import annotations

SHOWN_BY: dict[str, str] = {}  # the module with `VIEWS` for each package of results
MEDIA: list[str] = []  # its last entry names the module that makes texts, data frames and HTML of any result
