"""Transient problem: its equations, their integration, and problems with more modes for comparison."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Self, TypeVar

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, as_floats
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.beam_in_space.rotating_beam import QUANTITIES
from beamdyn.equations.effects import check_direction
from beamdyn.equations.root_motion import Quantity
from beamdyn.modes.modal.continuation import Loading, NoEquilibrium
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model, ensure_size
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.modal.equilibrium import find_bent, follow_to
from beamdyn.modes.modal.model import SPEED_SAMPLES, ModalBasis, Model
from beamdyn.scene.motion.base import Motion
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene
from beamdyn.transient.along_path import distance_along_path
from beamdyn.transient.beam_in_space_system import AnySystem, BeamInSpaceSystem
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.gauss import growth_without_bound
from beamdyn.transient.integration import follow_steps, integrate
from beamdyn.transient.step_size import TooManySteps
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import Path, Trajectory, in_direction, largest_on, magnitude_of, sample_tip

if TYPE_CHECKING:
    from scipy.integrate import OdeSolver

_LIMIT_DEFLECTION = 1000.0  # ratio of deflection to length above which the motion counts as unbounded
_FREE = 1e-9  # least modal stiffness, relative to that with a clamped root, below which the root turns freely
_REMEDY = "give 'rest' or an array"
_FINER_MODEL = 1e-3  # allowed discretization error of the modes, relative to the tolerance
_Found = TypeVar("_Found")


class Solution(NamedTuple):
    """Solution of a transient: equations, path, time-integration error and largest tip deflection [m]."""

    system: AnySystem
    path: Path
    error: float
    largest: float
    method: str = ""

    def peak(self, start: float, end: float, direction: int | None = None) -> float:
        """Find the largest |tip deflection| [m] in a window [s], or of its component in a direction."""
        if direction is None:
            return largest_on(lambda q: magnitude_of(self.system.deflections(q)), self.path, start, end)
        chosen = check_direction(direction)
        return largest_on(
            lambda q: np.abs(in_direction(self.system.deflections(q), chosen)), self.path, start, end
        )


def unless_unbounded(solve: Callable[[], _Found]) -> _Found | None:
    """Call `solve`; return None if the motion grows without bound, or takes too many steps."""
    try:
        return solve()
    except (ArithmeticError, TooManySteps):
        return None


def choose_for_basis(
    scene: Scene, discretization: DiscretizationChoice, basis: ModalBasis, tolerance: float
) -> Model:
    """Choose the smallest discretization whose modes are far more accurate than the tolerance requires.

    The modal basis consists of undamped modes.  For a scene with two planes, shear, rotary inertia or springs
    the choice also uses undamped modes: damped ones take far longer to compute in large models, and some do
    not exist if shear has no mass of its own.
    """
    speeds, modes, target = np.array(basis.speeds), basis.modes or 1, _FINER_MODEL * tolerance
    if scene.bends_in_space:
        plain = replace(scene.straightened, physics=Physics(planes=scene.physics.planes))
        return Model(scene, choose_for_basis(plain, discretization, basis, tolerance).discretization)
    if scene.physics.large_deflection:  # here, too, the basis consists of modes of the straight beam
        return choose_for_basis(scene.straightened, discretization, basis, tolerance).of(scene)
    plain = replace(scene, physics=replace(scene.physics, stretch=False)).is_slender_beam_in_one_plane
    if plain or not scene.is_damped:
        return choose_model(scene, discretization, speeds, modes, target)
    return choose_model(scene.undamped, discretization, speeds, modes, target).of(scene)


@dataclass(frozen=True)
class TransientProblem(FieldsOnly):
    """Checked arguments of `simulate`, with a modal basis instead of the number of modes."""

    scene: Scene
    t_end: float
    tolerance: float
    method: str | type[OdeSolver]
    discretization: DiscretizationChoice
    initial: str | np.ndarray
    t_eval: np.ndarray | None
    options: dict[str, Any]
    basis: ModalBasis

    @property
    def motion(self) -> Motion:
        """Motion of the scene."""
        assert self.scene.motion is not None
        return self.scene.motion

    @cached_property
    def model(self) -> Model:
        """Discretized scene, chosen for the modal basis and the tolerance."""
        return choose_for_basis(self.scene, self.discretization, self.basis, self.tolerance)

    def system(self) -> AnySystem:
        """Build the equations of motion of the run, without coordinates that stay at rest."""
        if self.scene.bends_in_space or self.scene.tip_load.acts:
            # The import is inside the function because few scenes have large deflection.
            from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem

            return BeamInSpaceSystem.of_model(self.model, self.basis, self.motion)
        if self.scene.physics.large_deflection:
            return ElasticaSystem.of_model(self.model, self.basis, self.motion)
        equations = self.model.modal_equations(self.basis)
        if isinstance(self.initial, str):
            return ModalSystem.from_rest(equations, self.motion, self.t_end)
        return ModalSystem(equations, self.motion)

    def solve(self) -> Solution:
        """Integrate the motion with the modal basis.

        Raises
        ------
        NoModelAnswer
            If the motion passes the critical speed (raised before any long computation).
        ArithmeticError
            If the motion has grown without bound, so that its error estimates are void.
        """
        self._refuse_past_critical()
        system = self.system()
        y0 = initial_state(self.initial, system)
        if self.method == "auto":
            path, error, name = integrate(system, y0, self.t_end, self.tolerance)
        else:
            from beamdyn.transient.scipy_integrators import integrate_by_solve_ivp

            name, error = self.method if isinstance(self.method, str) else self.method.__name__, np.nan
            path = integrate_by_solve_ivp(system, y0, self.t_end, self.method, self.tolerance, self.options)
        found = Solution(system, path, error, np.nan, name)
        largest, length = found.peak(path.start, path.end), self.scene.beam.length
        if not largest <= _LIMIT_DEFLECTION * length:
            raise growth_without_bound(f"to {largest / length:.1g} times the length")
        return found._replace(largest=largest)

    def _refuse_past_critical(self) -> None:
        """Raise `NoModelAnswer` if the motion passes the critical speed without large deflection."""
        t = np.linspace(0, self.t_end, SPEED_SAMPLES)
        speed = np.abs(self.motion.at(t).speed)
        if self.scene.physics.large_deflection:
            return
        critical = self.model.solver.critical_speed
        past = (speed >= critical) & (speed > 0)
        if past.any():
            k = int(past.argmax())
            raise NoModelAnswer(
                f"the motion reaches {speed[k]:.6g} rad/s at t = {t[k]:.4g} s, past the critical speed "
                f"{critical:.6g} rad/s: the beam buckles there, and linear theory does not hold; lower the "
                "speed"
            )

    # Problems with more modes ---------------------------------------------------------------------

    def refined(self) -> Self | None:
        """Return the problem with more modes, or a finer discretization if it has all modes.

        None if there is no larger problem.
        """
        base = replace(self, method="auto", t_eval=None)
        if self.basis.modes is None:
            finer = self.model.discretization.finer()
            return None if finer is None else replace(base, discretization=finer)
        basis = self.basis.refined()
        return basis and base._with_basis(basis)

    def with_one_more(self) -> Self | None:
        """Return the problem with one more mode; None if the basis already has all modes."""
        basis = None if self.basis.modes is None else self.basis.with_one_more()
        return basis and self._with_basis(basis)

    def _with_basis(self, basis: ModalBasis) -> Self:
        """Return the problem with a larger basis; with "ritz" if the discretization has too few functions."""
        assert basis.modes is not None and self.basis.modes is not None
        initial = self.initial
        if not isinstance(initial, str):
            parts = np.reshape(initial, (-1, self.basis.modes))
            initial = np.hstack([parts, np.zeros((len(parts), basis.modes - self.basis.modes))]).ravel()
        discretization = ensure_size(self.scene, self.discretization, basis.modes)
        return replace(self, basis=basis, discretization=discretization, initial=initial)

    def _refined_of_same_functions(self) -> Self | None:
        """Return the problem with more modes of the same discretization; None if it has too few functions."""
        finer = self.refined()
        if finer is None or finer.basis.modes is None:
            return finer
        own = self.model.discretization
        same = ensure_size(self.scene, own, finer.basis.modes) is own
        return replace(finer, discretization=own) if same else finer

    def follow_with_more_modes(self, path: Trajectory) -> tuple[AnySystem, Path] | None:
        """Integrate with the modes of `refined` in the time steps of a path; return equations and motion.

        None if there are no further modes, or the motion is unbounded or nonlinear.
        Two runs in the same steps differ only by the additional modes; neither needs an error estimate.
        If the steps are too long for the motion of the further modes, the steps of `refined` are used.
        """
        finer = self._refined_of_same_functions()
        if finer is None or not isinstance(system := finer.system(), ModalSystem):
            return None
        y0 = initial_state(finer.initial, system)
        if (found := unless_unbounded(lambda: follow_steps(path, system, y0, self.tolerance))) is None:
            return None
        followed, error = found
        if error <= self.tolerance * float(magnitude_of(sample_tip(system, followed)[1]).max()) < np.inf:
            return system, followed
        refined = self.refined()
        solved = refined and unless_unbounded(refined.solve)
        return solved and (solved.system, solved.path)

    def distance_with_more_modes(self, path: Trajectory, own: ModalSystem) -> float | None:
        """Estimate the largest difference [m] between tip deflections of a path and of one with more modes.

        `own` are the equations of the path.  None if there are no further modes, or no valid estimate.
        """
        finer = self._refined_of_same_functions()
        if finer is None or not isinstance(system := finer.system(), ModalSystem):
            return None
        states = (initial_state(each.initial, s) for each, s in ((self, own), (finer, system)))
        return distance_along_path(path, own, system, *states)


# Initial state ---------------------------------------------------------------------------------------


def initial_state(initial: str | np.ndarray, system: AnySystem) -> np.ndarray:
    """Build the initial state, coordinates and velocities: "rest", "equilibrium", or a given array.

    Raises
    ------
    ValueError
        If `initial` is another word or has another shape, or if there is no equilibrium.
    """
    n = system.size
    if isinstance(initial, str):
        if initial == "rest":
            return np.zeros(2 * n)
        if initial == "equilibrium":
            found = (
                _bent_equilibrium(system) if isinstance(system, BeamInSpaceSystem) else _equilibrium(system)
            )
            return np.concatenate([found, np.zeros(n)])
        raise ValueError(f"initial = {initial!r}: give 'rest', 'equilibrium' or an array")
    y0 = as_floats(initial)
    if y0 is None or y0.shape != (2 * n,) or not np.isfinite(y0).all():
        bound = f"give {2 * n} finite numbers, coordinates then velocities, or 'rest' or 'equilibrium'"
        raise InvalidValue("initial", initial, bound)
    return y0


def _equilibrium(system: ModalSystem) -> np.ndarray:
    """Compute the static equilibrium under the loads at time 0; a ValueError if the root turns freely.

    In this equilibrium a circuit has no voltage; its flux, the last coordinate, begins at 0.
    """
    _, K, f = system.coefficients(np.zeros(()))
    bent, found = slice(len(f) - (system.equations.voltage is not None)), np.zeros_like(f)
    if (shift := system.equations.shift) and np.abs(np.linalg.eigvalsh(K[bent, bent])).min() < _FREE * shift:
        bound = "at time 0 the beam turns freely on its hinge: no position is its equilibrium"
        raise InvalidValue("initial", "equilibrium", bound, "give 'rest', or a root_stiffness")
    found[bent] = np.linalg.solve(K[bent, bent], f[bent])
    return found


def _bent_equilibrium(system: BeamInSpaceSystem) -> np.ndarray:
    """Compute the coordinates in static equilibrium under loads at time 0, on the scene's branch.

    The solution is continued from the unloaded beam.  The parameter is the squared speed, and all other
    loads, such as gravity, grow in proportion; for a beam that does not rotate, the parameter is the fraction
    of the loads.
    """
    root, lowest = system.root(np.zeros(())), Solver(system.equations.steady()).lowest_at_rest
    speed = abs(float(root.speed)) or 1.0
    is_bent = system.branch == "bent"
    if is_bent and not root.speed:
        bound = "at time 0 the beam does not rotate, so that only the branch of the beam at rest exists"
        raise InvalidValue(
            "initial", "equilibrium", bound, f"{_REMEDY}, or a motion that begins with a speed"
        )
    values: dict[Quantity, float] = {name: float(getattr(root, name)) / speed**2 for name in QUANTITIES}
    elastica = system.elastica
    size = max(1.0, abs(values["root_transverse"]) / elastica.beam.stations.length)
    load = Loading(elastica, values, lowest / size, {"unity": 1.0} if elastica.load else {})
    largest = float(np.abs(load.rate(np.zeros(system.size))).max())
    try:
        return find_bent(load, speed, largest) if is_bent else follow_to(load, np.array([speed]))[0]
    except NoEquilibrium as error:
        bound = f"at time 0 there is none: {error}"
        raise InvalidValue("initial", "equilibrium", bound, _REMEDY) from None
