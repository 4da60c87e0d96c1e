"""Eigenvalues of P(s) = s^2 M + s (C + omega G) + K + omega^2 K2, refined to 40 digits.

Double precision gives where to look, and the factors that correct: each step of
[P, P' v; l, 0] (dv, ds) = -(P v, 0) gains some ten digits of what the exact residual has.
Vectors are of whole numbers, columns of real and imaginary part: shape (size, 2).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg
from mpmath import mp, mpc, mpf

from benchmarks.cases.reference.many_digits.energies import Energies, Form, Rows, Space, energies
from benchmarks.cases.reference.many_digits.fixed import BITS, dot, fixed, from_float, times, to_float, to_mpf
from benchmarks.cases.reference.many_digits.numbers import Numbers

DIGITS = 40
_STEPS = 12  # largest number of refinement steps
_LOST = 1e-13  # eigenvalue, relative to the largest, below which double precision has no correct digits
_OF_DOUBLES = 3  # number of steps for modes at rest, each of which doubles the digits


@dataclass(frozen=True)
class Pencil:
    """The matrices of a scene, as products with vectors."""

    numbers: Numbers
    space: Space
    damping: AtRest | None = None

    @classmethod
    def of(cls, numbers: Numbers) -> Pencil:
        return cls(numbers, Space(numbers))

    @cached_property
    def energies(self) -> Energies:
        return energies(self.numbers)

    def parts(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute the factors of s^2, s and 1 in P(s) v, in units of the scene's time."""
        e, found = self.energies, self.space.quantities(v)
        forms = e.mass, e.still, e.spin, e.gyroscopic, e.damper
        mass, rates, stiffness = self._summed(*(self._collected(form, found, v) for form in forms))
        return mass, rates if self.damping is None else rates + self.damping.times(v), stiffness

    def _collected(self, form: Form, quantities: Rows, v: np.ndarray) -> np.ndarray:
        return self.space.collect(form.times(quantities)) if form.parts else np.zeros_like(v)

    def _summed(self, mass: Any, still: Any, spin: Any, gyroscopic: Any, damper: Any) -> tuple[Any, Any, Any]:
        """Compute the factors of s^2, s and 1 in P(s) v from the products of each form with v."""
        n = self.numbers
        rates = _scaled(gyroscopic, n.omega) + _scaled(mass, n.mass_factor())
        rates = rates + _scaled(still, n.stiffness_factor()) + _scaled(damper, n.tip_damper())
        return mass, rates, still + _scaled(spin, n.omega**2)

    def quotient(self, mode: Mode) -> mpc:
        """Compute the root of left^T P(s) right near s [1/s] of a mode with nearly the vectors of this scene.

        The error of the root is quadratic in the error of the vectors.
        """
        e, tau = self.energies, self.numbers.time
        left, right = self.space.known(mode.left), self.space.known(mode.right)
        forms = e.mass, e.still, e.spin, e.gyroscopic, e.damper
        tables = self._summed(*(_between(form, left, right) for form in forms))
        a, b, c = map(_without_conjugate, tables)
        if self.damping is not None:
            b += _inner(mode.left, self.damping.times(mode.right))
        s = mode.s * tau
        for _ in range(_STEPS):
            step = (a * s**2 + b * s + c) / (2 * a * s + b)
            s -= step
            if abs(step) <= mpf(10) ** -DIGITS * abs(s):
                break
        return s / tau


def _between(form: Form, left: Rows, right: Rows) -> np.ndarray:
    """Compute a bilinear form of the real and imaginary parts of two vectors: shape (2, 2)."""
    found = np.zeros((2, 2), dtype=object)
    for key, values in form.times(right).items():
        found = found + dot(left[key].T, values)
    return found


@dataclass(frozen=True)
class AtRest:
    """Damping of modes at rest: C = sum 2 zeta_k lambda_k (M phi_k) (M phi_k)^T.

    Parameters
    ----------
    shapes : ndarray, shape (size, size)
        The modes phi_k, of unit mass.
    pushed : ndarray, shape (size, size)
        M phi_k.
    roots : list of mpf
        lambda_k.
    ratios : list of mpf
        zeta_k.
    """

    shapes: np.ndarray
    pushed: np.ndarray
    roots: list[mpf]
    ratios: list[mpf]

    @classmethod
    def of(cls, pencil: Pencil, near: np.ndarray | None = None) -> AtRest:
        """Compute all modes at rest from approximate ones: in double precision, or of a similar scene."""
        M, K = (_dense(pencil, form) for form in (pencil.energies.mass, pencil.energies.still))
        X = _modes_of_doubles(M, K) if near is None else near
        for _ in range(_OF_DOUBLES if near is None else 1):
            X, squares = _improved(X, M, K)
        roots = [mp.sqrt(max(to_mpf(z), mpf(0))) for z in squares]
        return cls(X, dot(M, X), roots, pencil.numbers.ratios(len(roots)))

    @cached_property
    def factors(self) -> np.ndarray:
        return fixed(2 * z * w for z, w in zip(self.ratios, self.roots, strict=True))

    def times(self, v: np.ndarray) -> np.ndarray:
        return dot(self.pushed, times(self.factors[:, None], dot(self.pushed.T, v)))

    def in_doubles(self) -> np.ndarray:
        pushed = to_float(self.pushed)
        return (pushed * to_float(self.factors)) @ pushed.T


