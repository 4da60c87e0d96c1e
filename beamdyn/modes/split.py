"""Guaranteed bounds of the eigenvalues of bending: the split of all functions into a head and a tail.

All quantities are nondimensional: x is x/L, mass and stiffness are relative to the segment at the root.

**The problem.**  With a(u, v) = int EI u'' v'' and four positive semidefinite forms

    P1(u, u) = int N_B u'^2,  P2 = int N_A u'^2,  P3 = int rho A u^2 + m t^2,  P4 = u'(1)^2,

where t = u(1) + eps u'(1) and int rho A u^2 contains m_k u(x_k)^2 of each point mass, the eigenvalues
z = lambda^2 are those at which the form

    Q_z = a + sum_j c_j(z) P_j,    c_j(z) = omega^2 spin_j - z mass_j,

has a kernel, and the k-th of them is at least z if Q_z >= 0 on a subspace of codimension k - 1.

**The split.**  The head is spanned by some trial functions, of any kind; the tail is its orthogonal
complement with respect to a.  On the tail P_j <= tail_j a, where tail_j is a trace,

    tail_j = trace(P_j) - trace(P_j on the head),  for instance  trace(P1) = int N_B(x) int_0^x 1/EI,

because P_j is a sum of squares of functionals whose norms the cantilever, being statically
determinate, has in closed form.  Hence Q_z >= q a on the tail with q = 1 - sum_j max(0, -c_j) tail_j.

**The coupling.**  For v of the head and w of the tail, integrating from the tip inwards,
sum_j c_j P_j(v, w) = int F w'', where F is the moment that the loads of v cause; and as int EI p w'' = 0 for
curvatures p of the head, it is int (F - EI p) w'' <= sqrt(R(v, v) a(w, w)), R = int (F - EI p)^2 / EI.
All this for any p; the best is the head's answer to the loads.  On cells where F and EI p are
polynomials, R is integrated exactly with an upper bound of 1/EI on each.

**The theorem.**  Q_z(v + w) >= Q_z(v) - 2 sqrt(R a(w, w)) + q a(w, w) >= (Q_z - R / q)(v).  So, if q > 0
and this last matrix has at most k - 1 negative eigenvalues, the k-th eigenvalue is at least z.
Nothing is assumed of other eigenvalues, signs or the speed.  Assumptions and rounding: docs/bounds.md.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from math import cos, sin

import numpy as np

from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.equations.root_motion import root_motion
from beamdyn.modes.flexibility import bound_on_cells, bound_traces
from beamdyn.modes.head import Head
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.scene.beam import TipMass
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene

_EPS = float(np.finfo(float).eps)
_MOST_STEPS = 12  # of the search for z from a Ritz value
_LARGEST_STEP = 10.0  # of this search, relative to 1 + |z|: a bound beyond it would be useless


class Enclosure(ABC):
    """Bounds of the lowest z of one problem, from the head and what bounds the tail.

    Parameters
    ----------
    speed : float
        Nondimensional speed.
    stiffness : ndarray, shape (n, n)
        Energies a of pairs of functions of the head.
    forms : ndarray, shape (m, n, n)
        The forms P_j on the head.
    spin, mass : ndarray, shape (m,)
        Parts of their coefficients c_j per squared speed and per -z.
    spin_terms : ndarray, shape (m,)
        Sums of the absolute values of the terms of `spin`.
    unit : float
        Rounding error of an entry of a matrix, relative to its terms.
    """

    speed: float
    stiffness: np.ndarray
    forms: np.ndarray
    spin: np.ndarray
    mass: np.ndarray
    spin_terms: np.ndarray
    unit: float

    @abstractmethod
    def _tail(self, coefficients: np.ndarray, terms: np.ndarray) -> float:
        """Upper bound of -sum_j c_j P_j on the tail relative to a: 1 - q, with the rounding of its terms."""

    @abstractmethod
    def _residual(self, coefficients: np.ndarray) -> np.ndarray:
        """Residual R of the loads with coefficients c_j, shape (n, n)."""

    @abstractmethod
    def _residual_allowance(self, terms: np.ndarray) -> float:
        """Bound of the rounding error of R: of the products, and of the moments in them."""

    @abstractmethod
    def _sizes(self) -> np.ndarray:
        """Traces of the absolute terms of the forms on the head, shape (m,)."""

    def bounds(self, modes: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute lower and upper bounds of the lowest z."""
        mass = self._sum(self.mass)
        starts = list(enumerate(self._ritz_values(mass, modes)))
        upper = [_search_bound(self.upper_form, mass, k, z, 1) for k, z in starts]
        return np.array([_search_bound(self.lower_form, mass, k, z, -1) for k, z in starts]), np.array(upper)

    def _ritz_values(self, mass: np.ndarray, modes: int) -> np.ndarray:
        """Ritz values of z, from which the search starts."""
        return -np.real(self._solver(mass).solve(np.array([self.speed]), modes).eigenvalue[0] ** 2)

    @cached_property
    def ritz_critical_speed(self) -> float:
        """Critical speed in the space of the head: never below the exact one but by rounding."""
        return self._solver(self._sum(self.mass)).critical_speed

    def _solver(self, mass: np.ndarray) -> Solver:
        zero = np.zeros_like(mass)
        return Solver(SteadyPencil(mass, zero, zero, self.stiffness, self._sum(self.spin), zero[0]))

    def upper_form(self, z: float) -> np.ndarray:
        """Q_z on the head plus the rounding allowance: with k + 1 eigenvalues <= 0, mode k is at most z."""
        allowance = self._allowance(self._absolute_coefficients(z))
        return self.stiffness + self._sum(self._coefficients(z)) + allowance * np.eye(len(self.stiffness))

    def lower_form(self, z: float) -> np.ndarray | None:
        """Q_z - R/q minus the rounding allowance: with <= k eigenvalues < 0, mode k is at least z."""
        return self._lower_form(self._coefficients(z), self._absolute_coefficients(z))

    def stiffness_form(self, squared_speed: float) -> np.ndarray | None:
        """Lower form at z = 0 and a speed: without eigenvalues < 0, no slower speed is critical."""
        return self._lower_form(squared_speed * self.spin, squared_speed * self.spin_terms)

    def _lower_form(self, coefficients: np.ndarray, terms: np.ndarray) -> np.ndarray | None:
        """Q - R/q minus the rounding allowance, for coefficients c_j and the sums of their absolute terms."""
        tail = self._tail(coefficients, terms)
        if tail >= 1:
            return None
        # Twice, with twice the allowance, because |a + b|^2 <= 2 (a^2 + b^2).
        R = 2 * self._residual(coefficients)
        allowance = self._allowance(terms) + 2 * self._residual_allowance(terms) / (1 - tail)
        return self.stiffness + self._sum(coefficients) - R / (1 - tail) - allowance * np.eye(len(R))

    def _coefficients(self, z: float) -> np.ndarray:
        """Coefficients c_j(z) of the forms."""
        return self.speed**2 * self.spin - z * self.mass

    def _absolute_coefficients(self, z: float) -> np.ndarray:
        """Sums of the absolute values of the terms of the coefficients c_j(z)."""
        return self.speed**2 * self.spin_terms + abs(z) * self.mass

    def _allowance(self, terms: np.ndarray) -> float:
        """Bound of the rounding error of Q: of an entry of a Gram matrix it is <= unit sqrt(P_ii P_jj)."""
        return float(self.unit * (np.trace(self.stiffness) + terms @ self._sizes()))

    def _sum(self, coefficients: np.ndarray) -> np.ndarray:
        return np.tensordot(coefficients, self.forms, 1)


