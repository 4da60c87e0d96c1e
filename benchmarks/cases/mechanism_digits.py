"""Equilibrium of drawn mechanisms to many digits, from forces and moments on each body.

No code of the package is used except the classes of joints and loads: no rows, gradients or scales.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
from mpmath import mpf

from brakes import planar

DIGITS = 40
_SETTLED = mpf(10) ** -30  # relative change of the forces below which friction has converged
_STEPS = 60

Wrench = dict[str, tuple[mpf, mpf, mpf]]  # forces along x and y, and moment about (0, 0), by body


@dataclass(frozen=True)
class Unknown:
    """A component of a joint's force, or an unknown load, as forces of unit size on the bodies."""

    name: str
    wrench: Wrench


def _force(body: str, at: Sequence[float], fx: Any, fy: Any) -> Wrench:
    x, y = map(mpf, at)
    return {body: (mpf(fx), mpf(fy), x * fy - y * fx)}


def _couple(body: str, size: Any) -> Wrench:
    return {body: (mpf(0), mpf(0), mpf(size))}


def _sum(*wrenches: Wrench) -> Wrench:
    total: dict[str, list[mpf]] = {}
    for wrench in wrenches:
        for body, parts in wrench.items():
            total[body] = [a + b for a, b in zip(total.get(body, [mpf(0)] * 3), parts, strict=True)]
    return {body: (a, b, c) for body, (a, b, c) in total.items()}


def _scaled(wrench: Wrench, size: Any) -> Wrench:
    return {body: (size * a, size * b, size * c) for body, (a, b, c) in wrench.items()}


def _pair(body: str, other: str, at: Sequence[float], fx: Any, fy: Any) -> Wrench:
    """Return a force on a body at a point, and the opposite force on the other body at this point."""
    return _sum(_force(body, at, fx, fy), _force(other, at, -fx, -fy))


def _unit(v: Sequence[float]) -> tuple[mpf, mpf]:
    x, y = map(mpf, v)
    size = mpmath.sqrt(x * x + y * y)
    return x / size, y / size


def _normal(contact: planar.Contact) -> tuple[mpf, mpf]:
    """Return the normal of a straight face, or of a round face the direction away from its centre."""
    if contact.centre is None:
        return _unit(contact.normal or (0.0, 1.0))
    return _unit([mpf(p) - mpf(c) for p, c in zip(contact.at, contact.centre, strict=True)])


def _pull(bodies: Sequence[str], points: Sequence[Sequence[float]]) -> Wrench:
    """Return a unit tension along a polyline through points of bodies."""
    parts = []
    for (a, p), (b, q) in zip(
        zip(bodies, points, strict=True), list(zip(bodies, points, strict=True))[1:], strict=False
    ):
        ux, uy = _unit((mpf(q[0]) - mpf(p[0]), mpf(q[1]) - mpf(p[1])))
        parts += [_force(a, p, ux, uy), _force(b, q, -ux, -uy)]
    return _sum(*parts)


def joint_forces(joint: planar.Joint) -> list[Unknown]:
    """List the unknown force components of a joint."""
    match joint:
        case planar.Pin():
            axes = (1, 0), (0, 1)
            return [Unknown(joint.name, _pair(joint.body, joint.other, joint.at, *axis)) for axis in axes]
        case planar.Bar():
            return [Unknown(joint.name, _pull((joint.body, joint.other), (joint.at, joint.to)))]
        case planar.Cable():
            return [Unknown(joint.name, _pull(joint.bodies, joint.points))]
        case planar.Slot():
            x, y = _unit(joint.along)
            return [Unknown(joint.name, _pair(joint.body, joint.other, joint.at, -y, x))]
        case planar.Contact():
            return [Unknown(joint.name, _pair(joint.body, joint.other, joint.at, *_normal(joint)))]
        case planar.RotationLock():
            ratio = mpf(joint.ratio)
            return [Unknown(joint.name, _sum(_couple(joint.body, 1), _couple(joint.other, -ratio)))]
    raise TypeError(f"no forces to many digits of {joint!r}")


