"""A planar mechanism, made of bodies, joints and loads, and the positions of its bodies."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.inputs.checks import kind, set_fields, several
from brakes.planar.part import Joint, Load, Part, Shape
from brakes.planar.rows import GROUND, FrictionLaw, Point, suggest
from brakes.planar.system import System


@dataclass(frozen=True)
class Mechanism:
    """Rigid bodies in a plane, with joints and loads.

    All points are given in one drawing of the mechanism [m]: x to the right, y up, angles anticlockwise.

    Parameters
    ----------
    bodies : tuple of str
        Names of the bodies; `GROUND` always exists and is not listed.
    joints : tuple of Joint
        The joints, such as a `Pin`; `JOINTS` lists all kinds.
    loads : tuple of Load
        The loads, such as a `Force`; `LOADS` lists all kinds.

    Raises
    ------
    ValueError
        If a name is used twice, or a joint or load is on a body that does not exist, or on nothing.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> loads = (
    ...     planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0),
    ...     planar.Force("work", "lever", at=(0.1, 0.0), direction=(0, 1)),
    ... )
    >>> found = planar.solve(planar.Mechanism(("lever",), (hinge,), loads))
    >>> round(float(found.amplitudes["work"]), 6)  # N: 100 * 0.3 / 0.1
    300.0
    """

    bodies: tuple[str, ...]
    joints: tuple[Joint, ...] = ()
    loads: tuple[Load, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.bodies, str):
            raise ValueError(f"bodies = {self.bodies!r}: give a sequence of names, ({self.bodies!r},)")
        for key, wanted in {"bodies": str, "joints": Joint, "loads": Load}.items():
            set_fields(self, **{key: several(key, getattr(self, key), wanted)})
        if not self.bodies or GROUND in self.bodies:
            raise ValueError(f"bodies = {self.bodies!r}: name one or more; {GROUND!r} is there by itself")
        for what, names in (("body", self.bodies), ("joint or load", [part.name for part in self.parts])):
            if twice := [name for name, times in Counter(names).items() if times > 1]:
                raise ValueError(f"{what} {twice[0]!r} occurs twice: give each its own name")
        for part in self.parts:
            if unknown := [name for name in part.acts_on if name not in (*self.bodies, GROUND)]:
                remedy = suggest(unknown[0], (*self.bodies, GROUND))
                raise ValueError(f"{part.title} is on body {unknown[0]!r}, which does not exist; {remedy}")
            if len(set(part.acts_on)) == 1:
                alone = f"{part.title} acts on {part.acts_on[0]!r} alone"
                raise ValueError(f"{alone}: name two different bodies, one of them movable")

    @property
    def parts(self) -> tuple[Part, ...]:
        """All joints, then all loads."""
        return (*self.joints, *self.loads)

    @property
    def unknown_loads(self) -> list[Load]:
        """Loads without a given magnitude, which equilibrium determines."""
        return [load for load in self.loads if load.amplitude(np.zeros(1)) is None]

    @cached_property
    def friction(self) -> dict[str, tuple[str, FrictionLaw]]:
        """Joint and friction law by name: the joint's name, with the law's label if the joint has several."""
        return {
            f"{joint.name} {law.label}".strip(): (joint.name, law)
            for joint in self.joints
            for law in joint.friction_laws()
            if law.coefficient
        }

    @cached_property
    def system(self) -> System:
        """Rows of all joints and loads as arrays."""
        joints = {joint.name: joint.rows() for joint in self.joints}
        return System(self.bodies, joints, {load.name: load.row() for load in self.loads}, self.friction)

    @cached_property
    def shapes(self) -> tuple[tuple[str, Shape], ...]:
        """Name and shape of everything that is drawn for joints and loads."""
        return tuple((part.name, shape) for part in self.parts for shape in part.shapes())

    @cached_property
    def points(self) -> dict[str, list[Point]]:
        """Points of each body and of the ground at which joints and loads act, without repetition [m]."""
        found: dict[str, list[Point]] = {body: [] for body in (*self.bodies, GROUND)}
        for owner, (x, y) in dict.fromkeys(end for _, shape in self.shapes for end in shape.ends):
            found[owner].append((float(x), float(y)))
        return found

    @cached_property
    def drawing(self) -> Position:
        """Position of the bodies in the drawing, whether or not the joints close there."""
        return Position(self, np.zeros(self.system.size))

    def load(self, name: str) -> Load:
        """Return the load of a name."""
        kind("load", name, str)
        known = {load.name: load for load in self.loads}
        if name not in known:
            raise ValueError(f"load {name!r} does not exist; {suggest(name, known)}")
        return known[name]


def check_mechanism(mechanism: object, position: object = None) -> None:
    """Check that arguments of an analysis are a mechanism and, if given, a position."""
    kind("mechanism", mechanism, Mechanism)
    kind("position", position, Position | None, "assemble(mechanism) gives one")


@dataclass(frozen=True)
class Position:
    """Positions of a mechanism's bodies at one instant, or at S instants.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism.
    coordinates : ndarray, shape (3 n,) or (S, 3 n)
        Displacements of the n bodies from the drawing, nondimensional: x and y divided by the mechanism's
        length, and the angle times the greatest distance of the body's points from their centre, over that
        length.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> place = planar.assemble(planar.Mechanism(("lever",), (hinge,)))
    >>> place.point("lever", (0.3, 0.0)).round(9)
    array([0.3, 0. ])
    """

    mechanism: Mechanism
    coordinates: np.ndarray

    @property
    def batch(self) -> np.ndarray:
        """Coordinates of shape (S, 3 n), with S = 1 for one instant."""
        return np.atleast_2d(self.coordinates)

    def __getitem__(self, index: int | slice) -> Position:
        return Position(self.mechanism, self.batch[index])

    def of(self, mechanism: Mechanism) -> Position:
        """Convert the position to another mechanism with the same bodies and drawing."""
        if mechanism is self.mechanism:
            return self
        if mechanism.bodies != self.mechanism.bodies:
            raise ValueError(
                f"the position is one of bodies {self.mechanism.bodies}, not of {mechanism.bodies}"
            )
        new, old, y = mechanism.system, self.mechanism.system, self.batch
        parts = []
        for body, centre, radius in zip(mechanism.bodies, new.centre, new.radius, strict=False):
            drawn = new.origin + new.length * centre
            moved = old.place(y, body, (drawn.real, drawn.imag)) - (drawn.real, drawn.imag)
            parts += [*(moved.T / new.length), old.angle(y, body) * radius]
        return Position(mechanism, np.stack(parts, axis=-1).reshape(self.coordinates.shape))

    def point(self, body: str, at: Point) -> np.ndarray:
        """Place [m], shape (2,) or (S, 2), of a body's point that is given by its place in the drawing."""
        place = self.mechanism.system.place(self.batch, body, at)
        return place.reshape(*self.coordinates.shape[:-1], 2)

    def angle(self, body: str) -> np.ndarray:
        """Return the angle by which a body has turned from the drawing [rad], shape () or (S,)."""
        angle = self.mechanism.system.angle(self.batch, body)
        return angle.reshape(self.coordinates.shape[:-1])
