"""Cases of a sweep: the request, and the solution of one chunk of cases, each with its own steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modal.choice import DiscretizationChoice
from beamdyn.modal.modal_basis import FEWEST_MODES, ModalBasis
from beamdyn.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.transient.integration import integrate
from beamdyn.transient.model_of_basis import choose_for_basis
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import largest_deflection
from beamdyn.transient.transient import TransientRequest

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

    @cached_property
    def modal_equations(self) -> Equations:
        """The equations of motion in the modal basis."""
        return self.model.modal_equations(self.basis)


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
        return [solve(request, motion) for motion in request.motions(speeds)]


def _solve(request: SweepRequest, motion: Motion) -> CaseResult:
    """Solve one case by its equations as `simulate` does; of its motion only peaks of the tip are kept."""
    system = ModalSystem.from_rest(request.modal_equations, motion, request.t_end)
    try:
        path, error, _ = integrate(system, np.zeros(2 * system.size), request.t_end, request.tolerance)
    except (ArithmeticError, np.linalg.LinAlgError) as reason:
        return _failed(request, str(reason))
    tip = path.projected(system.tips)
    outputs = np.eye(len(system.tips))
    peak, largest = (largest_deflection(outputs, tip, *w) for w in (request.window, (tip.start, tip.end)))
    if not np.isfinite(largest):
        return _failed(request, "not finite")
    each = (
        [largest_deflection(o[None], tip, *request.window) for o in outputs] if len(outputs) > 1 else [peak]
    )
    return CaseResult(peak, max(peak, largest), error, DONE, tuple(each))


def _solve_transient(request: SweepRequest, motion: Motion) -> CaseResult:
    """Solve one case of large deflection."""
    try:
        run = request.transient_request(motion).run()
        peak = run.peak(*request.window)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return _failed(request, str(error))
    if not np.isfinite(peak):
        return _failed(request, "not finite")
    by_direction = [run.peak(*request.window, i) for i in range(request.directions)]
    return CaseResult(peak, run.largest, run.time_error, DONE, tuple(by_direction))


def _failed(request: SweepRequest, reason: str) -> CaseResult:
    return CaseResult(np.nan, np.nan, np.nan, f"failed: {reason}", (np.nan,) * request.directions)