def _dense(pencil: Pencil, form: object) -> np.ndarray:
    space = pencil.space
    size = space.size
    identity = np.zeros((size, size), dtype=object)
    identity[np.diag_indices(size)] = 1 << BITS
    return space.apply(form, identity)


def _modes_of_doubles(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    A, B = to_float(M), to_float(K)
    shift = 1.0
    inverse, X = scipy.linalg.eigh(A, B + shift * A)
    X, inverse = X[:, ::-1], inverse[::-1]
    return from_float(X / np.sqrt(np.maximum(inverse, np.finfo(float).tiny)))


def _improved(X: np.ndarray, M: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, list[int]]:
    """Take one step of Ogita and Aishima (2018, doi:10.1007/s13160-018-0310-3), which doubles the digits."""
    R = -dot(X.T, dot(M, X))
    size = len(R)
    R[np.diag_indices(size)] += 1 << BITS
    S = dot(X.T, dot(K, X))
    squares = [(int(S[k, k]) << BITS) // ((1 << BITS) - int(R[k, k])) for k in range(size)]
    E = np.zeros_like(X)
    for i in range(size):
        for j in range(size):
            if i == j:
                E[i, i] = R[i, i] >> 1
            else:
                top = S[i, j] + ((squares[j] * R[i, j]) >> BITS)
                E[i, j] = (top << BITS) // (squares[j] - squares[i])
    return X + dot(X, E), squares


# Modes --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Mode:
    """An eigenvalue s [1/s] with its vectors."""

    s: mpc
    left: np.ndarray
    right: np.ndarray


def modes_of(pencil: Pencil, count: int) -> list[Mode]:
    """Return the lowest modes that vibrate, in order of |s|."""
    doubles = _Doubles.of(pencil)
    return [_refined(pencil, doubles, s, v) for s, v in doubles.lowest(count)]


@dataclass(frozen=True)
class _Doubles:
    """The matrices of P(s) in double precision, by powers of s."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    rest: np.ndarray  # matrix of stiffness at rest
    conserves: bool  # whether there is neither damping nor gyroscopic terms

    @classmethod
    def of(cls, pencil: Pencil) -> _Doubles:
        e, n, matrix = pencil.energies, pencil.numbers, pencil.space.matrix
        M, K0 = matrix(e.mass), matrix(e.still)
        D = (
            float(n.omega) * matrix(e.gyroscopic)
            + float(n.mass_factor()) * M
            + float(n.stiffness_factor()) * K0
        )
        D = D + float(n.tip_damper()) * matrix(e.damper)
        if pencil.damping is not None:
            D = D + pencil.damping.in_doubles()
        return cls(M, D, K0 + float(n.omega) ** 2 * matrix(e.spin), K0, not D.any())

    def lowest(self, count: int) -> list[tuple[complex, np.ndarray]]:
        if self.conserves:
            shift = 1.0
            while np.linalg.eigvalsh(self.K + shift * self.M)[0] <= 0:
                shift *= 4
            inverse, V = scipy.linalg.eigh(self.M, self.K + shift * self.M)
            squares = 1 / inverse[::-1] - shift
            return [(complex(0, np.sqrt(squares[k])), V[:, -1 - k].astype(complex)) for k in range(count)]
        inverse, X = scipy.linalg.eigh(self.M, self.rest + self.M)  # few modes: a small companion matrix
        kept = np.flatnonzero(inverse > _LOST * inverse[-1])[-60:]
        X = X[:, kept] / np.sqrt(inverse[kept])
        D, K = X.T @ self.D @ X, X.T @ self.K @ X
        zero, one = np.zeros_like(K), np.eye(len(K))
        values, vectors = np.linalg.eig(np.block([[zero, one], [-K, -D]]))
        order = [k for k in np.argsort(np.abs(values)) if values[k].imag > 1e-9 * abs(values[k])]
        return [(complex(values[k]), X @ vectors[: len(K), k]) for k in order[:count]]

    def at(self, s: complex) -> np.ndarray:
        return s**2 * self.M + s * self.D + self.K

    def slope(self, s: complex) -> np.ndarray:
        return 2 * s * self.M + self.D


def _refined(pencil: Pencil, doubles: _Doubles, s: complex, v: np.ndarray) -> Mode:
    scale = 1 / np.sqrt(np.abs(np.diag(doubles.rest)) + np.diag(doubles.M))
    s, v = _converged_in_doubles(doubles, s, v, scale)
    found, right = _corrected(pencil, doubles, mpc(s), v, scale)
    if doubles.conserves:
        return Mode(found / pencil.numbers.time, right, right)
    left = v.conj() if _is_even(doubles) else _left_in_doubles(doubles, s, scale)
    return Mode(found / pencil.numbers.time, from_complex(left), right)


def _is_even(doubles: _Doubles) -> bool:
    """Whether there is no damping, so that P(s)^T is the conjugate of P(s)."""
    return bool(np.abs(doubles.D + doubles.D.T).max() == 0)


def _bordered(doubles: _Doubles, s: complex, v: np.ndarray, scale: np.ndarray) -> tuple:
    """Factorize the bordered matrix [P, P' v; l, 0], in scaled coordinates."""
    P = doubles.at(s) * np.outer(scale, scale)
    x = v / scale
    x = x / np.linalg.norm(x)
    slope = scale * (doubles.slope(s) @ (scale * x))
    weight = np.linalg.norm(slope)
    full = np.block([[P, (slope / weight)[:, None]], [x.conj()[None, :], np.zeros((1, 1))]])
    return scipy.linalg.lu_factor(full), weight, x


def _converged_in_doubles(doubles: _Doubles, s: complex, v: np.ndarray, scale: np.ndarray) -> tuple:
    for _ in range(4):
        factors, weight, x = _bordered(doubles, s, v, scale)
        residual = scale * (doubles.at(s) @ (scale * x))
        change = scipy.linalg.lu_solve(factors, np.append(-residual, 0))
        v, s = scale * (x + change[:-1]), s + change[-1] / weight
    return complex(s), v / np.linalg.norm(v / scale)


def _corrected(
    pencil: Pencil, doubles: _Doubles, s: mpc, v: np.ndarray, scale: np.ndarray
) -> tuple[mpc, np.ndarray]:
    """Correct a mode by Newton's method, with exact residuals and factors in double precision."""
    factors, weight, _ = _bordered(doubles, complex(s), v, scale)
    vector, before = from_complex(v), mp.inf
    for _ in range(_STEPS):
        a, b, c = pencil.parts(vector)
        residual = _complex_times(a, s**2) + _complex_times(b, s) + c
        size = max(abs(int(value)) for value in residual.flat)
        if size == 0:
            break
        shift = max(size.bit_length() - 60, 0)  # only the leading digits of the residual are used
        leading = np.array([[int(x) >> shift for x in row] for row in residual], dtype=float)
        change = scipy.linalg.lu_solve(factors, np.append(-scale * (leading[:, 0] + 1j * leading[:, 1]), 0))
        vector = vector + _shifted(scale * change[:-1], shift)
        step = mpc(change[-1] / weight) * mp.ldexp(1, shift - BITS)
        s = s + step
        if abs(step) < mpf(10) ** -(DIGITS + 5) * abs(s) or abs(step) > before / 4:
            break
        before = abs(step)
    if abs(step) > mpf(10) ** -25 * abs(s):
        raise ArithmeticError(
            f"the eigenvalue {complex(s)} does not settle: its last change is {float(abs(step)):.0e}"
        )
    return s, vector


def _left_in_doubles(doubles: _Doubles, s: complex, scale: np.ndarray) -> np.ndarray:
    """Compute the left eigenvector in double precision, which suffices with an exact right one."""
    P = (doubles.at(s) * np.outer(scale, scale)).T
    return scale * scipy.linalg.svd(P)[2][-1].conj()


# Vectors of whole numbers -------------------------------------------------------------------------


def from_complex(v: np.ndarray) -> np.ndarray:
    """Return columns of the real and the imaginary part of complex numbers."""
    return np.stack([from_float(v.real), from_float(v.imag)], axis=1)


def _shifted(v: np.ndarray, shift: int) -> np.ndarray:
    """Convert columns of whole numbers to double precision, in units of 2^(shift - BITS)."""
    both = np.stack([v.real, v.imag], axis=1)
    flat = [int(mp.ldexp(mpf(float(x)), shift)) for x in both.flat]
    return np.array(flat, dtype=object).reshape(both.shape)


def _scaled(v: np.ndarray, factor: mpf) -> np.ndarray:
    return times(v, fixed([factor])[0])


def _complex_times(v: np.ndarray, factor: mpc) -> np.ndarray:
    real, imag = fixed([factor.real, factor.imag])
    return np.stack(
        [times(v[:, 0], real) - times(v[:, 1], imag), times(v[:, 0], imag) + times(v[:, 1], real)], axis=1
    )


def _inner(left: np.ndarray, right: np.ndarray) -> mpc:
    """Compute left^T right of two complex vectors, without conjugation."""
    return _without_conjugate(dot(left.T, right))


def _without_conjugate(table: np.ndarray) -> mpc:
    """Compute left^T right from the products (2, 2) of real and imaginary parts."""
    return mpc(to_mpf(table[0, 0]) - to_mpf(table[1, 1]), to_mpf(table[0, 1]) + to_mpf(table[1, 0]))
