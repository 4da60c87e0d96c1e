"""Selection of a few of many, evenly spread: rows of tables, curves of pictures, places of model errors."""

from __future__ import annotations

import numpy as np


def evenly_spread(count: int, most: int) -> np.ndarray:
    """Select at most `most` of `count` indices, evenly spread, with the first and the last; ascending."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
