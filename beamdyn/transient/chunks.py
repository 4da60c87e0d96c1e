"""Request of a sweep over speeds, and the solution of one chunk (group) of its cases."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import FEWEST_MODES, ModalBasis, Model, find_speed_range
from beamdyn.scene.motion.base import Motion
from beamdyn.scene.scene import Scene
from beamdyn.transient.integration import integrate
from beamdyn.transient.problem import choose_for_basis
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import largest_in_each, largest_on, magnitude
from beamdyn.transient.transient import TransientRequest

DONE = "done"


@dataclass(frozen=True)
class SweepRequest(FieldsOnly):
    """Checked arguments of `sweep`, from which every case (one final speed) is computed.

    All cases share `basis` if it consists of modes at rest; else each case uses modes at the slowest and the
    fastest speed of its own motion.  `modes_at`, if not empty, has pairs of a speed [rad/s], ascending, and
    the number of modes that it needs: each case uses the larger number of the two neighbouring speeds.
    """

    scene: Scene
    window: tuple[float, float]
    t_end: float
    tolerance: float
    discretization: DiscretizationChoice
    basis: ModalBasis = field(default=ModalBasis(FEWEST_MODES))
    modes_at: tuple[tuple[float, int], ...] = ()

    def transient_request(self, speed: float) -> TransientRequest:
        """Build the request of one case's transient, given by its final speed [rad/s]."""
        scene, basis = replace(self.scene, motion=self.motion(speed)), self.basis_at(speed)
        how = "auto", self.discretization, "rest", None, {}
        return TransientRequest(scene, self.t_end, self.tolerance, *how, basis)

    def basis_at(self, speed: float) -> ModalBasis:
        """Choose the modal basis of one case: modes at rest, or at its slowest and its fastest speed."""
        basis = self.basis
        if self.modes_at:
            speeds, modes = zip(*self.modes_at, strict=True)
            after = bisect_right(speeds, speed)
            basis = replace(basis, modes=max(modes[max(after - 1, 0) : after + 1]))
        at_rest = basis.is_at_rest
        return basis if at_rest else replace(basis, speeds=find_speed_range(self.motion(speed), self.t_end))

    @property
    def directions(self) -> int:
        """Number of directions in which the beam bends."""
        return self.scene.physics.planes

    def motion(self, speed: float) -> Motion:
        """Build the motion of one case, given by its final speed [rad/s]."""
        assert self.scene.motion is not None
        return self.scene.motion.with_speed(speed)

    @cached_property
    def model(self) -> Model:
        """Discretized scene, chosen for the modal basis and the tolerance."""
        return choose_for_basis(self.scene, self.discretization, self.basis, self.tolerance)

    @property
    def basis_name(self) -> str:
        """Description of the modal bases of all cases, in words."""
        if self.basis.is_at_rest:
            return str(self.basis)
        fewest = min((modes for _, modes in self.modes_at), default=self.basis.modes)
        modes = f"{self.basis.modes}" if fewest == self.basis.modes else f"{fewest} to {self.basis.modes}"
        noun = "mode" if modes == "1" else "modes"
        speeds = " to ".join(f"{speed:.4g}" for speed in self.basis.speeds)
        return f"{modes} {noun} at the slowest and at the fastest speed of each case ({speeds} rad/s)"

    @cached_property
    def _shared_equations(self) -> Equations:
        """Equations of motion in the basis that all cases share."""
        return self.model.modal_equations(self.basis)

    def modal_equations(self, speed: float) -> Equations:
        """Build the equations of motion of one case in its modal basis."""
        basis = self.basis_at(speed)
        return self._shared_equations if basis == self.basis else self.model.modal_equations(basis)


class CaseResult(NamedTuple):
    """Result of one case of a sweep, with the fields of `Sweep`."""

    peak: float
    largest: float
    time_error: float
    status: str
    by_direction: tuple[float, ...]


def solve_chunk(request: SweepRequest, speeds: tuple[float, ...]) -> list[CaseResult]:
    """Solve the cases of one chunk, each with its own steps."""
    with one_blas_thread(), np.errstate(all="ignore"):
        return [_solve(request, speed) for speed in speeds]


def _solve(request: SweepRequest, speed: float) -> CaseResult:
    """Solve one case as `simulate` does, but keep only the peaks of the tip deflection."""
    reason = "not finite"
    try:
        if request.scene.physics.large_deflection:
            found = request.transient_request(speed).solve()
            largest, error = found.largest, found.error
            peak = found.peak(*request.window)
            each = [found.peak(*request.window, direction) for direction in range(request.directions)]
        else:
            equations, motion = request.modal_equations(speed), request.motion(speed)
            system = ModalSystem.from_rest(equations, motion, request.t_end)
            path, error, _ = integrate(system, np.zeros(2 * system.size), request.t_end, request.tolerance)
            tip, outputs = path.projected(system.tips), np.eye(len(system.tips))
            windows = [request.window, (tip.start, tip.end)]
            peak, largest = largest_in_each(lambda q: magnitude(q, outputs), tip, windows)
            largest, each = max(peak, largest), [peak]
            if len(outputs) > 1:
                alone = (tip.projected(output[None]) for output in outputs)
                each = [largest_on(lambda q: np.abs(q[:, 0]), one, *request.window) for one in alone]
    except (ArithmeticError, np.linalg.LinAlgError) as stopped:
        peak, largest, error, each, reason = np.nan, np.nan, np.nan, [], reason_of(stopped)
    if not np.isfinite([peak, largest]).all():
        return CaseResult(np.nan, np.nan, np.nan, f"failed: {reason}", (np.nan,) * request.directions)
    return CaseResult(peak, largest, error, DONE, tuple(each))
