"""A scene with its discretization, equations and eigensolver, and its static response to steady rotation.

A modal basis has the lowest modes of the beam at rest, or at the slowest and fastest speed of a motion.
The papers use modes at rest, which converge slowly under rotation.  Modes at the slowest and the fastest
speed together reproduce the frequencies at both, and nearly those between.

The kind of a mode (bending, torsion, camber) is the one with the largest kinetic energy.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.inputs.checks import count
from beamdyn.common.results.one_line import counted
from beamdyn.common.results.result import Result
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.common.results.statements import OUTSIDE, Statement
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.circuit import coupling_of
from beamdyn.equations.discretization import Discretization, Spaces
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.equations.mass import sampled_axial_stiffness, steady_tension
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.eigenproblem import Eigensolver, LeadingSolver, Solver
from beamdyn.modes.modal.solvers import solver_of
from beamdyn.scene.motion.base import Motion
from beamdyn.scene.mount import RIGHT_ANGLE
from beamdyn.scene.scene import Scene, check_axis
from beamdyn.scene.validity import list_speeds, warn_of_static_deflection, warn_of_strain

if TYPE_CHECKING:
    from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
    from beamdyn.modes.modal.equilibrium import DeflectedSolver

_MANY = 100  # number of coordinates of a mesh, above which it is worth computing a coarser one first


@dataclass(frozen=True)
class Model(FieldsOnly):
    """Scene with its discretization; equations and eigensolver are built at their first use.

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
        """Return a model of this beam, with this discretization, for all other data of another scene."""
        return Model(replace(scene, beam=self.scene.beam), self.discretization)

    @cached_property
    def equations(self) -> Equations:
        """Equations of motion, linear about the straight beam or, with section matrices, its curved axis."""
        return self.over() if self.scene.beam.matrices is None else self.bent.about_straight

    def over(self, spaces: Spaces | None = None) -> Equations:
        """Build the equations of motion of the straight beam, in given functions or the discretization's.

        For large deflection, finite elements have coordinates in which their stiffness is well-conditioned.
        """
        if self.scene.chooses_physics:  # `Scene` skips this check for physics "auto"
            check_axis(self.scene.beam, self.scene.physics)
        bent = self.scene.bends_in_space
        scene = replace(self.scene, beam=self.scene.modelled_beam) if bent else self.scene
        straight = assemble_over(scene, spaces or self.discretization.spaces(self.scene.modelled_beam))
        if self.scene.physics.large_deflection and self.discretization.order is not None:
            return straight.of_unit_stiffness()
        return straight

    @cached_property
    def coupling(self) -> dict[str, np.ndarray]:
        """Work of the piezoelectric layers' moment under unit voltage, per function of each field."""
        return coupling_of(self.scene.beam, self.equations.deflections, self.equations.sections)

    @cached_property
    def solver(self) -> Eigensolver:
        """Solver of the eigenproblem at steady speeds."""
        return self.deflected if self.scene.physics.large_deflection else solver_of(self.equations)

    @cached_property
    def deflected(self) -> DeflectedSolver:
        """Eigensolver for small motions about equilibria with any deflection.

        Equilibria of many elements are found near those of the coarser mesh, whose steps cost far less.
        """
        # The import is inside the function because few scenes need the module.
        from beamdyn.modes.modal.equilibrium import DeflectedSolver

        guide = self.coarser.deflected if self._has_many_elements else None
        return DeflectedSolver(self.bent, self.scene.physics.branch, guide)

    @property
    def _has_many_elements(self) -> bool:
        return self.discretization.order is not None and self.equations.size > _MANY

    @cached_property
    def bent(self) -> RotatingBeam:
        """Equations of motion for arbitrarily large deflections, of a scene with large deflection."""
        # The import is inside the function because few scenes need the module.
        from beamdyn.equations.beam_in_space.rotating_beam import assemble_beam_in_space

        straight = self.equations if self.scene.beam.matrices is None else self.over()
        return assemble_beam_in_space(self.scene, self.discretization, straight)

    @cached_property
    def coarse_solver(self) -> Eigensolver:
        """Eigensolver of the coarser model that error estimates use for comparison."""
        if self.scene.physics.large_deflection:
            if self._has_many_elements:
                return self.coarser.deflected
            return self.deflected.guiding(self.compared.bent)
        coarse = self.equations.coarse
        if coarse is None:
            return self.coarser.solver
        if type(self.solver) is Solver and coarse[-1] + 1 == len(coarse):
            return LeadingSolver(self.solver, len(coarse))
        return solver_of(self.equations, coarse)

    @property
    def exceeds_coarser(self) -> bool:
        """Whether each field has functions beyond the coarser model's, as the error estimate needs.

        Fields of a strip need them both along it and across.  If the coarser model has different functions,
        it suffices that it has fewer in total.
        """
        coarse = self.equations.coarse
        if coarse is None:
            return self.coarser.equations.size < self.equations.size
        kept, blocks = {*coarse.tolist()}, self.equations.blocks
        if self.scene.models_width:  # coordinates of the last function across come last
            of_last = ((blocks[name].stop, f.of_each) for name, f in self.equations.sections)
            if any(kept.intersection(range(end - count, end)) for end, count in of_last):
                return False
        return not any(kept.issuperset(range(b.start, b.stop)) for b in blocks.values())

    def equations_at(self, speed: float) -> Equations:
        """Build the equations of small motions at a steady speed [rad/s], about the equilibrium there."""
        if not self.scene.physics.large_deflection:
            return self.equations
        return self.bent.at(self.deflected.equilibria(np.array([speed]))[0]).linearized()

    def static_tips(self, speeds: np.ndarray) -> np.ndarray:
        """Compute static tip deflections [m] at steady speeds [rad/s] in each direction: (S, planes)."""
        if not self.scene.physics.large_deflection:
            return self.solver.solve_static(speeds, self.equations.tips)
        return self.deflected.tips(speeds)

    def over_strip(self, along: int, across: int) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Compute n x k mesh points over a strip: x [m], eta from 1 to -1, y = -eta width/2 [m] (n, k).

        Returns None if the sections keep their shape, or if their width is not known.
        """
        section = self.scene.beam.strip
        if section is None or not self.scene.models_width:
            return None
        xi, eta = np.linspace(0, 1, along), np.linspace(1, -1, across)
        return self.scene.beam.length * xi, eta, np.outer(section.width(xi), -eta / 2)

    def modal_equations(self, basis: ModalBasis | int) -> Equations:
        """Transform the equations to the coordinates of a modal basis, or of a number of modes at rest.

        The circuit of a harvester is added, with its flux as coordinate.
        """
        basis = ModalBasis(basis) if isinstance(basis, int) else basis
        return reduce_to_modes(self.equations, basis).with_flux()

    @cached_property
    def coarser(self) -> Model:
        """Coarser model, whose results serve to estimate the error of this model."""
        return Model(self.scene, self.discretization.coarser())

    @property
    def lacks_two(self) -> bool:
        """Whether the model for error estimates has only two functions less in each field.

        This is so for large deflection in space without inner breakpoints, where strains converge fast and
        functions are costly: comparison with a much smaller model would only show the error of the smaller
        model.  With one function less it would show nothing in modes that only every other function changes.
        """
        is_whole = isinstance(self.discretization, Ritz) and len(self.scene.modelled_beam.breakpoints) == 2
        return is_whole and self.scene.bends_in_space

    @cached_property
    def compared(self) -> Model:
        """Model whose eigenvalues and equilibria are compared with this model's to estimate the error."""
        if self.lacks_two and isinstance(self.discretization, Ritz):
            fewer = max(1, self.discretization.functions - 2)
            return Model(self.scene, replace(self.discretization, functions=fewer))
        return self.coarser


