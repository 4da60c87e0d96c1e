"""The collocated balance of forces and moments; see the package's docstring."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmarks.cases.reference.elastica.beam import Elastica
from benchmarks.cases.reference.twisted_beam.mesh import Mesh

NODES = 12  # number of Gauss points of a piece


@dataclass(frozen=True)
class Shape:
    """The shape of one deflection: at the nodes and, last, at the centre of gravity of the body."""

    cos: np.ndarray
    sin: np.ndarray
    place: np.ndarray  # (2, n + 1), positions from the axis of rotation
    force: np.ndarray  # (2, n + 1), forces H, V over gamma^2, at rest in the rotating frame
    moment: np.ndarray  # (n + 1,), bending moments over gamma^2: at the root, then at the nodes
    tip: np.ndarray  # (2,), position of the tip from the root


@dataclass(frozen=True)
class Pencil:
    """Matrices of (stiffness + s gyroscopic + s^2 inertia) q = 0."""

    stiffness: np.ndarray
    gyroscopic: np.ndarray
    inertia: np.ndarray


class Collocation:
    """The equations of a beam on a mesh, for the unknowns q: curvatures at the n nodes, behind the turn of
    the root where there is a spring."""

    def __init__(self, beam: Elastica, pieces: int = 3, nodes: int = NODES) -> None:
        self.beam = beam
        self.mesh = mesh = Mesh.make(beam.breakpoints, pieces, nodes)
        x, body = mesh.x.ravel(), beam.body
        self.weights = (mesh.steps[:, None] * mesh.weights).ravel()
        ahead, beyond = _from_root(mesh), _to_tip(mesh)
        one, zero = np.ones((x.size, 1)), np.zeros((x.size, 1))
        mass = beam.mass(x)
        # Matrices that give slopes from curvatures, positions from cos and sin, forces from m a, and moments.
        self.turn = np.block([[one, ahead], [np.ones((1, 1)), self.weights[None]]])
        self.reach = np.block([[ahead, zero], [self.weights[None], np.full((1, 1), body.offset)]])
        self.outboard = np.block([[beyond * mass, body.mass * one], [0 * zero.T, np.full((1, 1), body.mass)]])
        self.lever = np.vstack([np.append(self.weights, body.offset), np.hstack([beyond, body.offset * one])])
        self.twist = np.vstack([np.append(self.weights, 1.0), np.hstack([beyond, one])])
        self.rotary = np.append(beam.rotary(x), body.inertia)
        self.spin = (1 - beam.in_plane) * np.append(beam.rotary(x), -body.spin)
        self.bending = np.append(0.0 if math.isinf(beam.spring) else beam.spring, beam.stiffness(x))
        self.free = slice(1 if math.isinf(beam.spring) else 0, None)

    @property
    def size(self) -> int:
        return self.turn.shape[1] - self.free.start

    @property
    def row_weights(self) -> np.ndarray:
        """Weights of the equations in virtual work: 1 at the root, and those of integrals at the nodes."""
        return np.append(1.0, self.weights)[self.free]

    @cached_property
    def tip_angle(self) -> np.ndarray:
        """Derivative of the tip's slope theta(1) by the unknowns q."""
        return self.turn[-1, self.free]

    def shape(self, q: np.ndarray) -> Shape:
        theta = self.turn[:, self.free] @ q
        cos, sin = np.cos(theta), np.sin(theta)
        place = np.stack([self.reach @ cos, self.reach @ sin])
        tip = np.array([self.weights @ cos[:-1], self.weights @ sin[:-1]])
        seen = place - np.array(self.beam.centre)[:, None]
        seen[1] *= self.beam.in_plane
        force = np.stack([self.outboard @ seen[0], self.outboard @ seen[1]])
        moment = self.lever @ (force[1] * cos - force[0] * sin) + self.twist @ (self.spin * sin * cos)
        return Shape(cos, sin, seen, force, moment, tip)

    def moment(self, q: np.ndarray) -> np.ndarray:
        """Compute the moment of centrifugal forces over gamma^2, at the position of each unknown."""
        return self.shape(q).moment[self.free]

    def residual(self, q: np.ndarray, square: float) -> np.ndarray:
        """Compute the residual B kappa - M at a given gamma^2."""
        return self.bending[self.free] * q - square * self.moment(q)

    def stiffness(self, q: np.ndarray, square: float) -> np.ndarray:
        """Compute the derivative of the residual by the unknowns q."""
        shape, turn = self.shape(q), self.turn
        along, across = self._moves(shape)
        force = self.outboard @ along, self.beam.in_plane * self.outboard @ across
        tilt = shape.force[1] * shape.sin + shape.force[0] * shape.cos
        by_force = self._moment_of(shape, *force) - self.lever @ (tilt[:, None] * turn)
        by_spin = self.twist @ ((self.spin * (shape.cos**2 - shape.sin**2))[:, None] * turn)
        return self._free(np.diag(self.bending) - square * (by_force + by_spin))

    def pencil(self, q: np.ndarray, square: float) -> Pencil:
        """Return the equations of small motions about an equilibrium."""
        shape = self.shape(q)
        along, across = self._moves(shape)
        twice = 2 * math.sqrt(square) * self.beam.in_plane
        coriolis = -twice * self.outboard @ across, twice * self.outboard @ along
        inertia = -self.outboard @ along, -self.outboard @ across
        turning = self.twist @ (self.rotary[:, None] * self.turn)
        return Pencil(
            self.stiffness(q, square),
            self._free(-self._moment_of(shape, *coriolis)),
            self._free(turning - self._moment_of(shape, *inertia)),
        )

    def _moves(self, shape: Shape) -> tuple[np.ndarray, np.ndarray]:
        """Compute the derivatives of positions X and Y by the unknowns q."""
        return -self.reach @ (shape.sin[:, None] * self.turn), self.reach @ (shape.cos[:, None] * self.turn)

    def _moment_of(self, shape: Shape, horizontal: np.ndarray, vertical: np.ndarray) -> np.ndarray:
        return self.lever @ (shape.cos[:, None] * vertical - shape.sin[:, None] * horizontal)

    def _free(self, matrix: np.ndarray) -> np.ndarray:
        return matrix[self.free, self.free]


def _from_root(mesh: Mesh) -> np.ndarray:
    """Compute integrals from the root to each node of the polynomials through the nodes: (n, n)."""
    pieces, nodes = mesh.x.shape
    matrix = np.zeros((pieces, nodes, pieces, nodes))
    for k, step in enumerate(mesh.steps):
        matrix[k, :, k] = step * mesh.inner
        matrix[k + 1 :, :, k] = step * mesh.weights
    return matrix.reshape(pieces * nodes, -1)


def _to_tip(mesh: Mesh) -> np.ndarray:
    """Compute integrals from each node to the tip."""
    whole = (mesh.steps[:, None] * mesh.weights).ravel()
    return whole - _from_root(mesh)
