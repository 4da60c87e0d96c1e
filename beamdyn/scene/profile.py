"""A property along the beam: a piecewise polynomial in the fraction x/L of the length.

Any form in which a user gives a property (constant, polynomial, table, smooth function) is converted to a
Legendre series on each segment between breakpoints, accurate to rounding.  Discretizations thus have one
representation to integrate; it is evaluated and multiplied in closed form, hashed and pickled.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, zip_longest
from typing import TypeAlias

import numpy as np
from numpy.polynomial import Polynomial, legendre

from beamdyn.common import numerics
from beamdyn.common.inputs.checks import MOST, InvalidValue, real, real_array, refuse
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.common.words import Named, Words

_FIT_NODES = (8, 16, 32, 64, 128)  # numbers of Gauss points tried in turn; 32 resolve a usual smooth taper
_SHORTEST_SEGMENT = 1e-12  # difference of x/L below which two breakpoints differ only by rounding
_FIT_TOLERANCE = 1e-13  # largest accepted error of a fit, relative to the function's largest value
_ZERO = 5e-13  # a property counts as 0 below this fraction of its largest value on a segment
_NOISE = 8 * float(np.finfo(float).eps)  # rounding error of a fit's coefficients, relative to the largest one
_SPACING = 2.5e-5  # distance in x/L of samples of a user's function: features wider than this are found
_FEW = 513  # number of samples, denser towards the ends of a segment, at which a fit is compared first
_AT_ONCE = 4096  # number of samples compared at once, which fit into the processor's cache


@dataclass(frozen=True)
class Table:
    """A property of the beam tabulated at stations, and linear between them.

    Parameters
    ----------
    stations : sequence of float
        Positions x/L, from 0 to 1, ascending; if a station is given twice, the property jumps there.
    values : sequence of float
        Values of the property at the stations [SI units].

    Examples
    --------
    >>> stiffness = bd.Table([0.0, 0.5, 1.0], [4.0, 3.0, 1.0])  # N m2 at x/L, straight lines between
    >>> beam = bd.Beam.from_stiffness(1.0, 1.0, stiffness)
    >>> float(beam.bending_stiffness(0.75))
    2.0
    """

    stations: Sequence[float]
    values: Sequence[float]


Property: TypeAlias = "float | Polynomial | Table | Callable[[np.ndarray], np.ndarray] | Profile"


@dataclass(frozen=True)
class Profile(FieldsOnly):
    """A property along the beam: a piecewise polynomial of the fraction x/L on [0, 1].

    Parameters
    ----------
    breakpoints : tuple of float
        Ends of the segments in ascending order, from 0 to 1.
    coefficients : tuple of tuple of float
        Legendre coefficients on each segment mapped to [-1, 1].

    Examples
    --------
    >>> taper = bd.Beam.from_stiffness(1.0, bd.Polynomial([2.0, -1.0]), 1.0).mass_per_length
    >>> float(taper(0.0)), float(taper(1.0))  # kg/m at root and tip
    (2.0, 1.0)
    """

    breakpoints: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:  # the hash is cached: profiles may have many segments, and caches need it often
        return hash((self.breakpoints, self.coefficients))

    def __call__(self, xi: np.ndarray) -> np.ndarray:
        """Evaluate the property at fractions `xi` of the length, of any shape; at a jump, its right limit."""
        xi = np.asarray(xi, dtype=float)
        segment = np.searchsorted(self._ends[1:-1], xi, side="right")
        if not self.degree:
            return self.series[0, segment]
        a, b = self._ends[segment], self._ends[segment + 1]
        t = ((xi - a) - (b - xi)) / (b - a)
        return legendre.legval(t, self.series[:, segment], tensor=False)

    @cached_property
    def _ends(self) -> np.ndarray:
        return np.array(self.breakpoints)

    @cached_property
    def series(self) -> np.ndarray:
        """Legendre coefficients of each segment, in columns, padded with 0 to the highest degree."""
        return np.array(list(zip_longest(*self.coefficients, fillvalue=0.0)))

    @cached_property
    def degree(self) -> int:
        """Largest polynomial degree over all segments."""
        return max(map(len, self.coefficients)) - 1

    def end_values(self) -> tuple[np.ndarray, np.ndarray]:
        """Evaluate the property at the left and right end of each segment: two arrays, different at jumps."""
        return self._at_ends

    @cached_property
    def _at_ends(self) -> tuple[np.ndarray, np.ndarray]:
        even, odd = self.series[::2].sum(axis=0), self.series[1::2].sum(axis=0)
        return even - odd, even + odd

    def split(self, breakpoints: Sequence[float]) -> Profile:
        """Represent the same property on segments that also end at the given breakpoints."""
        if breakpoints in ((0.0, 1.0), self.breakpoints):
            return self
        ends = merge_breakpoints(np.concatenate([self.breakpoints, breakpoints]))
        if ends == self.breakpoints:
            return self
        values = self(numerics.gauss_points_on(np.array(ends), self.degree + 1))
        return _of_series(ends, numerics.legendre_series(values.shape[1]) @ values.T)

    def __mul__(self, other: Profile) -> Profile:
        """Multiply two properties pointwise."""
        if other is ONE:
            return self
        a, b = self.split(other.breakpoints), other.split(self.breakpoints)
        return _of_series(a.breakpoints, numerics.multiply_series(a.series, b.series))

    def times_fraction(self) -> Profile:
        """Multiply the property by the fraction x/L."""
        fraction = np.stack([self._ends[:-1] + self._ends[1:], np.diff(self._ends)]) / 2
        return _of_series(self.breakpoints, numerics.multiply_series(self.series, fraction))

    def __add__(self, other: Profile) -> Profile:
        """Add two properties pointwise."""
        a, b = self.split(other.breakpoints), other.split(self.breakpoints)
        series = np.zeros((max(a.degree, b.degree) + 1, len(a.coefficients)))
        series[: a.degree + 1] = a.series
        series[: b.degree + 1] += b.series
        return _of_series(a.breakpoints, series)

    def at_points(self, points: int) -> np.ndarray:
        """Evaluate the property at Gauss points of each segment, shape (segments, points)."""
        return (numerics.legendre_values(points, self.degree) @ self.series).T

    def scaled(self, factor: float) -> Profile:
        """Multiply the property by a constant."""
        return _of_series(self.breakpoints, factor * self.series)

    def outboard_integral(self) -> Profile:
        """Integrate the property over x/L, from each section to the tip.

        For a mass per length, the result times the length L is the mass outboard of each section.
        """
        inner = numerics.integrate_series(-np.diff(self._ends) / 2 * self.series)
        # The integral over each segment is the value of its series at the left end, t = -1.
        of_segments = inner[::2].sum(axis=0) - inner[1::2].sum(axis=0)
        inner[0, :-1] += np.cumsum(of_segments[:0:-1])[::-1]
        return _of_series(self.breakpoints, inner)

    def derivative(self) -> Profile:
        """Differentiate the property with respect to x/L on each segment; jumps are left out."""
        series = legendre.legder(self.series) if self.degree else np.zeros_like(self.series)
        return _of_series(self.breakpoints, 2 / np.diff(self._ends) * series)

    def stepped(self, xi: np.ndarray, steps: np.ndarray) -> Profile:
        """Add a step for each xi to the property, everywhere inboard of this xi."""
        if not len(xi):
            return self
        parts = self.split(xi.tolist())
        ends, series = np.array(parts.breakpoints), parts.series.copy()
        series[0] += steps @ (ends[:-1] + ends[1:] < 2 * xi[:, None])
        return _of_series(parts.breakpoints, series)


def _of_series(ends: tuple[float, ...], series: np.ndarray) -> Profile:
    """Build a piecewise polynomial from Legendre coefficients, one column for each segment."""
    profile = Profile(ends, tuple(map(tuple, series.T.tolist())))
    profile.__dict__["series"] = series  # stores the known series as the cached property
    return profile


def combine(function: Callable[..., np.ndarray], *profiles: Profile) -> list[Profile]:
    """Apply an analytic function to properties, and represent its results as properties, exact to rounding.

    Parameters
    ----------
    function : callable
        Function of the values of each property at n points of c segments, shape (c, n), that returns the
        values of k results there, shape (k, c, n).
    *profiles : Profile
        The properties that `function` takes.

    Raises
    ------
    ValueError
        If a result varies too quickly between breakpoints.
    """
    ends = merge_breakpoints(np.concatenate([profile.breakpoints for profile in profiles]))
    parts, unresolved = [profile.split(ends) for profile in profiles], np.array([0])
    for nodes in _FIT_NODES if any(part.degree for part in parts) else (1,):
        values = np.swapaxes(function(*(part.at_points(nodes) for part in parts)), 1, 2)
        series = np.linalg.solve(numerics.legendre_values(nodes, nodes - 1), values)
        largest = np.abs(series).max(axis=1, keepdims=True)
        unresolved = np.flatnonzero(
            (np.abs(series[:, 1:][:, -3:]) > _FIT_TOLERANCE * largest).any(axis=(0, 1))
        )
        if not unresolved.size:
            kept = (np.abs(series) > _NOISE * largest).any(axis=2)
            return [
                _of_series(ends, s[: max(np.flatnonzero(k), default=0) + 1])
                for s, k in zip(series, kept, strict=True)
            ]
    a, b = ends[unresolved[0] : unresolved[0] + 2]
    raise ValueError(
        f"the property varies too quickly between x/L = {a:.4g} and {b:.4g}: give breakpoints between them"
    )


def _project(f: Callable, a: float, b: float, t: np.ndarray, w: np.ndarray) -> tuple[float, ...]:
    """Compute Legendre coefficients of f on [a, b] by a Gauss rule of points t and weights w on [-1, 1]."""
    values = f((a + b) / 2 + (b - a) / 2 * t)
    k = np.arange(len(t))
    return tuple((((2 * k + 1) / 2) * (legendre.legvander(t, len(t) - 1).T @ (w * values))).tolist())


def mean(profile: Profile) -> float:
    """Compute the mean of a property over the length of the beam."""
    return float(np.diff(profile.breakpoints) @ profile.series[0])


ONE = Profile((0.0, 1.0), ((1.0,),))


def as_profile(name: str, value: Property, breakpoints: Sequence[float] = (), power: int = 1) -> Profile:
    """Convert a property as given by the user to a positive `Profile`: see `to_profile`, `check_positive`.

    Raises
    ------
    ValueError
        As `to_profile`, or if the property is not positive everywhere.
    """
    profile = to_profile(name, value, breakpoints)
    check_positive(name, profile, power)
    return profile


def to_profile(name: str, value: Property, breakpoints: Sequence[float] = ()) -> Profile:
    """Convert a property as given by the user, of any sign, to a `Profile`.

    Parameters
    ----------
    name : str
        Name of the property, for error messages.
    value : float, Polynomial, Table, callable or Profile
        Polynomials and callables are functions of x/L; a callable takes and returns arrays, and is
        sampled at intervals of 2.5e-5.
    breakpoints : sequence of float
        Fractions x/L at which the property jumps or has a kink.

    Raises
    ------
    ValueError
        If the property is not finite everywhere, or a callable is not vectorised or not smooth between
        breakpoints.
    """
    # Validate inner breakpoints, and add the ends 0 and 1.
    inner = real_array("breakpoints", breakpoints)
    if inner.size and not (inner.min() > 0 and inner.max() < 1):
        bound = Words("give fractions x/L between 0 and 1, ends excluded", _OR_LENGTHS)
        raise InvalidValue("breakpoints", breakpoints, bound)
    ends = merge_breakpoints(np.concatenate([[0.0], inner, [1.0]]))
    if isinstance(value, Profile):
        profile = value
    elif isinstance(value, Table):
        profile = _from_table(name, value)
    elif isinstance(value, Polynomial):
        if np.iscomplexobj(value.coef) or not np.isfinite(value.coef).all():
            raise ValueError(
                f"{name}: the polynomial {value} has coefficients that are complex or not finite"
            )
        _check_largest(name, value.coef)  # small coefficients are allowed beside larger ones
        t, w = legendre.leggauss(value.degree() + 1)
        profile = Profile((0.0, 1.0), (_project(value, 0.0, 1.0, t, w),))
    elif callable(value):
        profile = Profile(ends, tuple(_fit(name, value, a, b) for a, b in pairwise(ends)))
    else:
        constant = real(name, value, remedy="or a Polynomial in x/L, a Table or a function of x/L")
        _check_sizes(name, np.array([constant]))
        profile = Profile((0.0, 1.0), ((constant,),))
    return profile.split(ends)


_OR_LENGTHS = Named("", ", or lengths with their unit")  # files may give lengths instead of fractions x/L
_SIZES = f"give sizes from {1 / MOST:g} to {{limit}} in SI units"


def _check_sizes(name: str, values: np.ndarray) -> None:
    """Refuse values so large or small that powers and products of them overflow."""
    _check_largest(name, values)
    sizes = np.abs(values)
    refuse((sizes < 1 / MOST) & (sizes > 0), name, values, "", _SIZES, limit=MOST)


def _check_largest(name: str, values: np.ndarray) -> None:
    """Refuse values so large that powers and products of them overflow."""
    refuse(np.abs(values) > MOST, name, values, "", _SIZES, limit=MOST)


def merge_breakpoints(breakpoints: np.ndarray) -> tuple[float, ...]:
    """Sort breakpoints and merge those that differ by rounding."""
    ends = np.sort(breakpoints)
    inner = ends[1:][np.diff(ends) > _SHORTEST_SEGMENT]
    inner = inner[ends[-1] - inner > _SHORTEST_SEGMENT]
    return (float(ends[0]), *inner.tolist(), float(ends[-1]))


def _from_table(name: str, table: Table) -> Profile:
    x, y = real_array(f"{name}.stations", table.stations), real_array(f"{name}.values", table.values)
    x = _without_rounding(x)
    _check_stations(f"{name}.stations", x, len(y))
    _check_sizes(f"{name}.values", y)
    segments = [(x[i + 1], y[i], y[i + 1]) for i in range(len(x) - 1) if x[i + 1] > x[i]]
    rows = tuple(((p + q) / 2, (q - p) / 2) for _, p, q in segments)
    return Profile((0.0, *(float(b) for b, _, _ in segments)), rows)


def _without_rounding(x: np.ndarray) -> np.ndarray:
    """Merge stations x/L that differ by rounding, and set the first to 0 and the last to 1."""
    x = x.copy()
    for k in np.flatnonzero(np.abs(np.diff(x)) < _SHORTEST_SEGMENT):
        x[k + 1] = x[k]
    for end in (0.0, 1.0):
        x[np.abs(x - end) < _SHORTEST_SEGMENT] = end
    return x


def _check_stations(name: str, x: np.ndarray, values: int) -> None:
    """Check that stations ascend from 0 to 1, one for each value; a station may occur twice, for a jump."""

    def refuse_station(k: int, bound: str) -> None:
        raise InvalidValue(f"{name}[{k}]", float(x[k]), bound, Words("give fractions x/L", _OR_LENGTHS))

    if len(x) != values or len(x) < 2:
        bound = f"{len(x)} stations and {values} values: give one value for each station, and at least two"
        raise InvalidValue(name, x.tolist(), bound)
    if x[0] != 0:
        refuse_station(0, "the first station must be 0, the root")
    if (falls := np.flatnonzero(x[1:] < x[:-1]) + 1).size:
        refuse_station(falls[0], f"it follows {x[falls[0] - 1]:g}; stations must ascend")
    if x[-1] != 1:
        tip = Named("1, the tip", "the tip, at 1 or the beam's length")
        refuse_station(len(x) - 1, Words("the last station must be ", tip))
    if x[1] == 0 or x[-2] == 1 or np.any(x[2:] == x[:-2]):
        bound = "a station may be given twice, for a jump there, except the first and the last one"
        raise InvalidValue(
            name, x.tolist(), bound, "give no station three times, nor the first or the last twice"
        )


def _fit(name: str, function: Callable, a: float, b: float) -> tuple[float, ...]:
    """Fit a Legendre series to a user's function on [a, b], with as few nodes as are exact to rounding."""
    # Points between a and b: first a few, denser towards the ends, then so many that no feature is missed.
    s = np.linspace(0, np.pi, _FEW + 2)[1:-1]
    uniform = np.linspace(a, b, max(8, int(np.ceil((b - a) / _SPACING))) + 1)[1:-1]
    xi = np.concatenate([a + (b - a) * (1 - np.cos(s)) / 2, uniform])
    exact = _sample(name, function, xi)
    bound, parts = _FIT_TOLERANCE * np.abs(exact).max(), 1 + len(xi) // _AT_ONCE
    samples = list(zip(np.array_split(xi, parts), np.array_split(exact, parts), strict=True))
    for nodes in _FIT_NODES:
        t, _ = legendre.leggauss(nodes)
        values = _sample(name, function, (a + b) / 2 + (b - a) / 2 * t)
        # Solving equations for the coefficients is more accurate than quadrature, which loses digits.
        row = np.linalg.solve(legendre.legvander(t, nodes - 1), values)
        short = legendre.legtrim(row, 0.01 * bound)
        if all(_misfit(short, a, b, *part).max() <= bound for part in samples):
            return tuple(legendre.legtrim(row, 1e-17 * np.abs(row).max()).tolist())
    where = xi[_FEW + 1 + np.abs(np.diff(exact[_FEW:], 2)).argmax()]  # where the slope changes most
    raise ValueError(
        f"{name}: the function is not smooth near x/L = {where:.4g}; "
        f"if it jumps or has a kink there, pass breakpoints=({where:.4g},) with the exact place; "
        "if it varies quickly, several breakpoints about it, or a Table"
    )


