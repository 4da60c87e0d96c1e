"""Trial functions made for one beam, used for a nearby beam: one that differs little, with other breakpoints.

They serve to compute the small difference between the modes of the two beams.  To first order, it follows
from the difference of the matrices for the same functions.  Functions made anew for the nearby beam would
only add their rounding errors to this difference.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.discretization import ArcQuadrature, Cells, RootConditions, SampledSpace, SampledSpaces
from beamdyn.equations.moment_functions import MomentSpace, MomentSpaces
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import merge_breakpoints


@dataclass(frozen=True)
class NearbySpaces(FieldsOnly, SampledSpaces):
    """Function spaces that were made for one beam, and are used for a nearby beam.

    Parameters
    ----------
    given : MomentSpaces
        The function spaces, with the beam for which they were made.
    beam : Beam
        The nearby beam, with the modelled properties.
    """

    given: MomentSpaces
    beam: Beam

    def functions(self, conditions: RootConditions) -> NearbySpace:
        """Return those trial functions of the original beam that satisfy conditions at the root."""
        return _build_space(self, conditions)

    @property
    def across(self) -> int:
        """Number of functions across the width of a plate, without the constant one."""
        return self.given.across

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width of a plate in the coarser basis."""
        return self.given.fewer_across

    def shares_functions(self, other: NearbySpaces) -> bool:
        """Whether other spaces have functions that were made for the same beam."""
        return self.given.shares_functions(other.given)

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule on cells within which the functions and the properties of the nearby beam are smooth."""
        cells = self.given.quadrature.cells
        ends = merge_breakpoints(np.concatenate([cells.ends, self.beam.breakpoints]))
        return ArcQuadrature(Cells(np.array(ends), cells.points))


@lru_cache(maxsize=16)  # cached, as several fields of a scene use the same functions
def _build_space(spaces: NearbySpaces, conditions: RootConditions) -> NearbySpace:
    return NearbySpace(spaces, spaces.given.functions(conditions))


@dataclass(frozen=True)
class NearbySpace(SampledSpace):
    """Trial functions that were made for one beam, and are used for a nearby beam.

    Parameters
    ----------
    spaces : NearbySpaces
        The function spaces, with the nearby beam.
    given : MomentSpace
        The functions on the beam for which they were made.
    """

    spaces: NearbySpaces
    given: MomentSpace

    @cached_property
    def samples(self) -> list[np.ndarray]:
        """Values of the functions and of each derivative at the Gauss points, (functions, points) each."""
        orders = range(self.given.conditions.derivatives + 1)
        return [self.given.evaluate(self.points, order) for order in orders]

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span the coarser discretization (the first ones); None if none do."""
        return self.given.coarse

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at the tip."""
        return self.given.end(order)

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at k positions xi: (functions, k)."""
        return self.given.evaluate(xi, order)
