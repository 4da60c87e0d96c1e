"""Planar mechanisms that tests and benchmarks share: the eeBrake, random ones, and their virtual work."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from brakes.planar import (
    GROUND,
    Bar,
    Cable,
    CablePair,
    Contact,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    Spring,
    TorsionSpring,
    solve,
    trace,
)

MM = 1e-3


def _mm(x: float, y: float) -> tuple[float, float]:
    return x * MM, y * MM


PIVOT_R, PIVOT_L = _mm(17.5, -19), _mm(-17.5, -19)
PAD_R, PAD_L = _mm(12.75, -45), _mm(-12.75, -45)
UPPER_R, UPPER_L = _mm(25.5, 11.053947511008978), _mm(-25.5, 11.053947511008978)
A, B, C = _mm(-22, 20.679813957477265), _mm(-12.6, 29), _mm(-3.765798714439799, 33.9)
G, BOLT = _mm(-3.6, 14.9), (0.0, 0.0)

JOINTS = (
    Pin("pivot R", "R", GROUND, PIVOT_R),
    Pin("pivot L", "L", GROUND, PIVOT_L),
    Pin("O", "V", "L", UPPER_L),
    Bar("S", "R", "V", UPPER_R, B),
    Bar("K", "V", GROUND, A, G),
)


def eebrake(tension=None, right=1.0, left=1.0, joints=JOINTS) -> Mechanism:
    """Build the eeBrake as reconstructed: levers R and L, upper-left lever V, strut S and link K as bars."""
    return Mechanism(
        ("R", "L", "V"),
        joints,
        (
            Force("pad R", "R", PAD_R, (1, 0), right),
            Force("pad L", "L", PAD_L, (-1, 0), left),
            CablePair("cable", "V", GROUND, C, PIVOT_R, tension),
        ),
    )


# Random mechanisms, and their virtual work by separate formulas: points in the frame of the drawing, complex
# steps of lengths, distances and angles.  No derivative of brakes.planar is used.

KINDS = ("Pin", "Bar", "Slot", "Contact", "RotationLock", "Cable")
LOADS = ("Force", "Follower", "Moment", "CablePair", "Spring", "TorsionSpring")
_STEP = 1e-30  # size of the complex step, with which derivatives are exact to rounding


def _rotated(angle, x, y):
    return np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y


class Motion:
    """Virtual motions: each coordinate of each body in turn moves by a complex step; arrays (3 n,)."""

    def __init__(self, bodies, poses):
        size = 3 * len(bodies)
        moved = np.repeat(np.ravel(poses)[:, None].astype(complex), size, axis=1)
        moved[np.arange(size), np.arange(size)] += 1j * _STEP
        self.pose = {body: moved[3 * k : 3 * k + 3] for k, body in enumerate(bodies)}
        self.pose[GROUND] = np.zeros((3, size), complex)

    def point(self, body, at):
        x, y, angle = self.pose[body]
        dx, dy = _rotated(angle, *at)
        return x + dx, y + dy

    def angle(self, body):
        return self.pose[body][2]

    def length(self, bodies, points):
        places = [self.point(b, p) for b, p in zip(bodies, points, strict=True)]
        return sum(np.sqrt((q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2) for p, q in pairwise(places))

    def offset(self, joint, normal):
        """Compute n.(p - o), with a normal n that turns with the other body."""
        p, o = (
            self.point(joint.body, joint.at),
            self.point(joint.other, joint.at if joint.on is None else joint.on),
        )
        x, y = _rotated(self.angle(joint.other), *(np.array(normal) / np.hypot(*normal)))
        return x * (p[0] - o[0]) + y * (p[1] - o[1])


def joint_functions(motion, joint):
    """Return the quantities that a joint keeps constant; they grow in the direction of the joint's force."""
    if isinstance(joint, Pin):
        p, q = motion.point(joint.body, joint.at), motion.point(joint.other, joint.at)
        return [p[0] - q[0], p[1] - q[1]]
    if isinstance(joint, Bar):
        return [-motion.length((joint.body, joint.other), (joint.at, joint.to))]
    if isinstance(joint, Cable):
        return [-motion.length(joint.bodies, joint.points)]
    if isinstance(joint, RotationLock):
        return [motion.angle(joint.body) - joint.ratio * motion.angle(joint.other)]
    if isinstance(joint, Slot):
        return [motion.offset(joint, (-joint.along[1], joint.along[0]))]
    return [motion.offset(joint, joint.normal)]


def load_function(motion, load):
    """Return the coordinate on which a unit load does work; for a spring minus its energy."""
    if isinstance(load, Force):
        x, y = motion.point(load.body, load.at)
        turned = motion.angle(load.body).real if load.follows else 0.0
        ux, uy = _rotated(turned, *(np.array(load.direction) / np.hypot(*load.direction)))
        return ux * x + uy * y
    if isinstance(load, Moment):
        return motion.angle(load.body) - motion.angle(load.other)
    if isinstance(load, TorsionSpring):
        angle = motion.angle(load.body) - motion.angle(load.other) - load.free_angle
        return -0.5 * load.stiffness * angle**2
    length = motion.length((load.body, load.other), (load.at, load.to))
    return -0.5 * load.stiffness * (length - load.free_length) ** 2 if isinstance(load, Spring) else -length


def slopes(functions):
    return np.array([np.imag(f) / _STEP for f in functions])


def random_point(rng):
    return tuple(rng.uniform(-1, 1, 2))


