"""A property along the beam: piecewise polynomial in the fraction x/L of the length.

Whatever a user gives (a constant, a polynomial, a table, any smooth function) becomes a Legendre
series on each segment between breakpoints, to rounding.  Discretizations therefore meet one
representation: it is evaluated, multiplied and integrated in closed form, hashed and pickled.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.polynomial import Polynomial, legendre

from beamdyn.common.checks import InvalidValue, real, real_array

_FIT_NODES = (8, 16, 32, 64, 128)  # a smooth engineering taper is resolved by 32
_SLIVER = 1e-12  # a shorter segment, relative to the beam, is a rounding of x/L
_FIT_ERROR = 1e-13  # relative to the largest value: rounding of the user's own function


@dataclass(frozen=True)
class Table:
    """A property given at stations, linear between them.

    Parameters
    ----------
    stations : sequence of float
        Positions x/L, from 0 to 1, ascending; a station given twice is a jump.
    values : sequence of float
        The property at the stations [its SI unit].
    """

    stations: Sequence[float]
    values: Sequence[float]


Property: TypeAlias = "float | Polynomial | Table | Callable[[np.ndarray], np.ndarray] | Profile"


@dataclass(frozen=True)
class Profile:
    """Piecewise polynomial of the fraction x/L on [0, 1].

    Parameters
    ----------
    breakpoints : tuple of float
        Ends of the segments, from 0 to 1: one more than there are segments.
    coefficients : tuple of tuple of float
        Legendre coefficients on each segment mapped to [-1, 1].
    """

    breakpoints: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    def __call__(self, xi: np.ndarray) -> np.ndarray:
        """Values at fractions `xi` of the length (from the right at a jump)."""
        xi = np.asarray(xi, dtype=float)
        segment = np.searchsorted(self.breakpoints, xi, side="right") - 1
        segment = np.clip(segment, 0, len(self.coefficients) - 1)
        values = np.empty(xi.shape)
        for k in np.unique(segment):
            here = segment == k
            values[here] = legendre.legval(self._local(k, xi[here]), self.coefficients[k])
        return values

    def _local(self, k: int, xi: np.ndarray) -> np.ndarray:
        a, b = self.breakpoints[k : k + 2]
        return ((xi - a) - (b - xi)) / (b - a)

    @property
    def degree(self) -> int:
        """Largest polynomial degree of a segment."""
        return max(len(c) for c in self.coefficients) - 1

    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Left and right end values of the segments, for extremes and jumps."""
        ends = [legendre.legval(np.array([-1.0, 1.0]), c) for c in self.coefficients]
        return np.array([e[0] for e in ends]), np.array([e[1] for e in ends])

    def split(self, breakpoints: Sequence[float]) -> Profile:
        """The same property on a finer set of segments."""
        edges = distinct(np.union1d(self.breakpoints, breakpoints))
        if edges == self.breakpoints:
            return self
        t, w = legendre.leggauss(self.degree + 1)
        return Profile(edges, tuple(_project(self, a, b, t, w) for a, b in pairwise(edges)))

    def __mul__(self, other: Profile) -> Profile:
        """Pointwise product."""
        a, b = self.split(other.breakpoints), other.split(self.breakpoints)
        pairs = zip(a.coefficients, b.coefficients, strict=True)
        return Profile(a.breakpoints, tuple(tuple(legendre.legmul(p, q).tolist()) for p, q in pairs))

    def scaled(self, factor: float) -> Profile:
        """The property times a constant."""
        return Profile(self.breakpoints, tuple(tuple(factor * c for c in row) for row in self.coefficients))

    def outboard_integral(self) -> Profile:
        """The integral from xi to 1, as a profile: the mass outboard of a section, for instance."""
        rows, total = [], 0.0
        for k in reversed(range(len(self.coefficients))):
            a, b = self.breakpoints[k : k + 2]
            inner = legendre.legint(self.coefficients[k], lbnd=1.0, scl=(a - b) / 2)
            inner[0] += total
            rows.append(tuple(inner.tolist()))
            total = float(legendre.legval(-1.0, inner))
        return Profile(self.breakpoints, tuple(reversed(rows)))


def _project(f: Callable, a: float, b: float, t: np.ndarray, w: np.ndarray) -> tuple[float, ...]:
    """Legendre coefficients of f on [a, b] by the Gauss rule (t, w) on [-1, 1]."""
    values = f((a + b) / 2 + (b - a) / 2 * t)
    k = np.arange(len(t))
    return tuple((((2 * k + 1) / 2) * (legendre.legvander(t, len(t) - 1).T @ (w * values))).tolist())


FRACTION = Profile((0.0, 1.0), ((0.5, 0.5),))  # x/L itself


def as_profile(name: str, given: Property, breakpoints: Sequence[float] = ()) -> Profile:
    """Turn what the user gave for a property into a positive `Profile`.

    Parameters
    ----------
    name : str
        Name of the property, for messages.
    given : float, Polynomial, Table, callable or Profile
        Polynomials and callables are functions of x/L; a callable takes and returns arrays.
    breakpoints : sequence of float
        Fractions x/L at which the property jumps or has a kink.

    Raises
    ------
    ValueError
        If it is not positive and finite everywhere, not vectorised, or not smooth between breakpoints.
    """
    edges = _edges(breakpoints)
    if isinstance(given, Profile):
        profile = given
    elif isinstance(given, Table):
        profile = _from_table(name, given)
    elif isinstance(given, Polynomial):
        profile = _from_polynomial(name, given)
    elif callable(given):
        profile = _from_function(name, given, edges)
    else:
        profile = Profile((0.0, 1.0), ((_number(name, given),),))
    profile = profile.split(edges)
    check_positive(name, profile)
    return profile


