"""Frequencies of a rotating cantilever from power series: the independent reference of the tests.

The boundary value problem is solved by shooting: Taylor series carry the two (bending) or three
(bending and stretch) solutions that satisfy the root's conditions to the tip, and the determinant
of the tip's conditions vanishes at an eigenvalue. Everything runs in mpmath with guard digits;
nothing is shared with `beamdyn`. A Rayleigh-Ritz solution in double precision only says where to
look and how many roots there are.

All quantities are nondimensional: length 1, mass per length rho A(0) = 1, stiffness EI(0) = 1.
``gamma`` is the speed and ``lambda`` the frequency, both times tau = sqrt(rho A(0) L^4 / EI(0));
``delta`` is the hub radius over the length, positive outward (an inward beam has delta = -r/L).

With w = lambda^2 + gamma^2 cos^2(psi) and the state (u, u', moment M, shear Q) the beam obeys

    EI u'' = M,   M' = Q + N u',   Q' = w m u,
    N(x) = gamma^2 (int_x^1 m(s) (delta + s) ds + m_t (delta + 1 + eps)),

and its tip body (mass m_t, offset eps, inertias J_n, J_e, J_1), with t = u(1) + eps u'(1),

    Q + w m_t t = 0,
    M + [gamma^2 (m_t (delta + 1 + eps) eps + sin^2(psi) (J_e - J_1)) - lambda^2 J_n] u'
      - w m_t eps t = 0.

Stretch s with force F (uniform beam; s ~ cos(lambda t), u ~ sin(lambda t); Yoo and Shin 1998):

    alpha^2 s' = F,   F' = k u - (gamma^2 + lambda^2) s,   Q' = w u - k s,
    k = 2 gamma lambda cos(psi).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import count as naturals
from itertools import pairwise
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.polynomial import Legendre, Polynomial
from scipy.linalg import cholesky, eigh

Number = int | float | str | mpf
State = Sequence[mpf]

# Number of Ritz functions for start values, and of modes kept of each field where stretch is coupled.
_FUNCTIONS, _MODES = 48, 20
_GUARD_DIGITS = 15


@dataclass(frozen=True)
class Tip:
    """A rigid body at the tip.

    Parameters
    ----------
    mass
        Mass over rho A(0) L.
    offset
        Distance of the centre of gravity beyond the tip, over L.
    inertia
        Moment of inertia J_n about the bending axis, over rho A(0) L^3, like the other two.
    lateral_inertia
        Moment of inertia J_e about the direction of bending; J_n if not given (an axisymmetric body).
    axial_inertia
        Moment of inertia J_1 about the beam's axis.
    """

    mass: Number = 0
    offset: Number = 0
    inertia: Number = 0
    lateral_inertia: Number | None = None
    axial_inertia: Number = 0


def bending_eigenvalues(
    gamma: Number,
    delta: Number = 0,
    bending_angle: Number = 0,
    mass: Sequence[Number] = (1,),
    stiffness: Sequence[Number] = (1,),
    tip: Tip | None = None,
    count: int = 3,
    digits: int = 30,
) -> list[mpf]:
    """Compute the lowest values of lambda^2, ascending; a negative one is a divergent mode.

    Parameters
    ----------
    gamma, delta
        Speed and hub radius.
    bending_angle
        Bending angle psi [rad] from the plane of rotation: 0 chordwise, pi/2 flapwise.
    mass, stiffness
        Coefficients of rho A and EI as polynomials in x/L, lowest first.
    tip
        The body at the tip.
    count, digits
        Number of values, and number of digits.

    Raises
    ------
    ArithmeticError
        If the roots differ from those predicted by Rayleigh-Ritz.
    """
    speed_squared = float(gamma) ** 2
    beam = _beam(delta, bending_angle, mass, stiffness, tip)
    bending, spin, inertia = _forms(beam)
    starts, _ = _lowest(bending + speed_squared * spin, inertia, count + 1)
    with mp.workdps(digits + _lost_digits(beam, speed_squared, starts[-1])):
        beam = _beam(delta, bending_angle, mass, stiffness, tip)
        gamma_squared = _exact(gamma) ** 2
        return _roots(lambda z: _bending_determinant(beam, gamma_squared, z), starts, digits)


def coupled_frequencies(
    gamma: Number,
    delta: Number,
    alpha: Number,
    bending_angle: Number = 0,
    count: int = 1,
    digits: int = 30,
) -> list[mpf]:
    """Compute the lowest frequencies of a uniform beam with stretch and Coriolis coupling, ascending.

    Parameters
    ----------
    gamma, delta, bending_angle, count, digits
        As in `bending_eigenvalues`; gamma below the critical speed and below pi alpha / 2.
    alpha
        sqrt(EA L^2 / EI).
    """
    beam = _beam(delta, bending_angle)
    starts = _coupled_starts(beam, float(gamma), float(alpha))[: count + 1]
    with mp.workdps(digits + _lost_digits(beam, float(gamma) ** 2, starts[-1] ** 2)):
        beam, speed, ratio = _beam(delta, bending_angle), _exact(gamma), _exact(alpha)
        return _roots(lambda z: _coupled_determinant(beam, speed, ratio, z), starts, digits, floor=0)


def critical_speed(
    delta: Number,
    bending_angle: Number = 0,
    mass: Sequence[Number] = (1,),
    stiffness: Sequence[Number] = (1,),
    tip: Tip | None = None,
    digits: int = 30,
) -> mpf:
    """Compute the lowest gamma at which lambda^2 = 0, infinite if there is none.

    The parameters are those of `bending_eigenvalues`.
    """
    beam = _beam(delta, bending_angle, mass, stiffness, tip)
    bending, spin, _ = _forms(beam)
    softening = eigh(-spin, bending, eigvals_only=True)[::-1]
    starts = [1 / mu for mu in softening[:2] if mu > 1e-8]
    if not starts:
        return mp.inf
    starts = [*starts, 4 * starts[0]][:2]  # the second start value only bounds the search for the first root
    with mp.workdps(digits + _lost_digits(beam, starts[-1], 0.0)):
        beam = _beam(delta, bending_angle, mass, stiffness, tip)
        return mp.sqrt(_roots(lambda z: _bending_determinant(beam, z, mpf(0)), starts, digits, floor=0)[0])


def solve_case(case: dict[str, Any], count: int = 3, digits: int = 30) -> list[mpf]:
    """Compute lambda^2 of a ``[[case]]`` of the data files, ascending."""
    with mp.workdps(digits + _GUARD_DIGITS):
        angle = mp.radians(_exact(case["bending_angle_deg"]))
    if case["model"] == "coupled":
        roots = coupled_frequencies(case["gamma"], case["delta"], case["alpha"], angle, count, digits)
        with mp.workdps(digits):
            return [root**2 for root in roots]
    tip = Tip(**case["tip"]) if "tip" in case else None
    section = case["mass"], case["stiffness"]
    return bending_eigenvalues(case["gamma"], case["delta"], angle, *section, tip, count, digits)


# --- the beam in exact numbers ---


@dataclass(frozen=True)
class _Beam:
    delta: mpf
    cos: mpf
    mass: list[mpf]
    stiffness: list[mpf]
    load: list[mpf]  # polynomial of the tension over gamma^2
    tip: Tip
    steps: list[tuple[mpf, mpf]]  # (start, length) of each Taylor series


def _exact(number: Number) -> mpf:
    """Convert a number by its decimal digits: 0.1 means one tenth, not the nearest binary number."""
    return number if isinstance(number, mpf) else mpf(str(number))


def _beam(
    delta: Number,
    bending_angle: Number,
    mass: Sequence[Number] = (1,),
    stiffness: Sequence[Number] = (1,),
    tip: Tip | None = None,
) -> _Beam:
    tip = _exact_tip(tip or Tip())
    delta, line = _exact(delta), [_exact(c) for c in mass]
    flexural = [_exact(c) for c in stiffness]
    load = _load(line, delta, tip)
    return _Beam(delta, mp.cos(_exact(bending_angle)), line, flexural, load, tip, list(_steps(flexural)))


def _exact_tip(tip: Tip) -> Tip:
    lateral = tip.inertia if tip.lateral_inertia is None else tip.lateral_inertia
    return Tip(*map(_exact, (tip.mass, tip.offset, tip.inertia, lateral, tip.axial_inertia)))


def _load(mass: list[mpf], delta: mpf, tip: Tip) -> list[mpf]:
    """Compute the tension over gamma^2: int_x^1 m(s) (delta + s) ds + m_t (delta + 1 + eps)."""
    moment = [delta * a + b for a, b in zip([*mass, 0], [0, *mass], strict=True)]
    integral = [a / k for k, a in enumerate(moment, start=1)]
    return [sum(integral) + tip.mass * (delta + 1 + tip.offset), *(-a for a in integral)]


def _steps(stiffness: list[mpf]) -> Iterator[tuple[mpf, mpf]]:
    """Yield steps along the beam, each within half the radius of convergence of the Taylor series."""
    zeros = Polynomial([float(c) for c in stiffness]).roots()
    start = mpf(0)
    while start < 1:
        radius = min(np.abs(zeros - float(start)), default=np.inf)
        if radius < 0.02:
            raise ValueError(f"EI vanishes near x/L = {float(start):.3f}: the series cannot pass it")
        step = min(mpf(radius) / 2, 1 - start)
        yield start, step
        start += step


# --- series and determinants ---


@dataclass(frozen=True)
class _Rates:
    """Coefficients of the first-order equations in the module's docstring."""

    weight: mpf
    coupling: mpf | int = 0
    stretch_weight: mpf | int = 0
    flexibility: mpf | int = 0  # 1 / alpha^2


