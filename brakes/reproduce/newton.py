"""The method of Yoo et al. 1997, for comparison: Newton-Raphson iteration on the ten equations (27)-(36).

The result depends on the start: from most random starts the iteration diverges, or converges to one of the
three mirror images of the solution. They satisfy the equations as well, with A x B or C x D of the wrong
sign, or both; B and D enter the moments by their magnitudes, so that Q and P_L are positive in all four
solutions.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import positive
from beamdyn.common.results.one_line import counted, number
from beamdyn.common.results.result import Result
from brakes.forklift import Levers, equilibrium_equations

_TOLERANCE = 1e-12  # tolerance of the largest residual of the equations, in units of T/r and r
_DIVERGED = 1e30  # residual, in units of T/r and r, above which the iteration counts as diverged
SCALED_START = (-1.5, 0.1, 0.1, 0.7, 0.6, 0.1, 0.05, -0.3, 0.5, 1.4)


@dataclass(frozen=True)
class NewtonResult(Result):
    """Result of a Newton-Raphson iteration.

    Attributes
    ----------
    unknowns : ndarray, shape (10,)
        The unknown forces Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L [N].
    converged : bool
        Whether the residual is below the tolerance.
    physical : bool
        Whether it converged to friction along the drum's motion, not to a mirror image.
    iterations : int
        Number of steps.
    residual : float
        Largest residual of the equations, in units of T/r and r.
    condition_number : float
        Condition number of the Jacobian at the last step, in the units of the iteration.
    """

    field_units: ClassVar[dict[str, str]] = {"N": "unknowns"}

    unknowns: np.ndarray
    converged: bool
    physical: bool
    iterations: int
    residual: float
    condition_number: float

    def headline(self) -> Iterator[str]:
        """Yield the number of steps with the residual, and the outcome; see `Result.headline`."""
        yield f"{counted(self.iterations, 'step')}, residual {number(self.residual)}"
        yield self.message

    @property
    def message(self) -> str:
        """One sentence that describes the outcome of the iteration."""
        if not self.converged:
            return f"no convergence within {self.iterations} steps: try another start, or the reduction"
        mirrored = "" if self.physical else " to a mirror image: friction against the drum's motion"
        return f"converged{mirrored}"


def _jacobian(levers: Levers, x: np.ndarray) -> np.ndarray:
    """Compute the derivatives of `equilibrium_equations` with respect to the unknowns, shape (10, 10)."""
    r, a1, b1, b2 = levers.drum_radius, levers.a1, levers.b1, levers.b2
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
) -> NewtonResult:
    """Solve the ten equilibrium equations of a single case by Newton-Raphson iteration.

    Parameters
    ----------
    levers : Levers
        Lever arms and directions of the forces.
    torque, piston_force : float
        Torque T [N m] and piston force P_T [N].
    start : ndarray, shape (10,), optional
        Initial unknowns in units of T/r; by default a start that works for the paper's brake.
    damped : bool
        Whether each step is halved until the residual decreases.
    scaled : bool
        Whether forces are divided by T/r and lengths by r; in SI units the Jacobian is ill-conditioned.
    steps : int
        Largest number of steps of the iteration.

    Returns
    -------
    NewtonResult
        Result of the iteration.

    Raises
    ------
    ValueError
        If torque or piston force is not positive.
    """
    T, P_T = positive("torque", torque, "N m"), positive("piston_force", piston_force, "N")
    unit = T / levers.drum_radius
    in_radii = levers.in_radii
    force, used = (unit, in_radii) if scaled else (1.0, levers)

    def equations(x: np.ndarray) -> np.ndarray:
        return equilibrium_equations(used, unit / force * used.drum_radius, P_T / force, x)

    def residual(x: np.ndarray) -> float:
        in_units = equilibrium_equations(in_radii, 1.0, P_T / unit, x * force / unit)
        return float(np.max(np.abs(in_units)))

    x = np.array(SCALED_START if start is None else start, dtype=float) * unit / force
    k, size = 0, residual(x)
    with np.errstate(all="ignore"):
        while k < steps and _TOLERANCE < size < _DIVERGED:
            try:
                step = np.linalg.solve(_jacobian(used, x), -equations(x))
            except np.linalg.LinAlgError:
                break
            if not np.isfinite(step).all():
                break
            cut = 1.0
            while damped and cut > 1e-6 and not residual(x + cut * step) < size:
                cut /= 2
            x, k = x + cut * step, k + 1
            size = residual(x)
        jacobian, forces = _jacobian(used, x), x * force
    Ax, Ay, Bx, By, Cx, Cy, Dx, Dy = forces[:8]
    converged = bool(size <= _TOLERANCE)
    return NewtonResult(
        unknowns=forces,
        converged=converged,
        physical=bool(converged and Ax * By - Ay * Bx < 0 and Cx * Dy - Cy * Dx < 0),
        iterations=k,
        residual=size,
        condition_number=float(np.linalg.cond(jacobian)) if np.isfinite(jacobian).all() else np.inf,
    )
