"""Cases of a sweep: the request, and the solution of one chunk of cases, each with its own steps."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.pickling import FieldsOnly
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.modal_basis import FEWEST_MODES, ModalBasis, find_speed_range
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.transient.integration import integrate
from beamdyn.transient.problem import choose_for_basis
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import Trajectory, largest_in_each, largest_on, magnitude
from beamdyn.transient.transient import TransientRequest

DONE = "done"


@dataclass(frozen=True)
class SweepRequest(FieldsOnly):
    """Checked arguments of `sweep` on which each case depends.

    The basis is that of all cases, of modes at rest or at the slowest and the fastest speed of all.  Where
    `modes_at` gives the numbers of modes that some speeds [rad/s] need, ascending, each case takes the larger
    one of its neighbours there.
    """

    scene: Scene
    window: tuple[float, float]
    t_end: float
    tolerance: float
    discretization: DiscretizationChoice
    basis: ModalBasis = field(default=ModalBasis(FEWEST_MODES))
    modes_at: tuple[tuple[float, int], ...] = ()

    def transient_request(self, speed: float) -> TransientRequest:
        """Request of the transient of the case with a final speed [rad/s]."""
        scene, method, rest = replace(self.scene, motion=self.motion(speed)), "auto", "rest"
        basis = self.basis_at(speed)
        return TransientRequest(
            scene, self.t_end, self.tolerance, method, self.discretization, rest, None, {}, basis
        )

    def basis_at(self, speed: float) -> ModalBasis:
        """Modal basis of one case, with as many modes as it needs, at its own slowest and fastest speed."""
        basis = replace(self.basis, modes=self._modes_near(speed)) if self.modes_at else self.basis
        at_rest = basis.is_at_rest
        return basis if at_rest else replace(basis, speeds=find_speed_range(self.motion(speed), self.t_end))

    def _modes_near(self, speed: float) -> int:
        speeds, modes = zip(*self.modes_at, strict=True)
        after = bisect_right(speeds, speed)
        return max(modes[max(after - 1, 0) : after + 1])

    @property
    def directions(self) -> int:
        """Number of directions in which the beam bends."""
        return self.scene.physics.planes

    def motion(self, speed: float) -> Motion:
        """Motion at a final speed [rad/s]."""
        assert self.scene.motion is not None
        return self.scene.motion.with_speed(speed)

    @cached_property
    def model(self) -> Model:
        """The discretized scene, chosen for the modal basis and the tolerance."""
        return choose_for_basis(self.scene, self.discretization, self.basis, self.tolerance)

    @property
    def basis_name(self) -> str:
        """The modal bases of all cases, in words."""
        if self.basis.is_at_rest:
            return str(self.basis)
        fewest = min((modes for _, modes in self.modes_at), default=self.basis.modes)
        modes = f"{self.basis.modes}" if fewest == self.basis.modes else f"{fewest} to {self.basis.modes}"
        speeds = " to ".join(f"{speed:.4g}" for speed in self.basis.speeds)
        return f"{modes} modes at the slowest and at the fastest speed of each case ({speeds} rad/s)"

    @cached_property
    def _shared_equations(self) -> Equations:
        """The equations of motion in the basis of all cases."""
        return self.model.modal_equations(self.basis)

    def modal_equations(self, speed: float) -> Equations:
        """The equations of motion of one case in its modal basis."""
        basis = self.basis_at(speed)
        return self._shared_equations if basis == self.basis else self.model.modal_equations(basis)


class CaseResult(NamedTuple):
    """Result of one case: the fields of `Sweep`."""

    peak: float
    largest: float
    time_error: float
    status: str
    by_direction: tuple[float, ...]


def solve_chunk(request: SweepRequest, speeds: tuple[float, ...]) -> list[CaseResult]:
    """Solve the cases of one chunk, each with its own steps."""
    solve = _solve_transient if request.scene.physics.large_deflection else _solve
    with one_blas_thread(), np.errstate(all="ignore"):
        return [solve(request, speed) for speed in speeds]


def _solve(request: SweepRequest, speed: float) -> CaseResult:
    """Solve one case by its equations as `simulate` does; of its motion only peaks of the tip are kept."""
    equations, motion = request.modal_equations(speed), request.motion(speed)
    system = ModalSystem.from_rest(equations, motion, request.t_end)
    try:
        path, error, _ = integrate(system, np.zeros(2 * system.size), request.t_end, request.tolerance)
    except (ArithmeticError, np.linalg.LinAlgError) as reason:
        return _failed(request, reason_of(reason))
    tip, outputs = path.projected(system.tips), np.eye(len(system.tips))
    windows = [request.window, (tip.start, tip.end)]
    peak, largest = largest_in_each(lambda q: magnitude(q, outputs), tip, windows)
    if not np.isfinite(largest):
        return _failed(request, "not finite")
    each = [peak] if len(outputs) == 1 else [_peak_of(output, tip, request.window) for output in outputs]
    return CaseResult(peak, max(peak, largest), error, DONE, tuple(each))


def _peak_of(output: np.ndarray, path: Trajectory, window: tuple[float, float]) -> float:
    """Largest magnitude in a window of one linear function of the coordinates, (n,) per unit of each."""
    return largest_on(lambda q: magnitude(q, output[None]), path, *window)


def _solve_transient(request: SweepRequest, speed: float) -> CaseResult:
    """Solve one case of large deflection."""
    try:
        run = request.transient_request(speed).run()
        peak = run.peak(*request.window)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return _failed(request, reason_of(error))
    if not np.isfinite(peak):
        return _failed(request, "not finite")
    by_direction = [run.peak(*request.window, i) for i in range(request.directions)]
    return CaseResult(peak, run.largest, run.time_error, DONE, tuple(by_direction))


def _failed(request: SweepRequest, reason: str) -> CaseResult:
    return CaseResult(np.nan, np.nan, np.nan, f"failed: {reason}", (np.nan,) * request.directions)
