"""Guaranteed bounds, from below and above, of the natural frequencies of bending.

All quantities are nondimensional: x is x/L, mass and stiffness are relative to the segment at the root.

**The problem.**  With a(u, v) = int EI u'' v'' and four positive semidefinite forms

    P1(u, u) = int N_B u'^2,  P2 = int N_A u'^2,  P3 = int rho A u^2 + m t^2,  P4 = u'(1)^2,

where t = u(1) + eps u'(1), the eigenvalues z = lambda^2 are those at which the form

    Q_z = a + sum_j c_j(z) P_j,    c_j(z) = omega^2 spin_j - z mass_j,

has a kernel, and the k-th of them is at least z if Q_z >= 0 on a subspace of codimension k - 1.

**The split.**  Trial functions have polynomial curvature of degree below n on each segment: the head.
The tail is the orthogonal complement with respect to a: its bending moments EI u'' are orthogonal
to all polynomials of degree below n.  On the tail P_j <= tail_j a, where tail_j is a trace,

    tail_j = trace(P_j) - trace(P_j on the head),  for instance  trace(P1) = int N_B(x) int_0^x 1/EI,

because P_j is a sum of squares of functionals whose norms the cantilever, being statically
determinate, has in closed form.  Hence Q_z >= q a on the tail with q = 1 - sum_j max(0, -c_j) tail_j.

**The coupling.**  For v of the head and w of the tail, integrating from the tip inwards,
sum_j c_j P_j(v, w) = int F w'', where F is a piecewise polynomial; and as int EI p w'' = 0 for
polynomials p of the head, it is int (F - EI p) w'' <= sqrt(R(v, v) a(w, w)), R = int (F - EI p)^2 / EI.
All this for any p; the best is the solution of the head's equations, K p = F.  The Legendre
coefficients of F and EI p are columns of the matrices of a slightly larger basis.

**The theorem.**  Q_z(v + w) >= Q_z(v) - 2 sqrt(R a(w, w)) + q a(w, w) >= (Q_z - R / q)(v).  So, if q > 0
and this last matrix has at most k - 1 negative eigenvalues, the k-th eigenvalue is at least z.
Nothing is assumed of other eigenvalues, signs or the speed.  Assumptions and rounding: docs/bounds.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from math import cos, sin
from time import perf_counter

import numpy as np
from numpy.polynomial import legendre

from beamdyn._version import __version__
from beamdyn.common.announced import announced_of_plain_beam
from beamdyn.common.checks import count, real
from beamdyn.common.results import Provenance, Result
from beamdyn.equations.centrifugal_tension import axial_tension
from beamdyn.equations.discretization import CLAMPED, Space
from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.equations.root_motion import root_motion
from beamdyn.modal.choice import choose_model
from beamdyn.modal.eigen import Solver
from beamdyn.model_error.choice import plain_physics, warn_of_plain
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds, warn_of_static_deflection
from beamdyn.spectrum.planes import refuse_uncovered, separate_planes

_EPS = float(np.finfo(float).eps)
_MOST_IN_ALL = 500  # functions on all segments together: an eigenproblem of a tenth of a second
_NARROW = 1e-11  # relative width of the squares below which the basis is not enlarged
_MOST_STEPS = 12  # of the search for z from a Ritz value
_LARGEST_STEP = 10.0  # of this search, relative to 1 + |z|: a bound beyond it would be useless
_PROOF_SIZES = (24, 48, 96)  # functions on all segments with which a bound of the critical speed is sought
_CLOSE = 1 - 1e-6  # part of the squared Ritz value at which such a bound is close enough
# The parts of the squared Ritz value that are tried as such a bound.
_SHARES = np.concatenate([1 - 10.0 ** np.arange(-13, 0), 4.0 ** -np.arange(0.5, 45)])
_FLEXIBILITY_DEGREES = (0, 8, 16, 32, 64, 128)
_OF_DEFLECTION = 1e-3  # relative error of a model of which the static deflection is read
_FINE, _COARSE = 1e-10, 1e-4  # relative excess of the flexibility over 1/EI: aimed at, and accepted


@dataclass(frozen=True)
class FrequencyBounds(Result):
    """Guaranteed bounds of the exact natural frequencies of bending, the lowest first.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    lower, upper : ndarray, shape (m,)
        Bounds of the frequency [Hz]; nan where the mode is, or for `lower` may be, unstable.
    lower_squared, upper_squared : ndarray, shape (m,)
        Bounds of the squared angular frequency [rad2/s2], negative for an unstable mode; nan where
        none is guaranteed.
    width : ndarray, shape (m,)
        Relative width upper / lower - 1; nan where a bound is.
    how : str
        Argument by which the bounds are guaranteed.
    warnings : tuple of str
        Bounds that are missing, and why; that rotation bends the beam too far for the model they are of.
    provenance : Provenance
        Program version, discretization and computing time.
    """

    speed: float
    lower: np.ndarray
    upper: np.ndarray
    lower_squared: np.ndarray
    upper_squared: np.ndarray
    width: np.ndarray
    how: str
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)


@announced_of_plain_beam
def frequency_bounds(scene: Scene, speed: float = 0.0, modes: int = 3) -> FrequencyBounds:
    """Compute guaranteed lower and upper bounds of the natural frequencies of bending at a steady speed.

    They hold for the Euler-Bernoulli model without damping, in one plane or in two that nothing couples; see
    docs/bounds.md.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.  Physics "auto" is the plain beam.
    speed : float
        Speed [rad/s].
    modes : int
        Number of modes.

    Returns
    -------
    FrequencyBounds

    Raises
    ------
    ValueError
        If an argument is out of its range, or the scene has what the theorem does not cover: stretch, shear,
        rotary inertia, damping, springs at the root, or planes that the twist or the bending angle couples.
    """
    start = perf_counter()
    check_scene(scene)
    unresolved, scene = scene, plain_physics(scene)
    speed, modes = real("speed", speed, "rad/s"), count("modes", modes)
    _check_input(scene, speed, modes)
    enclosed = [_enclose_plane(plane, speed, modes) for plane in separate_planes(scene, speed != 0)]
    # The k-th lowest of both planes lies between the k-th lowest of their lower and of their upper bounds.
    lower, upper = (np.sort(np.concatenate(b))[:modes] for b in ([e[i] for e in enclosed] for i in (0, 1)))
    functions = max(e[2] for e in enclosed)
    low, high = _frequency(lower, -8), _frequency(upper, 8)
    return FrequencyBounds(
        speed=speed,
        lower=low,
        upper=high,
        lower_squared=lower,
        upper_squared=upper,
        width=high / low - 1,
        how="above: Rayleigh-Ritz; below: the same less a bound of the coupling to all other functions",
        warnings=(*warn_of_plain(unresolved), *_warnings(lower, upper), *_warn_of_bending(scene, speed)),
        provenance=Provenance(__version__, str(Ritz(functions)), "its complement", perf_counter() - start),
        scene=scene,
    )


def _enclose_plane(scene: Scene, speed: float, modes: int) -> tuple[np.ndarray, np.ndarray, int]:
    """Bounds of the squared angular frequencies in one plane, and the functions of the last basis."""
    scaled, time = _nondimensional(scene)
    lower, upper, functions = _enclose(scaled, speed * time, modes)
    return _widen(lower, -8) / time**2, _widen(upper, 8) / time**2, functions


def _check_input(scene: Scene, speed: float, modes: int) -> None:
    refuse_uncovered(scene, speed)
    check_speeds(speed, "speed")
    planes = separate_planes(scene, speed != 0)
    most = min(_most_functions(plane.beam) * (len(plane.beam.breakpoints) - 1) for plane in planes)
    if modes > most:
        raise ValueError(
            f"modes = {modes}: give at most {max(0, most)}, for which this beam leaves room; the higher the "
            "degree of its properties, the less"
        )


def _warn_of_bending(scene: Scene, speed: float) -> Iterator[str]:
    """Yield a warning if rotation bends the beam too far for the model whose frequencies are bounded."""
    speeds = np.array([speed])
    tips = choose_model(scene, "ritz", speeds, 1, _OF_DEFLECTION).static_tips(speeds)
    yield from warn_of_static_deflection(np.linalg.norm(tips, axis=1), scene.beam.length, speeds)


def _widen(values: np.ndarray, units: int) -> np.ndarray:
    """Move values up (units > 0) or down (units < 0) by a number of rounding units."""
    return values + units * _EPS * np.abs(values)


def _frequency(squared: np.ndarray, units: int) -> np.ndarray:
    """Frequencies [Hz] of squared angular frequencies, moved by rounding units; nan where not positive."""
    return _widen(np.sqrt(np.where(squared > 0, squared, np.nan)) / (2 * np.pi), units)


def _warnings(lower: np.ndarray, upper: np.ndarray) -> Iterator[str]:
    missing, unstable, undecided = np.isnan(lower), upper <= 0, (lower <= 0) & (upper > 0)
    if missing.any():
        yield (
            f"no lower bound of mode(s) {_list_modes(missing)}: the functions left out could not be bounded, "
            "even with the largest basis"
        )
    if unstable.any():
        yield f"mode(s) {_list_modes(unstable)} are unstable: see the bounds of the squares"
    if undecided.any():
        yield f"mode(s) {_list_modes(undecided)} may be stable or not: the bounds of the squares enclose zero"


def _list_modes(mask: np.ndarray) -> str:
    """List the numbers of the masked modes in words."""
    numbers = np.flatnonzero(mask) + 1
    return ", ".join(map(str, numbers)) if len(numbers) < 6 else f"{numbers[0]} ... {numbers[-1]}"


def _nondimensional(scene: Scene) -> tuple[Scene, float]:
    """Scale a scene to unit length, mass and stiffness, and compute its unit of time [s]."""
    beam, length = scene.beam, scene.beam.length
    m, e = (p.coefficients[0][0] for p in (beam.mass_per_length, beam.bending_stiffness))
    mass, stiffness = beam.mass_per_length.scaled(1 / m), beam.bending_stiffness.scaled(1 / e)
    scaled = Beam(1.0, mass, stiffness, tip=_nondimensional_tip(beam.tip or TipMass(0.0), m * length, length))
    mount = replace(scene.mount, radius=scene.mount.radius / length)
    return Scene(scaled, mount), length**2 * float(np.sqrt(m / e))


def _nondimensional_tip(tip: TipMass, mass: float, length: float) -> TipMass:
    moments = (tip.inertia, tip.inertia_about_bending_direction, tip.axial_inertia)
    return TipMass(tip.mass / mass, tip.offset / length, *(j / (mass * length**2) for j in moments))


def bound_critical_speed(scene: Scene) -> float:
    """Compute a guaranteed lower bound of the critical speed of bending [rad/s]; 0 if none is proved.

    By the theorem of this module with z = 0 and k = 1: the stiffness at that speed, and so at every slower
    one, is positive.
    """
    scaled, time = _nondimensional(scene)
    if (flexibility := _flexibility(scaled.beam.bending_stiffness)) is None:
        return 0.0
    proved, most, segments = 0.0, _most_functions(scaled.beam), len(scaled.beam.breakpoints) - 1
    for total in _PROOF_SIZES:
        size = min(most, max(6, total // segments))
        split = Split(scaled, size, 1.0, flexibility)
        proved = max(proved, _prove_stiff(split))
        if proved >= _CLOSE * split.ritz_critical_speed**2:
            break
    return float(_widen(np.sqrt(np.array(proved)), -8) / time)


def _prove_stiff(split: Split) -> float:
    """Largest squared speed, of a descending list, for which the stiffness is proved positive; 0 if none."""
    softening = float(np.maximum(-split.spin, 0) @ split.tails)
    largest = min(1 / max(softening, _EPS), split.ritz_critical_speed**2)
    for squared in largest * _SHARES:
        form = split.stiffness_form(squared)
        if form is not None and np.isfinite(form).all() and np.linalg.eigvalsh(form)[0] >= 0:
            return float(squared)
    return 0.0


# The search ---------------------------------------------------------------------------------------


def _enclose(scene: Scene, speed: float, modes: int) -> tuple[np.ndarray, np.ndarray, int]:
    """Bounds of z from growing bases, until they hardly narrow, and the functions of the last basis."""
    flexibility = _flexibility(scene.beam.bending_stiffness)
    lower, upper = np.full(modes, np.nan), np.full(modes, np.nan)
    functions = 0
    for functions in _sizes(scene.beam, modes):
        try:
            low, high = Split(scene, functions, speed, flexibility).bounds(modes)
        except np.linalg.LinAlgError:  # rounding of so many functions at such a speed
            break
        last_width, lower, upper = upper - lower, np.fmax(lower, low), np.fmin(upper, high)
        width = upper - lower
        if (width <= _NARROW * np.abs(upper)).all() or (width > last_width / 2).all():
            break
    return lower, upper, functions


def _sizes(beam: Beam, modes: int) -> Iterator[int]:
    """Yield growing numbers of functions on each segment."""
    most, size = _most_functions(beam), max(6, (16 + 2 * modes) // (len(beam.breakpoints) - 1))
    while size < most:
        yield size
        size = 4 * size // 3
    yield most


def _most_functions(beam: Beam) -> int:
    """Largest number of functions of the head on each segment."""
    return min(MOST_FUNCTIONS - _extra_degrees(beam), _MOST_IN_ALL // (len(beam.breakpoints) - 1))


def _extra_degrees(beam: Beam) -> int:
    """Degrees by which F and EI p (see the module) exceed the polynomials of the head."""
    return max(beam.mass_per_length.degree + 4, beam.bending_stiffness.degree)


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


# The matrices -------------------------------------------------------------------------------------


class Split:
    """Split of the trial functions into head and tail, with the forms as matrices, at one speed.

    Parameters
    ----------
    scene : Scene
        A nondimensional scene.
    functions : int
        Number n of functions of the head on each segment.
    speed : float
        Nondimensional speed.
    flexibility : Profile or None
        Upper bound of 1/EI; without one there are no lower bounds.
    """

    def __init__(self, scene: Scene, functions: int, speed: float, flexibility: Profile | None) -> None:
        self.scene, self.speed, self.flexibility = scene, speed, flexibility
        larger = functions + _extra_degrees(scene.beam)
        segments = len(scene.beam.breakpoints) - 1
        space = Ritz(larger).spaces(scene.beam).functions(CLAMPED)
        self.stiffness = space.gram(scene.beam.bending_stiffness, 2)
        self.forms = _assemble_forms(scene.beam, space)
        self.head = np.flatnonzero(np.tile(np.arange(larger) < functions, segments))
        self.spin, self.spin_terms, self.mass = _split_coefficients(scene)
        # Rounding error of a sum of as many products as the rule has points, relative to its terms: doubled
        # for the factors, and again for the eigensolution.
        self.unit = 4 * _EPS * (len(space.points) + len(self.stiffness))

    def bounds(self, modes: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute lower and upper bounds of the lowest z."""
        mass = self._sum(self.mass)[self._square]
        starts = list(enumerate(self._ritz_values(mass, modes)))
        upper = [_search_bound(self.upper_form, mass, k, z, 1) for k, z in starts]
        if self.flexibility is None:
            return np.full(modes, np.nan), np.array(upper)
        return np.array([_search_bound(self.lower_form, mass, k, z, -1) for k, z in starts]), np.array(upper)

    def _ritz_values(self, mass: np.ndarray, modes: int) -> np.ndarray:
        """Ritz values of z, from which the search starts."""
        return -np.real(self._solver(mass).solve(np.array([self.speed]), modes).eigenvalue[0] ** 2)

    @cached_property
    def ritz_critical_speed(self) -> float:
        """Critical speed in the space of the head: never below the exact one but by rounding."""
        return self._solver(self._sum(self.mass)[self._square]).critical_speed

    def _solver(self, mass: np.ndarray) -> Solver:
        zero = np.zeros_like(mass)
        K0, K2 = self._K, self._sum(self.spin)[self._square]
        return Solver(SteadyPencil(mass, zero, zero, K0, K2, zero[0]))

    def upper_form(self, z: float) -> np.ndarray:
        """Q_z on the head plus the rounding allowance: with k + 1 eigenvalues <= 0, mode k is at most z."""
        form = (self.stiffness + self._sum(self._coefficients(z)))[self._square]
        return form + self._allowance(self._absolute_coefficients(z)) * np.eye(len(form))

    def lower_form(self, z: float) -> np.ndarray | None:
        """Q_z - R/q minus the rounding allowance: with <= k eigenvalues < 0, mode k is at least z."""
        return self._lower_form(self._coefficients(z), self._absolute_coefficients(z))

    def stiffness_form(self, squared_speed: float) -> np.ndarray | None:
        """The same at z = 0 and another speed: without eigenvalues < 0, no slower speed is critical."""
        return self._lower_form(squared_speed * self.spin, squared_speed * self.spin_terms)

    def _lower_form(self, coefficients: np.ndarray, terms: np.ndarray) -> np.ndarray | None:
        """Q - R/q minus the rounding allowance, for coefficients c_j and the sums of their absolute terms."""
        tail = np.maximum(self.unit * terms - coefficients, 0) @ self.tails
        if tail >= 1:
            return None
        coupling, allowance = self._sum(coefficients)[:, self.head], self._allowance(terms)
        defect = coupling - self.stiffness[:, self.head] @ np.linalg.solve(self._K, coupling[self.head])
        error = self.compliance.max() * (self.condition * allowance) ** 2  # rounding error, squared
        one = np.eye(len(self.head))
        R = 2 * (defect.T @ (self.compliance[:, None] * defect) + error * one)  # |a + b|^2 <= 2 (a^2 + b^2)
        return self._K + coupling[self.head] - R / (1 - tail) - allowance * one

    @cached_property
    def tails(self) -> np.ndarray:
        """Upper bounds tail_j of the four forms on the tail, relative to a."""
        assert self.flexibility is not None
        total = _bound_traces(self.scene.beam, self.flexibility)
        head = [np.trace(np.linalg.solve(self._K, form[self._square])) for form in self.forms]
        return np.maximum(total - head, 0) + self.unit * self.condition * total

    @cached_property
    def compliance(self) -> np.ndarray:
        """Upper bound of 1/EI on the segment of each function, by |P_k| <= 1."""
        assert self.flexibility is not None
        flexibility = self.flexibility.split(self.scene.beam.breakpoints)
        largest = [np.abs(row).sum() for row in flexibility.coefficients]
        return np.repeat(largest, len(self.stiffness) // len(largest))

    @cached_property
    def condition(self) -> float:
        """Upper bound of the condition number of the stiffness: largest over smallest EI."""
        rows = self.scene.beam.bending_stiffness.coefficients
        return float(max(np.abs(row).sum() for row in rows) * self.compliance.max())

    def _coefficients(self, z: float) -> np.ndarray:
        """Coefficients c_j(z) of the forms."""
        return self.speed**2 * self.spin - z * self.mass

    def _absolute_coefficients(self, z: float) -> np.ndarray:
        """Sums of the absolute values of the terms of the coefficients c_j(z)."""
        return self.speed**2 * self.spin_terms + abs(z) * self.mass

    def _allowance(self, terms: np.ndarray) -> float:
        """Bound of the rounding error of Q: of an entry of a Gram matrix it is <= unit sqrt(P_ii P_jj)."""
        traces = np.trace(self.forms, axis1=1, axis2=2)
        return float(self.unit * (np.trace(self.stiffness) + terms @ traces))

    def _sum(self, coefficients: np.ndarray) -> np.ndarray:
        return np.tensordot(coefficients, self.forms, 1)

    @cached_property
    def _K(self) -> np.ndarray:
        return self.stiffness[self._square]

    @property
    def _square(self) -> tuple[np.ndarray, ...]:
        return np.ix_(self.head, self.head)


def _assemble_forms(beam: Beam, space: Space) -> np.ndarray:
    """Assemble the matrices of the forms P1 ... P4: shape (4, n, n)."""
    tip = beam.tip or TipMass(0.0)
    n_a, n_b = axial_tension(beam)
    slope = space.end(1)
    centre = space.end(0) + tip.offset * slope
    inertia = space.gram(beam.mass_per_length, 0) + tip.mass * np.outer(centre, centre)
    return np.array([space.gram(n_b, 1), space.gram(n_a, 1), inertia, np.outer(slope, slope)])


def _split_coefficients(scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parts of c_j per omega^2, the sums of the absolute values of their terms, and per -z: (4,) each."""
    tip, psi = scene.beam.tip or TipMass(0.0), scene.mount.bending_angle
    root = float(root_motion(scene.mount, MotionSample.steady(1.0)).root_axial)
    tilt = sin(psi) ** 2 * np.array([tip.inertia_about_bending_direction, -tip.axial_inertia])
    tension = tip.mass * tip.offset * np.array([1.0, tip.offset, -root])
    ends = np.concatenate([tilt, tension])
    spin = np.array([1.0, -root, -(cos(psi) ** 2), ends.sum()])
    terms = np.append(np.abs(spin[:3]), np.abs(ends).sum())
    return spin, terms, np.array([0.0, 0.0, 1.0, tip.inertia])


# Traces -------------------------------------------------------------------------------------------


def _bound_traces(beam: Beam, flexibility: Profile) -> np.ndarray:
    """Upper bounds of the traces of P1 ... P4 relative to a: shape (4,).

    The slope at x under unit energy is at most sqrt(int_0^x 1/EI), the deflection
    sqrt(int_0^x (x - s)^2 / EI).  Exchanging the integrals leaves outboard integrals of the loads:
    int_s^1 (x - s)^2 rho A dx is twice the threefold one.
    """
    tip = beam.tip or TipMass(0.0)
    n_a, n_b = axial_tension(beam)
    moment = beam.mass_per_length.outboard_integral().outboard_integral().outboard_integral().scaled(2.0)
    arm = Profile((0.0, 1.0), ((0.5 + tip.offset, -0.5),))  # 1 - s + eps
    loads = (n_b.outboard_integral(), n_a.outboard_integral(), moment)
    tension_b, tension_a, inertia = (_integral(flexibility * load) for load in loads)
    inertia += tip.mass * _integral(flexibility * (arm * arm))
    return np.array([tension_b, tension_a, inertia, _integral(flexibility)])


def _integral(profile: Profile) -> float:
    lengths = (b - a for a, b in pairwise(profile.breakpoints))
    return sum(length * row[0] for length, row in zip(lengths, profile.coefficients, strict=True))


def _flexibility(stiffness: Profile) -> Profile | None:
    """Piecewise polynomial that is a close upper bound of 1/EI; None if the search fails."""
    rows = [_reciprocal(np.array(row)) for row in stiffness.coefficients]
    bounds = tuple(row for row in rows if row is not None)
    return Profile(stiffness.breakpoints, bounds) if len(bounds) == len(rows) else None


def _reciprocal(row: np.ndarray) -> tuple[float, ...] | None:
    """Legendre coefficients of g / (1 - misfit) >= 1/EI, if |1 - EI g| <= misfit < 1; None if too large."""
    for degree in _FLEXIBILITY_DEGREES:
        t, w = legendre.leggauss(degree + 1)
        projection = (np.arange(degree + 1) + 0.5)[:, None] * legendre.legvander(t, degree).T
        g = projection @ (w / legendre.legval(t, row))
        product = legendre.legmul(row, g)
        rounding = 4 * _EPS * (degree + len(row)) * np.abs(row).sum() * np.abs(g).sum()
        misfit = np.abs(legendre.legsub(product, [1.0])).sum() + rounding
        if misfit <= (_FINE if degree < _FLEXIBILITY_DEGREES[-1] else _COARSE):
            return tuple((g / (1 - misfit)).tolist())
    return None
