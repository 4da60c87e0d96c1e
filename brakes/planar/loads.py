"""Loads of a mechanism, with a known magnitude or an unknown one (`magnitude=None`) that equilibrium gives.

Each load does work on its own coordinate: travel of a point along the force, rotation, or shortening
of a cable.  A load of magnitude 0 measures this coordinate, and any load with a coordinate may
drive a stroke.  `Load` tells how to write a new one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.described import Described
from brakes.planar import part
from brakes.planar.joints import SLACK
from brakes.planar.rows import GROUND, Line, Point, Row, Turn, unit_vector


@dataclass(frozen=True)
class Force(part.AppliedLoad):
    """A force on a point of a body.

    Parameters
    ----------
    name, body : str
        Name of the force, and its body.
    at : tuple of 2 floats
        Point of application in the drawing [m].
    direction : tuple of 2 floats
        Direction of the force in the drawing.
    magnitude : float, optional
        Magnitude along the direction [N]; None if unknown.
    follows : bool
        Whether the direction turns with the body; otherwise it is fixed in space.

    Examples
    --------
    >>> hand = planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0)
    >>> hand.with_magnitude(50.0).magnitude  # N
    50.0
    """

    label = "forces"

    body: part.Body
    at: part.DrawnPoint
    direction: part.Direction
    magnitude: part.Newtons | None = None
    follows: Annotated[bool, Described(meaning="whether it turns with the body")] = False

    @property
    def has_coordinate(self) -> bool:
        """Whether the direction is fixed in space; if it is not, the work depends on the path."""
        return not self.follows

    def _direction(self) -> Point:
        return unit_vector("direction", self.direction)

    def row(self) -> Row:
        """Return the row whose value is the travel of the point along the force [m]."""
        frame = self.body if self.follows else GROUND
        return Line(self.body, self.at, GROUND, self.at, frame, self._direction())

    def shifted(self, distance: float) -> Force:
        """Copy the force with its point moved along its direction by a distance [m]."""
        (x, y), (dx, dy) = self.at, self._direction()
        return replace(self, at=(x + distance * dx, y + distance * dy))

    def shapes(self) -> tuple[part.Shape, ...]:
        """Return the drawing of the load: an arrow at its point."""
        return (part.Shape("force", ((self.body, self.at),)),)


@dataclass(frozen=True)
class Moment(part.AppliedLoad):
    """A moment on a body, positive anticlockwise, and the opposite moment on another body.

    Parameters
    ----------
    name, body : str
        Name of the moment, and its body.
    magnitude : float, optional
        Magnitude of the moment [N m]; None if unknown.
    other : str
        The body that has the opposite moment.

    Examples
    --------
    >>> planar.Moment("torque", "drum", magnitude=12.0).magnitude  # N m
    12.0
    """

    label = "moments"

    body: part.Body
    magnitude: part.NewtonMetres | None = None
    other: part.Other = GROUND

    def row(self) -> Row:
        """Return the row whose value is the rotation of the body relative to the other [rad]."""
        return Turn(self.body, self.other)


@dataclass(frozen=True)
class CablePair(part.BetweenPoints, part.AppliedLoad):
    """A cable and its housing: equal and opposite forces that pull points of two bodies together.

    Parameters
    ----------
    name, body, other : str
        Name of the cable, and the two bodies.
    at, to : tuple of 2 floats
        Points of the cable on the body and on the other body, in the drawing [m].
    magnitude : float, optional
        Tension of the cable [N]; None if unknown.

    Examples
    --------
    >>> pull = planar.CablePair("wire", "right arm", "left arm", at=(-0.042, 0.002), to=(-0.042, 0.034))
    >>> pull.acts_on
    ('right arm', 'left arm')
    """

    label = "cables with their housing"
    one_way = SLACK
    style = "cable"

    magnitude: part.Newtons | None = None

    def row(self) -> Row:
        """Return the row whose value is the shortening of the distance between the points [m]."""
        return self.path()


@dataclass(frozen=True)
class Spring(part.BetweenPoints, part.Load):
    """A linear spring between points of two bodies; it pulls with stiffness * (length - free length).

    Parameters
    ----------
    name, body, other : str
        Name of the spring, and the two bodies.
    at, to : tuple of 2 floats
        Ends of the spring on the body and on the other body, in the drawing [m].
    stiffness : float
        Stiffness [N/m].
    free_length : float
        Length of the spring without force [m].

    Examples
    --------
    >>> spring = planar.Spring(
    ...     "return", "arm", "ground", at=(0.0, 0.0), to=(0.0, 0.1), stiffness=500.0, free_length=0.08
    ... )
    >>> spring.stiffness  # N/m
    500.0
    """

    label = "springs"
    style = "spring"

    stiffness: Annotated[float, Described("N/m", "k", "stiffness", least=0)]
    free_length: Annotated[float, Described("m", meaning="length without force", least=0)]

    def row(self) -> Row:
        """Return the row whose value is the shortening below the free length [m]."""
        return self.path(self.free_length)

    def amplitude(self, coordinate: np.ndarray) -> np.ndarray:
        """Compute the tension [N], minus stiffness times shortening; negative if the spring pushes."""
        return -self.stiffness * coordinate


@dataclass(frozen=True)
class TorsionSpring(part.Load):
    """A linear spring between the angles of two bodies: moment -stiffness * (angle - free angle) on the body.

    Parameters
    ----------
    name, body : str
        Name of the spring, and its body.
    stiffness : float
        Stiffness [N m/rad].
    free_angle : float
        Relative angle without moment, measured from the drawing [rad].
    other : str
        The body at the other end of the spring.

    Examples
    --------
    >>> planar.TorsionSpring("return", "arm", stiffness=2.0, free_angle=-0.5).stiffness  # N m/rad
    2.0
    """

    label = "torsion springs"

    body: part.Body
    stiffness: Annotated[float, Described("N m/rad", "k", "stiffness", least=0)]
    free_angle: Annotated[float, Described("rad", meaning="angle without moment, from the drawing")]
    other: part.Other = GROUND

    def row(self) -> Row:
        """Return the row whose value is the rotation past the free angle [rad]."""
        return Turn(self.body, self.other, offset=self.free_angle)

    def amplitude(self, coordinate: np.ndarray) -> np.ndarray:
        """Compute the moment on the body [N m] at a rotation: minus stiffness times rotation."""
        return -self.stiffness * coordinate
