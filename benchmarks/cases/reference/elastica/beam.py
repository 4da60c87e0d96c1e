"""Description of a beam with large deflection, by functions of x/L and numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.cases.reference.twisted_beam.blade import Function, constant

__all__ = ["Body", "Elastica", "Function", "constant"]

_ONE, _NONE = constant(1), constant(0)


@dataclass(frozen=True)
class Body:
    """A rigid body at the tip.

    Parameters
    ----------
    mass, offset
        Mass, and distance of its centre of gravity beyond the tip along the tangent there.
    inertia
        Moment of inertia about the axis of bending, J_n.
    spin
        J_e - J_1: moment of inertia about the direction of bending less that about the beam axis.
    """

    mass: float = 0.0
    offset: float = 0.0
    inertia: float = 0.0
    spin: float = 0.0


@dataclass(frozen=True)
class Elastica:
    """A beam that bends in one plane; functions are of x/L.

    Parameters
    ----------
    mass, stiffness, rotary
        Mass per length, bending stiffness, second moment of mass per length.
    centre
        Position of the axis of rotation relative to the root: along the beam at rest, and along the direction
        of bending.
    in_plane
        1 where the beam bends in the plane of rotation, 0 where it bends out of it.
    spring
        Stiffness of the root's rotation spring: infinite is clamped.
    breakpoints
        Where properties may jump or have a kink.
    """

    mass: Function = _ONE
    stiffness: Function = _ONE
    rotary: Function = _NONE
    centre: tuple[float, float] = (0.0, 0.0)
    in_plane: int = 1
    spring: float = math.inf
    body: Body = Body()
    breakpoints: Sequence[float] = ()

    @property
    def is_symmetric(self) -> bool:
        """Whether the straight beam is an equilibrium, so that each equilibrium has a mirror image."""
        return not self.in_plane or self.centre[1] == 0
