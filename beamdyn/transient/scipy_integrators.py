"""Time integration by `scipy.integrate.solve_ivp`, and Gauss collocation with error control as its method.

This is a module of its own because importing `scipy.integrate` takes longer than many simulations.

In shapes of arrays, n counts coordinates, and k times.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import DenseOutput, OdeSolver, solve_ivp

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.transient.beam_in_space_system import AnySystem, BeamInSpaceSystem
from beamdyn.transient.gauss import LinearSystem, Segment, StepMaps, step_maps, tableau
from beamdyn.transient.integration import integrate
from beamdyn.transient.trajectory import SAMPLES

_KNOWN_METHODS = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
_JACOBIAN_METHODS = ("Radau", "BDF", "LSODA")
_SCALING_TOLERANCE = 1e-2  # tolerance of the preliminary run that finds the magnitude of each coordinate


@dataclass(frozen=True)
class SolveIvpPath:
    """Motion computed by `solve_ivp`, with the interface of a `Path`.

    Parameters
    ----------
    solution : OdeSolution
        Dense output.
    times : ndarray
        Sampled times [s].
    """

    solution: Any
    times: np.ndarray

    @property
    def start(self) -> float:
        """Time at the beginning of the computed motion [s]."""
        return float(self.times[0])

    @property
    def end(self) -> float:
        """Time at the end of the computed motion [s]."""
        return float(self.times[-1])

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times [s], coordinates and velocities (times, coordinates); several in each step."""
        return self.times, *self.at(self.times)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Evaluate coordinates and velocities at times t [s]: shapes (len(t), n)."""
        q, v = np.split(self.solution(t), 2)
        return q.T, v.T


def check_method(method: object) -> None:
    """Raise an error for an integration method that `solve_ivp` does not know."""
    named = isinstance(method, str) and method in _KNOWN_METHODS
    if not named and not (isinstance(method, type) and issubclass(method, OdeSolver)):
        known = ", ".join(map(repr, _KNOWN_METHODS))
        raise InvalidValue("method", method, f"give 'auto', {known} or a class derived from OdeSolver")


def integrate_by_solve_ivp(
    system: AnySystem,
    y0: np.ndarray,
    t_end: float,
    method: str | type[OdeSolver],
    tolerance: float,
    options: dict[str, Any],
) -> SolveIvpPath:
    """Integrate by a method of `solve_ivp`.

    Parameters
    ----------
    system : AnySystem
        The equations.
    y0 : ndarray, shape (2 n,)
        Coordinates and velocities at time 0.
    t_end : float
        End of the run [s].
    method : str or OdeSolver
        The method, by name or class.
    tolerance : float
        Default of rtol; a tenth of it, times each coordinate's largest magnitude, is the default of atol.
    options : dict
        Further options of `solve_ivp` and of the method.

    Returns
    -------
    SolveIvpPath

    Raises
    ------
    ArithmeticError
        If `solve_ivp` fails.
    """
    coarse, _, _ = integrate(system, y0, t_end, _SCALING_TOLERANCE)
    sizes = np.concatenate([np.abs(x).max(axis=0) for x in coarse.samples[1:]])
    options = {"rtol": tolerance, "atol": 0.1 * tolerance * sizes + 1e-300, **options}
    if isinstance(method, type) and issubclass(method, GaussCollocation):
        if isinstance(system, BeamInSpaceSystem):
            bound = "it integrates linear equations only, and large_deflection makes them nonlinear"
            raise InvalidValue("method", method.__name__, bound, "give 'auto'")
        options = {"system": system, **options}
    elif method in _JACOBIAN_METHODS:
        options = {"jac": system.jacobian, **options}
    chosen: Any = method  # `check_method` has accepted it, so its type is not checked again
    result: Any = solve_ivp(system.rhs, (0.0, t_end), y0, method=chosen, dense_output=True, **options)
    if not result.success:
        raise ArithmeticError(f"solve_ivp stopped at t = {result.t[-1]:g} s: {result.message}")
    steps = [np.linspace(a, b, SAMPLES + 1)[:-1] for a, b in pairwise(result.t)]
    return SolveIvpPath(result.sol, np.concatenate([*steps, [t_end]]))


# Gauss collocation ---------------------------------------------------------------------------------


class GaussCollocation(OdeSolver):
    """Gauss collocation for `solve_ivp`: with dense output, events, `t_eval` and error control.

    ``solve_ivp(system.rhs, (t0, t1), y0, method=GaussCollocation, system=system)`` integrates
    y = (q, q') of a `LinearSystem`, passed as the option `system`, which must evaluate C(t),
    K(t) and f(t) at arrays of times.  The right-hand side is used by `solve_ivp` only.

    Parameters
    ----------
    system : LinearSystem
        The equations.
    stages : int
        Stages s; the order is 2 s.
    rtol, atol : float
        Bounds of the local error, relative and absolute [units of y], which is estimated with two more
        stages in the first and the last step of each block.
    first_step, max_step : float
        Step size of the first block, and largest step size [s].
    block : int
        Number of equal steps solved as one batch.

    Raises
    ------
    ValueError
        If the end lies before the beginning.

    References
    ----------
    Hairer, Lubich and Wanner (2006), Geometric Numerical Integration, sections II.1.3 and IV.2.1.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), bd.SpinUp(55.0, duration=0.5))
    >>> run = bd.simulate(scene, t_end=0.5, modes=2, method=bd.GaussCollocation)
    >>> float(run.t[-1])  # s
    0.5
    """

    def __init__(
        self,
        fun: Any,
        t0: float,
        y0: np.ndarray,
        t_bound: float,
        vectorized: bool = False,
        *,
        system: LinearSystem,
        stages: int = 8,
        rtol: float = 1e-6,
        atol: float = 1e-9,
        first_step: float | None = None,
        max_step: float = np.inf,
        block: int = 16,
    ) -> None:
        super().__init__(fun, t0, y0, t_bound, vectorized)
        if t_bound < t0:
            raise ValueError(f"t_span = ({t0:g}, {t_bound:g}): GaussCollocation integrates forward only")
        self.system, self.stages, self.block = system, stages, block
        self.rtol, self.atol, self.max_step = rtol, atol, max_step
        self.h = min(max_step, first_step or self._first_step(t0, t_bound))
        self.solved_steps: list[tuple[float, np.ndarray, np.ndarray]] = []

    def _first_step(self, t0: float, t_bound: float) -> float:
        """Choose the step size [s] in which the fastest mode advances by 1 rad, but at most half the run."""
        _, K, _ = self.system.coefficients(np.array([t0]))
        fastest = np.sqrt(np.abs(np.linalg.eigvals(K[0])).max())
        return min(1 / fastest if fastest else np.inf, (t_bound - t0) / 2)

    def _step_impl(self) -> tuple[bool, str | None]:
        if not self.solved_steps:
            self._solve_block()
        self.start, self.start_state = self.t, self.augmented()
        end, step, acceleration = self.solved_steps.pop(0)
        self.accelerations = acceleration @ self.start_state
        self.y = step @ self.start_state
        self.h_last, self.t = end - self.t, end
        return True, None

    def augmented(self) -> np.ndarray:
        """Return the augmented state (1, coordinates, velocities) at the current time."""
        return np.concatenate([[1.0], self.y])

    def _solve_block(self) -> None:
        """Solve the next block of steps, with a step size from the local error, at most 4 times the last."""
        order = 2 * self.stages + 1
        while True:
            remaining = self.t_bound - self.t
            count = min(self.block, max(1, int(np.ceil(remaining / self.h * (1 - 1e-12)))))
            h = min(self.h, remaining / count) if count < self.block else self.h
            starts = self.t + h * np.arange(count)
            maps = step_maps(self.system, starts, h, tableau(self.stages))
            error = self._local_error(maps, starts, h)
            self.h = min(self.max_step, h * min(4.0, max(0.1, 0.9 * (error + 1e-30) ** (-1 / order))))
            if error <= 1:
                break
        ends = [*starts[1:], self.t_bound if h * count >= remaining * (1 - 1e-12) else starts[-1] + h]
        self.solved_steps = list(zip(ends, maps.step, maps.acceleration, strict=True))

    def _local_error(self, maps: StepMaps, starts: np.ndarray, h: float) -> float:
        """Compute the largest ratio of the local error to its bound in the first and last step of a block."""
        y = self.augmented()
        first = y
        for step in maps.step[:-1]:
            y = np.concatenate([[1.0], step @ y])
        finer = step_maps(self.system, starts[[0, -1]], h, tableau(self.stages + 2)).step
        coarse_end = np.array([maps.step[0] @ first, maps.step[-1] @ y])
        finer_end = np.array([finer[0] @ first, finer[-1] @ y])
        scale = self.atol + self.rtol * np.maximum(np.abs(coarse_end), np.abs(finer_end))
        return float(np.sqrt(np.mean(((coarse_end - finer_end) / scale) ** 2, axis=1)).max())

    def _dense_output_impl(self) -> DenseOutput:
        state = np.stack([self.start_state, self.augmented()])
        return _StepPolynomial(Segment(self.start, self.h_last, state, self.accelerations[None]))


class _StepPolynomial(DenseOutput):
    """Collocation polynomial of one step, used as dense output of `solve_ivp`."""

    def __init__(self, segment: Segment) -> None:
        super().__init__(segment.start, segment.end)
        self.segment = segment

    def _call_impl(self, t: np.ndarray) -> np.ndarray:
        y = np.concatenate(self.segment.at(np.atleast_1d(t)), axis=1).T
        return y[:, 0] if np.ndim(t) == 0 else y