def kinetic_energy(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Compute the fraction of kinetic energy in each of n coordinates, for k modes at S speeds: (S, n, k)."""
    return np.real(vectors.conj() * (equations.matrices[2]["unity"] @ vectors))


def plane_share(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Compute the fractions of kinetic energy in two directions of deflection, for k modes at S speeds.

    The shape is (S, k, 2).  The energy of other fields, such as stretch, is not counted: the sum is 1, or 0
    without deflection.
    """
    if equations.planes == 1:
        return np.full((*vectors[:, 0].shape, 2), (1.0, 0.0))
    energy, planes = kinetic_energy(equations, vectors), [[], []]
    for name in equations.deflecting:
        planes[equations.deflections[name].direction].append(name)
    first, second = (energy[:, equations.places(names)].sum(axis=1) for names in planes)
    total = first + second
    return np.stack([first, second], axis=2) / np.where(total == 0, 1.0, total)[..., None]


def static_load(model: Model, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute the static tip deflection and axial strain due to rotation.

    Parameters
    ----------
    model : Model
        A discretized scene.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    deflection : ndarray, shape (S,)
        Static tip deflection [m], in two planes its magnitude; nan at and above the critical speed.
    strain : ndarray, shape (S,)
        Largest static axial strain; nan if the axial stiffness is not given.
    """
    beam, tips = model.scene.beam, model.static_tips(speeds)
    deflection = tips[:, 0] if tips.shape[1] == 1 else np.linalg.norm(tips, axis=1)
    if beam.axial_stiffness is None:
        return deflection, np.full(len(speeds), np.nan)
    strain = steady_tension(beam, model.scene.mount) / sampled_axial_stiffness(beam)
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
    """Yield a warning at speeds at which the straight beam is unstable, if rotation bends it before that."""
    lost = np.isnan(deflection)
    if lost.any() and bends(model):
        end = f" the straight beam is unstable; rotation bends it at lower speeds: the answer is {OUTSIDE}"
        yield Statement("at ", list_speeds(speeds, lost), end, kind=OUTSIDE)


def bends(model: Model) -> bool:
    """Return whether steady rotation loads the straight beam transversely (misaligned by > 1e-8 rad)."""
    equations, scene = model.equations, model.scene
    load = np.abs(equations.steady().f2[equations.places(equations.deflecting)]).max(initial=0.0)
    along = max(np.abs(equations.P(d)).max() for d in range(scene.physics.planes))
    return bool(load > RIGHT_ANGLE * along * (scene.mount.radius + scene.beam.length))


# Modal bases -----------------------------------------------------------------------------------------

FEWEST_MODES = 2  # number of modes of the first basis, unless a number is given
SPEED_SAMPLES = 2001  # number of times at which a motion's slowest and fastest speed are searched
_MOST_MODES = 60  # largest number of modes: with more, the highest ones need too small time steps
# Ratio of a pivot of the mass matrix to the largest pivot, below which it is 0 within rounding.
_MASSLESS = 1e-14
_DEPENDENT = 1e-10  # relative singular value below which mode shapes are linearly dependent


@dataclass(frozen=True)
class ModalBasis:
    """Modes that span the coordinates of a reduced model.

    Parameters
    ----------
    modes : int or None
        Number of modes at each speed for each set of coupled fields; None for all modes of the
        discretization.
    speeds : tuple of float
        Speeds at which the modes are computed [rad/s].
    static : tuple of float
        Speeds at which the static responses to the loads of the moving root are added to the modes [rad/s].
    """

    modes: int | None
    speeds: tuple[float, ...] = (0.0,)
    static: tuple[float, ...] = ()

    def __str__(self) -> str:
        if self.modes is None:
            return "all modes"
        modes = counted(self.modes, "mode") + (" and the static responses to loads" if self.static else "")
        if self.is_at_rest:
            return modes
        return f"{modes} at {' and at '.join(f'{v:.4g}' for v in self.speeds)} rad/s"

    @property
    def is_at_rest(self) -> bool:
        """Whether all modes of the basis are modes at rest."""
        return self.speeds == (0.0,)

    def refined(self) -> ModalBasis | None:
        """Return a basis with 1.5 times as many modes, at least two more; None if these are too many."""
        assert self.modes is not None
        modes = self.modes + max(2, self.modes // 2)
        return replace(self, modes=modes) if modes <= _MOST_MODES else None

    def with_one_more(self) -> ModalBasis | None:
        """Return a basis with one mode more; None if these are too many."""
        assert self.modes is not None
        return replace(self, modes=self.modes + 1) if self.modes < _MOST_MODES else None


def given_basis(modes: int | str) -> ModalBasis | None:
    """Build a basis with a number of modes at rest; None for "auto": the tolerance then decides."""
    auto = isinstance(modes, str) and modes == "auto"
    return None if auto else ModalBasis(count("modes", modes, remedy='or "auto"'))


def find_speed_range(motion: Motion, t_end: float) -> tuple[float, ...]:
    """Find the smallest and largest |speed| [rad/s] until `t_end` [s]; one value if it is constant."""
    speed = np.abs(motion.at(np.linspace(0, t_end, SPEED_SAMPLES)).speed)
    return tuple(np.unique([speed.min(), speed.max()]).tolist())


def reduce_to_modes(equations: Equations, basis: ModalBasis) -> Equations:
    """Transform the equations to modal coordinates with unit mass and positive tip deflections."""
    pencil, count = equations.steady(), basis.modes or equations.size
    bases = {}
    for names in equations.coupled:
        places = equations.places(names)
        part = pencil.part(places).undamped()
        shapes = span_modes(
            part, count, basis.speeds, _static_responses(equations, places, part, basis.static)
        )
        tips = equations.tips[:, places] @ shapes
        larger = np.take_along_axis(tips, np.abs(tips).argmax(axis=0)[None], axis=0)[0]
        bases[names] = shapes * np.where(larger < 0, -1.0, 1.0)
    reduced = equations.reduced(bases)
    return reduced if equations.circuit is None else _with_residual(equations, reduced, basis.speeds[-1])


def _with_residual(equations: Equations, reduced: Equations, speed: float) -> Equations:
    """Add the residual flexibility of neglected modes, at a speed [rad/s], to a harvester's capacitance."""
    circuit, kept = equations.circuit, reduced.circuit
    assert circuit is not None and kept is not None
    stiffness = [p.K0 + speed**2 * p.K2 for p in (each.steady() for each in (equations, reduced))]
    of_modes, by_modes = np.zeros(equations.size), np.linalg.solve(stiffness[1], kept.coupling)
    for name, shape in reduced.shapes.items():
        of_modes[equations.blocks[name]] = shape.matrix @ by_modes[reduced.blocks[shape.block]]
    # Near the critical speed the deflection of all modes is large; the load on those left out is not.
    load = circuit.coupling - stiffness[0] @ of_modes
    residual = np.linalg.solve(stiffness[0], load)
    bent = {name: residual[equations.blocks[name]] for name in reduced.shapes}
    capacitance = circuit.capacitance + float(load @ residual)
    return replace(reduced, circuit=replace(kept, capacitance=capacitance, bent=bent))


def _static_responses(
    equations: Equations, places: np.ndarray, pencil: SteadyPencil, speeds: Sequence[float]
) -> list[np.ndarray]:
    """Compute the static responses, of unit mass, to the loads on the coordinates `places` at speeds [rad/s].

    In the spaces of modes they stand for the modes left out, which respond to slow loads without inertia
    (static correction).  `pencil` has the equations of these coordinates.
    """
    loads = [f[places] for f in equations.vectors.values() if f[places].any()]
    held = pencil.K0 + pencil.shift * pencil.M
    found = [np.linalg.solve(held + v**2 * pencil.K2, f) for v in speeds for f in loads]
    return [q / np.sqrt(q @ pencil.M @ q) for q in found]


def span_modes(
    pencil: SteadyPencil, modes: int, speeds: Sequence[float], further: Sequence[np.ndarray] = ()
) -> np.ndarray:
    """Compute mass-normalised shapes that span the lowest conservative modes at speeds, and further shapes.

    Parameters
    ----------
    pencil : SteadyPencil
        Conservative equations of size n.
    modes : int
        Number of modes at the last speed; at each other speed 2 + modes // 2, because higher modes
        hardly change with speed.
    speeds : sequence of float
        Speeds [rad/s].
    further : sequence of ndarray, shape (n,)
        Further shapes, of unit mass.

    Returns
    -------
    ndarray, shape (coordinates, shapes)
        Shapes in columns, with unit mass and a diagonal stiffness at rest; fewer than all modes together if
        those of different speeds are linearly dependent.
    """
    vectors = Solver(pencil).solve(np.asarray(speeds, dtype=float), min(modes, len(pencil.M))).vector
    if tuple(speeds) == (0.0,) and not further:
        return vectors[0]
    all_shapes = np.column_stack([*vectors[:-1, :, : 2 + modes // 2], vectors[-1], *further])
    independent = _orthonormal(pencil.M, all_shapes)
    return independent @ np.linalg.eigh(independent.T @ pencil.K0 @ independent)[1]


def _orthonormal(M: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Combine shapes in columns to linearly independent ones that are orthonormal in the mass matrix."""
    with suppress(np.linalg.LinAlgError):
        L = np.linalg.cholesky(M)
        pivots = np.diag(L) ** 2
        if pivots.min() >= _MASSLESS * pivots.max():
            directions, size, _ = np.linalg.svd(L.T @ shapes, full_matrices=False)
            return np.linalg.solve(L.T, directions[:, size > _DEPENDENT * size[0]])
    # The mass matrix is singular, as for bending and shear without rotary inertia.  It does not determine how
    # much of a deflection is shear; only combinations of the given shapes do.
    values, vectors = np.linalg.eigh(M)
    root = np.sqrt(np.maximum(values, 0))[:, None] * vectors.T
    _, size, weights = np.linalg.svd(root @ shapes, full_matrices=False)
    known = size > _DEPENDENT * size[0]
    combined = shapes @ (weights[known].T / size[known])
    L = np.linalg.cholesky(combined.T @ M @ combined)  # removes rounding errors of nearly dependent shapes
    return np.linalg.solve(L, combined.T).T


# Kinds of modes --------------------------------------------------------------------------------------

BENDING, TORSION, CAMBER = "bending", "torsion", "camber"
OTHER_KINDS = TORSION, CAMBER
_TIE = 1e-9  # relative difference of kinetic energies below which the first kind is chosen


def kinds_of_modes(equations: Equations, vectors: np.ndarray) -> np.ndarray | None:
    """Name the kind (S, k) of each of k modes at S speeds, by the largest part of kinetic energy.

    Bending in both directions, torsion and camber are compared, and ties within 1e-9 go to the first; the
    energy of stretch is not compared.  None if a model has neither torsion nor camber.
    """
    own = [name for name in OTHER_KINDS if name in equations.blocks]
    if not own:
        return None
    energy = np.real(vectors.conj() * equations.momentum(vectors))
    fields = [equations.deflecting, *([name] for name in own)]
    of_each = np.stack([energy[:, equations.places(names)].sum(axis=1) for names in fields])
    return np.array([BENDING, *own])[(of_each >= (1 - _TIE) * of_each.max(axis=0)).argmax(axis=0)]


class TellsKinds(Result):
    """Base class of modal results that state the kind of each mode; see `Result`.

    A subclass has the field `kinds`, which is None if all modes are bending modes.
    """

    frequency: np.ndarray
    kinds: np.ndarray | None

    @property
    def kind(self) -> np.ndarray:
        """Kind of each mode, by the largest part of its kinetic energy: "bending", "torsion" or "camber"."""
        return np.full(self.frequency.shape, BENDING) if self.kinds is None else self.kinds

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, with the kinds of modes if there are several."""
        return super().to_dict() | ({} if self.kinds is None else {"kind": self.kinds.tolist()})
