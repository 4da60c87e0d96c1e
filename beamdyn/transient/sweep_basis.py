"""Modal bases of a sweep, with the modes that sampled speeds need to keep the tolerance."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.modes.modal.modal_basis import FEWEST_MODES, ModalBasis, find_speed_range
from beamdyn.transient.chunks import SweepRequest
from beamdyn.transient.smallest_basis import run_smallest_basis
from beamdyn.transient.transient import Transient


def first_basis(request: SweepRequest, speeds: tuple[float, ...]) -> ModalBasis:
    """Smallest modal basis that is tried: modes at the slowest and at the fastest speed of all cases."""
    return ModalBasis(FEWEST_MODES, tuple(end_speeds(request, speeds).tolist()))


def end_speeds(request: SweepRequest, speeds: tuple[float, ...]) -> np.ndarray:
    """The slowest and the fastest speed of all cases [rad/s], one where they are the same."""
    ends = [
        find_speed_range(motion, request.t_end) for motion in map(request.motion, (speeds[0], speeds[-1]))
    ]
    return np.unique([ends[0][0], ends[1][-1]])


def list_samples(speeds: tuple[float, ...]) -> list[float]:
    """Speeds [rad/s] at which `mode_error` is estimated: the slowest that moves, the fastest, and between."""
    slowest = min(1, len(speeds) - 1) if speeds[0] == 0 else 0
    return sorted({speeds[max(slowest, k * (len(speeds) - 1) // 4)] for k in range(5)})


@one_blas_thread()
def run_samples(request: SweepRequest, speeds: tuple[float, ...]) -> list[Transient]:
    """Run the samples in bases that suffice, each beginning with one mode fewer than the one before needed.

    If some take modes at their speeds and others at rest, all run in one basis: at rest if that keeps the
    tolerance, as this takes fewer coordinates; else at their speeds if that does, or else in the better.
    """
    samples, basis = [], request.basis
    for speed in list_samples(speeds):
        samples.append(run_smallest_basis(replace(request, basis=basis).transient_request(speed)))
        needed = samples[-1].request.basis
        if needed.is_at_rest == basis.is_at_rest:
            basis = replace(basis, modes=max(FEWEST_MODES, (needed.modes or 0) - 1))
    if len({run.request.basis.is_at_rest for run in samples}) == 1:
        return samples
    most, tried = _most_modes(samples), []
    for each in (ModalBasis(most), replace(request.basis, modes=most)):
        tried.append(_run_in_basis(replace(request, basis=each), speeds, samples))
        if largest_mode_error(tried[-1]) <= request.tolerance:
            break
    return min(tried, key=largest_mode_error)


@one_blas_thread()
def _run_in_basis(
    request: SweepRequest, speeds: tuple[float, ...], samples: Sequence[Transient]
) -> list[Transient]:
    """Run the samples in the basis of the request, except those that were run in it before."""
    runs = []
    for speed, run in zip(list_samples(speeds), samples, strict=True):
        basis = request.basis_at(speed)
        same = (run.request.basis, run.request.tolerance) == (basis, request.tolerance)
        runs.append(run if same else replace(run.request, basis=basis, tolerance=request.tolerance).run())
    return runs


def with_basis_of(request: SweepRequest, speeds: tuple[float, ...], runs: list[Transient]) -> SweepRequest:
    """The request with the modal bases of its samples."""
    at_rest = runs[0].request.basis.is_at_rest
    basis = ModalBasis(_most_modes(runs), (0.0,) if at_rest else request.basis.speeds)
    modes = [run.request.basis.modes or 0 for run in runs]
    return replace(request, basis=basis, modes_at=tuple(zip(list_samples(speeds), modes, strict=True)))


def _most_modes(runs: Sequence[Transient]) -> int:
    """Largest number of modes of some runs."""
    return max(run.request.basis.modes or 0 for run in runs)


def largest_mode_error(runs: Iterable[Transient]) -> float:
    """Largest modal truncation error of the runs, relative to the largest deflection of each."""
    return max((run.mode_error for run in runs), default=0.0)
