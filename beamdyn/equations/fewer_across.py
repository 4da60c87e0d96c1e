"""A discretization with fewer functions across the width of plates than another, to estimate its error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.equations.discretization import Cells, Discretization, RootConditions, Space, Spaces
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile

_FEWER = 2  # number of functions across the width that are left out: one of torsion, one of camber
_LEAST = 2  # smallest number of functions across the width that remain


@dataclass(frozen=True)
class FewerAcross:
    """Discretization with the same functions along the beam as another one, but two fewer across its width.

    Parameters
    ----------
    whole : Discretization
        The other discretization, with all functions across the width.
    """

    whole: Discretization

    @property
    def order(self) -> int | None:
        """Order of convergence of eigenvalues along the beam: see `Discretization`."""
        return self.whole.order

    @property
    def converges_regularly(self) -> bool:
        """Whether the changes of an eigenvalue decrease steadily from refinement to refinement."""
        return self.whole.converges_regularly

    @property
    def rounding(self) -> float:
        """Relative rounding error of eigenvalues that is caused by the integrals."""
        return self.whole.rounding

    def spaces(self, beam: Beam) -> SpacesOfFewer:
        """Build the function spaces on a beam, one for each kind of boundary condition."""
        return SpacesOfFewer(self.whole.spaces(beam))

    def has_fewer_of_both(self, beam: Beam) -> bool:
        """Return whether two functions across the width are left out; in a small basis it is one or none."""
        return self.whole.spaces(beam).across >= _LEAST + _FEWER

    def cells(self, beam: Beam) -> Cells:
        """Divide a beam into cells on which the functions are smooth."""
        return self.whole.cells(beam)

    def coarser(self) -> FewerAcross:
        """Return a discretization that is coarser along the beam."""
        return FewerAcross(self.whole.coarser())

    def finer(self) -> FewerAcross | None:
        """Return a discretization that is finer along the beam; None if there is none."""
        finer = self.whole.finer()
        return None if finer is None else FewerAcross(finer)

    def fits(self, modes: int) -> bool:
        """Return whether both this discretization and `coarser` have enough functions for so many modes."""
        return self.whole.fits(modes)


@dataclass(frozen=True)
class SpacesOfFewer:
    """Function spaces like given ones, but with two functions fewer across the width of a plate.

    Parameters
    ----------
    whole : Spaces
        The other function spaces, with all functions across the width.
    """

    whole: Spaces

    def functions(self, conditions: RootConditions) -> Space:
        """Build trial functions that satisfy conditions at the root."""
        return self.whole.functions(conditions)

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate a weight times derivatives of two functions over x/L, for all pairs of functions.

        The rows of the result are functions with the root conditions `rows`, its columns are functions with
        the root conditions `columns`; `orders` are the orders of the two derivatives.
        """
        return self.whole.product(weight, rows, columns, orders)

    @property
    def across(self) -> int:
        """Number of functions across the width of a plate, without the constant one."""
        return max(_LEAST, self.whole.across - _FEWER)

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width of a plate in the coarser discretization."""
        return max(_LEAST, self.whole.fewer_across - _FEWER)

    def shares_functions(self, other: SpacesOfFewer) -> bool:
        """Whether other spaces have the same functions, whatever their Gauss rule."""
        return self.whole.shares_functions(other.whole)