def _bending_determinant(beam: _Beam, gamma_squared: mpf, eigenvalue: mpf) -> mpf:
    rates = _Rates(eigenvalue + gamma_squared * beam.cos**2)
    tips = [_shoot(beam, gamma_squared, rates, start) for start in (2, 3)]
    (a, b, _), (c, d, _) = (_residual(beam, gamma_squared, eigenvalue, tip) for tip in tips)
    return a * d - b * c


def _coupled_determinant(beam: _Beam, gamma: mpf, alpha: mpf, frequency: mpf) -> mpf:
    rates = _Rates(
        weight=frequency**2 + (gamma * beam.cos) ** 2,
        coupling=2 * gamma * frequency * beam.cos,
        stretch_weight=gamma**2 + frequency**2,
        flexibility=1 / alpha**2,
    )
    tips = [_shoot(beam, gamma**2, rates, start) for start in (2, 3, 5)]
    return mp.det(mp.matrix([_residual(beam, gamma**2, frequency**2, tip) for tip in tips]))


def _shoot(beam: _Beam, gamma_squared: mpf, rates: _Rates, start: int) -> State:
    """Compute the state (u, u', M, Q, s, F) at the tip from a state at the root with a 1 at index `start`."""
    state: State = [mpf(i == start) for i in range(6)]
    tension = [gamma_squared * c for c in beam.load]
    for x, step in beam.steps:
        section = [_local(p, x, step) for p in (beam.mass, beam.stiffness, tension)]
        state = _advance(state, step, rates, *section)
    return state


