"""Internal forces of a duo-servo brake (Yoo et al. 1997, section 4), by exact reduction to one equation.

The drum exerts the normal and friction forces A and B on the leading shoe, C and D on the trailing shoe. P_L
and P_T are the forces of the pistons on these shoes, and Q is the force of the adjuster. The arms a1, a2 of
P_L and P_T, the arms b1, b2 of Q, and the angles alpha1, alpha2, gamma are those of `Levers`; T is the torque
and r the drum's radius.

The moments about the drum's centre give B = (P_L a1 - Q b1) / r, D = (Q b2 - P_T a2) / r and B + D = T / r.
The forces give the resultants R_L^2 = A^2 + B^2 = P_L^2 + Q^2 + 2 P_L Q cos(phi1) and
R_T^2 = C^2 + D^2 = P_T^2 + Q^2 + 2 P_T Q cos(phi2), with phi1 = alpha1 + gamma, phi2 = alpha2 - gamma. Equal
friction, A / B = C / D, means B / R_L = D / R_T.

Given the torque, let u = D r / T be the share of the trailing shoe: Q = (P_T a2 + u T) / b2, and

    f(u) = u R_L - (1 - u) R_T = 0,   f(0) = -R_T < 0 < R_L = f(1).

There is exactly one root: for phi1 and phi2 within 90 degrees, u R_L / ((1 - u) R_T) rises with u from 0 to
infinity. All forces are positive there if B < R_L; otherwise no friction gives this torque.

Given the friction mu = B / A = D / C of the lining, with s = r mu / sqrt(1 + mu^2), Q follows from
Q b2 - P_T a2 = s R_T, and P_L from P_L a1 - Q b1 = s R_L; both are quadratic equations. They have positive
roots below self-locking, s < min(a1, b2).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, positive, together
from beamdyn.common.inputs.checks import InvalidValue, refuse
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import error_at_most, spanned, warned
from beamdyn.common.results.result import Result
from brakes.common.locking import LEAST_MARGIN
from brakes.forklift.duo_servo import HasLevers, Levers
from brakes.vehicle.axles import ROUNDING

_STEPS = 200  # largest number of iterations for the trailing shoe's share; bisection needs about 60
_ARMS_DIFFER = 1e-9  # relative difference of b1 and b2 above which there is a warning
_FRICTION_DIFFERS = 0.01  # relative difference of needed and given friction above which there is a warning


@dataclass(frozen=True)
class InternalForces(Result):
    """Forces in a duo-servo brake; arrays have one entry per case, vectors have their components last.

    Attributes
    ----------
    levers : Levers
        Lever arms and directions of the forces.
    torque, piston_force : ndarray
        Torque T of the brake [N m], and force P_T of the piston on the trailing shoe [N].
    A, B, C, D : ndarray
        Magnitudes of the drum's normal and friction forces on the leading (A, B) and on the trailing (C, D)
        shoe [N].
    Q, P_L : ndarray
        Force Q of the adjuster, and force P_L of the piston that the leading shoe pushes back [N].
    A_vector, B_vector, C_vector, D_vector : ndarray, shape (..., 2)
        The same forces of the drum on the shoes, as vectors [N].
    bolt_force : ndarray, shape (..., 2)
        Resultant force of both pistons on the cylinder, which its bolts carry [N].
    lining_friction : ndarray
        Friction mu = B / A = D / C. If the torque is given, it is a result: the friction that the lining must
        have.
    locking_friction, margin : ndarray
        Friction at which the brake locks, and 1 - lining_friction / locking_friction.
    c_star, c_star_slope : ndarray
        Brake factor C* = T / (P_T r), and its derivative with respect to the lining's friction.
    leading_share, trailing_share : ndarray
        Fractions of the torque from each shoe, B / (B + D) and D / (B + D).
    residual : ndarray
        Largest residual of `equilibrium_equations`, nondimensional: with the larger of T / r and P_T as the
        unit of force and r as the unit of length.
    error : ndarray
        Bound of the relative error of forces, torque, friction and factors (of vectors over their magnitude)
        by the rounding of arms and sums.  If friction is given it grows as 1 / margin; if torque is given, as
        the square of a large friction, and `c_star_slope` is not covered; nan where there are no forces.
    status : str or ndarray of str
        ``"equilibrium"``, ``"locked"`` or ``"no solution"``; the forces are nan for the last two.
    warnings : tuple of str
        Reasons to doubt the result, one sentence each.

    Examples
    --------
    >>> brake = forklift.BENDIX_12_5
    >>> forces = forklift.internal_forces(brake, torque=11000.0, piston_force=11650.0, clearance=0.0106)
    >>> round(float(forces.leading_share + forces.trailing_share), 9)
    1.0
    """

    field_units: ClassVar[dict[str, str]] = {"N": "A_vector B_vector C_vector D_vector bolt_force"}

    levers: Levers
    torque: Annotated[Numbers, Meaning("N m", "torque of the brake T")]
    piston_force: Annotated[Numbers, Meaning("N", "piston on the trailing shoe P_T")]
    A: Annotated[Numbers, Meaning("N", "leading shoe: drum's normal force A")]
    B: Annotated[Numbers, Meaning("N", "leading shoe: friction force B")]
    C: Annotated[Numbers, Meaning("N", "trailing shoe: drum's normal force C")]
    D: Annotated[Numbers, Meaning("N", "trailing shoe: friction force D")]
    Q: Annotated[Numbers, Meaning("N", "adjuster Q")]
    P_L: Annotated[Numbers, Meaning("N", "leading shoe on its piston P_L")]
    A_vector: np.ndarray
    B_vector: np.ndarray
    C_vector: np.ndarray
    D_vector: np.ndarray
    bolt_force: np.ndarray
    lining_friction: Annotated[Numbers, Meaning("", "friction of the lining, B/A = D/C")]
    locking_friction: Annotated[Numbers, Meaning("", "friction at self-locking")]
    margin: Annotated[Numbers, Meaning("", "margin to self-locking")]
    c_star: Annotated[Numbers, Meaning("", "brake factor C* = T / (P_T r)")]
    c_star_slope: Annotated[Numbers, Meaning("", "dC*/dmu")]
    leading_share: Annotated[Numbers, Meaning("", "share of the leading shoe in the torque")]
    trailing_share: Annotated[Numbers, Meaning("", "share of the trailing shoe")]
    residual: Annotated[Numbers, Meaning("", "residual of the equations, over T/r")]
    error: Annotated[Numbers, Meaning("", "bound of the relative error")]
    status: Any
    warnings: tuple[str, ...]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"torque {spanned(self.torque, 'N m')}, C* {spanned(self.c_star)}"
        yield error_at_most(self.error)
        yield f"{self.status}" if np.ndim(self.status) == 0 else self.message
        yield warned(self.warnings)

    @property
    def message(self) -> str:
        """One sentence that explains the status; of many cases, how many have each status."""
        if np.ndim(self.status):
            names, counts = np.unique(self.status, return_counts=True)
            return ", ".join(f"{name}: {count} cases" for name, count in zip(names, counts, strict=True))
        return _SENTENCES[str(self.status)]

    def messages_of_cases(self, count: int) -> dict[int, str]:
        """Return the message of each case without equilibrium, by its index.

        `count` is the number of all cases.
        """
        each = np.broadcast_to(self.status, (count,)).tolist()
        return {i: _SENTENCES[status] for i, status in enumerate(each) if status != "equilibrium"}


_SENTENCES = {
    "equilibrium": "the shoes are in equilibrium, all forces positive",
    "locked": "locked: the lining's friction is at or past self-locking; the shoes grip by themselves, "
    "and no torque follows from the piston's force",
    "no solution": "no solution: no friction of the lining, however large, gives this torque at this "
    "piston force; the arms a1 and b2 exceed the drum's radius",
}


def internal_forces(
    geometry: HasLevers,
    *,
    piston_force: Numbers,
    torque: Numbers | None = None,
    friction: Numbers | None = None,
    clearance: Numbers | None = None,
) -> InternalForces:
    """Compute the forces on the shoes from the torque or from the lining's friction.

    Parameters
    ----------
    geometry : DuoServo, ShoeMotion or Levers
        The brake; a `DuoServo` needs the clearance.
    piston_force : float or ndarray
        Force P_T of the piston on the trailing shoe [N].
    torque : float or ndarray, optional
        Torque T of one brake [N m]. The friction is then a result.
    friction : float or ndarray, optional
        Friction of the lining. Without a torque, it determines the torque; with one, it is compared
        with the friction that the torque needs.
    clearance : float or ndarray, optional
        Clearance between lining and drum at rest [m], for a `DuoServo` only.

    Returns
    -------
    InternalForces
        Complete result; arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If neither torque nor friction is given, a value is out of bounds, or a torque is demanded of
        a lining whose friction is at or past self-locking.

    References
    ----------
    Yoo et al. (1997), section 4, eqs. (27) to (36), corrected.

    Examples
    --------
    >>> brake = forklift.BENDIX_12_5
    >>> forces = forklift.internal_forces(brake, torque=11000.0, piston_force=11650.0, clearance=0.0106)
    >>> round(float(forces.Q), -2)  # N; Yoo et al. (1997): 34800
    34800.0
    """
    if torque is None and friction is None:
        raise ValueError("give torque, or friction, or both to compare them")
    if not isinstance(geometry, HasLevers):
        raise InvalidValue("geometry", geometry, "give a DuoServo or Levers")
    levers, lever_error = geometry.levers_and_error(clearance)
    P_T = positive("piston_force", piston_force, "N")
    T = None if torque is None else positive("torque", torque, "N m")
    mu = None if friction is None else positive("friction", friction)
    shapes = {"piston_force": P_T, "torque": T, "friction": mu, "levers": levers.phi1 * levers.a1 * levers.b2}
    together(**{name: value for name, value in shapes.items() if value is not None})
    rounding = 4 * ROUNDING + lever_error
    if T is None:
        return _solve_from_friction(levers, P_T, mu, rounding)
    if mu is not None:
        bound, past = "the brake locks: no torque can be demanded of it", _locks(levers, mu, rounding)
        refuse(past, "friction", mu, "", bound, "leave out the torque to see that it locks")
    return _solve_from_torque(levers, P_T, T, mu, rounding)


def _locks(levers: Levers, mu: Numbers, rounding: Numbers) -> np.ndarray:
    """Return whether the friction is at self-locking (within rounding) or past it."""
    s = levers.drum_radius * np.asarray(mu) / np.hypot(1.0, mu)
    margin = 1 - s / np.minimum(levers.a1, levers.b2)  # margin to self-locking of the shoe that locks first
    return margin <= np.maximum(LEAST_MARGIN / (1 + np.square(mu)), rounding)


def _solve_from_torque(
    levers: Levers, P_T: Numbers, T: Numbers, mu: Numbers | None, rounding: Numbers
) -> InternalForces:
    shape = np.broadcast_shapes(*(np.shape(x) for x in (P_T, T, *vars(levers).values())))
    u = _solve_trailing_share(levers, np.broadcast_to(P_T, shape), np.broadcast_to(T, shape))
    Q, P_L, R_L, R_T = _forces_at_share(levers, P_T, T, u)
    r = levers.drum_radius
    B, D = T * (1 - u) / r, T * u / r
    most = 1 - LEAST_MARGIN  # largest ratio of friction to resultant force; at 1, mu is infinite
    balanced = (most * R_L > B) & (most * R_T > D)
    status = np.where(balanced, "equilibrium", "no solution")
    with np.errstate(invalid="ignore"):
        A, C = np.sqrt((R_L - B) * (R_L + B)), np.sqrt((R_T - D) * (R_T + D))
        slope = _share_equation(levers, P_T, T, u)[1]
        shares = rounding * (1 + 2 * R_L / ((1 - u) * slope))
        error = shares * (3 + 2 * (B / A) ** 2)
    return _assemble_result(levers, P_T, np.broadcast_to(T, shape), (A, B, C, D, Q, P_L), status, mu, error)


def _forces_at_share(levers: Levers, P_T: Numbers, T: Numbers, u: np.ndarray) -> tuple[np.ndarray, ...]:
    """Compute the forces Q, P_L, R_L, R_T [N] (see module) from the trailing shoe's share u of the torque."""
    Q = (P_T * levers.a2 + T * u) / levers.b2
    P_L = (T * (1 - u) + Q * levers.b1) / levers.a1
    return Q, P_L, _resultant(P_L, Q, levers.phi1), _resultant(P_T, Q, levers.phi2)


