"""The numbers that papers print, one TOML file a paper; tests, benchmarks and reports read the same files."""

from __future__ import annotations

from typing import Any

from beamdyn.common import published


def load(name: str) -> dict[str, Any]:
    """Contents of ``beamdyn/published/<name>.toml``; see `beamdyn.common.published.load`."""
    return published.load(__name__, name)


def available() -> list[str]:
    """Names that `load` accepts, sorted."""
    return published.available(__name__)
