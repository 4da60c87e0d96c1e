"""Lever arms and directions of the forces on the two shoes of a duo-servo brake."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.checks import refuse
from beamdyn.common.inputs.described import Described
from brakes.common.locking import LEAST_MARGIN


class HasLevers:
    """Base of the brake descriptions that `internal_forces` accepts: they give lever arms."""

    def find_levers(self, clearance: Numbers | None = None) -> Levers:
        """Find the lever arms at the end of the shoes' motion.

        Parameters
        ----------
        clearance : float or ndarray, optional
            Clearance c_L between lining and drum at rest [m]; needed by a `DuoServo`.

        Returns
        -------
        Levers
            Lever arms and directions of the forces.

        Raises
        ------
        ValueError
            If the clearance is missing where it is needed, is given for `Levers`, which do not
            depend on it, or as for `DuoServo.move_shoes`.
        """
        return self.levers_and_error(clearance)[0]

    def levers_and_error(self, clearance: Numbers | None = None) -> tuple[Levers, Numbers]:
        """Find the levers, and one bound for the arms' relative errors and the angles' errors [rad]."""
        raise NotImplementedError


@dataclass(frozen=True)
class Levers(HasLevers):
    """Lever arms about the drum's centre and directions of the forces, as in Fig. 6 of Yoo et al. (1997).

    Every value may be an array, one entry per case.

    The drum turns counter-clockwise; the right shoe is the leading one, the left shoe the trailing one. P_L
    and P_T are the forces of the pistons on the leading and the trailing shoe, Q is the force of the adjuster
    between both shoes. With x to the right and y upward, P_L (cos alpha1, -sin alpha1) and Q (cos gamma, sin
    gamma) act on the leading shoe, P_T (-cos alpha2, -sin alpha2) and -Q (cos gamma, sin gamma) on the
    trailing shoe. The drum exerts the normal force A and the friction force B on the leading shoe, C and D on
    the trailing shoe.

    Parameters
    ----------
    drum_radius : float or ndarray
        Inner radius r of the drum [m].
    a1, a2 : float or ndarray
        Lever arms of P_L and P_T [m].
    b1, b2 : float or ndarray
        Lever arms of Q on the leading and on the trailing shoe [m]; equal, as Q has one line of action.
    alpha1, alpha2, gamma : float or ndarray
        Angles of P_L and P_T below the horizontal, and of Q above it [rad].

    Raises
    ------
    ValueError
        If a length is not positive, or if P_L and Q, or P_T and Q, are more than 90 degrees apart.

    References
    ----------
    Yoo et al. (1997), section 4.

    Examples
    --------
    >>> levers = forklift.BENDIX_12_5.move_shoes(0.0106).levers
    >>> float(levers.drum_radius)  # m
    0.15875
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "inner radius of the drum", above=0)]
    a1: Annotated[Numbers, Described("m", "a1", "arm of P_L, on the leading shoe", above=0)]
    a2: Annotated[Numbers, Described("m", "a2", "arm of P_T, on the trailing shoe", above=0)]
    b1: Annotated[Numbers, Described("m", "b1", "arm of Q on the leading shoe", above=0)]
    b2: Annotated[Numbers, Described("m", "b2", "arm of Q on the trailing shoe", above=0)]
    alpha1: Annotated[Numbers, Described("rad", "alpha1", "angle of P_L, below the horizontal")]
    alpha2: Annotated[Numbers, Described("rad", "alpha2", "angle of P_T, below the horizontal")]
    gamma: Annotated[Numbers, Described("rad", "gamma", "angle of Q, above the horizontal")]

    def __post_init__(self) -> None:
        keep_checked(self)
        for name, value in (("alpha1 + gamma", self.phi1), ("alpha2 - gamma", self.phi2)):
            bound = "the piston's force and the adjuster's are more than a right angle apart"
            past = np.abs(value) > np.pi / 2 + LEAST_MARGIN
            refuse(past, name, value, "rad", bound, "angles are in {unit}")

    @property
    def in_radii(self) -> Levers:
        """Return a copy with all lengths divided by the drum's radius."""
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
        """Friction of the lining at which the brake is self-locking; inf if it never is."""
        sigma = np.minimum(self.a1, self.b2) / self.drum_radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(sigma < 1, sigma / np.sqrt((1 - sigma) * (1 + sigma)), np.inf)[()]

    def levers_and_error(self, clearance: Numbers | None = None) -> tuple[Levers, Numbers]:
        """Return these levers, and zero as the error of their arms and angles, which are given."""
        if clearance is not None:
            raise ValueError("clearance: the lever arms are given; leave it out, or give a DuoServo")
        return self, 0.0