def _resultant(P: Numbers, Q: Numbers, phi: Numbers) -> np.ndarray:
    """Compute the magnitude [N] of the sum of two forces with the angle phi [rad] between them."""
    return np.hypot(P + Q * np.cos(phi), Q * np.sin(phi))


def _solve_trailing_share(levers: Levers, P_T: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Solve f(u) = 0 for the trailing shoe's share of the torque by Newton's method, or else bisection."""
    low, high = np.zeros(T.shape), np.ones(T.shape)
    u = np.full(T.shape, 0.4)
    for _ in range(_STEPS):
        f, slope = _share_equation(levers, P_T, T, u)
        low, high = np.where(f < 0, u, low), np.where(f < 0, high, u)
        with np.errstate(divide="ignore", invalid="ignore"):
            new = u - f / slope
        new = np.where((new > low) & (new < high), new, (low + high) / 2)
        change, u = np.abs(new - u), new
        if (change <= 4e-16 * u).all():
            break
    return u


def _share_equation(
    levers: Levers, P_T: np.ndarray, T: np.ndarray, u: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compute f(u) of the module's docstring [N], and its derivative with respect to u [N]."""
    Q, P_L, R_L, R_T = _forces_at_share(levers, P_T, T, u)
    dQ = T / levers.b2
    dP = (dQ * levers.b1 - T) / levers.a1
    dR_L = (P_L * dP + Q * dQ + (P_L * dQ + Q * dP) * np.cos(levers.phi1)) / R_L
    dR_T = (Q + P_T * np.cos(levers.phi2)) * dQ / R_T
    return u * R_L - (1 - u) * R_T, R_L + u * dR_L + R_T - (1 - u) * dR_T


def _solve_from_friction(levers: Levers, P_T: Numbers, mu: Numbers, rounding: Numbers) -> InternalForces:
    r, mu = levers.drum_radius, np.asarray(mu)
    sigma = mu / np.hypot(1.0, mu)
    locked = _locks(levers, mu, rounding)
    s = np.where(locked, np.nan, r * sigma)
    Q = _force_across_shoe(P_T, levers.a2, levers.b2, levers.phi2, s)
    P_L = _force_across_shoe(Q, levers.b1, levers.a1, levers.phi1, s)
    R_L, R_T = _resultant(P_L, Q, levers.phi1), _resultant(P_T, Q, levers.phi2)
    cosine = 1 / np.hypot(1.0, mu)
    forces = (cosine * R_L, sigma * R_L, cosine * R_T, sigma * R_T, Q, P_L)
    status = np.broadcast_to(np.where(locked, "locked", "equilibrium"), np.shape(R_L))
    # The relative error of dC*/dmu is the largest: twice the error of the shoes' forces.
    error = rounding * (1 + 2 * (levers.b2 / (levers.b2 - s) + levers.a1 / (levers.a1 - s)))
    return _assemble_result(levers, P_T, r * sigma * (R_L + R_T), forces, status, None, error)


def _force_across_shoe(P: Numbers, a: Numbers, b: Numbers, phi: Numbers, s: Numbers) -> np.ndarray:
    """Solve X b - P a = s |P + X| for the force X [N] at a shoe's other end, at the angle phi from P.

    As in the module, s = r mu / sqrt(1 + mu^2) [m] for the friction mu and the drum's radius r.
    """
    half = a * b + s**2 * np.cos(phi)
    root = s * np.sqrt(a**2 + b**2 + 2 * a * b * np.cos(phi) - (s * np.sin(phi)) ** 2)
    return P * (half + root) / (b**2 - s**2)


def _assemble_result(
    levers: Levers,
    P_T: Numbers,
    T: np.ndarray,
    forces: tuple,
    status: np.ndarray,
    mu: Numbers | None,
    error: np.ndarray,
) -> InternalForces:
    valid = status == "equilibrium"
    A, B, C, D, Q, P_L = (np.where(valid, force, np.nan) for force in forces)
    P, Q_on = _vector(levers.alpha1, -1, P_L), _vector(levers.gamma, 1, Q)
    P_trailing = -_vector(levers.alpha2, 1, P_T * np.ones(T.shape))
    A_vector, B_vector = _split(-(P + Q_on), A, B)
    C_vector, D_vector = _split(-(P_trailing - Q_on), C, D)
    unknowns = np.concatenate([A_vector, B_vector, C_vector, D_vector], axis=-1)
    x = np.concatenate([np.moveaxis(unknowns, -1, 0), [Q, P_L]])
    unit = np.fmax(T / levers.drum_radius, P_T)
    scaled = equilibrium_equations(levers.in_radii, T / unit / levers.drum_radius, P_T / unit, x / unit)
    residual = np.max(np.abs(scaled), axis=0)
    friction, limit = B / A, levers.locking_friction
    return InternalForces(
        levers=levers,
        torque=T[()],
        piston_force=P_T,
        A=A[()],
        B=B[()],
        C=C[()],
        D=D[()],
        Q=Q[()],
        P_L=P_L[()],
        A_vector=A_vector,
        B_vector=B_vector,
        C_vector=C_vector,
        D_vector=D_vector,
        bolt_force=-(P + P_trailing),
        lining_friction=friction[()],
        locking_friction=limit,
        margin=(1 - friction / limit)[()],
        c_star=(np.where(valid, T, np.nan) / (P_T * levers.drum_radius))[()],
        c_star_slope=_c_star_slope(levers, P_T, friction, P_L, Q)[()],
        leading_share=(B / (B + D))[()],
        trailing_share=(D / (B + D))[()],
        residual=residual[()],
        error=np.where(valid, error, np.nan)[()],
        status=status[()],
        warnings=tuple(_warnings(levers, friction, mu)),
    )


def equilibrium_equations(
    levers: Levers, torque: Numbers, piston_force: Numbers, unknowns: np.ndarray
) -> np.ndarray:
    """Evaluate the left-hand sides of the ten equations of equilibrium, (27)-(36) of the paper.

    Parameters
    ----------
    levers : Levers
        Lever arms and directions; `Levers.in_radii` makes the drum's radius the unit of length.
    torque, piston_force : float or ndarray
        Torque T [N m] and piston force P_T [N]; or both in other units that agree with levers and unknowns.
    unknowns : ndarray, shape (10, ...)
        The unknown forces Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L [N].

    Returns
    -------
    ndarray, shape (10, ...)
        Residuals in the paper's order: forces and moment of the leading, then of the trailing shoe; A normal
        to B, C to D; equal friction A D = B C; torque of the drum. They are zero at a solution.

    References
    ----------
    Yoo et al. (1997), eqs. (27) to (36), corrected.

    Examples
    --------
    >>> brake = forklift.BENDIX_12_5
    >>> forces = forklift.internal_forces(brake, torque=11e3, piston_force=11650.0, clearance=0.0106)
    >>> pins = (forces.A_vector, forces.B_vector, forces.C_vector, forces.D_vector)
    >>> unknowns = np.array([*np.concatenate(pins), forces.Q, forces.P_L])
    >>> left = forklift.equilibrium_equations(forces.levers, 11e3, 11650.0, unknowns)
    >>> bool((abs(left) < 1e-6).all())  # residuals [N, N m]: in balance
    True
    """
    r, alpha1, alpha2, gamma = levers.drum_radius, levers.alpha1, levers.alpha2, levers.gamma
    Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L = unknowns
    A, B, C, D = np.hypot(Ax, Ay), np.hypot(Bx, By), np.hypot(Cx, Cy), np.hypot(Dx, Dy)
    return np.stack(
        np.broadcast_arrays(
            Ax + Bx + P_L * np.cos(alpha1) + Q * np.cos(gamma),
            Ay + By - P_L * np.sin(alpha1) + Q * np.sin(gamma),
            B * r + Q * levers.b1 - P_L * levers.a1,
            Cx + Dx - piston_force * np.cos(alpha2) - Q * np.cos(gamma),
            Cy + Dy - piston_force * np.sin(alpha2) - Q * np.sin(gamma),
            D * r + piston_force * levers.a2 - Q * levers.b2,
            Ax * Bx + Ay * By,
            Cx * Dx + Cy * Dy,
            A * D - B * C,
            (B + D) * r - torque,
        )
    )


def _c_star_slope(levers: Levers, P_T: Numbers, mu: np.ndarray, P_L: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """Compute the derivative of the brake factor C* with respect to friction.

    It differentiates Q b2 - P_T a2 = s R_T and P_L a1 - Q b1 = s R_L by s, symbols as in this module.
    """
    r, root = levers.drum_radius, np.hypot(1.0, mu)
    s, cos1, cos2 = r * mu / root, np.cos(levers.phi1), np.cos(levers.phi2)
    R_L, R_T = _resultant(P_L, Q, levers.phi1), _resultant(P_T, Q, levers.phi2)
    dQ = R_T / (levers.b2 - s * (Q + P_T * cos2) / R_T)
    dP_L = (R_L + (levers.b1 + s * (Q + P_L * cos1) / R_L) * dQ) / (levers.a1 - s * (P_L + Q * cos1) / R_L)
    dT = levers.a1 * dP_L + (levers.b2 - levers.b1) * dQ
    return dT / (P_T * root**3)  # uses ds/dmu = r / root^3 and C* = T / (P_T r)


def _vector(angle: Numbers, sign: int, size: np.ndarray) -> np.ndarray:
    """Make vectors of magnitude `size` at an angle [rad] above (sign 1) or below (sign -1) the horizontal."""
    return np.stack(np.broadcast_arrays(size * np.cos(angle), sign * size * np.sin(angle)), axis=-1)


def _split(total: np.ndarray, normal: np.ndarray, friction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Split a force into normal and friction vectors of given magnitudes; the drum turns anticlockwise."""
    across = np.stack([-total[..., 1], total[..., 0]], axis=-1)
    n, f, square = normal[..., None], friction[..., None], np.sum(total**2, axis=-1)[..., None]
    return (n**2 * total + n * f * across) / square, (f**2 * total - n * f * across) / square


def _warnings(levers: Levers, friction: np.ndarray, lining: Numbers | None) -> list[str]:
    sentences = []
    apart = np.max(np.abs(np.asarray(levers.b1) / levers.b2 - 1))
    if apart > _ARMS_DIFFER:
        sentences.append(f"b1 and b2 differ by up to {apart:.3g}: Q has one line of action; give b1 = b2")
    if lining is not None:
        ratio = np.asarray(friction / lining)
        worst = ratio.flat[np.nanargmax(np.abs(ratio - 1))] if np.isfinite(ratio).any() else 1.0
        if abs(worst - 1) > _FRICTION_DIFFERS:
            sentences.append(
                f"the given torque needs {worst:.3g} times the lining's friction: the forces are not those "
                "of this lining; for those, leave out the torque, or the stop that gives it"
            )
    return sentences
