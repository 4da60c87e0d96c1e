"""Registry of the modules that show results: results cannot import them, as these modules import results."""

from __future__ import annotations

SHOWN_BY: dict[str, str] = {}  # by package of results: the module whose `VIEWS` say how to show them
MEDIA: list[str] = []  # its last entry names the module that makes texts, data frames and HTML of any result