def _residual(beam: _Beam, gamma_squared: mpf, eigenvalue: mpf, state: State) -> list[mpf]:
    u, slope, moment, shear, _, force = state
    tip, cos_squared = beam.tip, beam.cos**2
    push = (eigenvalue + gamma_squared * cos_squared) * tip.mass * (u + tip.offset * slope)
    pull = tip.mass * (beam.delta + 1 + tip.offset) * tip.offset
    gyration = (1 - cos_squared) * (tip.lateral_inertia - tip.axial_inertia)
    spring = gamma_squared * (pull + gyration) - eigenvalue * tip.inertia
    return [moment + spring * slope - tip.offset * push, shear + push, force]


def _local(polynomial: list[mpf], start: mpf, step: mpf) -> list[mpf]:
    """Compute a polynomial's coefficients in xi = (x - start) / step."""
    terms = range(len(polynomial))
    return [
        step**k * sum(mp.binomial(j, k) * start ** (j - k) * polynomial[j] for j in terms if j >= k)
        for k in terms
    ]


def _advance(
    state: State, h: mpf, rates: _Rates, mass: list[mpf], stiffness: list[mpf], tension: list[mpf]
) -> State:
    """Compute the state at the end of a step h by Taylor series in xi = (x - start) / h."""
    series = u, slope, moment, shear, stretch, force = [[value] for value in state]
    slope[0] *= h  # derivative d/dxi inside the step
    bend: list[mpf] = []  # d^2 u / dxi^2
    window = 3 + max(map(len, (mass, stiffness, tension)))
    small = mp.eps * max(map(abs, state))
    for k in naturals():
        bend.append((h * h * moment[k] - _convolved(stiffness, bend, k, first=1)) / stiffness[0])
        pull = h * shear[k] + _convolved(tension, slope, k)
        growth = [slope[k], bend[k], pull, h * rates.weight * _convolved(mass, u, k)]
        if rates.flexibility:
            growth[-1] -= h * rates.coupling * stretch[k]
            axial = rates.coupling * u[k] - rates.stretch_weight * stretch[k]
            growth += [h * rates.flexibility * force[k], h * axial]
        for coefficients, rate in zip(series, growth, strict=False):
            coefficients.append(rate / (k + 1))
        if k % window == 0 < k and _vanished(series, window, small):
            break
    u, slope, *others = map(mp.fsum, series)
    return [u, slope / h, *others]


