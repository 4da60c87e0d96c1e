"""Branches of equilibria not from rest: pitchfork of the straight beam, folds, least frequency."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from benchmarks.cases.reference.elastica.beam import Elastica
from benchmarks.cases.reference.elastica.equations import NODES, Collocation
from benchmarks.cases.reference.elastica.equilibrium import NotFound, State, from_rest, polished
from benchmarks.cases.reference.elastica.vibration import frequencies

_NEWTON = 30
_TOLERANCE = 1e-14
_SETTLED = 1e-11
_FIRST_ANGLE = 0.05  # first angle of the tip on the branch from the pitchfork [rad]
_BESIDE = 1e-3  # angle of the tip of a slightly bent beam [rad]
_ENTRIES = (1.0, 1.5, 2.0, 0.5, 2.5)  # angles of the tip, tried in turn, to find a fold's branch [rad]
_STEP = 0.1  # step of the tip's angle along a branch [rad]
_NEAR = 1e-2  # half the relative interval of speeds of the polynomial for the least frequency
_LARGEST_ANGLE = 6.0  # largest angle of the tip to which branches are followed [rad]


def critical_speed(beam: Elastica, pieces: int = 2, nodes: int = NODES) -> float:
    """Compute the lowest gamma at which the straight beam of a symmetric scene buckles."""
    return _pitchfork(Collocation(beam, pieces, nodes))[0] ** 0.5


def _pitchfork(equations: Collocation) -> tuple[float, np.ndarray]:
    """Compute gamma^2 at buckling, and the buckling mode with a tip angle of 1."""
    if not equations.beam.is_symmetric:
        raise NotFound("the straight beam is no equilibrium")
    still = np.zeros(equations.size)
    at_rest = equations.stiffness(still, 0.0)
    softening = np.linalg.solve(at_rest, at_rest - equations.stiffness(still, 1.0))
    found, vectors = np.linalg.eig(softening)
    found = np.where(np.abs(np.imag(found)) < 1e-9 * np.abs(found), np.real(found), 0.0)
    if found.max() <= 0:
        raise NotFound("the straight beam is stable at every speed")
    mode = np.real(vectors[:, found.argmax()])
    return 1 / float(found.max()), mode / (equations.tip_angle @ mode)


# Equilibria at given angles of the tip, with unknown speed -------------------------------------------


def at_tip_angle(start: State, angle: float) -> State:
    """Find the equilibrium with a given angle of the tip [rad], near a start."""
    equations, q, square, before = start.equations, start.q, start.square, np.inf
    for _ in range(_NEWTON):
        residual = np.append(equations.residual(q, square), equations.tip_angle @ q - angle)
        change = np.linalg.solve(_bordered(equations, q, square), residual)
        q, square = q - change[:-1], square - change[-1]
        size = np.abs(change).max() / max(1.0, np.abs(q).max(), abs(square))
        if size <= _TOLERANCE or (size <= _SETTLED and size >= before / 4):
            return State(equations, q, float(square))
        before = size
    raise NotFound(f"no equilibrium with the tip at {angle:.6g} rad near the start")


def _bordered(equations: Collocation, q: np.ndarray, square: float) -> np.ndarray:
    n = equations.size
    matrix = np.zeros((n + 1, n + 1))
    matrix[:n, :n] = equations.stiffness(q, square)
    matrix[:n, n] = -equations.moment(q)
    matrix[n, :n] = equations.tip_angle
    return matrix


def _tangent(state: State) -> np.ndarray:
    """Compute the derivatives of the unknowns q and of gamma^2 by the angle of the tip."""
    right = np.append(np.zeros(state.q.size), 1.0)
    return np.linalg.solve(_bordered(state.equations, state.q, state.square), right)


def followed(state: State, angle: float) -> State:
    """Follow the branch of an equilibrium to another angle of the tip [rad]."""
    count = max(1, int(np.ceil(abs(angle - state.tip_angle) / _STEP)))
    for goal in np.linspace(state.tip_angle, angle, count + 1)[1:]:
        step = (goal - state.tip_angle) * _tangent(state)
        guess = replace(state, q=state.q + step[:-1], square=state.square + step[-1])
        state = at_tip_angle(guess, float(goal))
    return state


class Branch:
    """Equilibria of a branch as a function of the tip angle, each found from the nearest known one."""

    def __init__(self, start: State) -> None:
        self.known = [start]

    def at(self, angle: float) -> State:
        nearest = min(self.known, key=lambda state: abs(state.tip_angle - angle))
        self.known.append(followed(nearest, angle))
        return self.known[-1]

    def slope(self, angle: float) -> float:
        """Compute the derivative of gamma^2 by the angle of the tip."""
        return float(_tangent(self.at(angle))[-1])


def branch_at(beam: Elastica, angle: float, pieces: int = 2, nodes: int = NODES, stages: int = 20) -> State:
    """Find the equilibrium with a given tip angle on the branch that starts at the pitchfork.

    For a scene that is not symmetric, the search starts from a symmetric scene, with the axis of rotation
    on the beam's line, and moves the axis to its position at constant tip angle.
    """
    aligned = replace(beam, centre=(beam.centre[0], 0.0))
    equations = Collocation(aligned, pieces, nodes)
    square, mode = _pitchfork(equations)
    first = float(np.copysign(_FIRST_ANGLE, angle))
    state = followed(at_tip_angle(State(equations, first * mode, square), first), angle)
    if beam.is_symmetric:
        return state
    for side in np.linspace(0, beam.centre[1], stages + 1)[1:]:
        moved = Collocation(replace(beam, centre=(beam.centre[0], float(side))), pieces, nodes)
        state = at_tip_angle(replace(state, equations=moved), angle)
    return replace(state, equations=Collocation(beam, pieces, nodes))


def fold(start: State) -> State:
    """Find the equilibrium of least speed along the branch through a start."""
    branch, angle = Branch(start), start.tip_angle
    end = 0.0 if branch.slope(angle) > 0 else _limit(start)
    return branch.at(_root(branch.slope, angle, end))


def fold_beside(beam: Elastica, side: int) -> State:
    """Find the fold of the branch bent to one side."""
    for angle in _ENTRIES:
        try:
            return fold(branch_at(beam, side * angle))
        except NotFound:
            continue
    raise NotFound("no fold found")


def equilibria_bent_to(beam: Elastica, gamma: float, side: int) -> list[State]:
    """Find the equilibria not on the branch from rest at one speed, by ascending angle of the tip.

    A symmetric scene has one on either side past its pitchfork; any other has two past its fold, between the
    straight beam, which the inner one approaches at high speeds, and the beam coiled up.
    """
    lowest = branch_at(beam, side * _BESIDE) if beam.is_symmetric else fold_beside(beam, side)
    if lowest.gamma >= gamma:
        return []
    ends = (_limit(lowest),) if beam.is_symmetric else (0.0, _limit(lowest))
    return [_at_speed(Branch(lowest), gamma, end) for end in ends]


def _at_speed(branch: Branch, gamma: float, end: float) -> State:
    """Find the equilibrium at a speed on a branch, up to an angle of the tip."""

    def excess(angle: float) -> float:
        return branch.at(angle).square - gamma**2

    angle = _root(excess, branch.known[0].tip_angle, end)
    return polished(replace(branch.at(angle), square=gamma**2))


def bent(beam: Elastica, gamma: float, side: int = 1) -> State:
    """Find the stable equilibrium not on the branch from rest: the one bent farthest at this speed."""
    found = equilibria_bent_to(beam, gamma, side)
    if not found:
        raise NotFound(f"no bent equilibrium at gamma = {gamma:.6g}")
    return found[-1]


def _limit(state: State) -> float:
    return float(np.copysign(_LARGEST_ANGLE, state.tip_angle))


def _root(function: Callable[[float], float], start: float, end: float) -> float:
    """Find the first zero of a function between start and end."""
    count = int(np.ceil(abs(end - start) / _STEP)) + 1
    angles = np.linspace(start, end, count + 1)[:-1].tolist()
    before = function(start)
    for low, high in pairwise(angles):
        after = function(high)
        if before * after <= 0:
            return float(brentq(function, low, high, xtol=1e-13, rtol=1e-14))
        before = after
    raise NotFound("no change of sign along the branch")


# The least frequency --------------------------------------------------------------------------------


def slowest(beam: Elastica, low: float, high: float, pieces: int = 2) -> tuple[float, float]:
    """Find the gamma at which the first frequency on the branch from rest is least, and the frequency.

    Brent's method gives half of the digits, a polynomial through neighbouring speeds the others.
    """

    def first(gamma: float) -> float:
        return float(frequencies(from_rest(beam, gamma, pieces), 1)[0])

    near = float(minimize_scalar(first, bounds=(low, high), method="bounded", options={"xatol": 1e-6}).x)
    around = np.polynomial.Chebyshev.interpolate(
        np.vectorize(first), 6, domain=[near * (1 - _NEAR), near * (1 + _NEAR)]
    )
    roots = around.deriv().roots()
    real = roots[np.abs(roots.imag) < 1e-9].real
    gamma = float(real[np.abs(real - near).argmin()])
    return gamma, first(gamma)
