"""Derivatives of a model's matrices and eigenvalues with respect to numbers of its scene.

The matrices are polynomials, quotients or sines of most numbers, or polynomials of high degree if a number is
a position along the beam.  They are evaluated for eight values near the number, and the polynomial through
these values is differentiated; its last term shows how well the dependence is resolved.  Eigenvalues have far
fewer correct digits, so that they are not differenced.

With the dynamic stiffness P(s) = s^2 M + s (C + omega G) + K0 + omega^2 K2 at the speed omega, and P v = 0,
w^T P = 0 at an eigenvalue s with right and left eigenvectors v and w, a change dP of P changes the eigenvalue
by ds = -w^T dP v / (w^T (2 s M + C + omega G) v)  (Lancaster, Lambda-Matrices and Vibrating Systems, 1966,
section 7).

In shapes of arrays, n counts coordinates, and k eigenvalues.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Generic, TypeAlias, TypeVar

import numpy as np
import scipy.linalg

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.equations.functions_of_nearby_beam import NearbySpaces
from beamdyn.equations.moment_functions import MomentSpaces
from beamdyn.modes.modal.model import Model
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.studies.sensitivities.sensitivity_result import SceneNumber

PLACES = 8
# Number of interval widths, over four decades: rounding errors are inversely proportional to the width.
_STEPS = 9

Evaluated = TypeVar("Evaluated")


@dataclass(frozen=True)
class Nearby(Generic[Evaluated]):
    """Matrices for values near a number, and weights that combine them to derivatives.

    Parameters
    ----------
    values : list
        Matrices for eight (`PLACES`) values of the number.
    weights : ndarray, shape (PLACES,)
        Weights of the matrices in the derivative [1 / unit of the number].
    last : ndarray, shape (PLACES,)
        Weights that give the last term of the interpolating polynomial, which bounds its error.
    width : float
        Half of the interval [unit of the number].
    """

    values: list[Evaluated]
    weights: np.ndarray
    last: np.ndarray
    width: float


def evaluate_nearby(
    number: SceneNumber, evaluate: Callable[[float], Evaluated]
) -> Iterator[Nearby[Evaluated]]:
    """Evaluate matrices near a number, in the widest interval of valid values, then in narrower ones.

    Values are refused if `evaluate` raises an `InvalidValue`; if all values on one side of the number are
    refused, only values on the other side are used.

    Parameters
    ----------
    number : SceneNumber
        The number.
    evaluate : callable
        Function from a value of the number to matrices.

    Yields
    ------
    Nearby

    Raises
    ------
    InvalidValue
        If the values on both sides are refused.
    """
    refused: InvalidValue | None = None
    for intervals in _intervals(number):
        found = False
        for low, high in intervals:
            try:
                middle, half = (low + high) / 2, (high - low) / 2
                points = -np.cos(np.pi * (np.arange(PLACES) + 0.5) / PLACES)
                values = [evaluate(float(middle + half * t)) for t in points]
                terms = np.polynomial.chebyshev.chebvander(points, PLACES - 1) * 2 / PLACES
                terms[:, 0] /= 2
                slopes = np.array([_slope(k, (number.value - middle) / half) for k in range(PLACES)]) / half
                nearby = Nearby(values, terms @ slopes, terms[:, -1] * slopes[-1], half)
            except InvalidValue as error:
                refused = error
            else:
                found = True
                yield nearby
        if found:
            return
    assert refused is not None
    raise refused


def _slope(degree: int, t: float) -> float:
    """Compute the derivative of the Chebyshev polynomial of a given degree at t."""
    return float(np.polynomial.Chebyshev.basis(degree).deriv()(t)) if degree else 0.0


def _intervals(number: SceneNumber) -> Iterator[list[tuple[float, float]]]:
    """Yield lists of intervals from wide to narrow: around the number, then above it, then below it."""
    steps = [number.step * 10 ** (-k / 2) for k in range(_STEPS)]
    lowest = [max(number.value - step, number.least) for step in steps]
    yield [(low, number.value + step) for low, step in zip(lowest, steps, strict=True)]
    yield [(number.value, number.value + step) for step in steps]
    yield [(low, number.value) for low in lowest if low < number.value]


# Changes of eigenvalues and critical speeds -------------------------------------------------------


@dataclass(frozen=True)
class PencilChange:
    """Derivatives of the matrices of a `SteadyPencil` with respect to one number."""

    M: np.ndarray
    C: np.ndarray
    G: np.ndarray
    K0: np.ndarray
    K2: np.ndarray

    @classmethod
    def of(cls, pencils: Sequence[SteadyPencil], weights: np.ndarray) -> PencilChange:
        """Return the weighted sum of the matrices of several equations."""
        return cls(
            *(np.tensordot(weights, [getattr(p, f.name) for p in pencils], axes=1) for f in fields(cls))
        )

    def between(self, left: np.ndarray, right: np.ndarray, s: complex, speed: float) -> complex:
        """Compute w^T dP v for vectors w and v, with the change dP of the dynamic stiffness at exponent s.

        The speed is in rad/s; dP is not formed.
        """
        of_rate = left @ (self.C @ right) + speed * (left @ (self.G @ right))
        of_stiffness = left @ (self.K0 @ right) + speed**2 * (left @ (self.K2 @ right))
        return complex(s**2 * (left @ (self.M @ right)) + s * of_rate + of_stiffness)

    def stiffness(self, speed: float) -> np.ndarray:
        """Compute the derivative of the stiffness at a speed [rad/s] with respect to the number."""
        return self.K0 + speed**2 * self.K2


@dataclass(frozen=True)
class PerturbedModes:
    """Modes at a speed with left eigenvectors, from which derivatives of eigenvalues are computed.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations.
    speed : float
        Speed [rad/s].
    eigenvalue : ndarray, shape (k,)
        Eigenvalues s [1/s].
    right, left : ndarray, shape (coordinates, k)
        Eigenvectors v and w.
    """

    pencil: SteadyPencil
    speed: float
    eigenvalue: np.ndarray
    right: np.ndarray
    left: np.ndarray

    @classmethod
    def of(
        cls, pencil: SteadyPencil, speed: float, eigenvalue: np.ndarray, right: np.ndarray
    ) -> PerturbedModes:
        """Build the modes from eigenvalues and right eigenvectors; the left eigenvectors are computed."""
        left = [_left(pencil, speed, s, v) for s, v in zip(eigenvalue, right.T, strict=True)]
        return cls(pencil, speed, eigenvalue, right, np.array(left).T)

    def derivatives(self, change: PencilChange) -> np.ndarray:
        """Compute the derivatives of the eigenvalues from the derivatives of the matrices."""
        return np.array(
            [
                -change.between(self.left[:, k], self.right[:, k], s, self.speed) / self._slope(k)
                if s
                else _NONE
                for k, s in enumerate(self.eigenvalue)
            ]
        )

    def speed_derivatives(self) -> np.ndarray:
        """Compute the derivatives of the eigenvalues with respect to the speed."""
        p = self.pencil
        changes = (s * p.G + 2 * self.speed * p.K2 for s in self.eigenvalue)
        return np.array(
            [self._quotient(k, dP) if self.eigenvalue[k] else _NONE for k, dP in enumerate(changes)]
        )

    def scales(self) -> np.ndarray:
        """Bound the derivatives of the eigenvalues with respect to a relative change of mass and stiffness.

        Absolute values are summed, so that nothing cancels: rounding errors are relative to this bound.
        """
        p = self.pencil
        whole = np.abs(p.K0) + self.speed**2 * np.abs(p.K2)
        sums = [
            np.abs(self.left[:, k]) @ (whole + abs(s) ** 2 * np.abs(p.M)) @ np.abs(self.right[:, k])
            for k, s in enumerate(self.eigenvalue)
        ]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.array(sums) / np.abs([self._slope(k) for k in range(len(self.eigenvalue))])

    def _quotient(self, k: int, dP: np.ndarray) -> complex:
        return -complex(self.left[:, k] @ dP @ self.right[:, k]) / self._slope(k)

    def _slope(self, k: int) -> complex:
        """Compute the derivative of the dynamic stiffness with respect to the eigenvalue, in mode k.

        It is w^T (2 s M + C + omega G) v, with the eigenvectors w and v of the mode.
        """
        p, left, right = self.pencil, self.left[:, k], self.right[:, k]
        of_rate = left @ (p.C @ right) + self.speed * (left @ (p.G @ right))
        return complex(2 * self.eigenvalue[k] * (left @ (p.M @ right)) + of_rate)


# Derivative of a double eigenvalue 0, which changes as the square root of a perturbation.
_NONE = complex(np.nan, np.nan)


def _left(pencil: SteadyPencil, speed: float, s: complex, v: np.ndarray) -> np.ndarray:
    """Compute the left eigenvector of an eigenvalue of the dynamic stiffness P(s).

    Without gyroscopic terms all matrices are symmetric; without damping P(s)^T is the conjugate of P(s).
    """
    if not (speed * pencil.G).any():
        return v
    if not pencil.C.any():
        return v.conj()
    P = s**2 * pencil.M + s * (pencil.C + speed * pencil.G) + pencil.K0 + speed**2 * pencil.K2
    # The scale includes the mass, as a hinged beam has a rotation without stiffness.
    scale = np.sqrt(np.diag(pencil.K0) + abs(s) ** 2 * np.diag(pencil.M))
    return scipy.linalg.svd(P.T / np.outer(scale, scale))[2][-1].conj() / scale


def critical_vector(pencil: SteadyPencil, speed: float) -> np.ndarray:
    """Compute the shape in which the beam buckles at its critical speed."""
    return scipy.linalg.eigh(pencil.K0 + speed**2 * pencil.K2, pencil.K0, subset_by_index=[0, 0])[1][:, 0]


def critical_derivative(pencil: SteadyPencil, speed: float, v: np.ndarray, change: PencilChange) -> float:
    """Compute the derivative of the critical speed, at which the beam buckles in the shape v.

    `change` has the derivatives of the matrices.
    """
    return float(-(v @ change.stiffness(speed) @ v) / (2 * speed * (v @ pencil.K2 @ v)))


# Derivatives of the matrices ----------------------------------------------------------------------


EPSILON = 32 * np.finfo(float).eps  # rounding error of an integral, relative to its largest contribution
# Ratio of a polynomial's last term to the matrices below which the interval is resolved.
_RESOLVED = 1e-13
# Ratio of a polynomial's last term to the matrices below which the term may be a rounding error: the rounding
# errors of modal damping reach this size.
_ROUNDED = 1e-10
# Ratio of the last term in a narrower interval to that in the next wider one, above which it is taken for a
# rounding error: narrowing the interval no longer reduces it.
_CONVERGES = 0.1
_Pencils: TypeAlias = tuple[SteadyPencil, SteadyPencil]


@dataclass(frozen=True)
class Changes:
    """Derivatives, with respect to n numbers, of the matrices of a model and of its coarser model.

    Parameters
    ----------
    of : tuple of list of PencilChange
        Derivatives for the model, and for the coarser model.
    missed : list of PencilChange
        Errors of the model's derivatives, as polynomials do not fully resolve the dependence on a number.
    rounding : ndarray, shape (n,)
        Rounding error of the derivatives, relative to the matrices [1 / unit of the number].
    refusals : tuple of str
        Numbers that cannot change alone, with the reason: their derivatives are nan.
    """

    of: tuple[list[PencilChange], list[PencilChange]]
    missed: list[PencilChange]
    rounding: np.ndarray
    refusals: tuple[str, ...]


@one_blas_thread()  # with small matrices, further threads only slow each other down
def changes_of(model: Model, numbers: Sequence[SceneNumber], damped: bool = True) -> Changes:
    """Compute derivatives of a model's matrices with respect to numbers, from several values near each.

    Without damping (`damped` False) the matrices are more exact, and of large models take far less time.
    """
    fine, coarse, missed, rounding, refusals = [], [], [], [], []
    for number in numbers:
        try:
            nearby = _resolved(number, partial(_pencils, model, number.name, damped))
        except InvalidValue as error:
            of_fine, of_coarse = (
                PencilChange(*np.full((5, *pencil.M.shape), np.nan)) for pencil in steady_pencils(model)
            )
            refusals.append(f"{number.name} cannot change alone, so that it has no derivative: {error}")
            lacks, weights = of_fine, np.zeros(1)
        else:
            weights = nearby.weights
            of_fine, of_coarse = (
                PencilChange.of([pair[k] for pair in nearby.values], weights) for k in (0, 1)
            )
            lacks = _last(nearby)
        fine.append(of_fine)
        coarse.append(of_coarse)
        missed.append(lacks)
        rounding.append(EPSILON * np.abs(weights).sum())
    return Changes((fine, coarse), missed, np.array(rounding), tuple(refusals))


def _resolved(number: SceneNumber, evaluate: Callable[[float], _Pencils]) -> Nearby[_Pencils]:
    """Evaluate the equations in the widest interval about a number in which polynomials resolve them."""
    before, best = np.inf, None
    for nearby in evaluate_nearby(number, evaluate):
        # The last term of each matrix's polynomial, at its maximum in the interval, relative to the matrix.
        last, whole = _last(nearby), nearby.values[0][0]
        pairs = ((getattr(last, f.name), getattr(whole, f.name)) for f in fields(last))
        share = max(_largest(part) * nearby.width / (_largest(matrix) or 1.0) for part, matrix in pairs)
        if best is not None and _CONVERGES * before < share < _ROUNDED:
            return best
        before, best = share, nearby
        if share <= _RESOLVED:
            break
    assert best is not None
    return best


def _last(nearby: Nearby[_Pencils]) -> PencilChange:
    """Compute the last terms of the matrices' polynomials: they are small if these resolve the matrices."""
    return PencilChange.of([fine for fine, _ in nearby.values], nearby.last)