def _convolved(polynomial: list[mpf], series: list[mpf], k: int, first: int = 0) -> mpf:
    """Compute coefficient k of the product of a polynomial and a series, without terms below `first`."""
    last = min(k + 1, len(polynomial))
    return mp.fdot((polynomial[j], series[k - j]) for j in range(first, last))


def _vanished(series: Sequence[list[mpf]], window: int, small: mpf) -> bool:
    return all(abs(c) < small for coefficients in series for c in coefficients[-window:])


def _lost_digits(beam: _Beam, gamma_squared: float, eigenvalue: float) -> int:
    """Estimate the digits that cancel in series and determinant: twice those of the solutions' growth."""
    x = np.linspace(0, 1, 101)
    mass, stiffness, load = (_values(p, x) for p in (beam.mass, beam.stiffness, beam.load))
    string = gamma_squared * np.abs(load) / stiffness
    beat = np.sqrt((abs(eigenvalue) + gamma_squared) * mass / stiffness)
    return _GUARD_DIGITS + int(2 * np.sqrt(string + beat).max() / np.log(10))


# --- roots ---


def _roots(
    function: Callable[[mpf], mpf], starts: Sequence[float], digits: int, floor: float = -np.inf
) -> list[mpf]:
    """Find one root near each start value except the last; midpoints of starts must separate the roots."""
    middles = [(a + b) / 2 for a, b in pairwise(starts)]
    edges = [mpf(e) for e in (max(floor, starts[0] - (starts[1] - starts[0]) / 2), *middles)]
    signs = [mp.sign(function(edge)) for edge in edges]
    if any(a * b != -1 for a, b in pairwise(signs)):
        raise ArithmeticError(f"the determinant does not change sign around each of {starts[:-1]}")
    return [
        _secant(function, mpf(s), *pair, digits) for s, pair in zip(starts, pairwise(edges), strict=False)
    ]


def _secant(function: Callable[[mpf], mpf], start: mpf, low: mpf, high: mpf, digits: int) -> mpf:
    a, b = start, start + mpf("1e-8") * (high - low)
    at_a = function(a)
    for _ in range(40):
        at_b = function(b)
        step = -at_b * (b - a) / (at_b - at_a)
        a, at_a, b = b, at_b, b + step
        if abs(step) < mpf(10) ** -digits * max(1, abs(b)):
            break
    else:
        raise ArithmeticError(f"the secant method does not converge from {start}")
    if not low < b < high or abs(b - start) > 0.01 * (high - low):
        raise ArithmeticError(f"the root {b} is not the one announced at {start}")
    return +b


