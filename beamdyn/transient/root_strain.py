"""Bending strain at the root during a run, with its time-integration error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.words import Words
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.root_moment import RootMoment, root_moment, strain_per_moment
from beamdyn.scene.names_elsewhere import GIVE_IT
from beamdyn.scene.physics import how_without_large_deflection
from beamdyn.scene.scene import Scene
from beamdyn.transient.beam_in_space_system import AnySystem, BeamInSpaceSystem
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import estimate_time_error
from beamdyn.transient.trajectory import Path, Trajectory

_TIMES_CHECKED = 257  # number of times at which the strain per unit of each coordinate is evaluated


@dataclass(frozen=True)
class RootStrain:
    """Bending strain of the outer fibre at the root, as a function of coordinates and velocities in a run.

    Parameters
    ----------
    system : ModalSystem
        Equations of motion of the run.
    moment : RootMoment
        Bending moment at the root.
    per_moment : float
        Strain per bending moment [1/(N m)].
    """

    system: ModalSystem
    moment: RootMoment
    per_moment: float

    @classmethod
    def of_scene(cls, scene: Scene, discretization: Discretization, system: AnySystem) -> RootStrain:
        """Build the strain for the coordinates of a scene's equations.

        A ValueError is raised for large deflection, a material that damps, or a beam without outer fibre.
        """
        if isinstance(system, BeamInSpaceSystem):
            bound = "the root strain of a beam with large deflection is not computed"
            remedy = how_without_large_deflection(scene.beam, scene.physics_choice is not None)
            raise InvalidValue("physics.large_deflection", True, bound, remedy)
        if scene.beam.outer_fibre is None:
            raise ValueError(Words("root_strain needs outer_fibre: ", GIVE_IT))
        if scene.damping.stiffness_factor:
            bound = "the strain of a material that damps is not a function of the moment alone"
            remedy = "give damping.ratios, or use frequency_response"
            factor = scene.damping.stiffness_factor
            raise InvalidValue("damping.stiffness_factor", factor, bound, remedy, "s")
        return cls(system, root_moment(scene, discretization, system.equations), strain_per_moment(scene))

    def at(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Evaluate the strain at T times t [s], with n coordinates q and velocities v (T, n): shape (T,)."""
        return self.per_moment * self.moment.at(self.system.root(t), q, v)

    def time_error(self, path: Path, of_tip: float) -> float:
        """Estimate the strain's time-integration error in a run from the error of the tip deflection [m].

        The result is nan if the error of the tip deflection is not known, and 0 if the beam stays in
        equilibrium.
        """
        if of_tip == 0 or not isinstance(path, Trajectory):
            return of_tip
        root = self.system.root(np.linspace(path.start, path.end, _TIMES_CHECKED))
        rows = np.zeros((_TIMES_CHECKED, self.system.size))  # strain per unit of each coordinate
        for quantity, row in self.moment.position.items():
            rows += np.outer(getattr(root, quantity), row)
        largest = self.per_moment * rows[None, np.abs(rows).sum(axis=1).argmax()]
        return estimate_time_error(self.system, path.segments, largest).total