def random_joint(rng, kind, name, bodies):
    a, b = rng.choice([*bodies, GROUND], 2, replace=False)
    if kind == "Pin":
        return Pin(name, a, b, random_point(rng))
    if kind == "Bar":
        return Bar(name, a, b, random_point(rng), random_point(rng))
    if kind == "RotationLock":
        return RotationLock(name, a, b, ratio=rng.choice([1.0, -1.0, 0.6]))
    if kind == "Cable":
        owners = (a, b, *rng.choice([*bodies, GROUND], rng.integers(1, 3)))
        return Cable(name, owners, tuple(random_point(rng) for _ in owners))
    return {"Slot": Slot, "Contact": Contact}[kind](name, a, b, random_point(rng), random_point(rng))


def random_load(rng, kind, name, bodies, magnitude):
    a, b = rng.choice([*bodies, GROUND], 2, replace=False)
    body = a if a != GROUND else b
    if kind in ("Force", "Follower"):
        return Force(name, body, random_point(rng), random_point(rng), magnitude, follows=kind == "Follower")
    if kind == "Moment":
        return Moment(name, a, magnitude, b)
    if kind == "CablePair":
        return CablePair(name, a, b, random_point(rng), random_point(rng), magnitude)
    if kind == "Spring":
        return Spring(
            name, a, b, random_point(rng), random_point(rng), rng.uniform(0.5, 2), rng.uniform(0, 1)
        )
    return TorsionSpring(name, a, rng.uniform(0.5, 2), rng.uniform(-1, 1), b)


def least(rows):
    """Compute the smallest singular value of matrix rows scaled to length 1."""
    rows = np.array(rows)
    return np.linalg.svd(rows / np.linalg.norm(rows, axis=1, keepdims=True))[1][-1] if len(rows) else 1.0


def random_mechanism(rng):
    """Draw two to five bodies with joints and loads of all kinds, statically determined, mobility 0 to 3."""
    bodies = tuple(f"b{k}" for k in range(rng.integers(2, 6)))
    mobility = int(rng.integers(0, 4))
    motion = Motion(bodies, np.zeros((len(bodies), 3)))
    joints, rows = [], []
    while len(rows) < 3 * len(bodies) - mobility:
        kind = str(rng.choice(KINDS))
        joint = random_joint(rng, kind, f"{kind} {len(joints)}", bodies)
        more = [*rows, *slopes(joint_functions(motion, joint))]
        if len(more) <= 3 * len(bodies) - mobility and least(more) > 0.02:
            joints, rows = [*joints, joint], more
    loads = []
    while len(loads) < mobility:
        kind = str(rng.choice(["Force", "Follower", "Moment", "CablePair"]))
        load = random_load(rng, kind, f"{kind} {len(loads)}", bodies, None)
        more = [*rows, *slopes([load_function(motion, load)])]
        if least(more) > 0.01:
            loads, rows = [*loads, load], more
    for kind in rng.choice(LOADS, rng.integers(1, 5)):
        loads.append(random_load(rng, str(kind), f"{kind} {len(loads)}", bodies, rng.uniform(-2, 2)))
    return Mechanism(bodies, tuple(joints), tuple(loads))


def virtual_work(mechanism, answer):
    """Compute the virtual work of joints and loads in all motions, and of loads in possible motions.

    Both are over the largest single contribution, by the magnitudes in an `Equilibrium` at one position.
    """
    origin = {body: answer.position.point(body, (0.0, 0.0)) for body in mechanism.bodies}
    poses = [[*origin[body], float(answer.position.angle(body))] for body in mechanism.bodies]
    motion = Motion(mechanism.bodies, poses)
    constraints, parts = [], []
    for joint in mechanism.joints:
        rows = slopes(joint_functions(motion, joint))
        sizes = answer.reactions[joint.name] if isinstance(joint, Pin) else [answer.magnitudes[joint.name]]
        constraints += list(rows)
        parts += [size * row for size, row in zip(sizes, rows, strict=True)]
    applied = []
    for load in mechanism.loads:
        energy = isinstance(load, Spring | TorsionSpring)
        size = 1.0 if energy else answer.amplitudes[load.name]
        applied.append(size * slopes([load_function(motion, load)])[0])
    rank = len(constraints)
    free = np.linalg.svd(np.reshape(constraints, (rank, -1)))[2][rank:]
    largest = max(np.abs(parts).max(initial=0.0), np.abs(applied).max())
    every = np.sum(parts, axis=0) + np.sum(applied, axis=0)
    return np.abs(every).max() / largest, np.abs(free @ np.sum(applied, axis=0)).max(initial=0.0) / largest


def worst_virtual_work(count, seed=0):
    """Compute the largest virtual work of random mechanisms, as drawn and along a stroke."""
    rng = np.random.default_rng(seed)
    worst, moved = np.zeros(2), 0
    for _ in range(count):
        mechanism = random_mechanism(rng)
        answer = solve(mechanism)
        worst = np.fmax(worst, virtual_work(mechanism, answer))
        worst[0] = np.inf if not answer.is_determined else worst[0]
        if answer.mobility == 1:
            place = trace(mechanism, _driver(mechanism), 0.2, 2).position[1]
            moved += 1
            answer = solve(mechanism, place)
            if answer.kept > 1e-4:
                worst = np.fmax(worst, virtual_work(mechanism, answer))
    return worst, moved


def _driver(mechanism):
    """Return the name of the load of unknown magnitude, which moves in every free motion."""
    return next(load.name for load in mechanism.loads if getattr(load, "magnitude", 0.0) is None)