class Split(Enclosure):
    """Split of the trial functions in one plane into head and tail, with the forms as matrices, at one speed.

    Parameters
    ----------
    scene : Scene
        A nondimensional scene.
    functions : int
        Number n of functions of the head, on each segment where these have their own.
    speed : float
        Nondimensional speed.
    flexibility : Profile or None
        Upper bound of 1/EI; without one there are no lower bounds.
    """

    def __init__(self, scene: Scene, functions: int, speed: float, flexibility: Profile | None) -> None:
        self.scene, self.speed, self.flexibility = scene, speed, flexibility
        self._head = Head(scene.beam, functions)
        self.stiffness, self.forms = self._head.stiffness, self._head.forms
        self.spin, self.spin_terms, self.mass = _split_coefficients(scene)
        # Rounding error of a sum of as many products as the rule has points, relative to its terms: doubled
        # for the factors, and again for the eigensolution.
        self.unit = 4 * _EPS * (self._head.quadrature.xi.size + len(self.stiffness))

    @property
    def head(self) -> np.ndarray:
        """Numbers of the functions, which functions with the same span have in a larger head."""
        return np.arange(len(self.stiffness))

    def _tail(self, coefficients: np.ndarray, terms: np.ndarray) -> float:
        if self.flexibility is None:
            return np.inf
        return float(np.maximum(self.unit * terms - coefficients, 0) @ self.tails)

    def _residual(self, coefficients: np.ndarray) -> np.ndarray:
        return np.einsum("j,jakb,k", coefficients, self._residuals, coefficients)

    @cached_property
    def _compliance(self) -> np.ndarray:
        """Upper bounds of 1/EI on the cells."""
        assert self.flexibility is not None
        return bound_on_cells(self.flexibility, self._head.ends)

    @cached_property
    def _residuals(self) -> np.ndarray:
        return self._head.residuals(self._compliance)

    @cached_property
    def _traces(self) -> np.ndarray:
        """Upper bounds of the traces of the forms on all functions, relative to a."""
        assert self.flexibility is not None
        return bound_traces(self.scene.beam, self.flexibility)

    @cached_property
    def tails(self) -> np.ndarray:
        """Upper bounds tail_j of the four forms on the tail, relative to a."""
        head = [np.trace(np.linalg.solve(self.stiffness, form)) for form in self.forms]
        return np.maximum(self._traces - head, 0) + self.unit * self._traces

    @cached_property
    def _variation(self) -> float:
        """Upper bound of the largest EI over the least, within a cell."""
        stiffness = bound_on_cells(self.scene.beam.bending_stiffness, self._head.ends)
        return float((stiffness * self._compliance).max())

    def _residual_allowance(self, terms: np.ndarray) -> float:
        products = terms @ np.sqrt(np.einsum("jaja->j", self._residuals))
        moments = self.unit * (terms @ self._traces)
        return self.unit * products**2 + self._variation * len(self.stiffness) * moments**2

    def _sizes(self) -> np.ndarray:
        return np.trace(self.forms, axis1=1, axis2=2)


