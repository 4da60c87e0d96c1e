"""A scene with its discretization, equations and eigensolver, and its static response to steady rotation."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.eigenproblem import Eigensolver
from beamdyn.modes.modal.modal_basis import ModalBasis, reduce_to_modes
from beamdyn.modes.modal.uncoupled import solver_of
from beamdyn.scene.scene import Scene, check_axis

if TYPE_CHECKING:
    from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
    from beamdyn.modes.modal.equilibrium import DeflectedSolver
from collections.abc import Iterator

from beamdyn.common.results.statements import OUTSIDE, Statement
from beamdyn.equations.mass import PLACES, steady_tension
from beamdyn.scene.mount import RIGHT_ANGLE
from beamdyn.scene.validity import list_speeds, warn_of_static_deflection, warn_of_strain


@dataclass(frozen=True)
class Model(FieldsOnly):
    """A scene with its discretization; equations and eigensolver are built when asked for.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : Discretization
        Discretization of the beam.
    """

    scene: Scene
    discretization: Discretization

    def of(self, scene: Scene) -> Model:
        """Model this beam and discretization with physics, motion and damping of another scene."""
        return Model(replace(scene, beam=self.scene.beam), self.discretization)

    @cached_property
    def equations(self) -> Equations:
        """Equations of motion, linear about the straight beam or, with section matrices, about its axis."""
        if self.scene.beam.matrices is not None:
            return self.bent.about_straight
        return self._of_fields

    @cached_property
    def _of_fields(self) -> Equations:
        """Equations of motion built from the fields of the straight beam."""
        if self.scene.chooses_physics:  # other scenes have been checked: a curved axis needs other equations
            check_axis(self.scene.beam, self.scene.physics)
        beam = self.scene.modelled_beam
        scene = replace(self.scene, beam=beam) if self.scene.bends_in_space else self.scene
        return assemble_over(scene, self.discretization.spaces(beam))

    @cached_property
    def solver(self) -> Eigensolver:
        """Solver of the eigenproblem at steady speeds."""
        return self._deflected if self.scene.physics.large_deflection else solver_of(self.equations)

    @cached_property
    def _deflected(self) -> DeflectedSolver:
        """Eigensolver about equilibria of any deflection."""
        from beamdyn.modes.modal.equilibrium import DeflectedSolver  # imported here, as few scenes need it

        return DeflectedSolver(self.bent, self.scene.physics.branch)

    @cached_property
    def bent(self) -> RotatingBeam:
        """Equations of motion for deflections of any size, of a scene with large deflection."""
        # Imported here, as few scenes need it.
        from beamdyn.equations.beam_in_space.rotating_beam import assemble_beam_in_space

        return assemble_beam_in_space(self.scene, self.discretization, self._of_fields)

    @cached_property
    def coarse_solver(self) -> Eigensolver:
        """Eigensolver of the coarser model that error estimates compare with."""
        if self.scene.physics.large_deflection:
            return self._deflected.guiding(self.compared.bent)
        if self.equations.coarse is None:
            return self.coarser.solver
        return solver_of(self.equations, self.equations.coarse)

    @property
    def exceeds_coarser(self) -> bool:
        """Whether each field has functions beyond the coarser model's, as the error estimate needs.

        Where the coarser model has different functions, it is enough that it has fewer in total.
        """
        coarse = self.equations.coarse
        if coarse is None:
            return self.coarser.equations.size < self.equations.size
        added = np.ones(self.equations.size, dtype=bool)
        added[coarse] = False
        return all(added[block].any() for block in self.equations.blocks.values())

    def equations_at(self, speed: float) -> Equations:
        """Build the equations of small motions at a steady speed [rad/s], about the equilibrium there."""
        if not self.scene.physics.large_deflection:
            return self.equations
        return self._deflected.equations(np.array([speed]))[0]

    def static_tips(self, speeds: np.ndarray) -> np.ndarray:
        """Compute static tip deflections [m] at steady speeds [rad/s] in each direction: (S, planes)."""
        if not self.scene.physics.large_deflection:
            return self.solver.solve_static(speeds, self.equations.tips)
        return self._deflected.tips(speeds)

    def over_strip(self, along: int, across: int) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Compute mesh points over a strip: x [m] (n,), eta from 1 to -1 (k,), and y = -eta b/2 [m] (n, k).

        Returns None where the sections keep their shape, or their width is not known.
        """
        section = self.scene.beam.strip
        if section is None or not self.scene.models_width:
            return None
        xi, eta = np.linspace(0, 1, along), np.linspace(1, -1, across)
        return self.scene.beam.length * xi, eta, np.outer(section.width(xi), -eta / 2)

    def modal_equations(self, basis: ModalBasis | int) -> Equations:
        """Transform the equations to the coordinates of a modal basis, or of a number of modes at rest.

        A harvester's circuit is added, with the flux as its coordinate.
        """
        basis = ModalBasis(basis) if isinstance(basis, int) else basis
        return reduce_to_modes(self.equations, basis).with_flux()

    @cached_property
    def coarser(self) -> Model:
        """The coarser model, whose results serve to estimate the error of this model."""
        return Model(self.scene, self.discretization.coarser())

    @property
    def lacks_one(self) -> bool:
        """Whether the model that errors are estimated from has just one function less in each field.

        This holds for beams that bend in space, without inner breakpoints: their strains converge fast and
        functions are costly; the distance from a much smaller model would only show the error of that.
        """
        is_whole = isinstance(self.discretization, Ritz) and len(self.scene.modelled_beam.breakpoints) == 2
        return is_whole and self.scene.bends_in_space

    @cached_property
    def compared(self) -> Model:
        """The model from whose eigenvalues and equilibria the error of this model is estimated."""
        if self.lacks_one and isinstance(self.discretization, Ritz):
            return Model(
                self.scene, replace(self.discretization, functions=self.discretization.functions - 1)
            )
        return self.coarser