# --- start values: Rayleigh-Ritz with u'' = P_k(2 x - 1), in double precision ---


@lru_cache
def _basis() -> tuple[np.ndarray, ...]:
    """Return Gauss points (the last is the tip), weights, and u, u', u'': shape (points, functions)."""
    nodes, weights = np.polynomial.legendre.leggauss(2 * _FUNCTIONS)
    x = np.append((nodes + 1) / 2, 1.0)
    bends = [Legendre.basis(k, domain=[0, 1]) * np.sqrt(2 * k + 1) for k in range(_FUNCTIONS)]
    tables = [np.stack([f.integ(m, lbnd=0)(x) for f in bends], axis=1) for m in (2, 1)]
    return x, np.append(weights / 2, 0.0), *tables, np.stack([f(x) for f in bends], axis=1)


def _values(polynomial: list[mpf], x: np.ndarray) -> np.ndarray:
    return Polynomial([float(c) for c in polynomial])(x)


def _forms(beam: _Beam) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute Ritz matrices of bending stiffness, of terms with gamma^2, and of terms with -lambda^2."""
    x, weights, u, slope, bend = _basis()
    mass, offset, inertia, lateral, axial = map(float, vars(beam.tip).values())
    delta, cos_squared = float(beam.delta), float(beam.cos) ** 2
    turn = np.outer(slope[-1], slope[-1])
    shift = u[-1] + offset * slope[-1]
    translation = _integral(_values(beam.mass, x) * weights, u) + mass * np.outer(shift, shift)
    pull = mass * (delta + 1 + offset) * offset + (1 - cos_squared) * (lateral - axial)
    spin = _integral(_values(beam.load, x) * weights, slope) + pull * turn - cos_squared * translation
    return _integral(_values(beam.stiffness, x) * weights, bend), spin, translation + inertia * turn


def _integral(weights: np.ndarray, table: np.ndarray) -> np.ndarray:
    return table.T @ (weights[:, None] * table)


def _lowest(stiffness: np.ndarray, mass: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Compute the lowest eigenvalues, and eigenvectors of unit mass.

    The solution is for 1/(eigenvalue + shift), as factorising the mass matrix would lose digits.
    """
    shift = _definite_shift(stiffness, mass)
    inverse, vectors = eigh(mass, stiffness + shift * mass)
    inverse, vectors = inverse[: -count - 1 : -1], vectors[:, : -count - 1 : -1]
    return 1 / inverse - shift, vectors / np.sqrt(inverse)


def _definite_shift(stiffness: np.ndarray, mass: np.ndarray) -> float:
    shift = 1.0  # not 0: a nearly singular stiffness would make higher modes inaccurate
    while True:
        try:
            cholesky(stiffness + shift * mass)
        except np.linalg.LinAlgError:
            shift *= 4
        else:
            return shift


def _coupled_starts(beam: _Beam, gamma: float, alpha: float) -> list[float]:
    """Compute positive frequencies of the gyroscopic problem (K + lambda G - lambda^2) q = 0."""
    x, weights, u, *_ = _basis()
    bending, spin, inertia = _forms(beam)
    squares, vectors = _lowest(bending + gamma**2 * spin, inertia, _MODES)
    waves = np.pi * (np.arange(_MODES) + 0.5)
    stretch = np.sqrt(2) * np.sin(np.outer(x, waves))
    mixed = 2 * gamma * float(beam.cos) * stretch.T @ (weights[:, None] * (u @ vectors))
    zero, one = np.zeros((_MODES, _MODES)), np.eye(2 * _MODES)
    stiffness = np.diag(np.append(alpha**2 * waves**2 - gamma**2, squares))
    companion = np.block([[np.zeros_like(one), one], [stiffness, np.block([[zero, mixed], [mixed.T, zero]])]])
    values = np.linalg.eigvals(companion)
    return sorted(v.real for v in values if v.real > 0 and abs(v.imag) < 1e-6 * abs(v))
