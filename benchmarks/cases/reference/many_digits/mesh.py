"""Trial functions on segments, evaluated at Gauss points and ends.

The second derivative of a deflection by bending is any polynomial of degree < n on each segment; deflection
and slope follow from the root.  What has one derivative only (shear, stretch) likewise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from mpmath import mp, mpf

from benchmarks.cases.reference.many_digits.fixed import DIGITS, ONE, dot, fixed, times

_MORE = 8  # number of Gauss points beyond the number of functions, because properties vary, too


@dataclass(frozen=True)
class Rule:
    """Gauss points of [-1, 1] followed by the end 1, for polynomials of degree < n on a segment.

    Parameters
    ----------
    t : list of mpf
        The q points, then 1.
    weights : list of mpf
        Quadrature weights, then 0.
    tables : tuple of ndarray, shape (q + 1, n)
        P_k, its integral from -1, and the integral of that.
    outboard : ndarray, shape (q + 1, q)
        Integral from each point to 1 of the polynomial with given values at the q points.
    """

    t: list[mpf]
    weights: list[mpf]
    tables: tuple[np.ndarray, np.ndarray, np.ndarray]
    outboard: np.ndarray


@lru_cache(maxsize=16)
def rule(n: int) -> Rule:
    """Return the rule for n functions on each segment."""
    with mp.workdps(DIGITS + 10):
        q = n + _MORE
        t, weights = _gauss(q)
        values = [_legendre(x, max(q, n) + 3) for x in (*t, mpf(1))]
        plain = [row[:n] for row in values]
        once = [[_integral(row, k) for k in range(n)] for row in values]
        twice = [[_second_integral(row, k) for k in range(n)] for row in values]
        tables = [np.stack([fixed(row) for row in table]) for table in (plain, once, twice)]
        halves = [w / 2 for w in weights]
        cardinal = np.stack(
            [
                fixed((2 * k + 1) * w * row[k] for k in range(q))
                for w, row in zip(halves, values[:-1], strict=True)
            ]
        )
        rest = np.stack([fixed(2 * (k == 0) - _integral(row, k) for k in range(q)) for row in values])
        return Rule([*t, mpf(1)], [*weights, mpf(0)], tuple(tables), dot(rest, cardinal.T))


def _gauss(q: int) -> tuple[list[mpf], list[mpf]]:
    points, weights = [], []
    for start in np.polynomial.legendre.leggauss(q)[0]:
        x = mpf(float(start))
        for _ in range(4):
            row = _legendre(x, q + 1)
            slope = q * (row[q - 1] - x * row[q]) / (1 - x * x)
            x -= row[q] / slope
        row = _legendre(x, q + 1)
        slope = q * (row[q - 1] - x * row[q]) / (1 - x * x)
        points.append(x)
        weights.append(2 / ((1 - x * x) * slope**2))
    return points, weights


def _legendre(x: mpf, count: int) -> list[mpf]:
    row = [mpf(1), x]
    for k in range(1, count):
        row.append(((2 * k + 1) * x * row[k] - k * row[k - 1]) / (k + 1))
    return row


def _integral(row: list[mpf], k: int) -> mpf:
    """Compute the integral of P_k from -1."""
    return row[1] + 1 if k == 0 else (row[k + 1] - row[k - 1]) / (2 * k + 1)


def _second_integral(row: list[mpf], k: int) -> mpf:
    if k == 0:
        return (row[1] + 1) ** 2 / 2
    return (_integral(row, k + 1) - _integral(row, k - 1)) / (2 * k + 1)


@dataclass(frozen=True)
class Mesh:
    """Points of all segments: the root, then the Gauss points and the right end of each segment.

    Parameters
    ----------
    ends : list of mpf
        Ends of the segments x/L, from 0 to 1.
    functions : int
        Number of polynomials on each segment.
    """

    ends: list[mpf]
    functions: int

    @property
    def rule(self) -> Rule:
        return rule(self.functions)

    @property
    def lengths(self) -> list[mpf]:
        return [b - a for a, b in zip(self.ends, self.ends[1:], strict=False)]

    @property
    def places(self) -> list[mpf]:
        """Points x/L of the mesh."""
        inner = [
            a + (1 + t) / 2 * h for a, h in zip(self.ends, self.lengths, strict=False) for t in self.rule.t
        ]
        return [mpf(0), *inner]

    @property
    def segments(self) -> list[int]:
        """Index of the segment that each point belongs to."""
        return [0, *(k for k in range(len(self.lengths)) for _ in self.rule.t)]

    @property
    def weights(self) -> np.ndarray:
        """Weights of integrals over x/L; 0 at ends."""
        return fixed([0, *(w * h / 2 for h in self.lengths for w in self.rule.weights)])

    def end(self, k: int) -> int:
        """Return the point at the right end of a segment."""
        return (k + 1) * len(self.rule.t)

    def outboard(self, values: np.ndarray) -> np.ndarray:
        """Integrate from each point to the tip a function with these values at the points."""
        found, beyond, size = np.zeros(len(values), dtype=object), 0, len(self.rule.t)
        for k in reversed(range(len(self.lengths))):
            start = 1 + k * size
            half = fixed([self.lengths[k] / 2])[0]
            inner = times(dot(self.rule.outboard, values[start : start + size - 1]), half)
            found[start : start + size] = inner + beyond
            whole = dot(fixed(self.rule.weights[:-1]), values[start : start + size - 1])
            beyond += (int(whole) * half) >> 200
        found[0] = beyond
        return found

    def once(self) -> tuple[np.ndarray, np.ndarray]:
        """Compute values and derivatives of functions with polynomial derivative: (points, segments n)."""
        slope, value = self._empty(1), self._empty(1)
        size, n = len(self.rule.t), self.functions
        for k, h in enumerate(self.lengths):
            start, columns = 1 + k * size, slice(k * n, (k + 1) * n)
            half = fixed([h / 2])[0]
            slope[start : start + size, columns] = self.rule.tables[0]
            value[start : start + size, columns] = times(self.rule.tables[1], half)
            value[start + size :, columns] = value[start + size - 1, columns]
        return value, slope

    def twice(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute values and two derivatives of functions with polynomial second derivative.

        The last function is x/L; shape (points, segments n + 1).
        """
        bend, slope, value = self._empty(), self._empty(), self._empty()
        size, n, places = len(self.rule.t), self.functions, fixed(self.places)
        for k, h in enumerate(self.lengths):
            start, columns = 1 + k * size, slice(k * n, (k + 1) * n)
            half = fixed([h / 2])[0]
            bend[start : start + size, columns] = self.rule.tables[0]
            slope[start : start + size, columns] = times(self.rule.tables[1], half)
            value[start : start + size, columns] = times(times(self.rule.tables[2], half), half)
            last = start + size - 1
            slope[last + 1 :, columns] = slope[last, columns]
            beyond = (places[last + 1 :] - places[last])[:, None]
            value[last + 1 :, columns] = value[last, columns] + times(beyond, slope[last, columns][None, :])
        slope[:, -1], value[:, -1] = ONE, places
        return value, slope, bend

    def _empty(self, less: int = 0) -> np.ndarray:
        points = 1 + len(self.lengths) * len(self.rule.t)
        return np.zeros((points, len(self.lengths) * self.functions + 1 - less), dtype=object)