def kinetic_energy(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Compute the part of each coordinate in the kinetic energy of modes (S, n, k): (S, n, k)."""
    return np.real(vectors.conj() * (equations.matrices[2]["unity"] @ vectors))


def plane_share(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Compute the shares of two directions in the deflection's kinetic energy of modes (S, n, k): (S, k, 2).

    The energy of other fields, such as the stretch, is not counted: shares add up to 1, or to 0 without any.
    """
    if equations.planes == 1:
        return np.stack([np.ones(vectors[:, 0].shape), np.zeros(vectors[:, 0].shape)], axis=2)
    energy, planes = kinetic_energy(equations, vectors), [[], []]
    for name in equations.deflecting:
        planes[equations.deflections[name].direction].append(name)
    first, second = (energy[:, equations.places(names)].sum(axis=1) for names in planes)
    total = first + second
    return np.stack([first, second], axis=2) / np.where(total == 0, 1.0, total)[..., None]


def static_load(model: Model, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute the static tip deflection and axial strain by rotation.

    Parameters
    ----------
    model : Model
        A discretized scene.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    deflection : ndarray, shape (S,)
        Static tip deflection [m], in two planes its magnitude; nan from the critical speed on.
    strain : ndarray, shape (S,)
        Largest static axial strain; nan if the axial stiffness is not given.
    """
    beam, tips = model.scene.beam, model.static_tips(speeds)
    deflection = tips[:, 0] if tips.shape[1] == 1 else np.linalg.norm(tips, axis=1)
    if beam.axial_stiffness is None:
        return deflection, np.full(len(speeds), np.nan)
    strain = steady_tension(beam, model.scene.mount) / beam.axial_stiffness(PLACES)
    return deflection, np.abs(strain).max() * speeds**2


def warn_of_rotation(model: Model, speed: float) -> Iterator[Statement]:
    """Yield a warning if rotation stretches or bends the beam beyond linear theory.

    Parameters
    ----------
    model : Model
        A discretized scene.
    speed : float
        Speed [rad/s].
    """
    speeds = np.array([speed])
    deflection, strain = static_load(model, speeds)
    yield from warn_of_strain(float(strain[0]))
    yield from warn_of_static_deflection(deflection, model.scene.beam.length, speeds)
    yield from warn_of_straight(deflection, speeds, model)


def warn_of_straight(deflection: np.ndarray, speeds: np.ndarray, model: Model) -> Iterator[Statement]:
    """Yield a warning at speeds where the straight beam is unstable, as rotation would bend it before."""
    lost = np.isnan(deflection)
    if lost.any() and bends(model):
        end = f" the straight beam is unstable; the rotation bends it before: the answer is {OUTSIDE}"
        yield Statement("at ", list_speeds(speeds, lost), end, kind=OUTSIDE)


def bends(model: Model) -> bool:
    """Whether steady rotation loads the straight beam transversely, misalignments of 1e-8 rad aside."""
    equations, scene = model.equations, model.scene
    load = np.abs(equations.steady().f2[equations.places(equations.deflecting)]).max(initial=0.0)
    along = max(np.abs(equations.P(d)).max() for d in range(scene.physics.planes))
    return bool(load > RIGHT_ANGLE * along * (scene.mount.radius + scene.beam.length))
