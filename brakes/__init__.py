"""Statics of brake mechanisms."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from beamdyn.common.results.shown_by import SHOWN_BY

if TYPE_CHECKING:
    from brakes.common.finding import find, find_whole
    from brakes.common.solutions import Solutions, WholeSolutions

__all__ = ["Solutions", "WholeSolutions", "find", "find_whole"]

SHOWN_BY["brakes"] = "brakes.views"
_MODULES = {each: "solutions" if each.endswith("Solutions") else "finding" for each in __all__}


def __getattr__(name: str) -> Any:
    """Import a public name only when it is first used, so that commands start fast."""
    if name not in _MODULES:
        raise AttributeError(f"module 'brakes' has no attribute {name!r}")
    return getattr(import_module(f"brakes.common.{_MODULES[name]}"), name)
