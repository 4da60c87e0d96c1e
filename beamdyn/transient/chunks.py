"""Cases of a sweep: the request, and the solution of one chunk of cases, as a batch or one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.pickling import FieldsOnly
from beamdyn.modal.choice import DiscretizationChoice
from beamdyn.modal.modal_basis import FEWEST_MODES, ModalBasis
from beamdyn.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.transient.batch import integrate_batch
from beamdyn.transient.model_of_basis import choose_for_basis
from beamdyn.transient.record_steps import is_record
from beamdyn.transient.simulate import TransientRequest
from beamdyn.transient.step_size import StepSize, TooManySteps
from beamdyn.transient.system import ModalSystem, excited_equations
from beamdyn.transient.trajectory import Trajectory, largest_deflection

DONE = "done"


@dataclass(frozen=True)
class SweepRequest(FieldsOnly):
    """Checked arguments of `sweep` on which each case depends."""

    scene: Scene
    window: tuple[float, float]
    t_end: float
    tolerance: float
    discretization: DiscretizationChoice
    basis: ModalBasis = field(default=ModalBasis(FEWEST_MODES))

    def transient_request(self, motion: Motion) -> TransientRequest:
        """Request of the transient of one case."""
        scene, method, rest = replace(self.scene, motion=motion), "auto", "rest"
        return TransientRequest(
            scene, self.t_end, self.tolerance, method, self.discretization, rest, None, {}, self.basis
        )

    @property
    def directions(self) -> int:
        """Number of directions in which the beam bends."""
        return self.scene.physics.planes

    def motions(self, speeds: Sequence[float]) -> list[Motion]:
        """Motion at each final speed [rad/s]."""
        assert self.scene.motion is not None
        return [self.scene.motion.with_speed(v) for v in speeds]

    @cached_property
    def model(self) -> Model:
        """The discretized scene, chosen for the modal basis and the tolerance."""
        return choose_for_basis(self.scene, self.discretization, self.basis, 1e-3 * self.tolerance)


class CaseResult(NamedTuple):
    """Result of one case: the fields of `Sweep`."""

    peak: float
    largest: float
    time_error: float
    status: str
    by_direction: tuple[float, ...]


def solve_chunk(request: SweepRequest, speeds: tuple[float, ...]) -> list[CaseResult]:
    """Solve the cases of one chunk as a batch, and again one by one those that exceed the tolerance."""
    motions = request.motions(speeds)
    with one_blas_thread(), np.errstate(all="ignore"):
        return [
            case if case.time_error <= request.tolerance * case.largest else _solve_single(request, motion)
            for case, motion in zip(_solve_batch(request, motions), motions, strict=True)
        ]


def _solve_batch(request: SweepRequest, motions: Sequence[Motion]) -> list[CaseResult]:
    if request.scene.physics.large_deflection:
        return [_solve_single(request, motion) for motion in motions]
    equations = excited_equations(request.model.modal_equations(request.basis), motions, request.t_end)
    systems = [ModalSystem(equations, motion) for motion in motions]
    if is_record(systems[-1], request.t_end, StepSize.from_tolerance(request.tolerance)):
        # A batch has no steps over several samples.
        return [_solve_single(request, motion) for motion in motions]
    try:
        batch = integrate_batch(systems, request.t_end, request.tolerance)
    except TooManySteps:
        if (half := len(motions) // 2) == 0:
            raise
        return [*_solve_batch(request, motions[:half]), *_solve_batch(request, motions[half:])]
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return [_failed(request, str(error))] * len(motions)
    return [_case_result(request, *pair) for pair in zip(batch.tips, batch.time_error, strict=True)]


def _solve_single(request: SweepRequest, motion: Motion) -> CaseResult:
    """Solve one case as `simulate` does, which refines its step size until the tolerance is met."""
    try:
        run = request.transient_request(motion).run()
        peak = run.peak(*request.window)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return _failed(request, str(error))
    if not np.isfinite(peak):
        return _failed(request, "not finite")
    by_direction = [run.peak(*request.window, i) for i in range(request.directions)]
    return CaseResult(peak, run.largest, run.time_error, DONE, tuple(by_direction))


def _case_result(request: SweepRequest, path: Trajectory, error: float) -> CaseResult:
    """Result of a case from a trajectory whose coordinates are the tip deflections in each direction."""
    outputs = np.eye(path.segments[0].acceleration.shape[2])
    windows = request.window, (path.start, path.end)
    peak, largest = (largest_deflection(outputs, path, *window) for window in windows)
    each = (
        [peak] if len(outputs) == 1 else [largest_deflection(o[None], path, *request.window) for o in outputs]
    )
    return CaseResult(peak, max(peak, largest), float(error), DONE, tuple(each))


def _failed(request: SweepRequest, reason: str) -> CaseResult:
    return CaseResult(np.nan, np.nan, np.nan, f"failed: {reason}", (np.nan,) * request.directions)
