"""Equations of vibration at steady speeds over the phases of the excitation, and its stability.

A straight beam has the same equations at all speeds.  With large deflection, the beam vibrates about the
equilibrium to which rotation bends it: its equations at each speed are linear about the equilibrium there, in
the modes of small vibration about it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.modal.equilibrium import DeflectedSolver, NoEquilibrium
from beamdyn.modes.modal.modal_basis import ModalBasis, reduce_to_modes
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.steady.excitation_phases import periodic_system, periodic_system_of_each, split_uncoupled
from beamdyn.steady.periodic_system import PeriodicSystem
from beamdyn.steady.stability import fastest_growth

UNSTABLE = "parametric instability"
_TURNING, _PAST = "turns freely about the root", "past the critical speed"
_MISSING, _UNSTABLE_MEAN = "no equilibrium", "unstable equilibrium"
WITHOUT_STABLE_MEAN = _PAST, _TURNING, _MISSING, _UNSTABLE_MEAN
_NO_FREQUENCY = 1e-8  # frequency, over that of a clamped beam, that rounding makes of 0


@dataclass(frozen=True)
class Vibration:
    """Equations of vibration at S speeds.

    Parameters
    ----------
    parts : list of (PeriodicSystem, ndarray)
        Equations that no term couples, each with its coordinates.
    tips : ndarray, shape (S, d, n)
        Deflection of the tip per coordinate, in each of d directions.
    static : ndarray, shape (S, d)
        Deflection of the tip in the equilibrium about which the beam vibrates [m].
    without_rate : ndarray of bool, shape (S,)
        Where no growth rate is defined.
    lost : dict of str to ndarray of bool, shape (S,)
        Where there is no stable mean to vibrate about, by the reason; the first that is true counts.
    """

    parts: list[tuple[PeriodicSystem, np.ndarray]]
    tips: np.ndarray
    static: np.ndarray
    without_rate: np.ndarray
    lost: dict[str, np.ndarray]

    def stability(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Growth rates of free motion, their errors, the status, and whether it is undecided: (S,) each."""
        rate, error = np.full((2, len(self.static)), np.nan)
        if (known := ~self.without_rate).any():
            rate[known], error[known] = fastest_growth([part[known] for part, _ in self.parts])
        status = np.where(rate > 0, UNSTABLE, "stable")
        status = np.select([*self.lost.values()], [*self.lost], status)
        return rate, error, status, (np.abs(rate) < error) & ~np.isin(status, [*self.lost])


def vibration_of(model: Model, basis: ModalBasis, motion: Motion | None, speeds: np.ndarray) -> Vibration:
    """Equations of vibration of a model in a modal basis.

    Parameters
    ----------
    model : Model
        The discretized scene, of a straight beam or with large deflection.
    basis : ModalBasis
        The modal basis; about equilibria its number of modes, at each speed.
    motion : Motion or None
        The motion; None for rotation about a fixed centre.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    Vibration
    """
    if isinstance(model.solver, DeflectedSolver):
        return _about_equilibria(model, basis, motion, speeds)
    return _of_straight_beam(model, basis, motion, speeds)


# The straight beam --------------------------------------------------------------------------------


def _of_straight_beam(
    model: Model, basis: ModalBasis, motion: Motion | None, speeds: np.ndarray
) -> Vibration:
    equations = model.modal_equations(basis)
    tips = np.broadcast_to(equations.tips, (len(speeds), *equations.tips.shape))
    free = _turns_freely(model, speeds)
    return Vibration(
        parts=split_uncoupled(periodic_system(equations, motion, speeds), equations),
        tips=tips,
        static=np.zeros(tips.shape[:2]),
        without_rate=free,
        lost={_TURNING: free, _PAST: np.asarray(np.abs(speeds) >= model.solver.critical_speed)},
    )


def _turns_freely(model: Model, speeds: np.ndarray) -> np.ndarray:
    """Whether nothing resists a rotation of the beam about its root, shape (S,)."""
    if not model.equations.shift:  # the stiffness at rest is positive definite
        return np.zeros(len(speeds), dtype=bool)
    lowest = np.abs(Solver(model.equations.steady().undamped()).eigenvalues(speeds, 1)[:, 0])
    return lowest < _NO_FREQUENCY * np.sqrt(model.equations.shift)