def _search_bound(form: Callable, mass: np.ndarray, k: int, z: float, side: int) -> float:
    """Move z until the k-th eigenvalue of form(z), k from 0, proves a lower (side -1) or upper (1) bound."""
    step = 0.0
    for _ in range(_MOST_STEPS):
        matrix = form(z)
        if matrix is None or not np.isfinite(matrix).all():
            break
        value, vector = np.linalg.eigh(matrix)
        if side * value[k] <= 0:
            return z
        step = 2 * max(step, abs(value[k]) / (vector[:, k] @ mass @ vector[:, k]))
        if step > _LARGEST_STEP * (1 + abs(z)):
            break
        z += side * step
    return np.nan


def _split_coefficients(scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parts of c_j per omega^2, the sums of the absolute values of their terms, and per -z: (4,) each."""
    tip, psi = scene.beam.tip or TipMass(0.0), scene.mount.bending_angle
    tension, turning = (v**2 for v in exact_cos_sin(scene.mount.precone))
    root = float(root_motion(scene.mount, MotionSample.steady(1.0)).root_axial)
    out = tension * sin(psi) ** 2 - turning
    tilt = out * np.array([tip.inertia_about_bending_direction, -tip.axial_inertia])
    pull = tip.mass * tip.offset * np.array([tension, tension * tip.offset, -root])
    ends = np.concatenate([tilt, pull])
    spin = np.array([tension, -root, -(cos(psi) ** 2 + turning * sin(psi) ** 2), ends.sum()])
    terms = np.append(np.abs(spin[:3]), np.abs(ends).sum())
    return spin, terms, np.array([0.0, 0.0, 1.0, tip.inertia])
