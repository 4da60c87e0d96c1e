"""A discretized scene, with its equations and eigenproblem, which are computed once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.equations_of_motion import Equations, assemble_equations
from beamdyn.modal.modal_basis import ModalBasis, reduce_to_modes
from beamdyn.modal.uncoupled import AnySolver, solver_of
from beamdyn.scene.scene import Scene


@dataclass(frozen=True)
class Model(FieldsOnly):
    """A discretized scene.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : Discretization
        Discretization of the beam.
    """

    scene: Scene
    discretization: Discretization

    @cached_property
    def equations(self) -> Equations:
        """Equations of motion."""
        return assemble_equations(self.scene, self.discretization)

    @cached_property
    def solver(self) -> AnySolver:
        """Solver of the eigenproblem at steady speeds."""
        return solver_of(self.equations)

    def modal_equations(self, basis: ModalBasis | int) -> Equations:
        """Transform the equations to the coordinates of a modal basis, or of a number of modes at rest."""
        return reduce_to_modes(self.equations, ModalBasis(basis) if isinstance(basis, int) else basis)

    @cached_property
    def coarser(self) -> Model:
        """The coarser model, by whose results the error of this one is estimated."""
        return Model(self.scene, self.discretization.coarser())
