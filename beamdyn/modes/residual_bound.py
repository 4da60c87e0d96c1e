"""Guaranteed bounds of eigenvalues of bending, from a Ritz basis and the residual of all other functions.

All quantities are nondimensional: x stands for x/L; mass and stiffness are relative to those of the segment
at the root.

**The problem.**  With a(u, v) = int EI u'' v'' and four positive semidefinite forms

    P1(u, u) = int N_B u'^2,  P2 = int N_A u'^2,  P3 = int rho A u^2 + m t^2,  P4 = u'(1)^2,

where t = u(1) + eps u'(1) and int rho A u^2 contains m_k u(x_k)^2 of each point mass, the eigenvalues
z = lambda^2 are those at which the form

    Q_z = a + sum_j c_j(z) P_j,    c_j(z) = omega^2 spin_j - z mass_j,

has a kernel, and the k-th of them is at least z if Q_z >= 0 on a subspace of codimension k - 1.

**The split.**  The Ritz part is spanned by trial functions of any kind; the tail is its
orthogonal complement with respect to a.  On the tail P_j <= tail_j a, where tail_j is a trace,

    tail_j = trace(P_j) - trace(P_j on the Ritz part),  for instance  trace(P1) = int N_B(x) int_0^x 1/EI,

because P_j is a sum of squares of functionals whose norms the cantilever, being statically
determinate, has in closed form.  Hence Q_z >= q a on the tail with q = 1 - sum_j max(0, -c_j) tail_j.

**The coupling.**  For v of the Ritz part and w of the tail, integrating from the tip inwards,
sum_j c_j P_j(v, w) = int F w'', where F is the moment that the loads of v cause; and as int EI p w'' = 0 for
curvatures p of the Ritz part, it is int (F - EI p) w'' <= sqrt(R(v, v) a(w, w)), R = int (F - EI p)^2 / EI.
This holds for any p; the best is the response of the Ritz part to the loads.  On cells where F and EI p are
polynomials, R is integrated exactly with an upper bound of 1/EI on each.

**The theorem.**  Q_z(v + w) >= Q_z(v) - 2 sqrt(R a(w, w)) + q a(w, w) >= (Q_z - R / q)(v).  So, if q > 0
and this last matrix has at most k - 1 negative eigenvalues, the k-th eigenvalue is at least z.
Nothing is assumed of other eigenvalues, signs or the speed.  Assumptions and rounding: docs/bounds.md.

**Two planes** that the twist or the mount couples.  With the curvature vector k = (v'', w'') and the
stiffness tensor D(x) of the sections, turned by the twist,

    a(u, u) = int k . D k,    P_mass = int rho A |u|^2 + m |t|^2,    P_tension = int N |u'|^2,

with P_soft = int rho A (d . u)^2 + m (d . t)^2 for the deflection in the plane of rotation, in the direction
d; and, with the slope vector s = u'(1) at the tip, the forms s . T s with the tensors T of the inertia and of
the spin of the tip body.  Without precone nothing is gyroscopic: z are the eigenvalues of a form, as in one
plane.

**The traces** on all functions need no twist.  The slope in a direction e is int_0^x e . k, of squared norm
int_0^x e . D^-1 e; the sum over both directions has the trace of D^-1, 1/EI_1 + 1/EI_2 however the section is
turned.  So the traces of tension, mass and slope at the tip are the sums of those of the two planes, and
P_soft <= P_mass and s . T s >= (least eigenvalue of T) |s|^2 are used on the tail alone.

**Twisting by inertia.**  A tip body with a product of inertia on the axes of rotation adds
H int (v' w'' - v'' w'), a form of either sign.  It is int int k(x) . K(x, s) k(s) with the kernel
K = (H/2) sign(s - x) (0, 1; -1, 0).  The squares of its eigenvalues relative to a have the sum
H^2 det(int D^-1) / 2, and on the tail at most that less the trace on the Ritz part.

**The coupling.**  Loads cause a moment vector F by the static balance of the cantilever, in fixed axes; with
any curvatures p of the Ritz part the tail sees F - D p, and R = int (F - D p) . D^-1 (F - D p), where D^-1 is
diagonal in the axes of the section, with 1/EI of each.  All else is as in one plane.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from math import cos, sin

import numpy as np

from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.equations.fields.transverse import plane_components
from beamdyn.equations.root_motion import root_at_unit_speed
from beamdyn.modes.flexibility import bound_on_cells, bound_traces
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.ritz_part import CoupledRitzPart, PlaneRitzPart
from beamdyn.scene.beam import TipMass
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import tip_inertia

_EPS = float(np.finfo(float).eps)
# Largest number of steps in the search for an eigenvalue bound z, which starts from a Ritz value.
_MOST_STEPS = 12
# Largest step of the search for z, over 1 + |z|: a larger one would give a useless bound.
_LARGEST_STEP = 10.0


class Enclosure(ABC):
    """Bounds of the lowest eigenvalues of one problem, from a Ritz basis and bounds for all other functions.

    Parameters
    ----------
    speed : float
        Nondimensional speed.
    stiffness : ndarray, shape (functions, functions)
        Elastic energies a of pairs of functions of the Ritz basis (Ritz part).
    forms : ndarray, shape (m, functions, functions)
        The forms P_j on the Ritz part.
    spin, mass : ndarray, shape (m,)
        Parts of the coefficients c_j per squared speed and per -z.
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
        """Bound the relative loss of energy by the forms P_j (see module) for functions outside the basis.

        In the module's docstring it is 1 - q.  The bound includes rounding.
        """

    @abstractmethod
    def _residual(self, coefficients: np.ndarray) -> np.ndarray:
        """Compute the residual R (see module), a matrix, of loads with coefficients c_j of the forms."""

    @abstractmethod
    def _residual_allowance(self, terms: np.ndarray) -> float:
        """Bound the rounding error of the residual R (see module): of products, and of moments."""

    @abstractmethod
    def _sizes(self) -> np.ndarray:
        """Compute traces, on the Ritz basis, of the forms with all terms taken as absolute values."""

    def bounds(self, modes: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute lower and upper bounds of the lowest eigenvalues z (squared frequencies), (modes,) each."""
        mass = self._sum(self.mass)
        starts = -np.real(self._solver.solve(np.array([self.speed]), modes).eigenvalue[0] ** 2)
        lower = [_search_bound(self.lower_form, mass, k, z, -1) for k, z in enumerate(starts)]
        upper = [_search_bound(self.upper_form, mass, k, z, 1) for k, z in enumerate(starts)]
        return np.array(lower), np.array(upper)

    @cached_property
    def ritz_critical_speed(self) -> float:
        """Critical speed computed in the Ritz basis: an upper bound of the exact one, except for rounding."""
        return self._solver.critical_speed

    @cached_property
    def _solver(self) -> Solver:
        """Solver of the eigenproblem in the Ritz basis, whose Ritz values start the search for bounds."""
        mass = self._sum(self.mass)
        zero = np.zeros_like(mass)
        return Solver(SteadyPencil(mass, zero, zero, self.stiffness, self._sum(self.spin), zero[0]))

    def upper_form(self, z: float) -> np.ndarray:
        """Compute the form Q_z (see module) on the Ritz basis, plus an allowance for rounding.

        If k + 1 of its eigenvalues are at most 0, mode k (from 0) has an eigenvalue of at most z.
        """
        coefficients, terms = self._coefficients(z)
        return self.stiffness + self._sum(coefficients) + self._allowance(terms) * np.eye(len(self.stiffness))

    def lower_form(self, z: float) -> np.ndarray | None:
        """Compute Q_z - R/q (see module), minus an allowance for rounding; None if there is no bound.

        If at most k of its eigenvalues are negative, mode k (from 0) has an eigenvalue of at least z.
        """
        return self._lower_form(*self._coefficients(z))

    def stiffness_form(self, squared_speed: float) -> np.ndarray | None:
        """Compute the form Q_z - R/q (see module) at z = 0.

        If it is positive definite, the beam is stable at this and at all lower speeds.
        """
        return self._lower_form(squared_speed * self.spin, squared_speed * self.spin_terms)

    def _lower_form(self, coefficients: np.ndarray, terms: np.ndarray) -> np.ndarray | None:
        """Compute Q - R/q (see module) minus rounding, from coefficients c_j and their terms.

        For each coefficient, `terms` is the sum of the absolute values of its terms.
        """
        tail = self._tail(coefficients, terms)
        if tail >= 1:
            return None
        # Computed moments a have rounding errors b.  As |a + b|^2 <= 2 (a^2 + b^2), R and the allowance for
        # rounding are doubled.
        R = 2 * self._residual(coefficients)
        allowance = self._allowance(terms) + 2 * self._residual_allowance(terms) / (1 - tail)
        return self.stiffness + self._sum(coefficients) - R / (1 - tail) - allowance * np.eye(len(R))

    def _coefficients(self, z: float) -> tuple[np.ndarray, np.ndarray]:
        """Compute the coefficients c_j(z) of the forms (see module), and the sums of their |terms|."""
        squared = self.speed**2
        return squared * self.spin - z * self.mass, squared * self.spin_terms + abs(z) * self.mass

    def _allowance(self, terms: np.ndarray) -> float:
        """Bound the rounding error of the form Q (see module), from the absolute terms of the coefficients.

        For an entry of a Gram matrix of a form P it is at most unit sqrt(P_ii P_jj).
        """
        return float(self.unit * (np.trace(self.stiffness) + terms @ self._sizes()))

    def _sum(self, coefficients: np.ndarray) -> np.ndarray:
        return np.tensordot(coefficients, self.forms, 1)


class PlaneEnclosure(Enclosure):
    """Bounds of the eigenvalues in one plane, at one speed.

    Parameters
    ----------
    scene : Scene
        A nondimensional scene.
    functions : int
        Number n of functions of the Ritz basis, or on each segment if each has separate functions.
    speed : float
        Nondimensional speed.
    flexibility : Profile or None
        Upper bound of 1/EI; without one there are no lower bounds.
    """

    def __init__(self, scene: Scene, functions: int, speed: float, flexibility: Profile | None) -> None:
        self.scene, self.speed, self.flexibility = scene, speed, flexibility
        self.part = PlaneRitzPart(scene.beam, functions)
        self.stiffness, self.forms = self.part.stiffness, self.part.forms
        # Coefficients of the forms, and the absolute values of their terms.
        tip, psi = scene.beam.tip or TipMass(0.0), scene.mount.bending_angle
        tension, turning = (v**2 for v in exact_cos_sin(scene.mount.precone))
        root = float(root_at_unit_speed(scene.mount).root_axial)
        out = tension * sin(psi) ** 2 - turning
        tilt = out * np.array([tip.inertia_about_bending_direction, -tip.axial_inertia])
        pull = tip.mass * tip.offset * np.array([tension, tension * tip.offset, -root])
        ends = np.concatenate([tilt, pull])
        self.spin = np.array([tension, -root, -(cos(psi) ** 2 + turning * sin(psi) ** 2), ends.sum()])
        self.spin_terms = np.append(np.abs(self.spin[:3]), np.abs(ends).sum())
        self.mass = np.array([0.0, 0.0, 1.0, tip.inertia])
        # Rounding error of a sum with as many products as the Gauss rule has points, relative to its terms:
        # it is doubled for the rounding errors of the factors, and doubled again for the eigensolution.
        self.unit = 4 * _EPS * (self.part.quadrature.xi.size + len(self.stiffness))

    def _tail(self, coefficients: np.ndarray, terms: np.ndarray) -> float:
        if self.flexibility is None:
            return np.inf
        return float(np.maximum(self.unit * terms - coefficients, 0) @ self.tails)

    def _residual(self, coefficients: np.ndarray) -> np.ndarray:
        return np.einsum("j,jakb,k", coefficients, self._residuals[0], coefficients)

    @cached_property
    def _residuals(self) -> tuple[np.ndarray, float]:
        """Integrals of products of unbalanced moments; bound of the largest ratio of two EI in one cell.

        The shape of the integrals is (forms, functions, forms, functions).
        """
        assert self.flexibility is not None
        compliance = bound_on_cells(self.flexibility, self.part.ends)
        stiffness = bound_on_cells(self.scene.beam.bending_stiffness, self.part.ends)
        return self.part.residuals(compliance), float((stiffness * compliance).max())

    @cached_property
    def _traces(self) -> np.ndarray:
        """Upper bounds of the traces of the four forms P_j (see module) over the elastic energy: shape (4,).

        The traces are over all functions, those of the Ritz basis and those of the tail.
        """
        assert self.flexibility is not None
        return bound_traces(self.scene.beam, self.flexibility)

    @cached_property
    def tails(self) -> np.ndarray:
        """Upper bounds (4,) of the forms P_j (see module) over the energy, outside the Ritz basis."""
        head = [np.trace(np.linalg.solve(self.stiffness, form)) for form in self.forms]
        return np.maximum(self._traces - head, 0) + self.unit * self._traces

    def _residual_allowance(self, terms: np.ndarray) -> float:
        residuals, variation = self._residuals
        products = terms @ np.sqrt(np.einsum("jaja->j", residuals))
        moments = self.unit * (terms @ self._traces)
        return self.unit * products**2 + variation * len(self.stiffness) * moments**2

    def _sizes(self) -> np.ndarray:
        return np.trace(self.forms, axis1=1, axis2=2)


class CoupledEnclosure(Enclosure):
    """Bounds of the eigenvalues in two coupled planes, at one speed.

    The forms are, in this order: the tension N_B per squared speed, the tension N_A per acceleration of the
    root, the mass, the mass in the plane of rotation, spin and inertia of the slope at the tip,
    and twisting by inertia.

    Parameters
    ----------
    scene : Scene
        A nondimensional scene in two planes without precone.
    moments : int
        Number of bending moments of the Ritz basis in each direction.
    speed : float
        Nondimensional speed.
    flexibility : tuple of Profile
        Upper bounds of 1/EI in the first direction of the sections and in the second.
    """

    def __init__(
        self, scene: Scene, moments: int, speed: float, flexibility: tuple[Profile, Profile]
    ) -> None:
        self.scene, self.speed, self.flexibility = scene, speed, flexibility
        self.part = CoupledRitzPart(scene.beam, moments, flexibility)
        self.stiffness, self.mass = self.part.stiffness, np.array([0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0])
        beam, tip, (d, n) = scene.beam, scene.beam.tip or TipMass(0.0), np.array(plane_components(scene))
        root = float(root_at_unit_speed(scene.mount).root_axial)
        tilting, body = tip_inertia(tip, beam.tip_twist)
        self.spin = np.array([1.0, -root, 0.0, -1.0, 1.0, 0.0, -float(d @ body @ n)])
        # Tensors T (2, 2) of the slope at the tip, per squared speed and per -z, and their absolute terms.
        pull = tip.mass * tip.offset * (1 + tip.offset - root)
        spin = pull * np.eye(2) + (np.outer(n, body @ n) + np.outer(body @ n, n)) / 2
        self._tensors = spin, tilting
        pull = tip.mass * abs(tip.offset) * (1 + abs(tip.offset) + abs(root))
        inertia = tip.inertia + tip.inertia_about_bending_direction
        self._tensor_terms = np.array([pull + inertia + 2 * tip.axial_inertia, inertia])
        self.spin_terms = np.append(np.abs(self.spin[:6]), self._tensor_terms[0] if self.spin[6] else 0.0)
        self._direction, self._slope = d, self.part.slope[..., -1]
        tilts = [self._slope @ T @ self._slope.T for T in self._tensors]
        self.forms = np.concatenate([self.part.forms(d), tilts, self.part.twisting[None]])
        # A sum over the Gauss points has two products at each point, one per direction.  To its rounding
        # error the relative error of the stiffness, `misfit`, is added.
        products = 2 * self.part.quadrature.xi.size
        self.unit = 4 * _EPS * (products + len(self.stiffness)) + self.part.misfit

    # Bounds on the tail (all functions orthogonal to the Ritz basis) ------------------------------------

    @cached_property
    def _traces(self) -> np.ndarray:
        """Upper bounds of the traces of tensions, mass and tip slope over all functions: shape (4,)."""
        first, second = (bound_traces(self.scene.beam, flexibility) for flexibility in self.flexibility)
        return first + second

    @cached_property
    def tails(self) -> np.ndarray:
        """Upper bounds of the forms of tension, mass and tip slope, divided by the elastic energy.

        They hold for functions outside the basis.
        """
        forms = [*self.forms[:3], self._slope @ self._slope.T]
        head = [np.trace(np.linalg.solve(self.stiffness, form)) for form in forms]
        return np.maximum(self._traces - head, 0) + self.unit * self._traces

    @cached_property
    def _twisting_tail(self) -> float:
        """Upper bound of the quadratic form of the tip's product of inertia, divided by the elastic energy.

        It holds for functions outside the basis.
        """
        slope = self._slope
        flexibility = slope.T @ np.linalg.solve(self.stiffness, slope) + self.tails[3] * np.eye(2)
        total = np.linalg.det(flexibility) / 2
        head = np.linalg.solve(self.stiffness, self.part.twisting)
        rounding = self.unit * (self._traces[3] ** 2 + self.part.twisting_size**2)
        return float(np.sqrt(max(total - np.trace(head @ head), 0.0) + rounding))

    def _tail(self, coefficients: np.ndarray, terms: np.ndarray) -> float:
        least = np.linalg.eigvalsh(np.tensordot(coefficients[4:6], self._tensors, 1))[0]
        softening = -min(coefficients[2], coefficients[2] + coefficients[3])
        signed = np.array([*-coefficients[:2], softening, -least])
        rounding = np.array([*terms[:2], terms[2] + terms[3], terms[4:6] @ self._tensor_terms])
        twisting = terms[6] * self._twisting_tail if terms[6] else 0.0
        return float(self.unit + twisting + np.maximum(signed + self.unit * rounding, 0) @ self.tails)

    # Residuals by squared speed and by -z, the coefficients of softening and of mass -----------------

    @cached_property
    def _residuals(self) -> np.ndarray:
        """Integrals of products of moments that the response of the Ritz basis leaves unbalanced.

        The shape is (2, functions, 2, functions): moments by the squared speed (softening) and by -z (mass).
        """
        n, d, (spin, inertia) = len(self.stiffness), self._direction, self._tensors
        of_spin = self.spin[:2], -np.outer(d, d), spin, self.spin[6]
        unbalanced = [
            self.part.unbalanced(self._sum(self.spin), *of_spin),
            self.part.unbalanced(self._sum(self.mass), np.zeros(2), np.eye(2), inertia, 0.0),
        ]
        return self.part.residuals(np.concatenate(unbalanced)).reshape(2, n, 2, n)

    def _residual(self, coefficients: np.ndarray) -> np.ndarray:
        c = np.array([-coefficients[3], coefficients[2]])
        return np.einsum("j,jakb,k", c, self._residuals, c)

    def _residual_allowance(self, terms: np.ndarray) -> float:
        of_loads = np.array([-terms[3], terms[2]])
        products = np.abs(of_loads) @ np.sqrt(np.einsum("jaja->j", self._residuals))
        moments = self.unit * (terms @ self._of_all(self._traces, 1.5 * self._traces[3]))
        variation = float(np.diag(self.part.ratios).max())
        return self.unit * products**2 + variation * len(self.stiffness) * moments**2

    def _of_all(self, traces: np.ndarray, twisting: float) -> np.ndarray:
        """List a trace or bound of each of the seven forms, in the order of the docstring of the class.

        `traces` has it for both tensions, the mass and the slope at the tip, `twisting` for the last form.
        """
        return np.array([*traces[:3], traces[2], *(self._tensor_terms * traces[3]), twisting])

    def _sizes(self) -> np.ndarray:
        traces = [*np.trace(self.forms[:3], axis1=1, axis2=2), float((self._slope**2).sum())]
        return self._of_all(np.array(traces), self.part.twisting_size)


def _search_bound(form: Callable, mass: np.ndarray, k: int, z: float, side: int) -> float:
    """Change z until the k-th eigenvalue (from 0) of form(z) proves a lower (side -1) or upper (1) bound."""
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
