"""A discretization by powers of x with exact integrals, for derivations over the same trial functions."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial

from beamdyn.equations.discretization import CLAMPED, FIXED, HINGED, Cells, RootConditions

BENDING = (2, 3, 4)  # powers of x, which satisfy the conditions at the root
STRETCH = (1, 2)


@dataclass(frozen=True)
class Powers:
    """Space of the functions x^k, with exact integrals of polynomial weights."""

    powers: tuple
    length: float

    @property
    def size(self):
        return len(self.powers)

    @property
    def coarse(self):
        return None

    def functions(self, order):
        return [self.length**k * Polynomial([0] * k + [1]).deriv(order) for k in self.powers]

    def gram(self, weight, order):
        phi = self.functions(order)
        return np.array([[over_the_beam(weight, p * q) for q in phi] for p in phi])

    def load(self, weight, order=0):
        return np.array([over_the_beam(weight, p) for p in self.functions(order)])

    def end(self, order):
        return np.array([p(1.0) for p in self.functions(order)])

    def evaluate(self, xi, order=0):
        return np.array([p(xi) for p in self.functions(order)])


@dataclass(frozen=True)
class PowerSpaces:
    length: float

    def functions(self, conditions):
        return Powers(
            {CLAMPED: BENDING, HINGED: (1, *BENDING), FIXED: STRETCH}[RootConditions(*conditions[:2])],
            self.length,
        )

    def product(self, weight, rows, columns, orders=(0, 0)):
        each = zip((rows, columns), orders, strict=True)
        first, second = (self.functions(conditions).functions(order) for conditions, order in each)
        pairs = [[p * q for q in second] for p in first]
        return np.array([[over_the_beam(weight, pq) for pq in row] for row in pairs])


@dataclass(frozen=True)
class PowerSeries:
    """The discretization by powers of x."""

    def spaces(self, beam):
        return PowerSpaces(beam.length)

    def cells(self, beam):
        return Cells(np.array([0.0, 1.0]), 30)

    def coarser(self):
        return self

    def finer(self):
        return None

    def fits(self, modes):
        return True


def over_the_beam(weight, p):
    """Compute the integral of a profile times a polynomial over xi."""
    segments = zip(pairwise(weight.breakpoints), weight.coefficients, strict=True)
    return sum(_over_segment(ends, row, p) for ends, row in segments)


def _over_segment(ends, coefficients, p):
    series = np.polynomial.Legendre(coefficients, domain=list(ends)).convert(kind=Polynomial)
    whole = (series * p).integ()
    return whole(ends[1]) - whole(ends[0])
