"""What a discretization yields: the beam as a small set of matrices and vectors.

A discretization supplies two function spaces, for bending and for stretch, which only need to
integrate; the physics of the operators stands here once, for all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import FRACTION, Profile


class Space(Protocol):
    """Trial functions phi_i of xi = x/L on [0, 1] that satisfy the conditions at the root."""

    @property
    def size(self) -> int:
        """Number n of functions."""
        ...

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrals of weight times the `order`-th derivatives of phi_i and phi_j: shape (n, n)."""
        ...

    def load(self, weight: Profile) -> np.ndarray:
        """Integrals of weight phi_i: shape (n,)."""
        ...

    def end(self, order: int) -> np.ndarray:
        """Derivatives of phi_i at the tip: shape (n,)."""
        ...

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives of phi_i at xi of shape (k,): shape (n, k)."""
        ...


class Spaces(Protocol):
    """The spaces of one discretization of one beam."""

    @property
    def bending(self) -> Space:
        """Functions with phi = phi' = 0 at the root."""
        ...

    @property
    def stretch(self) -> Space:
        """Functions with phi = 0 at the root."""
        ...

    def coupling(self, weight: Profile) -> np.ndarray:
        """Integrals of weight times stretch function i and bending function j."""
        ...


class Discretization(Protocol):
    """A way to turn a beam into spaces; frozen, so that it can stand in a result's provenance."""

    @property
    def order(self) -> int | None:
        """Order of convergence of eigenvalues when the size doubles; None where it is not a power."""
        ...

    @property
    def rounding(self) -> float:
        """Relative error of eigenvalues by rounding in its own integrals."""
        ...

    def spaces(self, beam: Beam) -> Spaces:
        """The spaces for a beam."""
        ...

    def coarser(self) -> Discretization:
        """A less accurate one, whose distance estimates the error of this one."""
        ...

    def finer(self) -> Discretization | None:
        """The next more accurate one; None where it ends."""
        ...

    def fits(self, modes: int) -> bool:
        """Whether the coarser one has functions enough for so many modes."""
        ...


@dataclass(frozen=True)
class BendingOperators:
    """Operators of the transverse deflection u = sum phi_i(x/L) q_i, SI units, shapes (n, n) and (n,).

    Symbols are those of Lee and Yoo (2019), eqs. (15)-(21), with rho A for their rho; a tip body
    is contained.

    Parameters
    ----------
    M : ndarray
        Mass (15) [kg].
    S : ndarray
        Mass of the spin softening [kg]: M without rotary inertia.
    J : ndarray
        Tip body's (J_e - J_1) phi_i'(L) phi_j'(L) [kg]: stiffening of its rotation out of the plane.
    KB : ndarray
        Bending stiffness (17) [N/m].
    KGA : ndarray
        Stiffness by tension under a unit root acceleration (18) [kg/m].
    KGB : ndarray
        Stiffness by the tension of rotation at unit speed about the root (19) [kg].
    P : ndarray
        Load under a unit root acceleration (21) [kg].
    Q : ndarray
        Load under a unit angular acceleration (20) [kg m].
    space : Space
        The functions, to evaluate shapes.
    """

    M: np.ndarray
    S: np.ndarray
    J: np.ndarray
    KB: np.ndarray
    KGA: np.ndarray
    KGB: np.ndarray
    P: np.ndarray
    Q: np.ndarray
    space: Space


@dataclass(frozen=True)
class StretchOperators:
    """Operators of the stretch s = sum phi_i(x/L) q_i and its coupling with the deflection, SI units.

    Parameters
    ----------
    M : ndarray, shape (m, m)
        Mass M11 (15) [kg].
    M12 : ndarray, shape (m, n)
        Coupling mass (15) [kg].
    KS : ndarray, shape (m, m)
        Axial stiffness (16) [N/m].
    P, Q : ndarray, shape (m,)
        Loads (21) [kg] and (20) [kg m].
    space : Space
        The functions.
    """

    M: np.ndarray
    M12: np.ndarray
    KS: np.ndarray
    P: np.ndarray
    Q: np.ndarray
    space: Space


@dataclass(frozen=True)
class Operators:
    """The operators of a discretized beam; `stretch` is None where it is not modelled."""

    bending: BendingOperators
    stretch: StretchOperators | None = None


def assemble(beam: Beam, discretization: Discretization, stretch: bool = False) -> Operators:
    """Operators of a beam.

    Parameters
    ----------
    beam : Beam
        The beam.
    discretization : Discretization
        Ritz functions or finite elements.
    stretch : bool
        Whether to model the stretch.

    Returns
    -------
    Operators
    """
    spaces = discretization.spaces(beam)
    return Operators(_bending(beam, spaces.bending), _stretch(beam, spaces) if stretch else None)


def tension(beam: Beam) -> tuple[Profile, Profile]:
    """Tension per unit root acceleration N_A [kg] and per squared unit speed N_B [kg m] over x/L.

    The axial force at steady speed is omega^2 N_B - a_O1 N_A.
    """
    length, mass = beam.length, beam.mass_per_length
    n_a = mass.scaled(length).outboard_integral()
    n_b = (mass * FRACTION).scaled(length**2).outboard_integral()
    if beam.tip is None:
        return n_a, n_b
    reach = length + beam.tip.offset
    return _shifted(n_a, beam.tip.mass), _shifted(n_b, beam.tip.mass * reach)


def _shifted(profile: Profile, constant: float) -> Profile:
    rows = tuple((row[0] + constant, *row[1:]) for row in profile.coefficients)
    return Profile(profile.breakpoints, rows)


def _bending(beam: Beam, space: Space) -> BendingOperators:
    length, mass, tip = beam.length, beam.mass_per_length, beam.tip or TipMass(0.0)
    n_a, n_b = tension(beam)
    reach = length + tip.offset
    slope = space.end(1) / length  # D: slope at the end per unit coordinate
    path = space.end(0) + tip.offset * slope  # t: deflection of the tip body's centre of gravity
    dd, tt = np.outer(slope, slope), np.outer(path, path)
    spin = space.gram(mass, 0) * length + tip.mass * tt
    return BendingOperators(
        M=spin + tip.inertia * dd,
        S=spin,
        J=(tip.inertia_transverse - tip.axial_inertia) * dd,
        KB=space.gram(beam.bending_stiffness, 2) / length**3,
        KGA=space.gram(n_a, 1) / length + tip.mass * tip.offset * dd,
        KGB=space.gram(n_b, 1) / length + tip.mass * reach * tip.offset * dd,
        P=space.load(mass) * length + tip.mass * path,
        Q=space.load(mass * FRACTION) * length**2 + tip.mass * reach * path + tip.inertia * slope,
        space=space,
    )


def _stretch(beam: Beam, spaces: Spaces) -> StretchOperators:
    length, mass, tip = beam.length, beam.mass_per_length, beam.tip or TipMass(0.0)
    stiffness = beam.axial_stiffness
    assert stiffness is not None, "a scene with stretch has an axial stiffness"
    space = spaces.stretch
    end = space.end(0)
    path = spaces.bending.end(0) + tip.offset / length * spaces.bending.end(1)
    return StretchOperators(
        M=space.gram(mass, 0) * length + tip.mass * np.outer(end, end),
        M12=spaces.coupling(mass) * length + tip.mass * np.outer(end, path),
        KS=space.gram(stiffness, 1) / length,
        P=space.load(mass) * length + tip.mass * end,
        Q=space.load(mass * FRACTION) * length**2 + tip.mass * (length + tip.offset) * end,
        space=space,
    )
