"""Cases of a sweep: what is asked of each, and the answers of a chunk of them, together or one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.operators import Discretization
from beamdyn.modal.error_estimate import Model, choose
from beamdyn.modal.modal_basis import FEWEST, Kept
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.transient.batch import histories
from beamdyn.transient.simulate import Task
from beamdyn.transient.step_size import Trajectory, largest_deflection
from beamdyn.transient.system import ModalSystem

DONE = "done"


@dataclass(frozen=True)
class Request:
    """What is asked of each case: see `sweep`."""

    scene: Scene
    window: tuple[float, float]
    t_end: float
    tolerance: float
    discretization: str | Discretization
    kept: Kept = field(default=Kept(FEWEST))

    def task(self, motion: Motion) -> Task:
        """One case alone."""
        scene = replace(self.scene, motion=motion)
        return Task(
            scene, self.t_end, self.tolerance, "auto", self.discretization, "rest", None, {}, self.kept
        )

    def motions(self, speeds: Sequence[float]) -> list[Motion]:
        """The motion at each speed."""
        assert self.scene.motion is not None
        return [self.scene.motion.with_speed(v) for v in speeds]

    def model(self) -> Model:
        """The discretized scene."""
        wanted, target = self.kept.modes or 1, 1e-3 * self.tolerance
        return choose(self.scene, self.discretization, np.array(self.kept.speeds), wanted, target)


class Case(NamedTuple):
    """The answer of one case: see `Sweep`."""

    peak: float
    largest: float
    time_error: float
    status: str


def solve(request: Request, speeds: tuple[float, ...]) -> list[Case]:
    """Cases of one chunk: together, and alone where that is not as accurate as is asked."""
    motions = request.motions(speeds)
    with one_blas_thread(), np.errstate(all="ignore"):
        return [
            case if case.time_error <= request.tolerance * case.largest else _alone(request, motion)
            for case, motion in zip(_together(request, motions), motions, strict=True)
        ]


def _together(request: Request, motions: Sequence[Motion]) -> list[Case]:
    modal = request.model().modal(request.kept)
    systems = [ModalSystem(modal.equations, motion) for motion in motions]
    try:
        found = histories(systems, modal.tip, request.t_end, request.tolerance)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return [_failed(str(error))] * len(motions)
    return [_case(request, *pair) for pair in zip(found.tips, found.time_error, strict=True)]


def _alone(request: Request, motion: Motion) -> Case:
    """One case by `simulate`, which refines its steps until the tolerance is met."""
    try:
        run = request.task(motion).run()
        peak = run.peak(*request.window)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return _failed(str(error))
    return Case(peak, run.largest, run.time_error, DONE) if np.isfinite(peak) else _failed("not finite")


def _case(request: Request, path: Trajectory, error: float) -> Case:
    """The case of a trajectory whose only coordinate is the tip deflection."""
    peak = largest_deflection(np.ones(1), path, *request.window)
    return Case(peak, max(peak, float(np.abs(path.samples[1]).max())), float(error), DONE)


def _failed(reason: str) -> Case:
    return Case(np.nan, np.nan, np.nan, f"failed: {reason}")
