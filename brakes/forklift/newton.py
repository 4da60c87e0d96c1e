"""The paper's own way: Newton-Raphson on the ten equations (27)-(36), kept for comparison.

It depends on its start: most random ones diverge, or end in one of the three mirror images of the solution
that the equations admit as well (A x B or C x D of the wrong sign, or both; B and D enter the moments by
their sizes, so that Q and P_L are positive in all four).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.common.array_checks import Numbers, positive
from beamdyn.common.results import Result
from brakes.forklift.levers import Levers

_DIVERGED = 1e30  # scaled residual past which an iteration is given up
SCALED_START = (-1.5, 0.1, 0.1, 0.7, 0.6, 0.1, 0.05, -0.3, 0.5, 1.4)


@dataclass(frozen=True)
class NewtonResult(Result):
    """End of an iteration.

    Attributes
    ----------
    unknowns : ndarray, shape (10,)
        Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L [N].
    converged : bool
        Whether the residual is below the tolerance.
    physical : bool
        Converged, with the friction along the drum's motion: no mirror image.
    iterations : int
        Steps taken.
    residual : float
        Largest left-hand side, in units of T/r and r.
    condition_number : float
        Of the Jacobian at the end, in the units of the iteration.
    """

    unknowns: np.ndarray
    converged: bool
    physical: bool
    iterations: int
    residual: float
    condition_number: float

    @property
    def message(self) -> str:
        """How it ended, in one sentence."""
        if not self.converged:
            return f"no convergence within {self.iterations} steps: try another start, or the reduction"
        return (
            "converged"
            if self.physical
            else "converged to a mirror image: friction against the drum's motion"
        )


def ten_equations(
    levers: Levers, torque: Numbers, piston_force: Numbers, x: np.ndarray, unit: Numbers
) -> np.ndarray:
    """Left-hand sides of (27)-(36), in forces over a unit and lengths over r.

    Parameters
    ----------
    levers : Levers
        Arms and directions.
    torque, piston_force : float or ndarray
        T [N m] and P_T [N].
    x : ndarray, shape (10, ...)
        Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L [N].
    unit : float or ndarray
        Unit of force [N], such as T/r.

    Returns
    -------
    ndarray, shape (10, ...)
        In the paper's order; zero at a solution.
    """
    r = levers.drum_radius
    a1, a2, b1, b2 = (arm / r for arm in (levers.a1, levers.a2, levers.b1, levers.b2))
    return _equations(levers, (a1, a2, b1, b2), 1.0, torque / unit / r, piston_force / unit, x / unit)


def _equations(
    levers: Levers, arms: tuple[Numbers, ...], r: float, T: Numbers, P_T: Numbers, x: np.ndarray
) -> np.ndarray:
    (a1, a2, b1, b2), (Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L) = arms, x
    A, B, C, D = np.hypot(Ax, Ay), np.hypot(Bx, By), np.hypot(Cx, Cy), np.hypot(Dx, Dy)
    alpha1, alpha2, gamma = levers.alpha1, levers.alpha2, levers.gamma
    return np.stack(
        np.broadcast_arrays(
            Ax + Bx + P_L * np.cos(alpha1) + Q * np.cos(gamma),
            Ay + By - P_L * np.sin(alpha1) + Q * np.sin(gamma),
            B * r + Q * b1 - P_L * a1,
            Cx + Dx - P_T * np.cos(alpha2) - Q * np.cos(gamma),
            Cy + Dy - P_T * np.sin(alpha2) - Q * np.sin(gamma),
            D * r + P_T * a2 - Q * b2,
            Ax * Bx + Ay * By,
            Cx * Dx + Cy * Dy,
            A * D - B * C,
            (B + D) * r - T,
        )
    )


def _jacobian(levers: Levers, arms: tuple[float, ...], r: float, x: np.ndarray) -> np.ndarray:
    a1, _, b1, b2 = arms
    vectors = x[:8].reshape(4, 2)
    A, B, C, D = sizes = np.hypot(*vectors.T)
    eA, eB, eC, eD = vectors / sizes[:, None]
    c, s = np.cos(levers.gamma), np.sin(levers.gamma)
    J = np.zeros((10, 10))
    J[0, [0, 2, 8, 9]] = 1, 1, c, np.cos(levers.alpha1)
    J[1, [1, 3, 8, 9]] = 1, 1, s, -np.sin(levers.alpha1)
    J[2, [2, 3, 8, 9]] = *(r * eB), b1, -a1
    J[3, [4, 6, 8]] = 1, 1, -c
    J[4, [5, 7, 8]] = 1, 1, -s
    J[5, [6, 7, 8]] = *(r * eD), -b2
    J[6, :4] = *vectors[1], *vectors[0]
    J[7, 4:8] = *vectors[3], *vectors[2]
    J[8, :8] = *(D * eA), *(-C * eB), *(-B * eC), *(A * eD)
    J[9, [2, 3, 6, 7]] = *(r * eB), *(r * eD)
    return J


def newton_raphson(
    levers: Levers,
    *,
    torque: float,
    piston_force: float,
    start: np.ndarray | None = None,
    damped: bool = False,
    scaled: bool = True,
    steps: int = 50,
    tolerance: float = 1e-12,
) -> NewtonResult:
    """Newton-Raphson on the ten equations, of one case.

    Parameters
    ----------
    levers : Levers
        Arms and directions.
    torque, piston_force : float
        T [N m] and P_T [N].
    start : ndarray, shape (10,), optional
        In units of T/r; one that works for the paper's brake unless given.
    damped : bool
        Whether a step is halved until the residual falls.
    scaled : bool
        Whether forces are over T/r and lengths over r; in SI units the Jacobian is ill-conditioned.
    steps : int
        Most steps.
    tolerance : float
        On the largest scaled left-hand side.

    Returns
    -------
    NewtonResult
        Where it ended.

    Raises
    ------
    ValueError
        If torque or piston force is not positive.
    """
    T, P_T, r = (
        positive("torque", torque, "N m"),
        positive("piston_force", piston_force, "N"),
        levers.drum_radius,
    )
    force, length = (T / r, r) if scaled else (1.0, 1.0)
    arms = tuple(arm / length for arm in (levers.a1, levers.a2, levers.b1, levers.b2))
    problem = (arms, r / length, T / force / length, P_T / force)
    x = np.array(SCALED_START if start is None else start, dtype=float) * (T / r) / force

    def residual(x: np.ndarray) -> float:
        return float(np.max(np.abs(ten_equations(levers, T, P_T, x * force, T / r))))

    k, size = 0, residual(x)
    with np.errstate(all="ignore"):
        while k < steps and tolerance < size < _DIVERGED:
            step = _step(levers, problem, x)
            if step is None:
                break
            cut = 1.0
            while damped and cut > 1e-6 and not residual(x + cut * step) < size:
                cut /= 2
            x, k = x + cut * step, k + 1
            size = residual(x)
    return _ended(levers, problem, x, force, k, size, tolerance)


def _step(levers: Levers, problem: tuple, x: np.ndarray) -> np.ndarray | None:
    arms, r, T, P_T = problem
    try:
        step = np.linalg.solve(_jacobian(levers, arms, r, x), -_equations(levers, arms, r, T, P_T, x))
    except np.linalg.LinAlgError:
        return None
    return step if np.isfinite(step).all() else None


def _ended(
    levers: Levers, problem: tuple, x: np.ndarray, force: float, k: int, size: float, tolerance: float
) -> NewtonResult:
    Ax, Ay, Bx, By, Cx, Cy, Dx, Dy = x[:8]
    with np.errstate(all="ignore"):
        along = Ax * By - Ay * Bx < 0 and Cx * Dy - Cy * Dx < 0
        jacobian = _jacobian(levers, problem[0], problem[1], x)
    usable = np.isfinite(jacobian).all()
    return NewtonResult(
        unknowns=x * force,
        converged=bool(size <= tolerance),
        physical=bool(size <= tolerance and along),
        iterations=k,
        residual=size,
        condition_number=float(np.linalg.cond(jacobian)) if usable else np.inf,
    )
