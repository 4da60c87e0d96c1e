"""Arithmetic of 60 digits on arrays: whole numbers, in units of 2^-200.

Python multiplies them some fifty times faster than the numbers of mpmath, and numpy sums their products
without rounding; one shift then brings a product back to the unit.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from mpmath import mp, mpf

BITS = 200
DIGITS = 60
ONE = 1 << BITS


def fixed(values: Iterable[mpf | float]) -> np.ndarray:
    """Convert numbers to multiples of 2^-200, shape (n,)."""
    return np.array([int(mp.floor(mp.ldexp(mpf(v), BITS))) for v in values], dtype=object)


def to_mpf(value: int) -> mpf:
    return mp.ldexp(mpf(value), -BITS)


def to_float(values: np.ndarray) -> np.ndarray:
    """Convert an array of any shape to double precision."""
    flat = [int(v) / ONE for v in np.ravel(values)]
    return np.array(flat).reshape(np.shape(values))


def from_float(values: np.ndarray) -> np.ndarray:
    """Convert a real array of any shape, exactly to the unit."""
    flat = [int(mp.ldexp(mpf(float(v)), BITS)) for v in np.ravel(values)]
    return np.array(flat, dtype=object).reshape(np.shape(values))


def times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Multiply element by element."""
    return (a * b) >> BITS


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Multiply matrices, or a matrix and a vector."""
    return np.asarray(a @ b) >> BITS
