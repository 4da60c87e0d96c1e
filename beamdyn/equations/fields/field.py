"""Interface of displacement fields: unknown functions along the beam, with terms in the equations.

In shapes of arrays, n counts coordinates, k positions along the beam, and l across it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from beamdyn.equations.discretization import Functions, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.scene.scene import Scene


@dataclass(frozen=True, eq=False)
class Term:
    """Term of the left-hand side: factor * quantity(t) * matrix * (time derivative of coordinates).

    Parameters
    ----------
    name : str
        Name in `beamdyn.terms`.
    rows, columns : str
        Field whose equations contain the term, and field whose coordinates it multiplies.
    order : int
        Order of the time derivative: 0 stiffness, 1 damping and gyroscopic, 2 mass.
    matrix : ndarray, shape (coordinates, coordinates)
        Matrix over the coordinates of the two fields.
    quantity : str
        Quantity of `RootMotion` that multiplies the matrix.
    factor : float
        Constant factor.
    """

    name: str
    rows: str
    columns: str
    order: int
    matrix: np.ndarray
    quantity: Quantity = "unity"
    factor: float = 1.0

    def coefficient(self, root: RootMotion) -> np.ndarray:
        """Compute factor times quantity at all times of the root's motion."""
        return self.factor * getattr(root, self.quantity)


@dataclass(frozen=True, eq=False)
class Load:
    """Term of the right-hand side: factor * quantity(t) * vector in the equations of the field `rows`."""

    name: str
    rows: str
    vector: np.ndarray
    quantity: Quantity
    factor: float = 1.0

    def coefficient(self, root: RootMotion) -> np.ndarray:
        """Compute factor times quantity at all times of the root's motion."""
        return self.factor * getattr(root, self.quantity)


@dataclass(frozen=True, eq=False)
class Deflection:
    """Transverse deflection of the beam by one field: trial functions, and loads on them.

    Parameters
    ----------
    space : Functions
        Functions phi_i of x/L.
    P : ndarray, shape (n,)
        Load under a unit root acceleration in the direction of the deflection [kg].
    Q, Q_across : ndarray, shape (n,)
        Loads under a unit angular acceleration in the plane of the deflection, and in the other plane [kg m].
    direction : int
        Direction of the deflection: 0 for the one that the mount's bending angle gives, 1 for the one that is
        perpendicular to it and to the beam.
    """

    space: Functions
    P: np.ndarray
    Q: np.ndarray
    Q_across: np.ndarray
    direction: int = 0


class SectionFunctions(Protocol):
    """Functions of a field that deform a strip's cross-sections: deflections that vary over its width.

    `of_strip` is whether the width is known.
    """

    of_strip: ClassVar[bool]

    @property
    def of_each(self) -> int:
        """Number of coordinates of each function across the width; they are consecutive."""
        ...

    @property
    def corner(self) -> np.ndarray:
        """Deflection of the tip's corner 2 y/width = 1 per unit of each coordinate.

        If the width is unknown, it is the twist [rad].
        """
        ...

    def evaluate(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Evaluate the functions at k positions x/L and l positions 2 y/width across: (functions, k, l)."""
        ...

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """Evaluate second derivatives with respect to 2 y/width, averaged over the width, at x/L."""
        ...


class Coordinates(Protocol):
    """The part of the interface of trial functions (`Space`) that the equations of motion use."""

    @property
    def size(self) -> int:
        """Number of trial functions."""
        ...

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span the coarser discretization; None where no subset does."""
        ...


@dataclass(frozen=True, eq=False)
class FieldEquations:
    """Contribution of a field to the equations of motion of a scene.

    Parameters
    ----------
    space : Coordinates
        Trial functions; the coordinates are their coefficients.
    terms : tuple of Term
        Terms of the left-hand side.
    loads : tuple of Load
        Terms of the right-hand side.
    deflection : Deflection or None
        Deflection of the beam by the coordinates; None for a field without deflection.
    turns_at_root : bool
        Whether the first coordinate is a rigid rotation of the beam about its root.
    sections : SectionFunctions or None
        Deflection over a strip's width by the coordinates; None for a field that does not deform sections.
    """

    space: Coordinates
    terms: tuple[Term, ...]
    loads: tuple[Load, ...]
    deflection: Deflection | None = None
    turns_at_root: bool = False
    sections: SectionFunctions | None = None


class Field(ABC):
    """Base class of fields: unknown functions along the beam, such as bending.

    In order to add a field, write a subclass in a module of its own in `beamdyn.equations.fields`, and
    name it in the list `FIELDS` there:

    1. `name` identifies the field in `Term.rows` and `Term.columns`.
    2. `requires` has the values of `Physics` with which a scene has the field, or `is_modelled` decides
       whether it has.  A scene without the field needs no extra computing time.
    3. `assemble` takes functions that satisfy the conditions at the root from the discretization, by
       ``spaces.functions(conditions)``, and returns the terms, the loads and, for a field that deflects the
       beam transversely, the `Deflection`; and for a field that deforms the cross-sections, the functions
       over them (`sections`), by which shapes are drawn as surfaces.  `kinds_of_modes` in
       `beamdyn.modes.modal.model` has the name of its kind of modes.
    4. A term whose coefficient varies in time names a quantity of `RootMotion`; all analyses treat
       every quantity.  The field's stiffness at rest, of the quantity "unity", is positive definite; only a
       field that `turns_at_root` may lack stiffness against its first coordinate.
    5. Of two coupled fields, one supplies the coupling terms in the equations of both.
    6. `explanations` has, by the name of each term and load, its symbol, the reason for its presence and its
       conditions, for `beamdyn.terms`.
    7. Damping is added to all fields (`beamdyn.equations.assembly`), under the name `damping_name`.
    8. `complete` returns a scene in which every term of the field is present, for `beamdyn.terms`.

    Discretizations, modal reductions, integrators, harmonic balance and results read the list of terms
    and do not depend on which fields there are.
    """

    name: ClassVar[str]
    damping_name: ClassVar[str] = "damping"
    explanations: ClassVar[Mapping[str, Explanation]]
    requires: ClassVar[Mapping[str, object]] = {}

    def is_modelled(self, scene: Scene) -> bool:
        """Return whether the model of a scene includes this field."""
        physics = scene.physics
        return all(getattr(physics, name) == value for name, value in self.requires.items())

    def complete(self, scene: Scene) -> Scene:
        """Return the scene, extended so that every term of this field is nonzero; by default unchanged."""
        return scene

    @abstractmethod
    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble the terms and loads of this field; terms with the factor 0 may be included."""
