"""Virtual displacements of a beam that is cut at stations, by which its internal loads are found.

The principle of virtual work gives the force or moment with which the part outboard of a cut acts on the part
inboard, if the part outboard moves as a rigid body while the part inboard stays: along the beam, across it,
or by a rotation about the cut.  Here these displacements are appended to the trial functions of a
discretization, so that the fields (`beamdyn.equations.fields`) assemble all their terms for them, too, and no
physics is programmed twice.

A rotation about the cut is a kink.  Its curvature, a delta function at the cut, is kept in all terms but the
product of two curvatures: the work of the bending moment there gives the moment that is to be computed.

In shapes of arrays, n and m count functions, S stations, and k other positions.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from beamdyn.common.numerics import gauss_points_on, gauss_rule
from beamdyn.equations.discretization import Cells, RootConditions, SampledSpace, Space, Spaces
from beamdyn.loads.stations import SpanStations
from beamdyn.scene.profile import Profile

_TOUCHING = 1e-12  # distance of a point mass from a station, divided by the length, that counts as 0


@dataclass(frozen=True)
class CutQuadrature:
    """Gauss quadrature on cells between element ends, breakpoints and stations, with the stations appended.

    Parameters
    ----------
    stations : SpanStations
        The cuts.
    cells : Cells
        Cells of the discretization, with points that integrate its products.
    """

    stations: SpanStations
    cells: Cells

    @cached_property
    def points(self) -> np.ndarray:
        """Quadrature points x/L, followed by the stations."""
        return np.concatenate([gauss_points_on(self._ends, self.cells.points).ravel(), self.stations.xi])

    @cached_property
    def weights(self) -> np.ndarray:
        """Quadrature weights of the points, then the weight 1 for the delta function at each station."""
        _, w = gauss_rule(self.cells.points)
        inside = (np.diff(self._ends)[:, None] / 2 * w).ravel()
        return np.concatenate([inside, np.ones(len(self.stations.xi))])

    @property
    def _ends(self) -> np.ndarray:
        """Ends x/L of the cells, including the stations."""
        return np.unique(np.concatenate([self.cells.ends, self.stations.xi]))


@dataclass(frozen=True)
class CutSpace(SampledSpace):
    """Trial functions, followed by the virtual displacements of the part outboard of each cut.

    The virtual displacements are rotations, if functions have slopes, and then translations.

    Parameters
    ----------
    space : Space or None
        The function space of the trial functions; None if there are none.
    derivatives : int
        Highest order of derivatives: with 2, the displacements include rotations.
    quadrature : CutQuadrature
        Stations and quadrature rule.
    length : float
        Length of the beam [m].
    """

    space: Space | None
    derivatives: int
    quadrature: CutQuadrature
    length: float

    @property
    def trials(self) -> int:
        """Number of trial functions, which come before the virtual displacements."""
        return 0 if self.space is None else self.space.size

    @cached_property
    def points(self) -> np.ndarray:
        """Quadrature points x/L, followed by the stations."""
        return self.quadrature.points

    @cached_property
    def rule(self) -> np.ndarray:
        """Quadrature weights, followed by 1 for each station."""
        return self.quadrature.weights

    @property
    def coarse(self) -> None:
        """Indices of a coarser discretization's functions: None, because no equations are solved here."""
        return None

    @cached_property
    def samples(self) -> list[np.ndarray]:
        """Values of the functions and of each derivative at the points: (functions, points) each.

        At the stations, virtual displacements have the value 0; but the second derivative of a rotation has
        the weight of its delta function.
        """
        count, values = len(self.quadrature.stations.xi), []
        for order in range(self.derivatives + 1):
            sampled = self.evaluate(self.points, order)
            sampled[self.trials :, -count:] = 0.0
            values.append(sampled)
        if self.derivatives == 2:
            values[2][self.trials : self.trials + count, -count:] = self.length * np.eye(count)
        return values

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at the tip."""
        return self.evaluate(np.ones(1), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivative of each function (row) at xi, leaving out delta functions."""
        stations = self.quadrature.stations
        cut, least = stations.xi[:, None], stations.xi + np.where(stations.inboard, -_TOUCHING, _TOUCHING)
        moved = (np.asarray(xi) > least[:, None]).astype(float)  # 1 for points outboard of each cut
        flat = np.zeros_like(moved)
        parts = [] if self.space is None else [self.space.evaluate(xi, order)]
        if self.derivatives == 2:
            parts.append((self.length * (xi - cut) * moved, self.length * moved, flat)[order])
        return np.concatenate([*parts, moved if order == 0 else flat])

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate a weight times the `order`-th derivatives of all pairs of functions."""
        return self.product(self, weight, (order, order))

    def product(self, columns: CutSpace, weight: Profile, orders: tuple[int, int]) -> np.ndarray:
        """Integrate over x/L a weight times derivatives of functions of this space and of `columns`.

        `orders` are the orders of the two derivatives.  The product of two delta functions is left out.
        """
        rule = self.weights(weight)
        if orders == (2, 2):
            rule[-len(self.quadrature.stations.xi) :] = 0.0
        return (self.samples[orders[0]] * rule) @ columns.samples[orders[1]].T


@dataclass(frozen=True)
class CutSpaces:
    """Function spaces of a beam that is cut at stations.

    Parameters
    ----------
    spaces : Spaces
        Function spaces of the beam.
    quadrature : CutQuadrature
        Stations and quadrature rule.
    length : float
        Length of the beam [m].
    without : str
        Stiffness against a deformation that is not modelled, such as "axial_stiffness" for stretch; it has no
        trial functions.
    """

    spaces: Spaces
    quadrature: CutQuadrature
    length: float
    without: str
    _built: dict[RootConditions, CutSpace] = field(default_factory=dict, repr=False)

    def functions(self, conditions: RootConditions) -> CutSpace:
        """Build trial functions that satisfy conditions at the root, with the virtual displacements."""
        if conditions not in self._built:
            space = None if conditions.stiffness == self.without else self.spaces.functions(conditions)
            built = CutSpace(space, conditions.derivatives, self.quadrature, self.length)
            self._built[conditions] = built
        return self._built[conditions]

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate a weight times derivatives of two functions over x/L, for all pairs of functions.

        The rows of the result are functions with the root conditions `rows`, its columns are functions with
        the root conditions `columns`; `orders` are the orders of the two derivatives.
        """
        return self.functions(rows).product(self.functions(columns), weight, orders)

    @property
    def across(self) -> int:
        """Number of trial functions across the width of a plate, without the constant function."""
        return self.spaces.across

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width of a plate in the coarser discretization."""
        return self.spaces.fewer_across

    def shares_functions(self, other: CutSpaces) -> bool:
        """Return whether other spaces have the same trial functions and the same cuts."""
        same = np.array_equal(self.quadrature.points, other.quadrature.points)
        return same and self.spaces.shares_functions(other.spaces)
