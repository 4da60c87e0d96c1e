"""Description of a twisted beam on a hub, by functions of x/L and numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Function = Callable[[np.ndarray], np.ndarray]
Pair = tuple[Function, Function]


def constant(value: float) -> Function:
    return lambda x: np.full(np.shape(x), float(value))


_ONE, _NONE = constant(1), constant(0)


@dataclass(frozen=True)
class Body:
    """A rigid body at the tip, in the axes of the section at the tip (angle psi(1)).

    Parameters
    ----------
    mass, offset
        Mass, and distance of its centre of gravity beyond the tip along the normal of the last section.
    inertia, transverse, axial
        Moments of inertia about the axis of the first bending, the direction of that bending, the beam axis.
    """

    mass: float = 0.0
    offset: float = 0.0
    inertia: float = 0.0
    transverse: float = 0.0
    axial: float = 0.0

    def moments(self, psi: float) -> tuple[np.ndarray, np.ndarray]:
        """Compute the inertia matrix J_t of the rotation p, and the matrix W_t by the speed."""
        c, s = math.cos(psi), math.sin(psi)
        about_2 = self.transverse * c**2 + self.inertia * s**2
        about_3 = self.transverse * s**2 + self.inertia * c**2
        product = self.product(psi)
        spin = np.array([[0.0, -product / 2], [-product / 2, about_3 - self.axial]])
        return np.array([[about_3, product], [product, about_2]]), spin

    @property
    def along(self) -> float:
        """Second moment of mass int x^2 dm along the beam."""
        return (self.inertia + self.transverse - self.axial) / 2

    def product(self, psi: float) -> float:
        """Compute the product of inertia E23."""
        return (self.inertia - self.transverse) * math.cos(psi) * math.sin(psi)


@dataclass(frozen=True)
class Blade:
    """A beam on a rotating hub; functions are of x/L, pairs of (first bending direction, second).

    Parameters
    ----------
    mass, stiffness
        Mass per length; bending stiffnesses in both directions.
    twist
        Twist of the section, added to `bending_angle` [rad].
    flexibility
        Shear flexibility 1/(kappa G A); 0 without shear deformation.
    rotary
        Second moments of mass per length, rho I.
    springs
        Stiffness of the root's rotation springs along e1 and e2: infinite is clamped, 0 a hinge.
    planes
        Number of planes; with 1 the beam bends along e1 only, and has no twist.
    precone
        Angle of the axis out of the plane of rotation, towards b3 [rad]; `hub` stays the distance of the root
        from the axis of rotation.
    breakpoints
        Positions x/L where properties may jump, have a kink, or change fast.
    """

    mass: Function = _ONE
    stiffness: Pair = (_ONE, _ONE)
    twist: Function = _NONE
    flexibility: Pair = (_NONE, _NONE)
    rotary: Pair = (_NONE, _NONE)
    hub: float = 0.0
    bending_angle: float = 0.0
    springs: tuple[float, float] = (math.inf, math.inf)
    body: Body = Body()
    planes: int = 2
    breakpoints: Sequence[float] = ()
    precone: float = 0.0

    def directions(self, x: np.ndarray | float) -> np.ndarray:
        """Compute unit vectors of both directions of bending in b2, b3, as columns: shape (..., 2, 2)."""
        psi = self.bending_angle + self.twist(np.asarray(x, dtype=float))
        c, s = np.cos(psi), np.sin(psi)
        return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)

    @property
    def tip_angle(self) -> float:
        return self.bending_angle + float(self.twist(np.asarray(1.0)))

    @property
    def basis(self) -> np.ndarray:
        """Directions in which the beam may bend, as columns."""
        c, s = math.cos(self.bending_angle), math.sin(self.bending_angle)
        return np.eye(2) if self.planes == 2 else np.array([[c], [s]])
