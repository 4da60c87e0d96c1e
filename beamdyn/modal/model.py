"""A scene in one discretization, with what is computed from it once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from beamdyn.equations.discretization import Discretization
from beamdyn.equations.equations_of_motion import Equations, assemble_equations
from beamdyn.modal.eigen import Solver
from beamdyn.modal.modal_basis import ModalBasis, reduce_to_modes
from beamdyn.scene.scene import Scene


@dataclass(frozen=True)
class Model:
    """A scene in one discretization.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : Discretization
        Its discretization.
    """

    scene: Scene
    discretization: Discretization

    @cached_property
    def equations(self) -> Equations:
        """The equations of motion."""
        return assemble_equations(self.scene, self.discretization)

    @cached_property
    def solver(self) -> Solver:
        """The eigenproblem at steady speed."""
        return Solver(self.equations.steady())

    def modal_equations(self, basis: ModalBasis | int) -> Equations:
        """The equations in the coordinates of a modal basis, or of a number of modes at rest."""
        return reduce_to_modes(self.equations, ModalBasis(basis) if isinstance(basis, int) else basis)

    @cached_property
    def coarser(self) -> Model:
        """The coarser model, whose distance estimates the error of this one."""
        return Model(self.scene, self.discretization.coarser())