def _edges(breakpoints: Sequence[float]) -> tuple[float, ...]:
    inner = real_array("breakpoints", breakpoints)
    if inner.size and not (inner.min() > 0 and inner.max() < 1):
        raise InvalidValue("breakpoints", breakpoints, "give fractions x/L between 0 and 1, ends excluded")
    return distinct(np.concatenate([[0.0], inner, [1.0]]))


def distinct(edges: np.ndarray) -> tuple[float, ...]:
    """Sorted ends of segments, those that differ by rounding merged into one."""
    edges = np.unique(edges)
    return tuple(edges[np.diff(edges, prepend=-1.0) > _SLIVER].tolist())


def _number(name: str, given: object) -> float:
    return real(name, given, remedy="or a Polynomial in x/L, a Table or a function of x/L")


def _from_polynomial(name: str, given: Polynomial) -> Profile:
    if np.iscomplexobj(given.coef) or not np.isfinite(given.coef).all():
        raise ValueError(f"{name}: the polynomial {given} has coefficients that are complex or not finite")
    t, w = legendre.leggauss(given.degree() + 1)
    with np.errstate(over="ignore", invalid="ignore"):  # huge values are refused with all others
        return Profile((0.0, 1.0), (_project(given, 0.0, 1.0, t, w),))


def _from_table(name: str, table: Table) -> Profile:
    x, y = real_array(f"{name}.stations", table.stations), real_array(f"{name}.values", table.values)
    if len(x) != len(y) or len(x) < 2:
        raise ValueError(f"{name}: {len(x)} stations and {len(y)} values: give as many of each, at least two")
    if x[0] != 0 or x[-1] != 1 or np.any(np.diff(x) < 0):
        raise ValueError(
            f"{name}: stations run from {x[0]:g} to {x[-1]:g}; they must ascend from 0 to 1 (fractions x/L)"
        )
    if x[1] == 0 or x[-2] == 1 or np.any(x[2:] == x[:-2]):
        raise ValueError(
            f"{name}: a station given twice is a jump and stands between others; "
            "none may be given three times, nor twice at an end"
        )
    steps = [(x[i], x[i + 1], y[i], y[i + 1]) for i in range(len(x) - 1) if x[i + 1] > x[i]]
    rows = tuple(((p + q) / 2, (q - p) / 2) for _, _, p, q in steps)
    return Profile((0.0, *(float(b) for _, b, _, _ in steps)), rows)


def _from_function(name: str, function: Callable, edges: Sequence[float]) -> Profile:
    rows = tuple(_fit(name, function, a, b) for a, b in pairwise(edges))
    return Profile(tuple(edges), rows)


def _fit(name: str, function: Callable, a: float, b: float) -> tuple[float, ...]:
    """Legendre series of a user's function on [a, b], of the lowest tried degree exact to rounding."""
    check = _probes(a, b)
    wanted = _sample(name, function, check)
    local = ((check - a) - (b - check)) / (b - a)
    misfit = np.full(check.shape, np.inf)
    for nodes in _FIT_NODES:
        t, w = legendre.leggauss(nodes)
        row = _project(lambda x: _sample(name, function, x), a, b, t, w)
        misfit = np.abs(legendre.legval(local, row) - wanted)
        if misfit.max() <= _FIT_ERROR * np.abs(wanted).max():
            return tuple(legendre.legtrim(row, 1e-17 * np.abs(row).max()).tolist())
    where = check[misfit.argmax()]
    raise ValueError(
        f"{name}: the function is not smooth near x/L = {where:.3f}; "
        f"if it jumps or has a kink there, pass breakpoints=({where:.3f},) with the exact place"
    )


def _probes(a: float, b: float) -> np.ndarray:
    """Points that see a jump wherever it is, also beside the ends: spacing shrinks towards them."""
    s = np.linspace(0, np.pi, 515)[1:-1]
    return a + (b - a) * (1 - np.cos(s)) / 2


def _sample(name: str, function: Callable, x: np.ndarray) -> np.ndarray:
    try:
        values = np.asarray(function(x))
        values = values if np.iscomplexobj(values) else values.astype(float)
    except Exception as error:  # whatever a user's function may raise
        raise ValueError(
            f"{name}: the function failed on an array of x/L ({error}); it must take and return arrays"
        ) from error
    if values.shape != x.shape:
        raise ValueError(
            f"{name}: the function returned shape {values.shape} for x/L of shape {x.shape}; "
            "it must be vectorised: take and return arrays of one shape"
        )
    bad = ~np.isfinite(values) | np.iscomplex(values)
    if bad.any():
        raise ValueError(
            f"{name}: the function is {values[bad][0]} at x/L = {x[bad][0]:.3f}; it must be finite"
        )
    return values


def check_positive(name: str, profile: Profile) -> None:
    """Refuse a property that is not positive and finite somewhere, with a ValueError that names it."""
    edges = np.array(profile.breakpoints)
    inner = np.linspace(edges[:-1], edges[1:], 129)[1:-1].ravel()
    left, right = profile.sides()
    where = np.concatenate([inner, edges[:-1], edges[1:]])
    values = np.concatenate([profile(inner), left, right])
    k = int(values.argmin()) if np.isfinite(values).all() else int(np.argmin(np.isfinite(values)))
    if not (np.isfinite(values[k]) and values[k] > 0):
        place = f" at x/L = {where[k]:.3f}"
        raise InvalidValue(name, float(values[k]), "it must be positive and finite", where=place)