def _largest(matrix: np.ndarray) -> float:
    return float(np.abs(matrix).max(initial=0.0))


def _pencils(model: Model, name: str, damped: bool, value: float) -> _Pencils:
    """Return the equations of a model and of its coarser model, for another value of a number."""
    scene = with_numbers(model.scene, {name: value})
    scene = scene if damped else scene.undamped
    if len(scene.beam.breakpoints) != len(model.scene.beam.breakpoints):
        bound = "a point or an end of layers would leave the root, the tip or a jump of the section"
        raise InvalidValue(name, value, bound, "place it at a small distance from there")
    equations = equations_near(model, scene)
    if equations.size != model.equations.size:
        bound = "the number of basis functions differs between nearby values of the number"
        raise InvalidValue(name, value, bound, "give a Ritz or a Fem of another size")
    fine, coarse = equations.steady(), model.equations.coarse
    if coarse is None:
        return fine, equations_near(model.coarser, scene).steady()
    return fine, fine.part(coarse)


def equations_near(model: Model, scene: Scene) -> Equations:
    """Build the equations of a scene that differs little from a model's scene, in nearly the same functions.

    Matrices of nearby scenes then change smoothly.  The model's functions are used if the segments of both
    beams agree.  Otherwise functions of bending moments are adapted to the new segments, as new ones could
    differ abruptly after the smallest change of the beam; other functions are built for the new breakpoints.
    """
    nearby, own, other = Model(scene, model.discretization), model.scene.modelled_beam, scene.modelled_beam
    if scene.beam.matrices is not None:
        return nearby.equations
    spaces = model.discretization.spaces(own)
    if own.breakpoints != other.breakpoints:
        of_moments = isinstance(spaces, MomentSpaces)
        spaces = NearbySpaces(spaces, other) if of_moments else model.discretization.spaces(other)
    return nearby.over(spaces)


def steady_pencils(model: Model) -> tuple[SteadyPencil, SteadyPencil]:
    """Return the equations of a model at steady speeds, and those of its coarser model."""
    fine, coarse = model.equations.steady(), model.equations.coarse
    return fine, model.coarser.equations.steady() if coarse is None else fine.part(coarse)
