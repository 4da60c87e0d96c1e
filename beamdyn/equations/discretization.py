"""Interface of discretizations: function spaces on a beam, integrated by Gauss rules on cells of the beam.

In shapes of arrays, n and m count trial functions, k positions, c cells, p Gauss points in a cell, and N
Gauss points in all cells.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.numerics import gauss_points_on, gauss_rule, gauss_weights_on, legendre_series
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of a beam: parts on which the trial functions of a discretization are smooth.

    Parameters
    ----------
    ends : ndarray, shape (c + 1,)
        Ends of the c cells, as x/L from 0 to 1.
    points : int
        Number p of Gauss points on each cell, which resolve nonlinear functions of the trial functions.
    """

    ends: np.ndarray
    points: int


@dataclass(frozen=True)
class ArcQuadrature:
    """Gauss rule on the cells of a beam, which also integrates from the root to each point.

    Parameters
    ----------
    cells : Cells
        Cells, and number of Gauss points on each.
    """

    cells: Cells

    @cached_property
    def xi(self) -> np.ndarray:
        """Gauss points x/L on [0, 1]."""
        return gauss_points_on(self.cells.ends, self.cells.points).ravel()

    @cached_property
    def weights(self) -> np.ndarray:
        """Gauss weights for integrals over x/L from 0 to 1."""
        return gauss_weights_on(self.cells.ends, self.cells.points)

    @cached_property
    def _half_lengths(self) -> np.ndarray:
        return np.diff(self.cells.ends)[:, None] / 2

    def integrate(self, values: np.ndarray) -> np.ndarray:
        """Integrate values at Gauss points (last axis) from the root to each Gauss point and to the tip."""
        p, N = self.cells.points, len(self.xi)
        of_cells = values.reshape(-1, p)
        shape = *values.shape[:-1], (len(self.cells.ends) - 1), p
        ends = np.cumsum(
            (of_cells @ gauss_rule(p)[1]).reshape(shape[:-1]) * self._half_lengths[:, 0], axis=-1
        )
        # All integrals are computed in this one array, as allocation takes longer than the arithmetic.
        integrals = np.empty((*values.shape[:-1], N + 1))
        inside = integrals[..., :N].reshape(shape)
        np.multiply((of_cells @ integrals_between_points(p).T).reshape(shape), self._half_lengths, out=inside)
        inside[..., 1:, :] += ends[..., :-1, None]
        integrals[..., N] = ends[..., -1]
        return integrals

    def transposed(self, forces: np.ndarray) -> np.ndarray:
        """Apply the transposed matrix of `integrate` to forces at the Gauss points and the tip."""
        p = self.cells.points
        _, w = gauss_rule(p)
        inside = forces[..., :-1].reshape(*forces.shape[:-1], (len(self.cells.ends) - 1), p)
        of_cells = inside.sum(axis=-1)
        beyond = np.cumsum(of_cells[..., ::-1], axis=-1)[..., ::-1] - of_cells + forces[..., -1:]
        scaled = (inside @ integrals_between_points(p) + beyond[..., None] * w) * self._half_lengths
        return scaled.reshape(*forces.shape[:-1], (len(self.cells.ends) - 1) * p)

    def integrate_to(self, xi: np.ndarray) -> np.ndarray:
        """Compute weights (k, N) of values at Gauss points for integrals from the root to k positions xi."""
        cell, t, own = self._find(xi)
        length, p = np.diff(self.cells.ends)[cell], self.cells.points
        matrix = np.where(np.arange(len(self.xi)) < (cell * p)[:, None], self.weights, 0.0)
        np.put_along_axis(matrix, own, length[:, None] / 2 * _integrate_interpolant(t, p), axis=1)
        return matrix

    def interpolate_to(self, xi: np.ndarray) -> np.ndarray:
        """Compute weights (k, N) of values at Gauss points for interpolation to k positions xi."""
        _, t, own = self._find(xi)
        matrix = np.zeros((len(xi), len(self.xi)))
        values = legendre.legvander(t, self.cells.points - 1) @ legendre_series(self.cells.points)
        np.put_along_axis(matrix, own, values, axis=1)
        return matrix

    def _find(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Find, for each xi, its cell, its coordinate in the cell (-1 to 1), and the cell's Gauss points."""
        ends, p = self.cells.ends, self.cells.points
        cell = np.clip(np.searchsorted(ends, xi, side="right") - 1, 0, len(ends) - 2)
        t = np.clip(2 * (xi - ends[cell]) / np.diff(ends)[cell] - 1, -1, 1)
        return cell, t, cell[:, None] * p + np.arange(p)


@cache
def integrals_between_points(points: int) -> np.ndarray:
    """Compute weights (p, p) that integrate values at p Gauss points from -1 to each of the points."""
    return _integrate_interpolant(gauss_rule(points)[0], points)


def _integrate_interpolant(t: np.ndarray, points: int) -> np.ndarray:
    """Compute weights (k, p) that integrate values at p Gauss points from -1 to each of k values t."""
    integrals = legendre.legint(np.eye(points), lbnd=-1)
    return legendre.legvander(t, points) @ integrals @ legendre_series(points)


# Legendre polynomials are cached at least up to this degree: most properties, and the tension, have no higher
# degree.
_OF_TENSION = 8


class Sampler:
    """Sampler of the beam's properties at the Gauss points of cells; each property is evaluated once.

    Parameters
    ----------
    left, right : ndarray, shape (c,)
        Ends of the cells, as x/L; properties are smooth within them.
    points : int
        Number of Gauss points on each cell.
    """

    def __init__(self, left: np.ndarray, right: np.ndarray, points: int) -> None:
        self._left, self._right, self._points = left, right, points
        self._known: dict[Profile, np.ndarray] = {}
        self._placed: dict[tuple[float, ...], tuple[np.ndarray, np.ndarray]] = {}

    @classmethod
    def on_cells(cls, cells: Cells) -> Sampler:
        """Build a sampler for the Gauss points of consecutive cells."""
        return cls(cells.ends[:-1], cells.ends[1:], cells.points)

    def __call__(self, profile: Profile) -> np.ndarray:
        """Evaluate a property at all Gauss points, cell by cell, in an array with one axis."""
        if profile not in self._known:
            segment, polynomials = self._place(profile.breakpoints, profile.degree)
            series = profile.series.T[segment]
            values = np.einsum("cpd,cd->cp", polynomials[..., : profile.degree + 1], series)
            self._known[profile] = values.ravel()
        return self._known[profile]

    def _place(self, breakpoints: tuple[float, ...], degree: int) -> tuple[np.ndarray, np.ndarray]:
        """Find the segment that contains each cell, and evaluate Legendre polynomials on the segments.

        The values (cells, points, degrees) are at the Gauss points, for all degrees up to at least the given
        one; they are cached, as most properties have the same segments.
        """
        placed = self._placed.get(breakpoints)
        if placed is not None and placed[1].shape[2] > degree:
            return placed
        ends, left, right = np.array(breakpoints), self._left, self._right
        segment = ends[1:-1].searchsorted((left + right) / 2, side="right")
        a, b = ends[segment, None], ends[segment + 1, None]
        xi = left[:, None] + (right - left)[:, None] * (1 + gauss_rule(self._points)[0]) / 2
        polynomials = legendre.legvander(((xi - a) - (b - xi)) / (b - a), max(degree, _OF_TENSION))
        self._placed[breakpoints] = segment, polynomials
        return segment, polynomials


class SampledSpace(FieldsOnly, ABC):
    """Base class of function spaces that are sampled at the points of a Gauss rule on cells."""

    spaces: Any  # the spaces that it belongs to, whose `quadrature` is the Gauss rule

    @cached_property
    def points(self) -> np.ndarray:
        """Points x/L of the Gauss rule on [0, 1]."""
        return self.spaces.quadrature.xi

    @cached_property
    def rule(self) -> np.ndarray:
        """Weights of the Gauss rule."""
        return self.spaces.quadrature.weights

    @cached_property
    @abstractmethod
    def samples(self) -> list[np.ndarray]:
        """Values of the trial functions and of each derivative at the Gauss points, functions in rows."""

    @property
    def size(self) -> int:
        """Number n of trial functions."""
        return len(self.samples[0])

    @property
    @abstractmethod
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span the coarser discretization; None if no subset of functions does.

        Results with the coarser discretization serve to estimate errors.
        """

    def weights(self, weight: Profile) -> np.ndarray:
        """Multiply the weights of the Gauss rule by a property of the beam at the Gauss points."""
        return self.rule * weight(self.points)

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate a weight times the `order`-th derivatives of all pairs of functions: a matrix."""
        phi = self.samples[order]
        return (phi * self.weights(weight)) @ phi.T

    def load(self, weight: Profile, order: int = 0) -> np.ndarray:
        """Integrate a weight times the `order`-th derivative of each function."""
        return self.samples[order] @ self.weights(weight)


class RootConditions(NamedTuple):
    """Boundary conditions of a field's trial functions at the root, and their smoothness.

    Parameters
    ----------
    held : int
        Number of quantities that vanish at the root: the value, the first derivative, and so on.
    derivatives : int
        Highest order of a derivative that must be square-integrable.
    stiffness : str
        Name of the section stiffness that resists the highest derivative; functions may be adapted to it.
    direction : int
        Direction of the displacement: 0 for that of bending at the root, 1 for the one perpendicular to it.
    """

    held: int
    derivatives: int
    stiffness: str = ""
    direction: int = 0


CLAMPED = RootConditions(2, 2)  # a deflection with zero slope at the root
HINGED = RootConditions(1, 2)  # a deflection that is 0 at the root; its first function rotates about the root
FIXED = RootConditions(1, 1)  # a displacement that is 0 at the root, such as stretch


class SampledSpaces(ABC):
    """Base of function spaces whose functions are sampled at the points of a common Gauss rule."""

    @abstractmethod
    def functions(self, conditions: RootConditions) -> SampledSpace:
        """Build trial functions that satisfy conditions at the root."""

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate a weight times derivatives of two functions over x/L, for all pairs of functions.

        The rows of the result are functions with the root conditions `rows`, its columns are functions with
        the root conditions `columns`; `orders` are the orders of the two derivatives.
        """
        left, right = self.functions(rows), self.functions(columns)
        return (left.samples[orders[0]] * left.weights(weight)) @ right.samples[orders[1]].T


class Functions(Protocol):
    """Trial functions phi_i of xi = x/L on [0, 1]."""

    @property
    def size(self) -> int:
        """Number n of functions."""
        ...

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of phi_i at the tip."""
        ...

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives of all phi_i at k positions xi: shape (functions, k)."""
        ...


class Space(Functions, Protocol):
    """Trial functions phi_i that satisfy the boundary conditions at the root."""

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span the coarser discretization; None if no subset of functions does.

        Results with the coarser discretization serve to estimate errors.
        """
        ...

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate over xi the weight times the `order`-th derivatives of all pairs phi_i, phi_j."""
        ...

    def load(self, weight: Profile, order: int = 0) -> np.ndarray:
        """Integrate over xi the weight times the `order`-th derivative of phi_i."""
        ...


class Spaces(Protocol):
    """The function spaces of one discretization of one beam."""

    def functions(self, conditions: RootConditions) -> Space:
        """Build trial functions that satisfy conditions at the root.

        For `HINGED`, the first function has a slope at the root; the others are the functions for `CLAMPED`.
        """
        ...

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate a weight times derivatives of two functions over x/L, for all pairs of functions.

        The rows of the result are functions with the root conditions `rows`, its columns are functions with
        the root conditions `columns`; `orders` are the orders of the two derivatives.
        """
        ...

    @property
    def across(self) -> int:
        """Number of functions across the width of a plate, not counting the constant one."""
        ...

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width of a plate in the coarser discretization."""
        ...

    def shares_functions(self, other: Self) -> bool:
        """Whether another object of this class has the same functions, even if its Gauss rule differs."""
        ...


class Discretization(Protocol):
    """A discretization of a beam, such as `Ritz` or `Fem`.

    In order to add a discretization, write a class in a module of its own:

    1. It is a frozen dataclass of its sizes: it is hashed and pickled, and its `repr` is recorded in the
       provenance of results.
    2. `spaces(beam)` returns the function spaces (`Spaces`).  They have a breakpoint, or a node, at each
       of `beam.breakpoints`, so that integrals are exact where a property jumps.  They are pickled and saved
       with results: as dataclasses of numbers and arrays, which compute derived quantities at first use
       (`FieldsOnly`).
    3. All physics is in the displacement fields (`beamdyn.equations.fields`); a function space only
       integrates and evaluates.
    4. `coarser` and `finer` make a sequence.  The truncation error of a result is estimated by its difference
       from that of `coarser`; a tolerance is met by repeating `finer`.  Where some functions of a space
       span the coarser space, its `coarse` has their indices; the matrices of the coarser equations are then
       rows and columns of the matrices of the finer ones.
    5. `order` is the order of convergence, for Richardson extrapolation, if the error is a power of the size;
       `converges_regularly` tells whether errors can be estimated without a further margin.
    6. An instance is passed as ``discretization=`` to any analysis.  To be chosen by name, it needs a line
       in `beamdyn.modes.modal.discretization_choice`.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> for discretization in (bd.Ritz(), bd.Fem()):
    ...     modes = bd.natural_modes(bd.Scene(strip), modes=1, discretization=discretization)
    ...     print(f"{modes.frequency[0]:.5f} Hz")
    65.23046 Hz
    65.23046 Hz
    """

    @property
    def order(self) -> int | None:
        """Order p of convergence: errors of eigenvalues are proportional to size^-p; None if they are not."""
        ...

    @property
    def converges_regularly(self) -> bool:
        """Whether the changes of an eigenvalue decrease steadily from refinement to refinement."""
        ...

    @property
    def rounding(self) -> float:
        """Relative rounding error of eigenvalues that is caused by the integrals of the discretization."""
        ...

    def spaces(self, beam: Beam) -> Spaces:
        """Build the function spaces on a beam, one for each kind of boundary condition."""
        ...

    def cells(self, beam: Beam) -> Cells:
        """Divide a beam into cells on which the functions are smooth, for integrals of large deflection."""
        ...

    def coarser(self) -> Discretization:
        """Return a coarser discretization; the difference between both results estimates the error."""
        ...

    def finer(self) -> Discretization | None:
        """Return the next finer discretization; None if this is the largest."""
        ...

    def fits(self, modes: int) -> bool:
        """Return whether both this discretization and `coarser` have enough functions for so many modes."""
        ...