def load_force(load: planar.Load) -> tuple[Wrench, mpf | None]:
    """Return the forces of a unit load, and the load's magnitude as drawn; None if unknown."""
    match load:
        case planar.Force():
            return _force(load.body, load.at, *_unit(load.direction)), _size(load.magnitude)
        case planar.Moment():
            return _sum(_couple(load.body, 1), _couple(load.other, -1)), _size(load.magnitude)
        case planar.CablePair():
            return _pull((load.body, load.other), (load.at, load.to)), _size(load.magnitude)
        case planar.Spring():
            length = mpmath.hypot(mpf(load.at[0]) - mpf(load.to[0]), mpf(load.at[1]) - mpf(load.to[1]))
            tension = mpf(load.stiffness) * (length - mpf(load.free_length))
            return _pull((load.body, load.other), (load.at, load.to)), tension
        case planar.TorsionSpring():
            couple = mpf(load.stiffness) * mpf(load.free_angle)
            return _sum(_couple(load.body, 1), _couple(load.other, -1)), couple
    raise TypeError(f"no force to many digits of {load!r}")


def _size(magnitude: float | None) -> mpf | None:
    return None if magnitude is None else mpf(magnitude)


def friction_force(joint: Any) -> tuple[Wrench, mpf]:
    """Return the forces of unit friction, signed as in the package, and the friction coefficient."""
    if isinstance(joint, planar.Pin):
        mu = mpf(joint.friction)
        arm = mpf(joint.radius) * mu / mpmath.sqrt(1 + mu * mu)
        return _sum(_couple(joint.body, 1), _couple(joint.other, -1)), arm
    along = _unit(joint.along) if isinstance(joint, planar.Slot) else _normal(joint)
    x, y = along if isinstance(joint, planar.Slot) else (-along[1], along[0])
    return _pair(joint.body, joint.other, joint.at, x, y), mpf(joint.friction)


def exact_forces(
    mechanism: planar.Mechanism, senses: Mapping[str, float], start: Mapping[str, Sequence[float]]
) -> dict[str, list[mpf]] | None:
    """Compute forces of joints, and loads, by name [N, N m]; None if friction does not converge.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism, as drawn.
    senses : mapping
        Sign of the friction of each joint that rubs, against the sliding.
    start : mapping
        Initial forces of joints with friction, by component, for the direction in which each presses.
    """
    with mpmath.workdps(DIGITS):
        loads = {load.name: load_force(load) for load in mechanism.loads}
        unknown = [each for joint in mechanism.joints for each in joint_forces(joint)]
        unknown += [Unknown(name, wrench) for name, (wrench, size) in loads.items() if size is None]
        known = _sum(*(_scaled(wrench, size) for wrench, size in loads.values() if size is not None))
        rubbing = {joint.name: joint for joint in mechanism.joints if joint.name in senses}
        forces = {name: [mpf(part) for part in parts] for name, parts in start.items()}
        for _ in range(_STEPS):
            directions = {name: _direction(parts) for name, parts in forces.items()}
            found = _solve(mechanism.bodies, unknown, known, rubbing, senses, directions)
            changed = max(
                (abs(a - b) for name in forces for a, b in zip(forces[name], found[name], strict=True)),
                default=mpf(0),
            )
            largest = max(abs(part) for parts in found.values() for part in parts)
            forces = {name: found[name] for name in forces}
            if changed <= _SETTLED * largest:
                return found
    return None


def _direction(parts: Sequence[mpf]) -> list[mpf]:
    size = mpmath.sqrt(sum(part * part for part in parts))
    return [part / size for part in parts]


def _solve(
    bodies: Sequence[str],
    unknown: Sequence[Unknown],
    known: Wrench,
    rubbing: Mapping[str, planar.Joint],
    senses: Mapping[str, float],
    directions: Mapping[str, Sequence[mpf]],
) -> dict[str, list[mpf]]:
    """Solve for forces in equilibrium with known loads, friction proportional to forces along directions."""
    seen: dict[str, int] = {}
    matrix = mpmath.zeros(3 * len(bodies), len(unknown))
    for j, each in enumerate(unknown):
        wrench = each.wrench
        if each.name in rubbing:
            k = seen[each.name] = seen.get(each.name, -1) + 1
            rub, coefficient = friction_force(rubbing[each.name])
            wrench = _sum(wrench, _scaled(rub, senses[each.name] * coefficient * directions[each.name][k]))
        for i, body in enumerate(bodies):
            for c, part in enumerate(wrench.get(body, (0, 0, 0))):
                matrix[3 * i + c, j] = part
    right = mpmath.matrix([-part for body in bodies for part in known.get(body, (mpf(0),) * 3)])
    sizes = mpmath.lu_solve(matrix, right)
    found: dict[str, list[mpf]] = {}
    for each, size in zip(unknown, sizes, strict=True):
        found.setdefault(each.name, []).append(size)
    return found
