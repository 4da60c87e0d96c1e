"""What a discretization supplies: function spaces on a beam, which integrate and evaluate."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile


class Space(Protocol):
    """Trial functions phi_i of xi = x/L on [0, 1] that satisfy the conditions at the root."""

    @property
    def size(self) -> int:
        """Number n of functions."""
        ...

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrals over xi of weight times the `order`-th derivatives of phi_i and phi_j: shape (n, n)."""
        ...

    def load(self, weight: Profile) -> np.ndarray:
        """Integrals over xi of weight times phi_i: shape (n,)."""
        ...

    def end(self, order: int) -> np.ndarray:
        """Derivatives of phi_i at the tip: shape (n,)."""
        ...

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives of phi_i at xi of shape (k,): shape (n, k)."""
        ...


class Spaces(Protocol):
    """The function spaces of one discretization of one beam."""

    def functions(self, held: int) -> Space:
        """Functions whose derivatives 0 ... held - 1 vanish at the root.

        Parameters
        ----------
        held : int
            2 for a clamped deflection (value and slope), 1 for a stretch (value).  The derivative of this
            order is square-integrable.
        """
        ...

    def product(self, weight: Profile, rows: int, columns: int) -> np.ndarray:
        """Integrals over xi of weight times function i of `functions(rows)`, j of `functions(columns)`."""
        ...


class Discretization(Protocol):
    """A way to discretize a beam, such as `Ritz` or `Fem`.

    In order to add a discretization, write a class in a module of its own:

    1. It is a frozen dataclass of its sizes: it stands in the provenance of results, where its `repr`
       says what was computed, and it is hashed and pickled.
    2. `spaces(beam)` returns the function spaces (`Spaces`).  They have a breakpoint, or a node, at each
       of `beam.breakpoints`, so that integrals are exact where a property jumps.
    3. All physics is in the fields (`beamdyn.equations.fields`): a space only integrates and evaluates.
    4. `coarser` and `finer` make a sequence.  The error of a result is estimated by its distance from that
       of `coarser`; a tolerance is met by going along `finer`.
    5. `order` is the order of convergence if it is a power of the size, for Richardson extrapolation.
    6. An instance is passed as ``discretization=`` to any analysis.  To be chosen by name, it needs a line
       in `beamdyn.modal.choice`.
    """

    @property
    def order(self) -> int | None:
        """Order of convergence of eigenvalues as the size doubles; None where it is not a power."""
        ...

    @property
    def rounding(self) -> float:
        """Relative rounding error of eigenvalues by its own integrals."""
        ...

    def spaces(self, beam: Beam) -> Spaces:
        """The function spaces on a beam."""
        ...

    def coarser(self) -> Discretization:
        """A less accurate one, whose distance estimates the error of this one."""
        ...

    def finer(self) -> Discretization | None:
        """The next more accurate one; None at the largest."""
        ...

    def fits(self, modes: int) -> bool:
        """Whether the coarser one has functions enough for a number of modes."""
        ...
