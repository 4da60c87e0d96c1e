"""The cases of a sweep: the request, and the answers of one chunk of cases, together or one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.modal.choice import DiscretizationChoice, choose_model
from beamdyn.modal.modal_basis import FEWEST_MODES, ModalBasis
from beamdyn.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.transient.batch import integrate_batch
from beamdyn.transient.simulate import TransientRequest
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import Trajectory, largest_deflection

DONE = "done"


@dataclass(frozen=True)
class SweepRequest:
    """The arguments of `sweep` that each case depends on, checked."""

    scene: Scene
    window: tuple[float, float]
    t_end: float
    tolerance: float
    discretization: DiscretizationChoice
    basis: ModalBasis = field(default=ModalBasis(FEWEST_MODES))

    def single(self, motion: Motion) -> TransientRequest:
        """The request of one case alone."""
        scene, method, rest = replace(self.scene, motion=motion), "auto", "rest"
        return TransientRequest(
            scene, self.t_end, self.tolerance, method, self.discretization, rest, None, {}, self.basis
        )

    def motions(self, speeds: Sequence[float]) -> list[Motion]:
        """The motion at each speed [rad/s]."""
        assert self.scene.motion is not None
        return [self.scene.motion.with_speed(v) for v in speeds]

    def model(self) -> Model:
        """The discretized scene."""
        modes, target = self.basis.modes or 1, 1e-3 * self.tolerance
        return choose_model(self.scene, self.discretization, np.array(self.basis.speeds), modes, target)


class CaseResult(NamedTuple):
    """The answer of one case: see `Sweep`."""

    peak: float
    largest: float
    time_error: float
    status: str


def solve_chunk(request: SweepRequest, speeds: tuple[float, ...]) -> list[CaseResult]:
    """Solve the cases of one chunk together, and alone those that miss the tolerance."""
    motions = request.motions(speeds)
    with one_blas_thread(), np.errstate(all="ignore"):
        return [
            case if case.time_error <= request.tolerance * case.largest else _solve_alone(request, motion)
            for case, motion in zip(_solve_together(request, motions), motions, strict=True)
        ]


def _solve_together(request: SweepRequest, motions: Sequence[Motion]) -> list[CaseResult]:
    equations = request.model().modal_equations(request.basis)
    systems = [ModalSystem(equations, motion) for motion in motions]
    try:
        batch = integrate_batch(systems, request.t_end, request.tolerance)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return [_failed(str(error))] * len(motions)
    return [_measure(request, *pair) for pair in zip(batch.tips, batch.time_error, strict=True)]


def _solve_alone(request: SweepRequest, motion: Motion) -> CaseResult:
    """One case by `simulate`, which refines its steps until the tolerance is met."""
    try:
        run = request.single(motion).run()
        peak = run.peak(*request.window)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return _failed(str(error))
    return CaseResult(peak, run.largest, run.time_error, DONE) if np.isfinite(peak) else _failed("not finite")


def _measure(request: SweepRequest, path: Trajectory, error: float) -> CaseResult:
    """The answer from a trajectory whose only coordinate is the tip deflection."""
    peak = largest_deflection(np.ones(1), path, *request.window)
    return CaseResult(peak, max(peak, float(np.abs(path.samples[1]).max())), float(error), DONE)


def _failed(reason: str) -> CaseResult:
    return CaseResult(np.nan, np.nan, np.nan, f"failed: {reason}")
