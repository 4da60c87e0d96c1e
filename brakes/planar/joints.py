"""Joints between two bodies, or a body and the ground.

Coordinates [m] are those of the drawing.  The force of a joint is its force on the body that is named first;
tension of a bar or cable and the push of a contact are positive.  `Joint` tells how to write a new one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.described import Described
from brakes.planar.part import (
    BetweenPoints,
    Coefficient,
    DescribedBody,
    DescribedPoint,
    Direction,
    DrawnPoint,
    Joint,
    Length,
    OneWay,
    OnTwoBodies,
    Shape,
)
from brakes.planar.rows import (
    GROUND,
    End,
    FrictionLaw,
    Line,
    Path,
    Point,
    Round,
    Row,
    Turn,
    check_distinct,
    path_length,
    unit_vector,
)

_NORMAL = 0.9999  # least cosine of the angle between the normal of a round face and the line to its centre
_TURNS = 0.1  # rotation of a straight face over a stroke above which there is a warning [deg]
_PIVOT = Described("m", "r", "radius of the pivot", least=0, remedy="give the radius of the pivot")
_CENTRE = DescribedPoint("m", meaning="centre of a round face; straight if not given")
_OPEN = "it is open, or its normal is reversed; remove it, or reverse its normal"
_ROUND = Described("m", "R", "radius of a round face, if not the drawing's", above=0)
SLACK = OneWay("cable", "push", "cable slackens", "it is slack; remove it, or reverse the loads")


@dataclass(frozen=True)
class Pin(OnTwoBodies, Joint):
    """A pin joint: a point of one body stays on a point of another.

    Parameters
    ----------
    name, body, other : str
        Name of the pin, and the two bodies, of which `other` may be `GROUND`.
    at : tuple of 2 floats
        Position of the pin on the body, in the drawing [m].
    at_other : tuple of 2 floats, optional
        Position of the pin on the other body, if different in the drawing [m]; `assemble` closes the gap.
    radius, friction : float
        Radius of the pivot [m] and coefficient of friction.

    References
    ----------
    Standard: the two points coincide; friction circle of a pin.

    Examples
    --------
    >>> pin = planar.Pin("axle", "drum", "ground", at=(0.25, -0.2), radius=0.015, friction=0.1)
    >>> pin.is_hinge
    True
    """

    label = "pins"
    is_hinge = True

    at: DrawnPoint
    at_other: DrawnPoint | None = None
    radius: Annotated[float, _PIVOT] = 0.0
    friction: Coefficient = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.friction and not self.radius:
            raise ValueError(f"{self.title} has friction but no radius: give the radius of the pivot")

    @property
    def _ends(self) -> tuple[End, End]:
        return (self.body, self.at), (self.other, self.at if self.at_other is None else self.at_other)

    def rows(self) -> tuple[Row, ...]:
        """Return two rows, for the constraints along x and y."""
        end, other = self._ends
        return Line(*end, *other, GROUND, (1.0, 0.0)), Line(*end, *other, GROUND, (0.0, 1.0))

    def friction_laws(self) -> tuple[FrictionLaw, ...]:
        """Return a friction couple against the rotation, whose arm is the radius of the friction circle."""
        arm = self.radius * self.friction / math.hypot(1.0, self.friction)
        return (FrictionLaw(Turn(self.body, self.other), arm),)

    def with_pivot(self, radius: float, friction: float) -> Pin:
        """Copy the pin with a radius [m] and a coefficient of friction, unless it already has friction."""
        return self if self.friction else replace(self, radius=self.radius or radius, friction=friction)

    def shapes(self) -> tuple[Shape, ...]:
        """Return the drawing of the joint: a pin at its points."""
        return (Shape("pin", self._ends),)


@dataclass(frozen=True)
class Bar(BetweenPoints, Joint):
    """A two-force link of constant length between points of two bodies.

    Parameters
    ----------
    name, body, other : str
        Name of the bar, and the two bodies, of which one may be `GROUND`.
    at, to : tuple of 2 floats
        Ends of the bar on the body and on the other body, in the drawing [m].
    length : float, optional
        Length of the bar [m], if it differs from the drawing.

    Examples
    --------
    >>> rod = planar.Bar("rod", "handle", "ground", at=(0.02, 0.02), to=(0.04, 0.055))
    >>> rod.acts_on
    ('handle', 'ground')
    """

    label = "bars"
    signs = ("tension", "compression")
    remedy = "move one of its ends, or join the bodies by a pin"
    style = "bar"

    length: Length | None = None

    def rows(self) -> tuple[Row, ...]:
        """Return one row, whose multiplier is positive in tension."""
        return (self.path(self.length),)

    def shapes(self) -> tuple[Shape, ...]:
        """Return the drawing of a bar with pins at its ends."""
        return (*super().shapes(), *(Shape("pin", (end,)) for end in self.path().ends))


@dataclass(frozen=True)
class Slot(OnTwoBodies, Joint):
    """A point of a body slides along a straight slot of another body, which holds it in both directions.

    Parameters
    ----------
    name, body, other : str
        Name of the slot; the body that has the point, and the body that has the slot.
    at : tuple of 2 floats
        The sliding point, in the drawing [m].
    along : tuple of 2 floats
        Direction of the slot, in the drawing.
    on : tuple of 2 floats, optional
        A point of the slot [m], if the slot does not pass through `at` in the drawing.
    friction : float
        Coefficient of friction.

    References
    ----------
    Standard: a point on a line; Coulomb's law of friction.

    Examples
    --------
    >>> guide = planar.Slot("guide", "slider", "ground", at=(0.1, 0.0), along=(1, 0))
    >>> guide.acts_on
    ('slider', 'ground')
    """

    label = "slots"

    at: DrawnPoint
    along: Direction
    on: DrawnPoint | None = None
    friction: Coefficient = 0.0

    def rows(self) -> tuple[Row, ...]:
        """Return one row: the force on the body, positive to the left of `along`."""
        x, y = unit_vector("along", self.along)
        return (_line(self, (-y, x)),)

    def friction_laws(self) -> tuple[FrictionLaw, ...]:
        """Return a friction force against the sliding."""
        return (FrictionLaw(_line(self, unit_vector("along", self.along)), self.friction),)

    def shapes(self) -> tuple[Shape, ...]:
        """Return the drawing of a short line along the slot."""
        return (Shape("face", ((self.body, self.at),), self.other, self.along),)


@dataclass(frozen=True)
class Contact(OnTwoBodies, Joint):
    """A point of a body pushes on a straight or round face of another body.

    Parameters
    ----------
    name, body, other : str
        Name of the contact; the body that has the point, and the body that has the face.
    at : tuple of 2 floats
        The touching point, in the drawing [m].
    normal : tuple of 2 floats, optional
        Normal of the face, from the other body towards the body; by default, for a round face, away from its
        centre.
    on : tuple of 2 floats, optional
        A point of the straight face [m], if the face does not pass through `at` in the drawing.
    friction : float
        Coefficient of friction.
    centre : tuple of 2 floats, optional
        Centre of a round face, such as a drum's [m]; if not given, the face is straight and its normal turns
        with the other body.
    radius : float, optional
        Radius of the round face [m], if it differs from the drawing.

    References
    ----------
    Standard: contact without penetration; Coulomb's law of friction.

    Examples
    --------
    >>> block = planar.Contact("block", "lever", "drum", at=(0.25, -0.05), centre=(0.25, -0.2), friction=0.4)
    >>> block.friction
    0.4
    """

    label = "contacts"
    one_way = OneWay("contact", "pull", "contact opens", _OPEN)

    at: DrawnPoint
    normal: Direction | None = None
    on: DrawnPoint | None = None
    friction: Coefficient = 0.0
    centre: Annotated[Point, _CENTRE] | None = None
    radius: Annotated[float, _ROUND] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.centre is None:
            if self.normal is None:
                raise ValueError(f"{self.title} has no normal: give it, or the centre of a round face")
            if self.radius is not None:
                remedy = "give the centre of its round face"
                raise ValueError(f"{self.title} has a radius but no centre: {remedy}")
            return
        check_distinct(self.title, (self.at, self.centre), "move the point or the centre of the face")
        if self.on is not None:
            remedy = "give no `on`, which is a point of a straight face"
            raise ValueError(f"{self.title} has a round face: {remedy}")
        if abs(self._cosine) < _NORMAL:
            raise ValueError(
                f"{self.title}: its normal must point from the centre of the round face or towards it; "
                "leave it out, or turn it"
            )

    @property
    def _cosine(self) -> float:
        """Cosine of the angle between the normal and the line from the centre of a round face."""
        if self.normal is None or self.centre is None:
            return 1.0
        out = complex(*self.at) - complex(*self.centre)
        return (out / abs(out) * complex(*unit_vector("normal", self.normal)).conjugate()).real

    def _row(self, direction: complex) -> Row:
        """Return the row along the normal, turned anticlockwise by a direction (a unit complex number)."""
        if self.centre is None:
            normal = direction * complex(*unit_vector("normal", self.normal or (0.0, 1.0)))
            return _line(self, (normal.real, normal.imag))
        radius = math.dist(self.at, self.centre) if self.radius is None else self.radius
        outward = math.copysign(1.0, self._cosine)
        return Round(self.body, self.at, self.other, self.centre, radius, outward * direction)

    def rows(self) -> tuple[Row, ...]:
        """Return one row, whose multiplier is positive if the contact pushes."""
        return (self._row(1.0 + 0.0j),)

    def friction_laws(self) -> tuple[FrictionLaw, ...]:
        """Return a friction force against the sliding."""
        return (FrictionLaw(self._row(1j), self.friction),)

    def doubts(self, angles: Mapping[str, np.ndarray]) -> Iterator[str]:
        """Warn of a straight face that rotates: it stands for a round face correctly at one position only."""
        turned = np.degrees(np.ptp(angles.get(self.other, 0.0)))
        if self.centre is None and turned > _TURNS:
            yield (
                f"{self.title} has a straight face, which turns with {self.other!r} by {turned:.3g} deg: "
                "right for a flat face; for a round one, such as a drum, give the centre, not the normal"
            )

    def shapes(self) -> tuple[Shape, ...]:
        """Return the drawing of a short line along a straight face, or of an arc of a round one."""
        if self.centre is not None:
            return (Shape("face", ((self.body, self.at), (self.other, self.centre))),)
        x, y = unit_vector("normal", self.normal or (0.0, 1.0))
        return (Shape("face", ((self.body, self.at),), self.other, (-y, x)),)


@dataclass(frozen=True)
class RotationLock(OnTwoBodies, Joint):
    """A gear: a body turns by `ratio` times the angle of another (1: no relative rotation; -1: mirrored).

    Parameters
    ----------
    name, body, other : str
        Name of the joint, and the two bodies.
    ratio : float
        Ratio of the angles; if it is not 1, the joint is a gear whose housing is on the ground.

    Examples
    --------
    >>> planar.RotationLock("gears", "left arm", "right arm", ratio=-1.0).ratio
    -1.0
    """

    label = "bodies that turn together"

    ratio: Annotated[float, Described(meaning="ratio of the angles")] = 1.0

    def rows(self) -> tuple[Row, ...]:
        """Return one row, whose multiplier is the couple on the body [N m]."""
        return (Turn(self.body, self.other, self.ratio),)


@dataclass(frozen=True)
class Cable(Joint):
    """A taut cable of fixed length over frictionless eyes, with one tension, positive if it pulls.

    Parameters
    ----------
    name : str
        Name of the cable.
    bodies : tuple of str
        The body of each point.
    points : tuple of points
        Points of the cable in the drawing, from end to end [m].
    length : float, optional
        Length of the cable [m], if it differs from the drawing.

    Examples
    --------
    >>> wire = planar.Cable("wire", ("arm", "ground"), ((0.04, 0.0), (0.0, 0.05)))
    >>> wire.points
    ((0.04, 0.0), (0.0, 0.05))
    """

    label = "cables of fixed length"
    one_way = SLACK

    bodies: Annotated[tuple[str, ...], DescribedBody(meaning="body of each point")]
    points: tuple[Annotated[Point, DescribedPoint("m", meaning="points in the drawing")], ...]
    length: Length | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.bodies) != len(self.points) or len(self.points) < 2:
            raise ValueError(
                f"{self.title} has {len(self.bodies)} bodies and {len(self.points)} points: "
                "give two or more points, and the body of each"
            )
        check_distinct(self.title, self.points, "move one of its points")

    def rows(self) -> tuple[Row, ...]:
        """Return one row, whose multiplier is positive in tension."""
        length = path_length(self.points) if self.length is None else self.length
        return (Path(tuple(self.bodies), tuple(self.points), length),)

    def shapes(self) -> tuple[Shape, ...]:
        """Return the drawing of a cable through its points."""
        return (Shape("cable", self.rows()[0].ends),)


def _line(joint: Slot | Contact, normal: Point) -> Line:
    """Make the constraint of a joint's point along a normal that turns with the other body."""
    on = joint.at if joint.on is None else joint.on
    return Line(joint.body, joint.at, joint.other, on, joint.other, normal)