def _misfit(
    row: Sequence[float] | np.ndarray, a: float, b: float, xi: np.ndarray, exact: np.ndarray
) -> np.ndarray:
    """Compute the distance of a Legendre series on [a, b] from exact values at xi."""
    return np.abs(legendre.legval(((xi - a) - (b - xi)) / (b - a), row) - exact)


def _sample(name: str, function: Callable, x: np.ndarray) -> np.ndarray:
    """Evaluate a user's function; raise a ValueError if it fails, is not vectorised or not finite."""
    try:
        with np.errstate(all="ignore"):  # values that are not finite are refused below
            values = np.asarray(function(x))
        values = values if np.iscomplexobj(values) else values.astype(float)
    except Exception as error:  # any exception that a user's function may raise
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
    _check_sizes(name, values)
    return values


def check_positive(name: str, profile: Profile, power: int = 1) -> None:
    """Refuse a property that is not positive and finite everywhere; the message names it and the place.

    A value counts as zero where value**power is less than 5e-13 of the largest such power on the segment.
    """
    ends, zero = np.array(profile.breakpoints), _ZERO ** (1 / power)
    values, where = np.stack(profile.end_values()), np.stack([ends[:-1], ends[1:]])
    if profile.degree > 1:  # a linear property has its minimum at an end
        inner = np.linspace(ends[:-1], ends[1:], 129)[1:-1]
        where, values = np.concatenate([inner, where]), np.concatenate([profile(inner), values])
    least = zero * np.abs(profile.series).sum(axis=0)
    if (bad := ~(np.isfinite(values) & (values > least))).any():
        k = np.unravel_index(np.where(bad, values, np.inf).argmin(), values.shape)
        value = 0.0 if abs(values[k]) <= least[k[1]] else float(values[k])
        bound = (
            f"it must be positive and finite; less than {zero:.1g} of the largest value nearby counts as zero"
        )
        raise InvalidValue(name, value, bound, "end a taper above 0", where=f" at x/L = {where[k]:.3f}")
