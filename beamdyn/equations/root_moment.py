"""Bending moment at the root, computed from the loads and the inertia of the whole beam.

The curvature of a few modes converges slowly at a clamped end, and from below.  The principle of virtual work
needs no curvature there: its test function w may rotate about the root, so that the clamp's moment M does
work,

    M w'(0) = f[w] - m[q'', w] - g[q', w] - k[q, w],

with the loads f and the forms m, g, k of mass, gyroscopic terms and stiffness.  The test function is the
rigid rotation x/L, made orthogonal to the modes in the model with respect to the mass matrix: neither
accelerations nor modal damping (C q' with C = M Phi 2 zeta Omega Phi^T M) do work on it.  The result is the
moment of the modes in the model, and the static moment of all others, as in the mode-acceleration method:
Craig and Kurdila, Fundamentals of Structural Dynamics (2006), section 11.4.  If a spring supports the root, M
is the moment of the spring; it also does work on the modes contained in w, as they rotate the root.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.scene.scene import Scene


@dataclass(frozen=True)
class RootMoment:
    """Bending moment at the root as a linear function of coordinates and their velocities.

    Parameters
    ----------
    load : dict of str to float
        Moment in the undeflected beam per unit of each quantity of the root's motion [N m per unit].
    position, velocity : dict of str to ndarray, shape (n,)
        Moment per unit coordinate and velocity, for each quantity of the root's motion that multiplies it.
    """

    load: Mapping[Quantity, float]
    position: Mapping[Quantity, np.ndarray]
    velocity: Mapping[Quantity, np.ndarray]

    def at(self, root: RootMotion, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Compute the moment [N m] at coordinates q and velocities v, positive for a positive deflection."""
        moment = np.zeros(root.unity.shape)
        for quantity, value in self.load.items():
            moment += getattr(root, quantity) * value
        for rows, state in ((self.position, q), (self.velocity, v)):
            for quantity, row in rows.items():
                moment += getattr(root, quantity) * (state @ row)
        return moment


def root_moment(scene: Scene, discretization: Discretization, equations: Equations) -> RootMoment:
    """Derive the bending moment at the root as a function of the coordinates of given equations.

    The moment is about the bending axis of the root section, which depends on the twist.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : Discretization
        Discretization of the scene's equations.
    equations : Equations
        Equations of the scene in this discretization, reduced or not.

    Returns
    -------
    RootMoment
    """
    twist = scene.modelled_beam.root_twist
    by_direction = [math.cos(twist), math.sin(twist)][: equations.planes]
    moments = [_moment(scene, discretization, equations, direction) for direction in range(len(by_direction))]
    if by_direction == [1.0]:
        return moments[0]
    parts = ([m.load for m in moments], [m.position for m in moments], [m.velocity for m in moments])
    return RootMoment(*(_weighted_sum(part, by_direction) for part in parts))


def strain_per_moment(scene: Scene) -> float:
    """Compute the strain of the outer fibre at the root per bending moment there [1/(N m)].

    The beam's `outer_fibre` must be given.  For a plate, the strain is the mean over the width.
    """
    beam, root = scene.beam, np.zeros(1)
    assert beam.outer_fibre is not None
    stiffness = float(beam.bending_stiffness(root)[0])
    if scene.physics.camber and beam.strip is not None:
        stiffness *= float(beam.strip.camber_stiffening(root)[0])
    return float(beam.outer_fibre(root)[0]) / stiffness


def _weighted_sum(parts: Sequence[Mapping[Quantity, Any]], factors: list[float]) -> dict[Quantity, Any]:
    """Sum values of each quantity times factors, one factor for each part; a missing quantity counts as 0."""
    names: dict[Quantity, None] = dict.fromkeys(name for part in parts for name in part)
    pairs = [*zip(factors, parts, strict=True)]
    return {name: sum(f * part.get(name, 0.0) for f, part in pairs) for name in names}


@dataclass(frozen=True)
class StaticLoad:
    """A constant load on the beam at steady speed, and the deflection under it.

    Parameters
    ----------
    accelerations : dict of str to complex
        Values of quantities of the root's motion that load the beam in addition to the steady rotation.
    force : tuple of (float, int), optional
        Position x/L and direction of a unit force.
    deflection : ndarray, shape (n,)
        Static deflection under the load, as coordinates of all functions of the discretization.
    """

    accelerations: Mapping[Quantity, complex]
    force: tuple[float, int] | None
    deflection: np.ndarray


