"""Lever arms and directions of the forces on the two shoes of a duo-servo brake."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.array_checks import Numbers, numbers, positive, together
from beamdyn.common.checks import refuse


@dataclass(frozen=True)
class Levers:
    """Lever arms about the drum's centre and directions of the forces, as in the paper's Fig. 6.

    Every value may be an array, one entry per case.

    The drum turns counter-clockwise and the right shoe leads. On it act P_L (cos alpha1, -sin alpha1)
    and Q (cos gamma, sin gamma), on the left one P_T (-cos alpha2, -sin alpha2) and
    -Q (cos gamma, sin gamma), and the drum's forces: A, C normal and B, D of friction.

    Parameters
    ----------
    drum_radius : float or ndarray
        r [m].
    a1, a2 : float or ndarray
        Arms of P_L and P_T [m].
    b1, b2 : float or ndarray
        Arms of Q on the leading and the trailing shoe [m]; equal, as Q has one line of action.
    alpha1, alpha2, gamma : float or ndarray
        Angles of P_L and P_T below, of Q above the horizontal [rad].

    Raises
    ------
    ValueError
        If a length is not positive, or P_L and Q, or P_T and Q, more than 90 degrees apart.
    """

    drum_radius: Numbers
    a1: Numbers
    a2: Numbers
    b1: Numbers
    b2: Numbers
    alpha1: Numbers
    alpha2: Numbers
    gamma: Numbers

    def __post_init__(self) -> None:
        for name in ("drum_radius", "a1", "a2", "b1", "b2"):
            object.__setattr__(self, name, positive(name, getattr(self, name), "m"))
        for name in ("alpha1", "alpha2", "gamma"):
            object.__setattr__(self, name, numbers(name, getattr(self, name), "rad"))
        together(**vars(self))
        for name, value in (("alpha1 + gamma", self.phi1), ("alpha2 - gamma", self.phi2)):
            bound = "the piston's force and the adjuster's are more than a right angle apart"
            refuse(np.abs(value) > np.pi / 2, name, value, "rad", bound, "angles are in {unit}")

    @property
    def in_radii(self) -> Levers:
        """The same with all lengths over the drum's radius."""
        arms = {name: getattr(self, name) / self.drum_radius for name in ("a1", "a2", "b1", "b2")}
        return replace(self, drum_radius=1.0, **arms)

    @property
    def phi1(self) -> Numbers:
        """Angle between P_L and Q [rad]."""
        return self.alpha1 + self.gamma

    @property
    def phi2(self) -> Numbers:
        """Angle between P_T and Q [rad]."""
        return self.alpha2 - self.gamma

    @property
    def locking_friction(self) -> Numbers:
        """Friction of the lining at which the brake locks by itself; inf if it never does."""
        sigma = np.minimum(self.a1, self.b2) / self.drum_radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(sigma < 1, sigma / np.sqrt((1 - sigma) * (1 + sigma)), np.inf)[()]

    def find_levers(self, clearance: None = None) -> Levers:
        """These levers: they belong to one position of the brake.

        Raises
        ------
        ValueError
            If a clearance is given.
        """
        if clearance is not None:
            raise ValueError("clearance: lever arms belong to one position; give it with a DuoServo geometry")
        return self
