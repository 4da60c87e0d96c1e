"""Published results, one TOML file for each paper, read by tests, benchmarks and reports."""

from __future__ import annotations

from typing import Any

from beamdyn.common.results import published


def load(name: str) -> dict[str, Any]:
    """Load ``beamdyn/published/<name>.toml``; see `beamdyn.common.results.published.load`."""
    return published.load(__name__, name)


def available() -> list[str]:
    """Return the names that `load` accepts, sorted."""
    return published.available(__name__)