def static_moment(
    scene: Scene, discretization: Discretization, equations: Equations, root: RootMotion, load: StaticLoad
) -> complex:
    """Compute the bending moment at the root under a static load [N m], by equilibrium of forces.

    Parameters
    ----------
    scene, discretization
        As for `root_moment`.
    equations : Equations
        Equations of the scene in all functions of the discretization.
    root : RootMotion
        The root's motion at the steady speed.
    load : StaticLoad
        The load, and the deflection under it.
    """
    twist, total = scene.modelled_beam.root_twist, 0.0 + 0.0j
    for about, factor in enumerate([math.cos(twist), math.sin(twist)][: equations.planes]):
        if scene.mount.root_stiffnesses[about] == 0:
            continue
        full = _freed(scene, discretization, about)
        rotation = _rotation(full, full.blocks[_field_of(equations, about)])
        given = load.accelerations.items()
        pushed = sum((a * full.vectors.get(name, 0.0) for name, a in given), np.zeros(full.size))
        if load.force is not None:
            pushed = pushed + full.deflection(np.array(load.force[:1]), direction=load.force[1])[:, 0]
        held = full.matrix(0, root) @ _embed(full, equations) @ load.deflection
        total += factor * scene.beam.length * (rotation @ (pushed - held))
    return complex(total)


def _freed(scene: Scene, discretization: Discretization, direction: int) -> Equations:
    """Assemble the equations of the scene with a root that rotates freely in one direction."""
    hinges = {"root_stiffness": 0.0} if direction == 0 else {"second_root_stiffness": 0.0}
    local = replace(scene.damping, ratios=())  # leave out modal damping: it does no work on the test function
    freed = replace(scene, damping_ratio=0.0, damping=local, mount=replace(scene.mount, **hinges))
    return assemble_over(freed, discretization.spaces(scene.modelled_beam))


def _field_of(equations: Equations, direction: int) -> str:
    """Find the name of the field that bends the beam in a direction."""
    return next(n for n, d in equations.deflections.items() if d.direction == direction)


def _moment(scene: Scene, discretization: Discretization, equations: Equations, direction: int) -> RootMoment:
    """Derive the moment of the clamp or spring at the root from the virtual work of a rotation."""
    spring = scene.mount.root_stiffnesses[direction]
    if spring == 0:
        return RootMoment({}, {}, {})
    full, name = _freed(scene, discretization, direction), _field_of(equations, direction)
    kept, M, rigid = _embed(full, equations), full.matrices[2]["unity"], _rotation(full, full.blocks[name])
    moving = kept.any(axis=0)  # omit the coordinate of a circuit
    share, own = np.zeros(equations.size), kept if moving.all() else kept[:, moving]
    share[moving] = np.linalg.solve(own.T @ M @ own, own.T @ M @ rigid)
    rotation = rigid - kept @ share  # subtract the mass-orthogonal projection on the modes in the model
    length = scene.beam.length  # the slope of the rotation x/L is 1/L

    def rows(order: int) -> dict[Quantity, np.ndarray]:
        matrices = full.matrices[order].items()
        return {quantity: -length * (rotation @ A @ kept) for quantity, A in matrices}

    loads = full.vectors.items()
    load: dict[Quantity, float] = {quantity: length * float(rotation @ f) for quantity, f in loads}
    position, velocity = rows(0), rows(1)
    if math.isfinite(spring):
        slope = kept[full.blocks[name].start] / length  # slope due to bending, without shear
        of_spring = spring * length * (slope @ share) * slope
        position["unity"] = position["unity"] + of_spring
        if beta := scene.damping.stiffness_factor:  # it damps the spring, too
            velocity["unity"] = velocity["unity"] + beta * of_spring
    if (voltage := equations.voltage) is not None and full.circuit is not None:
        by_state = position if voltage.order == 0 else velocity
        of_voltage = length * (rotation @ full.circuit.coupling) * voltage.row
        by_state["unity"] = by_state.get("unity", 0.0) + of_voltage
    return RootMoment(load, position, velocity)


def _embed(full: Equations, equations: Equations) -> np.ndarray:
    """Compute the matrix that transforms coordinates of `equations` to those of `full`.

    `full` are the equations in all functions, for a root that rotates freely.
    """
    kept = np.zeros((full.size, equations.size))
    for name, shape in equations.shapes.items():
        end = full.blocks[name].stop
        kept[end - len(shape.matrix) : end, equations.blocks[shape.block]] = shape.matrix
    return kept


def _rotation(full: Equations, field: slice) -> np.ndarray:
    """Build the rigid rotation x/L about the root, a deflection without elastic energy, as coordinates.

    The only coordinate with a slope at the root is the field's first.
    """
    first, others = field.start, np.arange(field.start + 1, field.stop)
    K, rotation = full.matrices[0]["unity"], np.zeros(full.size)
    rotation[first] = 1.0
    rotation[others] = -np.linalg.solve(K[np.ix_(others, others)], K[others, first])
    return rotation
