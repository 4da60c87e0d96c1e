"""What a field is: unknown functions along the beam, with their terms in the equations of motion."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from beamdyn.equations.discretization import Space, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.scene.scene import Scene


@dataclass(frozen=True)
class Term:
    """One term of the left-hand side: factor * quantity(t) * matrix * (derivative of the coordinates).

    Parameters
    ----------
    name : str
        What it is.
    rows, columns : str
        Field in whose equations it stands, and field whose coordinates it multiplies.
    order : int
        Time derivative of the coordinates: 0 stiffness, 1 damping and gyroscopic, 2 mass.
    matrix : ndarray
        Its matrix.
    quantity : str
        Quantity of the `RootMotion` that multiplies it.
    factor : float
        A constant factor.
    """

    name: str
    rows: str
    columns: str
    order: int
    matrix: np.ndarray
    quantity: Quantity = "unity"
    factor: float = 1.0

    def coefficient(self, root: RootMotion) -> np.ndarray:
        """Its coefficient at the times of `root`."""
        return self.factor * getattr(root, self.quantity)


@dataclass(frozen=True)
class Load:
    """One term of the right-hand side: factor * quantity(t) * vector in the equations of one field."""

    name: str
    rows: str
    vector: np.ndarray
    quantity: Quantity
    factor: float = 1.0

    def coefficient(self, root: RootMotion) -> np.ndarray:
        """Its coefficient at the times of `root`."""
        return self.factor * getattr(root, self.quantity)


@dataclass(frozen=True)
class Deflection:
    """How the coordinates of a field deflect the beam: u(xi) = sum_j q_j (vectors.T phi(xi))_j.

    Parameters
    ----------
    space : Space
        The functions phi.
    vectors : ndarray, shape (n, m)
        Coefficients of the functions in the shape of each coordinate; the identity before a reduction.
    P : ndarray, shape (m,)
        Load under a unit root acceleration in the direction of bending [kg], over the coordinates.
    Q : ndarray, shape (m,)
        Load under a unit angular acceleration [kg m].
    """

    space: Space
    vectors: np.ndarray
    P: np.ndarray
    Q: np.ndarray

    def evaluate(self, xi: np.ndarray, order: int) -> np.ndarray:
        """Derivatives with respect to xi of the shapes at xi of shape (k,): shape (m, k)."""
        return self.vectors.T @ self.space.evaluate(xi, order)

    @property
    def tip(self) -> np.ndarray:
        """Tip deflection of a unit coordinate, shape (m,)."""
        return self.vectors.T @ self.space.end(0)

    def reduced(self, vectors: np.ndarray) -> Deflection:
        """The same in coordinates of which the present ones are `vectors` @ q_reduced."""
        P, Q = vectors.T @ self.P, vectors.T @ self.Q
        return replace(self, vectors=self.vectors @ vectors, P=P, Q=Q)


@dataclass(frozen=True)
class FieldEquations:
    """What a field contributes to the equations of a scene.

    Parameters
    ----------
    size : int
        Number of coordinates.
    terms : tuple of Term
        Left-hand side.
    loads : tuple of Load
        Right-hand side.
    deflection : Deflection or None
        How it deflects the beam; None for a field that does not.
    """

    size: int
    terms: tuple[Term, ...]
    loads: tuple[Load, ...]
    deflection: Deflection | None = None


class Field(ABC):
    """Base class of fields.

    In order to add a field, write a subclass in a module of its own in `beamdyn.equations.fields`, and
    name it in the list `FIELDS` there:

    1. `name` identifies it in `Term.rows` and `Term.columns`; nothing else reads it.
    2. `is_modelled` says whether a scene has it.  A scene without it does not pay for it.
    3. `assemble` takes the functions with the conditions at the root that the field needs from the
       discretization, ``spaces.functions(held)``, and returns the terms, the loads and, for a field that
       moves the beam transversely, the deflection of its coordinates.
    4. A term whose coefficient varies in time names a quantity of `RootMotion`; all analyses treat
       every quantity.  Its own stiffness, under the quantity "unity", is positive definite.
    5. A term that couples it with another field is written by one of the two, both halves.
    6. `explanations` says of each term and load, by name, how it is written, why it is there and what it
       needs, for `beamdyn.terms`.
    7. `complete` returns a scene in which every term of the field is there, for the same list.

    Discretizations, modal reductions, integrators, harmonic balance and results read the list of terms
    and know no field by its name or place.
    """

    name: ClassVar[str]
    explanations: ClassVar[Mapping[str, Explanation]]

    @abstractmethod
    def is_modelled(self, scene: Scene) -> bool:
        """Whether a scene has this field."""

    @abstractmethod
    def complete(self, scene: Scene) -> Scene:
        """The scene with this field, and with all that its terms need."""

    @abstractmethod
    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Terms and loads of this field in a scene; those with a factor of 0 may be included."""
