"""Polynomials on parts of the beam: forces in it, which jump or have a kink at point masses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre


@dataclass(frozen=True)
class PiecewisePolynomials:
    """Polynomials in x/L on each part of the beam.

    Parameters
    ----------
    ends : tuple of float
        Ends of the p parts, from 0 to 1.
    """

    ends: tuple[float, ...]

    def counts(self, number: int) -> list[int]:
        """Numbers of functions on the parts, of so many if there is one; short parts need fewer."""
        return [int(np.ceil(number * length**0.5)) for length in np.diff(self.ends)]

    def __call__(self, xi: np.ndarray, counts: Sequence[int], continuous: bool) -> np.ndarray:
        """Values at xi (N,) of all polynomials: shape (n, N).

        Parameters
        ----------
        xi : ndarray, shape (N,)
            Places within the parts.
        counts : sequence of int
            Number of polynomials on each part; of continuous functions at least those that are linear.
        continuous : bool
            Whether the functions are continuous from part to part, or may jump.
        """
        on_parts = [self._on_part(xi, k, n) for k, n in enumerate(counts)]
        if len(on_parts) == 1:
            return on_parts[0]
        if not continuous:
            return np.concatenate(on_parts)
        bubbles = [P[2:] - P[:-2] for P in on_parts]  # 0 at both ends of their part
        return np.concatenate([self._hats(xi), *bubbles])

    def _on_part(self, xi: np.ndarray, k: int, number: int) -> np.ndarray:
        """Legendre polynomials of part k, 0 elsewhere: shape (number, N)."""
        a, b = self.ends[k : k + 2]
        inside = self._part(xi) == k
        values = np.zeros((number, len(xi)))
        if number:
            values[:, inside] = legendre.legvander(2 * (xi[inside] - a) / (b - a) - 1, number - 1).T
        return values

    def _hats(self, xi: np.ndarray) -> np.ndarray:
        """Functions that are 1 at one end of a part and 0 at all others, linear between: (p + 1, N)."""
        return np.array([np.interp(xi, self.ends, unit) for unit in np.eye(len(self.ends))])

    def _part(self, xi: np.ndarray) -> np.ndarray:
        """Number of the part (N,) in which each xi lies."""
        return np.clip(np.searchsorted(self.ends, xi, side="right") - 1, 0, len(self.ends) - 2)

    def contained(self, counts: Sequence[int], fewer: Sequence[int], continuous: bool) -> np.ndarray:
        """Whether each of the functions of some counts (n,) is also among those of smaller counts."""
        bubbles = 2 if continuous and len(counts) > 1 else 0
        on_parts = [np.arange(max(n - bubbles, 0)) < m - bubbles for n, m in zip(counts, fewer, strict=True)]
        hats = np.ones(len(self.ends) if bubbles else 0, dtype=bool)
        return np.concatenate([hats, *on_parts])

    def phases(self, left: np.ndarray, right: np.ndarray, number: int) -> np.ndarray:
        """Change of phase (c,) [rad] of the highest polynomial over each cell between its ends (c,)."""
        part, ends = self._part((left + right) / 2), np.array(self.ends)
        start, length = ends[part], np.diff(ends)[part]
        first, last = (np.arccos(np.clip(1 - 2 * (x - start) / length, -1, 1)) for x in (left, right))
        return (last - first) * np.array(self.counts(number))[part]
