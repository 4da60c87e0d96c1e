"""A discretized scene, with its equations and eigenproblem, and what steady rotation alone does to it."""

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
from beamdyn.equations.mass import axial_tension
from beamdyn.scene.mount import RIGHT_ANGLE, exact_cos_sin
from beamdyn.scene.validity import list_speeds, warn_of_static_deflection, warn_of_strain


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

    def of(self, scene: Scene) -> Model:
        """Model this beam and discretization with the physics, motion and damping of another scene."""
        return Model(replace(scene, beam=self.scene.beam), self.discretization)

    @cached_property
    def equations(self) -> Equations:
        """Equations of motion, linear about the straight beam; with matrices of sections about its axis."""
        if self.scene.beam.matrices is not None:
            return self.bent.about_straight
        return self._of_fields

    @cached_property
    def _of_fields(self) -> Equations:
        """Equations of motion by the fields of a straight beam."""
        check_axis(self.scene.beam, self.scene.physics)  # of an analysis that does not choose the physics
        beam = self.scene.modelled_beam
        scene = replace(self.scene, beam=beam) if self.scene.bends_in_space else self.scene
        return assemble_over(scene, self.discretization.spaces(beam))

    @cached_property
    def solver(self) -> Eigensolver:
        """Solver of the eigenproblem at steady speeds."""
        return self._deflected if self.scene.physics.large_deflection else solver_of(self.equations)

    @cached_property
    def _deflected(self) -> DeflectedSolver:
        """Solver of equations for deflections of any size."""
        from beamdyn.modes.modal.equilibrium import DeflectedSolver  # few scenes need it

        return DeflectedSolver(self.bent, self.scene.physics.branch)

    @cached_property
    def bent(self) -> RotatingBeam:
        """Equations of motion for deflections of any size, of a scene that has them."""
        # Few scenes need it.
        from beamdyn.equations.beam_in_space.rotating_beam import assemble_beam_in_space

        return assemble_beam_in_space(self.scene, self.discretization, self._of_fields)

    @cached_property
    def coarse_solver(self) -> Eigensolver:
        """Solver of the model compared with: where functions of this one span its own, over these."""
        if self.scene.physics.large_deflection:
            return self._deflected.guiding(self.compared.bent)
        if self.equations.coarse is None:
            return self.coarser.solver
        return solver_of(self.equations, self.equations.coarse)

    @property
    def exceeds_coarser(self) -> bool:
        """Whether each field has functions beyond those of the coarser model, which else says nothing of it.

        Where the coarser model has other functions, it is enough that they are fewer in all.
        """
        coarse = self.equations.coarse
        if coarse is None:
            return self.coarser.equations.size < self.equations.size
        added = np.ones(self.equations.size, dtype=bool)
        added[coarse] = False
        return all(added[block].any() for block in self.equations.blocks.values())

    def equations_at(self, speed: float) -> Equations:
        """Equations of small motions at a steady speed [rad/s], about the equilibrium there."""
        if not self.scene.physics.large_deflection:
            return self.equations
        return self._deflected.equations(np.array([speed]))[0]

    def static_tips(self, speeds: np.ndarray) -> np.ndarray:
        """Static deflections of the tip at steady speeds [rad/s] in each direction [m], shape (S, planes)."""
        if not self.scene.physics.large_deflection:
            return self.solver.solve_static(speeds, self.equations.tips)
        return self._deflected.tips(speeds)

    def over_strip(self, along: int, across: int) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Places of a mesh over a strip: x [m] (n,), eta from 1 to -1 (k,), and y = -eta b/2 [m] (n, k).

        None where the sections keep their shape, or their width is not known.
        """
        section = self.scene.beam.section
        if section is None or not self.scene.models_width:
            return None
        xi, eta = np.linspace(0, 1, along), np.linspace(1, -1, across)
        return self.scene.beam.length * xi, eta, np.outer(section.width(xi), -eta / 2)

    def modal_equations(self, basis: ModalBasis | int) -> Equations:
        """Transform the equations to the coordinates of a modal basis, or of a number of modes at rest.

        A harvester's circuit is added by its flux.
        """
        basis = ModalBasis(basis) if isinstance(basis, int) else basis
        return reduce_to_modes(self.equations, basis).with_flux()

    @cached_property
    def coarser(self) -> Model:
        """The coarser model, by whose results the error of this one is estimated."""
        return Model(self.scene, self.discretization.coarser())

    @property
    def lacks_one(self) -> bool:
        """Whether the model compared with has one function less in each field.

        Strains of a bent beam without breakpoints converge fast, and each function more costs much: further
        ones would only show how far the smaller model is from this one.
        """
        is_whole = isinstance(self.discretization, Ritz) and len(self.scene.modelled_beam.breakpoints) == 2
        return is_whole and self.scene.bends_in_space

    @cached_property
    def compared(self) -> Model:
        """The model by whose eigenvalues and equilibria the error of those of this one is estimated."""
        if self.lacks_one and isinstance(self.discretization, Ritz):
            return Model(
                self.scene, replace(self.discretization, functions=self.discretization.functions - 1)
            )
        return self.coarser


def kinetic_energy(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Parts of the coordinates in v^T M v of modes (S, n, k), twice their kinetic energy: (S, n, k)."""
    return np.real(vectors.conj() * (equations.matrices[2]["unity"] @ vectors))


def plane_share(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Share of the two directions in the kinetic energy of deflection of modes (S, n, k): (S, k, 2).

    The energy of other fields, such as the stretch, is not counted: the two add up to 1, or to 0 without any.
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
        Static tip deflection [m], its magnitude in two planes; nan from the critical speed on.
    strain : ndarray, shape (S,)
        Largest static axial strain; nan if the axial stiffness is not given.
    """
    beam, mount = model.scene.beam, model.scene.mount
    tips = model.static_tips(speeds)
    deflection = tips[:, 0] if tips.shape[1] == 1 else np.linalg.norm(tips, axis=1)
    if beam.axial_stiffness is None:
        return deflection, np.full(len(speeds), np.nan)
    n_a, n_b = axial_tension(beam)
    xi = np.linspace(0, 1, 101)
    cosine, _ = exact_cos_sin(mount.precone)
    force = cosine**2 * n_b(xi) - cosine * np.cos(mount.setting_angle) * mount.radius * n_a(xi)
    return deflection, np.abs(force / beam.axial_stiffness(xi)).max() * speeds**2


def warn_of_rotation(model: Model, speed: float) -> Iterator[Statement]:
    """Yield a warning if the rotation stretches or bends a beam by more than linear theory allows.

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
    """Yield a warning where the straight beam is unstable, which the rotation would have bent before."""
    lost = np.isnan(deflection)
    if lost.any() and bends(model):
        end = f" the straight beam is unstable; the rotation bends it before: the answer is {OUTSIDE}"
        yield Statement("at ", list_speeds(speeds, lost), end, kind=OUTSIDE)


def bends(model: Model) -> bool:
    """Whether a steady rotation loads the straight beam transversely, but for a misalignment of 1e-8 rad."""
    equations, scene = model.equations, model.scene
    load = np.abs(equations.steady().f2[equations.places(equations.deflecting)]).max(initial=0.0)
    along = max(np.abs(equations.P(d)).max() for d in range(scene.physics.planes))
    return bool(load > RIGHT_ANGLE * along * (scene.mount.radius + scene.beam.length))
