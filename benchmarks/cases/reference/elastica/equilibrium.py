"""Equilibria of the elastica: Newton's method, and continuation in speed from rest."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.cases.reference.elastica.beam import Elastica
from benchmarks.cases.reference.elastica.equations import NODES, Collocation

_TOLERANCE = 3e-15  # tolerance of curvatures, over the larger of 1 and the largest curvature
_SETTLED = 1e-11  # change of curvatures below which it may be rounding
_STEPS = 30
_LARGEST_TURN = 0.15  # largest change of a slope in one step of continuation [rad]
_LARGEST_CORRECTION = 0.03  # largest difference of a slope from its prediction along the tangent [rad]
_LEAST_STEP = 1e-9


class NotFound(ArithmeticError):
    """Raised if no equilibrium is found near the start."""


@dataclass(frozen=True)
class State:
    """An equilibrium.

    Parameters
    ----------
    equations
        The collocated equations that the equilibrium satisfies.
    q
        Values of the unknowns of the equations.
    square
        gamma^2.
    """

    equations: Collocation
    q: np.ndarray
    square: float

    @property
    def gamma(self) -> float:
        return float(np.sqrt(self.square))

    @property
    def tip(self) -> np.ndarray:
        """Position of the tip from the root, along the beam at rest and along the direction of bending."""
        return self.equations.shape(self.q).tip

    @property
    def tip_angle(self) -> float:
        return float(self.equations.tip_angle @ self.q)

    @property
    def stiffness(self) -> np.ndarray:
        return self.equations.stiffness(self.q, self.square)

    @property
    def downhill(self) -> int:
        """Number of negative eigenvalues of the stiffness, which changes at folds and pitchforks.

        The stiffness is the second derivative of the energy, but for the weights of the nodes.
        """
        weighted = self.equations.row_weights[:, None] * self.stiffness
        return int((np.linalg.eigvalsh((weighted + weighted.T) / 2) < 0).sum())


def polished(start: State, steps: int = _STEPS) -> State:
    """Find the equilibrium at the speed of the start by Newton's method."""
    equations, q, before = start.equations, start.q, np.inf
    for _ in range(steps):
        change = np.linalg.solve(equations.stiffness(q, start.square), equations.residual(q, start.square))
        q = q - change
        size = np.abs(change).max() / max(1.0, np.abs(q).max())
        if size <= _TOLERANCE or (size <= _SETTLED and size >= before / 4):
            return replace(start, q=q)
        before = size
    raise NotFound(f"Newton's method does not settle at gamma = {start.gamma:.6g}")


def on(equations: Collocation, state: State) -> State:
    """Return the same equilibrium on another mesh."""
    theta_rate = _interpolated(state, equations.mesh.x.ravel())
    root = state.q[: 1 - state.equations.free.start]
    return polished(State(equations, np.append(root, theta_rate), state.square))


def _interpolated(state: State, x: np.ndarray) -> np.ndarray:
    """Interpolate the curvature at any x by the polynomials through the nodes of each piece."""
    mesh = state.equations.mesh
    curvature = state.q[1 - state.equations.free.start :].reshape(mesh.x.shape)
    place = np.clip(np.searchsorted(mesh.ends, x, side="right") - 1, 0, mesh.steps.size - 1)
    local = 2 * (x - mesh.ends[place]) / mesh.steps[place] - 1
    nodes = 2 * (mesh.x[0] - mesh.ends[0]) / mesh.steps[0] - 1
    legendre = np.polynomial.legendre
    coefficients = np.linalg.solve(legendre.legvander(nodes, nodes.size - 1), curvature.T)  # (nodes, pieces)
    return np.sum(legendre.legvander(local, nodes.size - 1) * coefficients[:, place].T, axis=1)


def from_rest(beam: Elastica, gamma: float, pieces: int = 3, nodes: int = NODES) -> State:
    """Follow the equilibrium from the straight beam at rest, in steps of gamma^2.

    A step is halved until Newton's method converges near the prediction by the tangent, and the number of
    negative eigenvalues is unchanged; only the straight beam of a symmetric scene may pass its pitchfork.
    """
    equations = Collocation(beam, pieces, nodes)
    state = State(equations, np.zeros(equations.size), 0.0)
    if beam.is_symmetric:
        return replace(state, square=gamma**2)
    step = goal = gamma**2
    while state.square < goal:
        step = min(step, goal - state.square)
        try:
            state = _advanced(state, step)
            step *= 2
        except NotFound:
            step /= 2
            if step < _LEAST_STEP * goal:
                raise NotFound(f"the branch from rest ends at gamma = {state.gamma:.9g}") from None
    return polished(replace(state, square=goal))


def _advanced(state: State, step: float) -> State:
    """Return the next equilibrium, if it clearly belongs to the same branch."""
    equations = state.equations
    tangent = np.linalg.solve(state.stiffness, equations.moment(state.q))
    turn = equations.turn[:, equations.free]
    if np.abs(turn @ tangent).max() * step > _LARGEST_TURN:
        raise NotFound("a step too long")
    guess = replace(state, q=state.q + step * tangent, square=state.square + step)
    found = polished(guess, steps=8)
    strayed = np.abs(turn @ (found.q - guess.q)).max() > _LARGEST_CORRECTION
    if strayed or found.downhill != state.downhill:
        raise NotFound("another branch")
    return found
