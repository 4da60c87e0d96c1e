"""Published numbers from papers and books, in one TOML file per source, which tests and reports read."""

from __future__ import annotations

from typing import Any

from beamdyn.common.results import published


def load(name: str) -> dict[str, Any]:
    """Read the contents of ``brakes/published/<name>.toml``; see `beamdyn.common.results.published.load`."""
    return published.load(__name__, name)


def available() -> list[str]:
    """List the names that `load` accepts, sorted."""
    return published.available(__name__)
