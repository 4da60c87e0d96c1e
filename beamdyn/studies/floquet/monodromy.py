"""Period and monodromy matrix of a scene in periodic motion, which maps the state of free motion over it.

Time steps are by Gauss collocation of order 16, as for transients, which preserves the symplectic form of
undamped motion.  Displacements are multiplied by the frequencies at rest, so that the map of each mode at
rest is orthogonal.

In shapes of arrays, P counts matrices, and n coordinates.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count
from beamdyn.common.inputs.described import Designs, VariedInput
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.common.words import Words
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model
from beamdyn.modes.modal.model import Model, find_speed_range
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.scene.motion.rotations import Rotation
from beamdyn.scene.names_elsewhere import REPEATING
from beamdyn.scene.numbers import SPEED, with_numbers
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import refuse_large_deflection
from beamdyn.transient.gauss import step_maps, tableau
from beamdyn.transient.system import ModalSystem

MOST_TURNS = 64  # largest number of cycles of the first phase in a common period of all phases
_MOST_OTHERS = MOST_TURNS**2  # largest number of cycles of any other phase in a common period
_COMMENSURATE = 1e-12  # relative distance from a fraction at which a frequency ratio counts as this fraction


class Period(NamedTuple):
    """Period after which the coefficients of the equations of motion repeat.

    Parameters
    ----------
    time : float
        Length of the period [s].
    turns : int
        Number of cycles of the first phase in this time.
    """

    time: float
    turns: int


def rates_of(scene: Scene) -> tuple[float, ...]:
    """Return the angular frequencies [rad/s] of the phases that the coefficients of the equations depend on.

    The angle of rotation is such a phase if gravity, or an acceleration of the carrier, has a fixed
    direction.

    Raises
    ------
    InvalidValue
        If there is no motion, or if it is not periodic.
    """
    motion = scene.motion
    if motion is None:
        remedy = Words("such as ", REPEATING)
        raise InvalidValue("scene.motion", None, "stability needs a periodic motion", remedy)
    rates = tuple(map(abs, motion.rates))
    if isinstance(motion, Rotation) and not scene.gravity and len(rates) > 1:
        rates = rates[1:]
    rates = tuple(rate for rate in rates if rate)
    if not rates:
        bound = "the carrier stands still, and nothing pulsates"
        raise InvalidValue("scene.motion", motion, bound, "use natural_modes, or give another motion")
    return rates


def meet_again(scene: Scene) -> bool:
    """Return whether the phases of the motion have a common period within the limits of `period_of`."""
    rates = rates_of(scene)
    return all(_is_fraction(rate / rates[0]) for rate in rates)


def period_of(scene: Scene) -> Period:
    """Find the smallest period of the coefficients of the equations of motion.

    Raises
    ------
    InvalidValue
        As for `rates_of`, or if the phases have no common period within 64 cycles of the first phase, or 4096
        of another one.
    """
    rates = rates_of(scene)
    turns = math.lcm(*(_fraction(rate, rates[0]).denominator for rate in rates))
    return Period(2 * math.pi / rates[0] * turns, turns)


def _is_fraction(ratio: float) -> bool:
    """Return whether a ratio is a fraction with numerator <= 4096 and denominator <= 64, within rounding."""
    found = Fraction(ratio).limit_denominator(MOST_TURNS)
    return abs(found - Fraction(ratio)) <= _COMMENSURATE * ratio and found.numerator <= _MOST_OTHERS


def _fraction(rate: float, first: float) -> Fraction:
    """Return the ratio of two frequencies as a fraction; raise an error unless `_is_fraction`."""
    ratio = rate / first
    found = Fraction(ratio).limit_denominator(MOST_TURNS)
    nearest = min(max(found, Fraction(1, MOST_TURNS)), Fraction(_MOST_OTHERS))
    if not _is_fraction(ratio):
        within = f"{MOST_TURNS} periods of the first and {_MOST_OTHERS} of the other"
        bound = f"its rates {first:.9g} and {rate:.9g} rad/s have no common period within {within}"
        remedy = (
            f"take the ratio {nearest.numerator}/{nearest.denominator}, or use floquet_multipliers, which "
            "decides on the stability of a single scene with two such rates"
        )
        raise InvalidValue("scene.motion", ratio, bound, remedy)
    return found


# Description of the second solution, from which errors are estimated.
COARSER = "two thirds of the steps in time"
_STAGES = 8
_ANGLE = 2.0  # phase angle of the fastest mode per step [rad], for which the error is about 1e-14
_FEWEST = 12  # smallest number of steps in a period of the motion, which resolves the harmonics of the motion
COARSER_STEPS = 2 / 3  # ratio of the number of steps of the second solution to that of the first
# Assumed ratio of the errors of the two solutions; the ratio tends to (3/2)^16 = 650 for small steps.
_EXCESS = 100.0
# In states (w q, q'), w is the angular frequency of a mode at rest, but 2 pi/period if that frequency is at
# most this fraction of 2 pi/period.
_SLOWEST = 1e-3
_SAMPLES = 64  # number of times in a period at which the stiffness is evaluated to find its maximum
_ROUNDING = 4 * np.finfo(float).eps  # rounding error of a step, relative to the size of its matrix


@dataclass(frozen=True)
class Monodromy:
    """Monodromy matrices of P scenes with the same modal coordinates.

    Parameters
    ----------
    matrix : ndarray, shape (P, 2 n, 2 n)
        Maps over a period of the state (w q, q'), with coordinates q and frequencies w at rest [rad/s].
    error : ndarray, shape (P,)
        Estimated errors of the matrices, as 2-norms.
    period : ndarray, shape (P,)
        The periods [s].
    form : ndarray, shape (P, 2 n, 2 n), or None
        Antisymmetric matrices J of the forms that undamped motions preserve: matrix^T J matrix = J.  None
        with damping.
    turns : int
        Number of cycles of the first phase in a period, the same for all scenes.
    """

    matrix: np.ndarray
    error: np.ndarray
    period: np.ndarray
    form: np.ndarray | None
    turns: int


def monodromy(scene: Scene, period: Period, equations: Equations) -> Monodromy:
    """Integrate the free vibration of a scene over its period.

    Parameters
    ----------
    scene : Scene
        The scene, with a periodic motion.
    period : Period
        Period of the motion.
    equations : Equations
        Equations of the scene in modal coordinates with unit mass matrix.

    Returns
    -------
    Monodromy
        The scene's monodromy matrix; its error is estimated by a second solution with two thirds of the
        steps.
    """
    assert scene.motion is not None
    system = ModalSystem(equations, scene.motion)
    C, K, _ = system.coefficients(period.time * np.arange(_SAMPLES) / _SAMPLES)
    steps = count_steps(K, period.time, scene.motion.rates)
    counts = steps, math.ceil(COARSER_STEPS * steps)
    both = np.array([_propagate(system, period.time, each) for each in counts])
    fine, coarse = scaled_states(equations, period.time, both)
    error = np.linalg.norm(fine - coarse, 2) / _EXCESS + _ROUNDING * steps * np.linalg.norm(fine, 2)
    scale = _scale(equations, period.time)
    form = None if scene.is_damped else _form(None if C is None else C[0], scale)[None]
    return Monodromy(fine[None], np.array([error]), np.array([period.time]), form, period.turns)


def _scale(equations: Equations, period: float) -> np.ndarray:
    """Return the factors, shape (2 n,), by which the entries of states (q, q') are multiplied.

    The factor of a coordinate is its angular frequency at rest, or 2 pi/period where this is 0; that of a
    velocity is 1.  Rounding gives the free turn of a hinged beam a tiny frequency, which counts as 0.
    """
    frequency, turning = np.sqrt(np.abs(np.diagonal(equations.matrices[0]["unity"]))), 2 * math.pi / period
    frequency = np.where(frequency > _SLOWEST * turning, frequency, turning)
    return np.concatenate([frequency, np.ones(equations.size)])


def scaled_states(equations: Equations, period: float, maps: np.ndarray) -> np.ndarray:
    """Convert maps of states (q, q') to maps of (w q, q') with frequencies w at rest.

    The flux of a circuit (the time integral of its voltage) is omitted, as only its rate acts.
    """
    scale = _scale(equations, period)
    maps, n = scale[:, None] * maps / scale, equations.size
    states = np.arange(2 * n) != (n - 1 if equations.voltage is not None else -1)
    return maps[:, states][:, :, states]


def count_steps(K: np.ndarray, period: float, rates: tuple[float, ...]) -> int:
    """Return the number of steps, over a period [s], that resolve the fastest mode and the motion."""
    fastest = np.sqrt(np.abs(K).sum(axis=-1).max())
    turns = max(1.0, period * max(map(abs, rates)) / (2 * math.pi))
    return math.ceil(max(_FEWEST * turns, period * fastest / _ANGLE))


def _propagate(system: ModalSystem, period: float, steps: int) -> np.ndarray:
    """Integrate the map of the state (q, q') over a period, in equal steps."""
    h = period / steps
    maps = step_maps(system, h * np.arange(steps), h, tableau(_STAGES)).step[:, :, 1:]
    return reduce(lambda before, step: step @ before, maps)


def _form(C: np.ndarray | None, scale: np.ndarray) -> np.ndarray:
    """Compute the antisymmetric form that undamped motion preserves, in scaled states.

    q1^T q2' - q1'^T q2 + q1^T C q2 of two motions is constant, as C = -C^T and K - C'/2 is symmetric.
    """
    n = len(scale) // 2
    J = np.zeros((2 * n, 2 * n))
    J[:n, n:], J[n:, :n] = np.eye(n), -np.eye(n)
    if C is not None:
        J[:n, :n] = C
    return J / scale[:, None] / scale


# Scenes in periodic motion -----------------------------------------------------------------------------


_STRAIGHT = "stability in periodic motion is computed only for the straight beam"


@dataclass(frozen=True)
class PeriodicScenes(FieldsOnly):
    """Scenes in periodic motion that differ from a given scene in some of its numbers.

    Parameters
    ----------
    scene : Scene
        The scene.
    modes : int
        Number of modes at rest of each uncoupled displacement, such as bending in each plane.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    """

    scene: Scene
    modes: int
    discretization: DiscretizationChoice
    _models: dict[Any, tuple[Model, Equations]] = field(default_factory=dict, repr=False, compare=False)

    def at(self, values: Mapping[str, float]) -> Scene:
        """Return the scene with other values of the numbers; a new speed also changes the motion."""
        scene = with_numbers(self.scene, values)
        if SPEED not in values or scene.motion is None:
            return scene
        return replace(scene, motion=scene.motion.with_speed(values[SPEED]))

    def monodromy(self, values: Mapping[str, float]) -> Monodromy:
        """Integrate the monodromy matrix of the scene with other values of the numbers."""
        scene = self.at(values)
        return monodromy(scene, period_of(scene), self.equations(scene))

    def equations(self, scene: Scene) -> Equations:
        """Return the equations of a scene in modes at rest."""
        return replace(self.modal(scene)[1], mount=scene.mount, gravity=scene.gravity)

    @property
    def size(self) -> int:
        """Number of entries of a state: modal displacements and velocities, and the voltage of a circuit."""
        equations = self.modal(self.scene)[1]
        return 2 * equations.size - (equations.voltage is not None)

    def modal(self, scene: Scene) -> tuple[Model, Equations]:
        """Return model and equations in modes at rest.

        Scenes that differ only in the motion of the root share them.
        """
        still = replace(scene.mount, radius=0.0, setting_angle=0.0, precone=0.0)
        key = scene.beam, still, scene.mount.precone, scene.physics, scene.damping_ratio, scene.damping
        if key not in self._models:
            model = choose_model(scene, self.discretization, speeds_of(scene), self.modes)
            self._models[key] = model, model.modal_equations(self.modes)
        return self._models[key]


def speeds_of(scene: Scene) -> np.ndarray:
    """Return the slowest and the fastest speed of a scene's periodic motion [rad/s]."""
    period = period_of(scene).time if meet_again(scene) else 2 * np.pi / rates_of(scene)[0] * MOST_TURNS
    assert scene.motion is not None
    return np.array(find_speed_range(scene.motion, period))


def check_periodic(
    scene: Scene, modes: int, discretization: DiscretizationChoice, inputs: Sequence[VariedInput] = ()
) -> PeriodicScenes:
    """Check the arguments of a stability analysis in periodic motion, and choose the physics if "auto".

    If inputs are varied, the physics is that of the extreme scene that needs the most effects.

    Raises
    ------
    InvalidValue
        If an argument is out of its range, the motion is not periodic, or large deflection is modelled.
    """
    check_scene(scene)
    refuse_large_deflection(scene, _STRAIGHT)
    modes = count("modes", modes)
    if scene.chooses_physics:
        extremes = Designs(inputs).extremes() if inputs else [{}]
        each = PeriodicScenes(scene, modes, discretization)
        most = max([_choose_physics(each.at(numbers), modes) for numbers in extremes], key=_needs)
        scene = replace(scene, physics=most.physics, physics_choice=most.physics_choice)
    return PeriodicScenes(scene, modes, discretization)


def _needs(scene: Scene) -> tuple[int, float]:
    """Return a sort key for choices of physics: number of effects, then model error."""
    choice = scene.physics_choice
    return (0, 0.0) if choice is None else (len(choice.included), choice.model_error)


def _choose_physics(scene: Scene, modes: int) -> Scene:
    return choose_physics(scene, speeds_of(scene), modes, barred={LARGE_DEFLECTION.name: _STRAIGHT})
