"""Interface of discretizations: function spaces on a beam, which integrate and evaluate."""

from __future__ import annotations

from typing import NamedTuple, Protocol, Self

import numpy as np

from beamdyn.equations.quadrature import Cells
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile


class RootConditions(NamedTuple):
    """Conditions at the root and smoothness of trial functions.

    Parameters
    ----------
    held : int
        Number of derivatives, from the value on, that vanish at the root.
    derivatives : int
        Highest order of derivative that is square-integrable.
    stiffness : str
        Property of the sections that resists that derivative, to which functions may be adapted.
    direction : int
        Direction of the displacement across the beam, 0 or 1.
    """

    held: int
    derivatives: int
    stiffness: str = ""
    direction: int = 0


CLAMPED = RootConditions(2, 2)  # a deflection without slope at the root
HINGED = RootConditions(1, 2)  # a deflection that may turn about the root, by its first function
FIXED = RootConditions(1, 1)  # a displacement, such as the stretch


class Functions(Protocol):
    """Functions phi_i of xi = x/L on [0, 1]."""

    @property
    def size(self) -> int:
        """Number n of functions."""
        ...

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of phi_i at the tip: shape (n,)."""
        ...

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives of phi_i at xi of shape (k,): shape (n, k)."""
        ...


class Space(Functions, Protocol):
    """Trial functions phi_i that satisfy the boundary conditions at the root."""

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span those of the coarser discretization; None where no few do."""
        ...

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate over xi the weight times the `order`-th derivatives of phi_i and phi_j: shape (n, n)."""
        ...

    def load(self, weight: Profile, order: int = 0) -> np.ndarray:
        """Integrate over xi the weight times the `order`-th derivative of phi_i: shape (n,)."""
        ...


class Spaces(Protocol):
    """The function spaces of one discretization of one beam."""

    def functions(self, conditions: RootConditions) -> Space:
        """Trial functions that satisfy conditions at the root.

        Those of `HINGED` are one with a slope at the root, then those of `CLAMPED`.
        """
        ...

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate over xi the weight times derivatives of function i of `rows` and j of `columns`."""
        ...

    @property
    def across(self) -> int:
        """Number of functions across the width of a plate beyond the mean."""
        ...

    @property
    def fewer_across(self) -> int:
        """Number of those of the coarser discretization."""
        ...

    def shares_functions(self, other: Self) -> bool:
        """Whether the functions are those of other spaces of the same kind, but for the quadrature."""
        ...


class Discretization(Protocol):
    """A discretization of a beam, such as `Ritz` or `Fem`.

    In order to add a discretization, write a class in a module of its own:

    1. It is a frozen dataclass of its sizes: it is hashed and pickled, and its `repr` stands in the
       provenance of results.
    2. `spaces(beam)` returns the function spaces (`Spaces`).  They have a breakpoint, or a node, at each
       of `beam.breakpoints`, so that integrals are exact where a property jumps.  Results keep them:
       dataclasses of numbers and arrays, which compute the rest when asked (`FieldsOnly`), are pickled and
       saved with a result.
    3. All physics is in the fields (`beamdyn.equations.fields`): a space only integrates and evaluates.
    4. `coarser` and `finer` make a sequence.  The truncation error of a result is estimated by its distance
       from that of `coarser`; a tolerance is met by repeating `finer`.  Where functions of a space span those
       of the coarser one, its `coarse` names them, and the coarser equations are a part of these.
    5. `order` is the order of convergence, for Richardson extrapolation, if the error is a power of the size;
       `converges_regularly` says whether the estimate needs no further margin.
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
        """Order p of convergence of eigenvalues, whose error is as size^-p; None if it is not a power."""
        ...

    @property
    def converges_regularly(self) -> bool:
        """Whether further functions change an eigenvalue ever less, rather than by fits and starts."""
        ...

    @property
    def rounding(self) -> float:
        """Relative rounding error of eigenvalues due to the integrals of the discretization."""
        ...

    def spaces(self, beam: Beam) -> Spaces:
        """The function spaces on a beam."""
        ...

    def cells(self, beam: Beam) -> Cells:
        """Parts of the beam on which the functions are smooth, for integrals of large deflections."""
        ...

    def coarser(self) -> Discretization:
        """A coarser discretization, from whose results those of this one differ by about their error."""
        ...

    def finer(self) -> Discretization | None:
        """The next finer discretization; None at the largest."""
        ...

    def fits(self, modes: int) -> bool:
        """Whether the coarser discretization has functions enough for a number of modes."""
        ...
