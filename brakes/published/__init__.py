"""The numbers that papers and books print, one TOML file a source; tests and reports read the same files."""

from __future__ import annotations

from typing import Any

from beamdyn.common.results import published


def load(name: str) -> dict[str, Any]:
    """Contents of ``brakes/published/<name>.toml``; see `beamdyn.common.results.published.load`."""
    return published.load(__name__, name)


def available() -> list[str]:
    """Names that `load` accepts, sorted."""
    return published.available(__name__)
