"""Bending moment at the clamped root, from the loads and the inertia of the whole beam.

The curvature of a few modes converges slowly at a clamped end, and from below.  The principle of virtual
work needs no curvature there: its test function w may turn about the root, against the clamp, whose moment
M then does work,

    M w'(0) = f[w] - m[q'', w] - g[q', w] - k[q, w],

with the loads f and the forms m, g, k of mass, gyroscopic terms and stiffness.  The test function here is
the rigid rotation x/L minus as much of the kept shapes as makes it orthogonal to them in the mass: neither
the accelerations nor modal damping (C q' with C = M Phi 2 zeta Omega Phi^T M) work on it.  What remains is
the moment of the kept shapes and the static one of all others, as in the mode-acceleration method: Craig
and Kurdila, Fundamentals of Structural Dynamics (2006), section 11.4.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from beamdyn.equations.discretization import Discretization, Space, Spaces
from beamdyn.equations.equations_of_motion import Equations, assemble_over
from beamdyn.equations.fields.bending import HELD
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.scene.profile import FRACTION, Profile
from beamdyn.scene.scene import Scene

_ROTATION = (FRACTION, Profile((0.0, 1.0), ((1.0,),)), Profile((0.0, 1.0), ((0.0,),)))  # x/L, derivatives


@dataclass(frozen=True)
class RootMoment:
    """Bending moment at the root as a linear function of coordinates and velocities.

    Parameters
    ----------
    load : dict of str to float
        Moment by each quantity of the root's motion on the beam at rest [N m per unit].
    position, velocity : dict of str to ndarray, shape (n,)
        Moment per coordinate and per velocity, by each quantity of the root's motion.
    """

    load: Mapping[Quantity, float]
    position: Mapping[Quantity, np.ndarray]
    velocity: Mapping[Quantity, np.ndarray]

    def at(self, root: RootMotion, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Moment [N m], positive if it bends towards positive deflection, for q and v (T, n): shape (T,)."""
        moment = np.zeros(root.unity.shape)
        for quantity, value in self.load.items():
            moment += getattr(root, quantity) * value
        for rows, state in ((self.position, q), (self.velocity, v)):
            for quantity, row in rows.items():
                moment += getattr(root, quantity) * (state @ row)
        return moment


def root_moment(scene: Scene, discretization: Discretization, equations: Equations) -> RootMoment:
    """Derive the bending moment at the root for the coordinates of given equations.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : Discretization
        Its discretization.
    equations : Equations
        Equations of the scene in this discretization, as they are or reduced.

    Returns
    -------
    RootMoment
    """
    turning = _equations_with_rotation(replace(scene, damping_ratio=0.0), discretization, equations.shapes)
    rotations = [turning.blocks[name].start for name in equations.deflections]
    kept = np.concatenate(
        [np.arange(b.stop - equations.shapes[name].shape[1], b.stop) for name, b in turning.blocks.items()]
    )
    length = scene.beam.length  # the slope of the rotation x/L is 1/L

    def rows(order: int) -> dict[Quantity, np.ndarray]:
        matrices = turning.matrices[order].items()
        return {name: -length * A[np.ix_(rotations, kept)].sum(axis=0) for name, A in matrices}

    load: dict[Quantity, float] = {
        name: length * float(f[rotations].sum()) for name, f in turning.vectors.items()
    }
    return RootMoment(load, rows(0), rows(1))


def _equations_with_rotation(
    scene: Scene, discretization: Discretization, shapes: Mapping[str, np.ndarray]
) -> Equations:
    """Equations over the given shapes; the first of a clamped field is the rotation, orthogonal to them."""
    full = assemble_over(scene, _SpacesWithRotation(discretization.spaces(scene.beam)))
    mass = full.matrices[2]["unity"]
    extended = {name: _add_rotation(mass[place, place], shapes[name]) for name, place in full.blocks.items()}
    return full.reduced(extended)


def _add_rotation(mass: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Shapes with the rotation before them if the mass has it, minus its projection on the shapes."""
    if len(mass) == len(shapes):
        return shapes
    kept = scipy.linalg.block_diag([[1.0]], shapes)
    product = kept.T @ mass @ kept
    kept[:, 0] -= kept[:, 1:] @ np.linalg.solve(product[1:, 1:], product[1:, 0])
    return kept


@dataclass(frozen=True)
class _SpacesWithRotation:
    """Function spaces with the rigid rotation x/L as the first function of a clamped deflection."""

    spaces: Spaces

    def functions(self, held: int) -> Space:
        """Trial functions, with the rotation before the clamped ones."""
        space = self.spaces.functions(held)
        return _SpaceWithRotation(space) if held == HELD else space

    def product(self, weight: Profile, rows: int, columns: int) -> np.ndarray:
        """Integrate the weight times functions i of ``functions(rows)`` and j of ``functions(columns)``."""
        matrix, moment = self.spaces.product(weight, rows, columns), weight * FRACTION
        if columns == HELD:
            matrix = np.column_stack([self.spaces.functions(rows).load(moment), matrix])
        if rows == HELD:
            matrix = np.vstack([self.functions(columns).load(moment), matrix])
        return matrix


@dataclass(frozen=True)
class _SpaceWithRotation:
    """The rigid rotation x/L, then the functions of a space."""

    space: Space

    @property
    def size(self) -> int:
        """Number of functions."""
        return self.space.size + 1

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate the weight times the `order`-th derivatives of functions i and j."""
        row = self.load(weight * _ROTATION[order], order)
        return np.block([[row[:1, None], row[None, 1:]], [row[1:, None], self.space.gram(weight, order)]])

    def load(self, weight: Profile, order: int = 0) -> np.ndarray:
        """Integrate the weight times the `order`-th derivative of function i."""
        rotation = (weight * _ROTATION[order]).outboard_integral()
        return np.append(rotation(np.zeros(1)), self.space.load(weight, order))

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives at the tip."""
        return np.append(_ROTATION[order](np.ones(1)), self.space.end(order))

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives at xi."""
        return np.vstack([_ROTATION[order](np.asarray(xi, dtype=float)), self.space.evaluate(xi, order)])
