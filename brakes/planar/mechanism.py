"""A planar mechanism: bodies, joints and loads, and where its bodies are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from brakes.planar.joints import Contact, Joint, Pin, Slot
from brakes.planar.loads import Load
from brakes.planar.rows import GROUND, Friction, Point, Row, bodies_of, suggestion
from brakes.planar.system import System, build


@dataclass(frozen=True)
class Mechanism:
    """Rigid bodies in a plane, their joints and loads.

    Points are given in one drawing of the mechanism [m], x to the right, y up, angles anticlockwise.

    Parameters
    ----------
    bodies : tuple of str
        Names of the bodies; `GROUND` is there by itself.
    joints : tuple of joints
        `Pin`, `Bar`, `Slot`, `Contact`, `RotationLock`, `Cable`.
    loads : tuple of loads
        `Force`, `Moment`, `CablePair`, `Spring`, `TorsionSpring`.

    Raises
    ------
    ValueError
        If a name is used twice, or a joint or load is on a body that does not exist, or on nothing.
    """

    bodies: tuple[str, ...]
    joints: tuple[Joint, ...] = ()
    loads: tuple[Load, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.bodies, str):
            raise ValueError(f"bodies = {self.bodies!r}: give a sequence of names, ({self.bodies!r},)")
        for key in ("bodies", "joints", "loads"):
            object.__setattr__(self, key, tuple(getattr(self, key)))
        if not self.bodies or GROUND in self.bodies:
            raise ValueError(f"bodies = {self.bodies!r}: name one or more; {GROUND!r} is there by itself")
        _unique("body", self.bodies)
        _unique("joint or load", [part.name for part in self.parts])
        for joint in self.joints:
            _check_bodies(f"{_kind(joint)} {joint.name!r}", bodies_of(joint.rows()[0]), self.bodies)
        for load in self.loads:
            _check_bodies(f"{_kind(load)} {load.name!r}", bodies_of(load.row()), self.bodies)

    @property
    def parts(self) -> tuple[Joint | Load, ...]:
        """Joints, then loads."""
        return self.joints + self.loads

    @cached_property
    def rubbing(self) -> dict[str, Friction]:
        """Friction of the joints that have some."""
        laws = {
            joint.name: joint.rubbing() for joint in self.joints if isinstance(joint, Pin | Slot | Contact)
        }
        return {name: law for name, law in laws.items() if law.coefficient}

    @cached_property
    def system(self) -> System:
        """Its rows as arrays."""
        joints: list[tuple[str, tuple[Row, ...]]] = [(joint.name, joint.rows()) for joint in self.joints]
        loads: list[tuple[str, tuple[Row, ...]]] = [(load.name, (load.row(),)) for load in self.loads]
        rubbing = [(name, law.row, law.coefficient) for name, law in self.rubbing.items()]
        return build(self.bodies, joints, loads, rubbing)

    @cached_property
    def drawing(self) -> Position:
        """The position drawn, whether or not its joints close."""
        return Position(self, np.zeros(self.system.size))

    def load(self, name: str) -> Load:
        """The load of a name."""
        known = {load.name: load for load in self.loads}
        if name not in known:
            raise ValueError(f"load {name!r} does not exist; {suggestion(name, known)}")
        return known[name]


@dataclass(frozen=True)
class Position:
    """Where the bodies of a mechanism are, at one instant or at each of S.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism.
    coordinates : ndarray, shape (3 n,) or (S, 3 n)
        Displacements from the drawing in the scales of the system.
    """

    mechanism: Mechanism
    coordinates: np.ndarray

    @property
    def batch(self) -> np.ndarray:
        """Coordinates, shape (S, 3 n), with S = 1 for one instant."""
        return np.atleast_2d(self.coordinates)

    def __getitem__(self, index: int | slice) -> Position:
        return Position(self.mechanism, self.batch[index])

    def of(self, mechanism: Mechanism) -> Position:
        """The same places of the bodies of another mechanism, which has the same bodies and drawing."""
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
        """Where a point of a body, given by its place in the drawing, is now [m], shape (2,) or (S, 2)."""
        place = self.mechanism.system.place(self.batch, body, at)
        return place.reshape(*self.coordinates.shape[:-1], 2)

    def angle(self, body: str) -> np.ndarray:
        """Angle by which a body has turned from the drawing [rad], shape () or (S,)."""
        angle = self.mechanism.system.angle(self.batch, body)
        return angle.reshape(self.coordinates.shape[:-1])


def _kind(part: Joint | Load) -> str:
    return "".join(f" {c.lower()}" if c.isupper() else c for c in type(part).__name__).strip()


def _unique(what: str, names: Iterable[str]) -> None:
    twice = [name for name, times in Counter(names).items() if times > 1]
    if twice:
        raise ValueError(f"{what} {twice[0]!r} occurs twice: give each its own name")


def _check_bodies(key: str, names: tuple[str, ...], bodies: tuple[str, ...]) -> None:
    for name in names:
        if name != GROUND and name not in bodies:
            raise ValueError(
                f"{key} is on body {name!r}, which does not exist; {suggestion(name, (*bodies, GROUND))}"
            )
    if len(set(names)) == 1:
        raise ValueError(f"{key} acts on {names[0]!r} alone: name two different bodies, one of them movable")