# About equilibria ---------------------------------------------------------------------------------


def _about_equilibria(
    model: Model, basis: ModalBasis, motion: Motion | None, speeds: np.ndarray
) -> Vibration:
    """Equations about each equilibrium; where there is none, those of the straight beam hold the place.

    The directions of the tip are that of bending, and along the beam axis.
    """
    q = find_equilibria(model, speeds)
    missing = np.asarray(np.isnan(q).any(axis=1))
    each = [*_reduced_about(model, basis, np.where(missing[:, None], 0.0, q), speeds)]
    equations = [reduced for reduced, _ in each]
    system = periodic_system_of_each(equations, motion, speeds)
    parts = split_uncoupled(system, equations[0])
    assert model.elastica is not None
    return Vibration(
        parts=parts,
        tips=np.array([tips for _, tips in each]),
        static=model.elastica.tip(q)[:, ::-1] - [0.0, model.scene.beam.length],
        without_rate=missing,
        lost={_MISSING: missing, _UNSTABLE_MEAN: _are_unstable(parts, missing)},
    )


def _reduced_about(
    model: Model, basis: ModalBasis, q: np.ndarray, speeds: np.ndarray
) -> Iterator[tuple[Equations, np.ndarray]]:
    """Yield the equations in the modes about each equilibrium, with the tip's motion (2, n) in these."""
    assert model.elastica is not None
    for speed, state in zip(np.abs(speeds).tolist(), map(model.elastica.at, q), strict=True):
        equations = reduce_to_modes(state.linearized(), replace(basis, speeds=(speed,)))
        along = state.elastica.points.tip(-state.sin * state.elastica.angles)
        (shape,) = equations.shapes.values()
        yield equations, np.array([equations.tip, along @ shape.matrix])


def _are_unstable(parts: list[tuple[PeriodicSystem, np.ndarray]], missing: np.ndarray) -> np.ndarray:
    """Whether each equilibrium (S,) is unstable, without the periodic coefficients; False where missing."""
    rate = np.zeros(len(missing))
    if (known := ~missing).any():
        rate[known] = fastest_growth([replace(part[known], varying=()) for part, _ in parts])[0]
    return np.asarray(rate > 0)


def find_equilibria(model: Model, speeds: np.ndarray) -> np.ndarray:
    """Coordinates (S, n) in equilibrium at each speed; nan where the branch has none.

    The branch from rest is followed upwards, the other one downwards from the fastest speed that has it: past
    the end of either, there is no more.
    """
    solver = model.solver
    assert isinstance(solver, DeflectedSolver)
    try:
        return solver.equilibria(speeds)
    except NoEquilibrium:
        return _find_each(solver, speeds)


def _find_each(solver: DeflectedSolver, speeds: np.ndarray) -> np.ndarray:
    q, reached = np.full((len(speeds), solver.elastica.size), np.nan), False
    order = np.argsort(np.abs(speeds), kind="stable")
    for k in order if solver.branch == "straight" else order[::-1]:
        try:
            q[k] = solver.equilibria(speeds[[k]])[0]
            reached = True
        except NoEquilibrium:
            if reached:
                break
    return q


def choose_vibrating(
    scene: Scene, discretization: DiscretizationChoice, speeds: np.ndarray, modes: int
) -> Model:
    """Choose a model at the speeds at which the beam has an equilibrium: see `choose_model`."""
    try:
        return choose_model(scene, discretization, speeds, modes)
    except NoEquilibrium:
        pass
    from_rest = replace(scene, physics=replace(scene.physics, branch="straight"))
    at_rest = choose_model(from_rest, discretization, np.zeros(1), modes)
    rough = at_rest.of(scene)
    found = speeds[np.isfinite(find_equilibria(rough, speeds)).all(axis=1)]
    return choose_model(scene, discretization, found, modes) if found.size else rough
